// A canvas in metres east and north that pans and zooms; what lies on it is drawn by `paint`.
const maps = [];
class GroundMap {
  constructor(canvas) {
    this.canvas = canvas;
    this.picture = document.createElement("canvas");
    this.scale = 0;
    this.centre = [0, 0];
    this.background = [];
    this.stale = true;
    maps.push(this);
    new ResizeObserver(() => { this.stale = true; this.refresh(); }).observe(canvas);
    listenToMap(this);
  }
  px(x) { return this.width / 2 + (x - this.centre[0]) * this.scale; }
  py(y) { return this.height / 2 - (y - this.centre[1]) * this.scale; }

  // Show a rectangle [west, east, south, north].
  fit([a, b, c, d]) {
    const pad = Math.min(44, this.width / 9), buttons = 28;
    const wide = Math.max(b - a, 20), high = Math.max(d - c, 20);
    this.scale = Math.min((this.width - 2 * pad - buttons) / wide, (this.height - 2 * pad) / high);
    this.centre = [(a + b) / 2 - buttons / 2 / this.scale, (c + d) / 2];
    this.redraw();
  }
  redraw() { this.stale = true; requestMaps(); }
  refresh() {
    const { canvas, picture } = this, ratio = Math.max(window.devicePixelRatio || 1, this.sharp || 1);
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    if (!this.width) return;
    const w = Math.round(this.width * ratio), h = Math.round(this.height * ratio);
    if (!this.scale || this.fitted !== w) { this.fitted = w; this.home(); }
    if (this.stale || picture.width !== w || picture.height !== h) {
      picture.width = canvas.width = w;
      picture.height = canvas.height = h;
      const c = picture.getContext("2d");
      c.scale(ratio, ratio);
      this.draw(c);
      this.stale = false;
    }
    const c = canvas.getContext("2d");
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, w, h);
    c.drawImage(picture, 0, 0);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const [p, hue] of view.now === null ? [] : this.cursors(view.now)) this.blob(c, p, hue);
  }
  blob(c, p, hue) {
    c.beginPath(); c.arc(this.px(p[0]), this.py(p[1]), 6.5, 0, 6.3);
    c.fillStyle = colour(hue);
    c.fill();
    c.lineWidth = 2.5;
    c.strokeStyle = colour("card");
    c.stroke();
  }

  draw(c) {
    this.grid(c);
    this.backdrop(c);
    c.lineJoin = c.lineCap = "round";
    this.paint(c);
    this.furniture(c);
  }
  grid(c) {
    const step = niceStep(this.width / this.scale, this.width / 130);
    const across = this.width / this.scale / 2, up = this.height / this.scale / 2, [x0, y0] = this.centre;
    c.strokeStyle = colour("grid");
    c.lineWidth = 1;
    c.beginPath();
    for (let k = Math.ceil((x0 - across) / step); k * step < x0 + across; k++) { const x = Math.round(this.px(k * step)) + 0.5; c.moveTo(x, 0); c.lineTo(x, this.height); }
    for (let k = Math.ceil((y0 - up) / step); k * step < y0 + up; k++) { const y = Math.round(this.py(k * step)) + 0.5; c.moveTo(0, y); c.lineTo(this.width, y); }
    c.stroke();
  }
  backdrop(c) {
    c.lineWidth = 1.2;
    c.strokeStyle = colour("ground");
    c.fillStyle = colour("ground", 0.35);
    for (const { area, rings } of this.background) {
      c.beginPath();
      for (const ring of rings) {
        for (let i = 0; i < ring.length; i += 2) c.lineTo(this.px(ring[i]), this.py(ring[i + 1]));
        c.moveTo(0, 0);
      }
      if (area) c.fill("evenodd");
    }
    for (const { rings } of this.background) for (const ring of rings) {
      c.beginPath();
      for (let i = 0; i < ring.length; i += 2) c.lineTo(this.px(ring[i]), this.py(ring[i + 1]));
      c.stroke();
    }
  }
  line(c, p, hue, { width = 2, dash = [], gap = Infinity, alpha = 1, from = -Infinity, to = Infinity } = {}) {
    c.strokeStyle = colour(hue);
    c.lineWidth = width;
    c.globalAlpha = alpha;
    c.setLineDash(dash);
    c.beginPath();
    const a = alongPath(p, from), b = alongPath(p, to);
    if (a) c.moveTo(this.px(a[0]), this.py(a[1]));
    let pen = Boolean(a);
    for (let i = from === -Infinity ? 0 : below(p.t, from) + 1; i < p.t.length && p.t[i] <= to; i++) {
      const X = this.px(p.x[i]), Y = this.py(p.y[i]);
      if (pen && (i === 0 || p.t[i] - p.t[i - 1] < gap)) c.lineTo(X, Y); else c.moveTo(X, Y);
      pen = true;
    }
    if (b) c.lineTo(this.px(b[0]), this.py(b[1]));
    c.stroke();
    c.setLineDash([]);
    c.globalAlpha = 1;
  }
  ellipse(c, [, x, y, a, b, angle], hue, strength = 1) {
    c.beginPath();
    c.ellipse(this.px(x), this.py(y), a * this.scale, b * this.scale, -angle, 0, 2 * Math.PI);
    c.lineWidth = 1;
    c.fillStyle = colour(hue, 0.06 * strength); c.fill();
    c.strokeStyle = colour(hue, 0.4 * strength); c.stroke();
  }
  label(c, text, x, y, align, hue = "ink") {
    c.textAlign = align;
    c.lineWidth = 4;
    c.lineJoin = "round";
    c.strokeStyle = colour("card");
    c.strokeText(text, x, y);
    c.fillStyle = colour(hue);
    c.fillText(text, x, y);
  }
  furniture(c) {
    const room = Math.min(150, this.width / 3) / this.scale, power = 10 ** Math.floor(Math.log10(room));
    const length = [5, 2, 1].map(k => k * power).find(k => k <= room), w = length * this.scale;
    const x = this.width - 22 - w, y = this.height - 18, X = this.width - 30, Y = 24;
    c.strokeStyle = colour("ink");
    c.lineWidth = 1.5;
    c.lineCap = "butt";
    c.beginPath(); c.moveTo(x, y - 5); c.lineTo(x, y); c.lineTo(x + w, y); c.lineTo(x + w, y - 5); c.stroke();
    c.font = font(12);
    c.textBaseline = "alphabetic";
    this.label(c, length >= 1000 ? `${length / 1000} km` : `${+length.toPrecision(1)} m`, x + w / 2, y - 8, "center");
    c.fillStyle = colour("ink");
    c.beginPath(); c.moveTo(X, Y - 8); c.lineTo(X + 6, Y + 9); c.lineTo(X, Y + 5); c.lineTo(X - 6, Y + 9); c.closePath(); c.fill();
    c.font = font(12, 600);
    this.label(c, "N", X, Y + 24, "center");
  }

  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const dx = x - this.width / 2, dy = this.height / 2 - y, before = this.scale;
    this.scale = Math.min(Math.max(before * factor, 1e-4), 500);
    this.centre[0] += dx / before - dx / this.scale;
    this.centre[1] += dy / before - dy / this.scale;
    this.redraw();
  }
  pan(dx, dy) {
    this.centre[0] -= dx / this.scale;
    this.centre[1] += dy / this.scale;
    this.redraw();
  }
}

let requested = false;
function requestMaps() {
  if (requested) return;
  requested = true;
  requestAnimationFrame(() => { requested = false; for (const m of maps) m.refresh(); });
}
onTime.push(requestMaps);
onTheme.push(() => { for (const m of maps) { m.stale = true; m.refresh(); } });
onPrint.push(() => { for (const m of maps) { m.sharp = 3; m.stale = true; } });
addEventListener("afterprint", () => { for (const m of maps) { m.sharp = 1; m.redraw(); } });
