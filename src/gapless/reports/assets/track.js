// The track from above: equal scales, metres east and north, with fixes, reference and ellipses.
class Track extends Drawing {
  constructor(canvas) {
    super(canvas);
    this.track = data.track;
    this.listen();
    this.key();
  }

  bounds(from = -Infinity, to = Infinity) {
    const { t, x, y } = this.track;
    let [a, b, c, d] = [Infinity, -Infinity, Infinity, -Infinity];
    const take = (px, py) => { a = Math.min(a, px); b = Math.max(b, px); c = Math.min(c, py); d = Math.max(d, py); };
    for (let i = 0; i < t.length; i++) if (t[i] >= from && t[i] <= to) take(x[i], y[i]);
    for (const e of this.track.ellipses) if (e[0] >= from && e[0] <= to) { take(e[1] - e[3], e[2] - e[3]); take(e[1] + e[3], e[2] + e[3]); }
    for (const time of [from, to]) { const p = Number.isFinite(time) && this.at(time); if (p) take(p[0], p[1]); }
    return a <= b ? [a, b, c, d] : [-50, 50, -50, 50];
  }
  fit(from, to) {
    const [a, b, c, d] = this.bounds(from, to), pad = 40, buttons = 28;
    const wide = Math.max(b - a, 20), high = Math.max(d - c, 20);
    this.scale = Math.min((this.width - 2 * pad - buttons) / wide, (this.height - 2 * pad) / high);
    this.centre = [(a + b) / 2 - buttons / 2 / this.scale, (c + d) / 2];
    this.stale = true;
    request();
  }
  px(x) { return this.width / 2 + (x - this.centre[0]) * this.scale; }
  py(y) { return this.height / 2 - (y - this.centre[1]) * this.scale; }

  // Where the track is at a time; straight and even between the rows kept.
  at(time) {
    const { t, x, y } = this.track, i = below(t, time);
    if (i < 0 || time > t[t.length - 1]) return null;
    if (i === t.length - 1) return [x[i], y[i]];
    const w = (time - t[i]) / (t[i + 1] - t[i]);
    return [x[i] + w * (x[i + 1] - x[i]), y[i] + w * (y[i + 1] - y[i])];
  }

  draw(c) {
    if (!this.scale || this.fitted !== this.width) { this.fitted = this.width; this.fit(); }
    this.grid(c);
    const [open, away] = this.track.fixes;
    this.dots(c, open, 0.5);
    this.dots(c, away, 0.5, true);
    this.ellipses(c);
    c.lineJoin = c.lineCap = "round";
    if (this.track.reference) this.path(c, this.track.reference, "ink", 1.2, 30);
    this.path(c, this.track, "c0", 2.2);
    for (const [a, b] of this.track.coasting) this.stretch(c, a, b);
    this.ends(c);
    this.numbers(c);
    this.furniture(c);
  }

  grid(c) {
    const { step } = ticks(0, this.width / this.scale, this.width / 130);
    c.strokeStyle = colour("grid");
    c.lineWidth = 1;
    c.beginPath();
    for (let k = Math.floor((this.centre[0] - this.width / this.scale) / step); k * step < this.centre[0] + this.width / this.scale; k++) {
      const x = Math.round(this.px(k * step)) + 0.5; c.moveTo(x, 0); c.lineTo(x, this.height);
    }
    for (let k = Math.floor((this.centre[1] - this.height / this.scale) / step); k * step < this.centre[1] + this.height / this.scale; k++) {
      const y = Math.round(this.py(k * step)) + 0.5; c.moveTo(0, y); c.lineTo(this.width, y);
    }
    c.stroke();
  }
  dots(c, p, alpha, hollow = false) {
    const r = Math.min(3.2, 1.2 + 0.6 * Math.sqrt(this.scale));
    c.globalAlpha = hollow ? 0.8 : alpha;
    c.fillStyle = c.strokeStyle = colour("fix");
    c.lineWidth = 1;
    for (let i = 0; i < p.x.length; i++) {
      c.beginPath(); c.arc(this.px(p.x[i]), this.py(p.y[i]), r, 0, 6.3);
      if (hollow) c.stroke(); else c.fill();
    }
    c.globalAlpha = 1;
  }
  path(c, p, hue, width, gap = Infinity) {
    c.strokeStyle = colour(hue);
    c.lineWidth = width;
    c.beginPath();
    for (let i = 0; i < p.x.length; i++) {
      const X = this.px(p.x[i]), Y = this.py(p.y[i]);
      if (i && p.t[i] - p.t[i - 1] < gap) c.lineTo(X, Y); else c.moveTo(X, Y);
    }
    c.stroke();
  }
  stretch(c, a, b) {
    const { t, x, y } = this.track, start = this.at(a), end = this.at(b);
    if (!start || !end) return;
    c.strokeStyle = colour("alone");
    c.lineWidth = 3.4;
    c.beginPath();
    c.moveTo(this.px(start[0]), this.py(start[1]));
    for (let i = below(t, a) + 1; i < t.length && t[i] < b; i++) c.lineTo(this.px(x[i]), this.py(y[i]));
    c.lineTo(this.px(end[0]), this.py(end[1]));
    c.stroke();
  }
  ellipses(c) {
    c.lineWidth = 1;
    for (const [, x, y, a, b, angle] of this.track.ellipses) {
      c.beginPath();
      c.ellipse(this.px(x), this.py(y), a * this.scale, b * this.scale, -angle, 0, 2 * Math.PI);
      c.fillStyle = c.strokeStyle = colour("alone");
      c.globalAlpha = 0.05; c.fill();
      c.globalAlpha = 0.38; c.stroke();
    }
    c.globalAlpha = 1;
  }
  ends(c) {
    const { x, y } = this.track, last = x.length - 1;
    c.font = font(12, 600);
    c.textBaseline = "middle";
    for (const [i, name, square] of [[0, "start", false], [last, "end", true]]) {
      const X = this.px(x[i]), Y = this.py(y[i]);
      c.fillStyle = colour("card");
      c.strokeStyle = colour("ink");
      c.lineWidth = 2.5;
      c.beginPath();
      if (square) c.rect(X - 4.5, Y - 4.5, 9, 9); else c.arc(X, Y, 5, 0, 6.3);
      c.fill(); c.stroke();
      this.label(c, name, X + 11, Y + (square ? 9 : -9), "left");
    }
  }
  numbers(c) {
    c.font = font(11, 650);
    c.textBaseline = "middle";
    data.outages.forEach(([a, b], k) => {
      const p = this.at(Math.min(Math.max((a + b) / 2, this.track.t[0]), b));
      if (!p) return;
      const X = this.px(p[0]), Y = this.py(p[1]);
      c.fillStyle = colour("card");
      c.strokeStyle = colour("alone");
      c.lineWidth = 2;
      c.beginPath(); c.arc(X, Y, 9.5, 0, 6.3); c.fill(); c.stroke();
      c.fillStyle = colour("alone");
      c.textAlign = "center";
      c.fillText(String(k + 1), X, Y + 0.5);
    });
  }
  label(c, text, x, y, align) {
    c.textAlign = align;
    c.lineWidth = 4;
    c.lineJoin = "round";
    c.strokeStyle = colour("card");
    c.strokeText(text, x, y);
    c.fillStyle = colour("ink");
    c.fillText(text, x, y);
  }
  furniture(c) {
    const room = Math.min(150, this.width / 3) / this.scale, power = 10 ** Math.floor(Math.log10(room));
    const length = [5, 2, 1].map(k => k * power).find(k => k <= room), w = length * this.scale;
    const x = this.width - 22 - w, y = this.height - 20;
    c.strokeStyle = colour("ink");
    c.lineWidth = 1.5;
    c.lineCap = "butt";
    c.beginPath(); c.moveTo(x, y - 5); c.lineTo(x, y); c.lineTo(x + w, y); c.lineTo(x + w, y - 5); c.stroke();
    c.font = font(12);
    c.textBaseline = "alphabetic";
    this.label(c, length >= 1000 ? `${length / 1000} km` : `${+length.toPrecision(1)} m`, x + w / 2, y - 8, "center");
    const X = this.width - 30, Y = 24;
    c.fillStyle = colour("ink");
    c.beginPath(); c.moveTo(X, Y - 8); c.lineTo(X + 6, Y + 9); c.lineTo(X, Y + 5); c.lineTo(X - 6, Y + 9); c.closePath(); c.fill();
    c.font = font(12, 600);
    this.label(c, "N", X, Y + 24, "center");
  }
  drawCursor(c) {
    const p = view.now !== null && this.scale && this.at(view.now);
    if (!p) return;
    const alone = this.track.coasting.some(([a, b]) => view.now >= a && view.now <= b);
    c.beginPath(); c.arc(this.px(p[0]), this.py(p[1]), 7, 0, 6.3);
    c.fillStyle = colour(alone ? "alone" : "c0");
    c.fill();
    c.lineWidth = 3;
    c.strokeStyle = colour("card");
    c.stroke();
  }

  key() {
    const { track } = this, host = document.getElementById("key");
    const add = (name, hue, kind = "") => {
      const entry = element("span"), mark = element("i", "", kind);
      mark.style.color = mark.style.borderColor = `var(--${hue})`;
      entry.append(mark, name);
      host.append(entry);
    };
    add("solution", "c0");
    if (track.coasting.length) add("without GNSS", "alone");
    if (track.ellipses.length) add("95 % ellipse", "alone", "ring");
    if (track.reference) add("reference", "ink");
    add("GNSS fix", "fix", "dot");
    if (track.fixes[1].x.length) add("withheld fix", "fix", "hollow");
  }

  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const before = [(x - this.width / 2) / this.scale, (this.height / 2 - y) / this.scale];
    this.scale = Math.min(Math.max(this.scale * factor, 1e-4), 500);
    this.centre[0] += before[0] - (x - this.width / 2) / this.scale;
    this.centre[1] += before[1] - (this.height / 2 - y) / this.scale;
    this.stale = true;
    request();
  }
  pan(dx, dy) {
    this.centre[0] -= dx / this.scale;
    this.centre[1] += dy / this.scale;
    this.stale = true;
    request();
  }
  point(e) {
    const { t, x, y } = this.track, box = this.canvas.getBoundingClientRect();
    const X = e.clientX - box.left, Y = e.clientY - box.top;
    let best = 24 ** 2, found = null;
    for (let i = 0; i + 1 < t.length; i++) {
      const ax = this.px(x[i]), ay = this.py(y[i]), dx = this.px(x[i + 1]) - ax, dy = this.py(y[i + 1]) - ay;
      const w = Math.min(1, Math.max(0, ((X - ax) * dx + (Y - ay) * dy) / (dx * dx + dy * dy || 1)));
      const d = (ax + w * dx - X) ** 2 + (ay + w * dy - Y) ** 2;
      if (d < best) { best = d; found = t[i] + w * (t[i + 1] - t[i]); }
    }
    if (found !== null) setTime(found);
  }
  listen() {
    const { canvas } = this, fingers = new Map();
    canvas.addEventListener("pointerdown", e => { fingers.set(e.pointerId, e); canvas.setPointerCapture(e.pointerId); });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => fingers.delete(e.pointerId));
    canvas.addEventListener("pointermove", e => {
      const before = fingers.get(e.pointerId);
      if (!before) return this.point(e);
      if (fingers.size === 2) {
        const other = [...fingers.values()].find(f => f.pointerId !== e.pointerId), box = canvas.getBoundingClientRect();
        const reach = f => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
        this.zoom(reach(e) / reach(before), other.clientX - box.left, other.clientY - box.top);
      } else this.pan(e.clientX - before.clientX, e.clientY - before.clientY);
      fingers.set(e.pointerId, e);
    });
    canvas.addEventListener("wheel", e => {
      if (document.activeElement !== canvas && !e.ctrlKey && !e.metaKey) return;   // let the page scroll
      e.preventDefault();
      const box = canvas.getBoundingClientRect();
      this.zoom(Math.exp(-e.deltaY * 0.0015), e.clientX - box.left, e.clientY - box.top);
    }, { passive: false });
    canvas.addEventListener("dblclick", () => this.fit());
    canvas.addEventListener("keydown", e => {
      const act = {
        "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => this.fit(),
        ArrowLeft: () => this.pan(60, 0), ArrowRight: () => this.pan(-60, 0),
        ArrowUp: () => this.pan(0, 60), ArrowDown: () => this.pan(0, -60),
      }[e.key];
      if (act) { e.preventDefault(); act(); }
    });
  }
}
