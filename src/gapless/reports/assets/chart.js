// One chart over time: lines or dots, bands of one standard deviation, an area under a bound.
class Chart extends Drawing {
  constructor(spec, host) {
    const figure = element("figure", "", spec.wide ? "chart wide" : "chart");
    const canvas = element("canvas");
    const caption = element("figcaption"), title = element("h3", spec.title), legend = element("div", "", "legend");
    title.append(element("small", spec.unit));
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${spec.group}, ${spec.title}, in ${spec.unit || "plain numbers"}, over time; arrow keys move the time cursor`);
    caption.append(title, legend);
    figure.append(caption, canvas);
    if (spec.note) figure.append(element("p", spec.note));
    host.append(figure);
    super(canvas);
    this.spec = spec;
    this.values = spec.series.map((s, k) => {
      const entry = element("span"), mark = element("i"), value = element("b");
      mark.style.color = mark.style.borderColor = `var(--${this.hue(k)})`;
      if (spec.area === k) mark.className = "area";
      entry.append(mark, s.name, value);
      legend.append(entry);
      return value;
    });
    this.listen();
  }
  hue(k) { return this.spec.area === k ? "c0" : "c" + (k % 6); }

  // Screen coordinates of time and value.
  frame() {
    const { range, log } = this.spec;
    const left = 46, right = this.width - 6, top = 7, bottom = this.height - 21;
    const f = log ? Math.log10 : v => v, a = f(range[0]), b = f(range[1]);
    return {
      left, right, top, bottom,
      x: t => left + (t - view.from) / (view.to - view.from) * (right - left),
      y: v => bottom - (f(v) - a) / (b - a) * (bottom - top),
      t: x => view.from + (x - left) / (right - left) * (view.to - view.from),
    };
  }

  draw(c) {
    const g = this.frame();
    this.axes(c, g);
    c.save();
    c.beginPath();
    c.rect(g.left, g.top - 1, g.right - g.left, g.bottom - g.top + 2);
    c.clip();
    const { t, series, dots, area } = this.spec;
    const first = Math.max(0, below(t, view.from) - 1), last = Math.min(t.length - 1, below(t, view.to) + 2);
    this.rows = [first, last];
    series.forEach((s, k) => { if (s.band) this.band(c, g, s.band.map((b, i) => b === null ? null : dots ? 0 : s.y[i]), s.band, dots ? "quiet" : this.hue(k), dots ? 0.16 / series.length : 0.13); });
    if (area !== undefined) this.band(c, g, series[area].y.map(v => v === null ? null : 0), series[area].y, this.hue(area), 0.16);
    for (let k = series.length - 1; k >= 0; k--) if (k !== area) (dots ? this.dots : this.line).call(this, c, g, series[k].y, this.hue(k));
    c.restore();
  }

  axes(c, g) {
    const { spec } = this;
    c.fillStyle = colour("shade");
    for (const [a, b] of data.outages) {
      const x0 = Math.max(g.left, g.x(a)), x1 = Math.min(g.right, g.x(b));
      if (x1 > x0) c.fillRect(x0, g.top, x1 - x0, g.bottom - g.top);
    }
    c.font = font(11);
    c.lineWidth = 1;
    c.textBaseline = "middle";
    c.textAlign = "right";
    const rows = Math.floor((g.bottom - g.top) / 34);
    const degrees = spec.wrap ? { step: 90, found: [0, 90, 180, 270, 360] } : ticks(spec.range[0], spec.range[1], rows);
    const values = spec.log ? logTicks(spec.range[0], spec.range[1], rows) : degrees.found;
    for (const v of values) {
      const y = Math.round(g.y(v)) + 0.5;
      c.strokeStyle = colour(v === 0 && !spec.log ? "rule" : "grid");
      c.beginPath(); c.moveTo(g.left, y); c.lineTo(g.right, y); c.stroke();
      c.fillStyle = colour("faint");
      c.fillText(spec.log ? String(+v.toPrecision(2)) : tickLabel(v, degrees.step), g.left - 7, y);
    }
    c.textBaseline = "top";
    c.textAlign = "center";
    const across = ticks(view.from, view.to, Math.max(2, Math.floor((g.right - g.left) / 90)));
    for (const v of across.found) {
      const x = g.x(v), text = tickLabel(v, across.step) + (v === across.found[across.found.length - 1] ? " s" : "");
      c.fillText(text, Math.min(Math.max(x, g.left + 8), g.right - c.measureText(text).width / 2), g.bottom + 6);
    }
  }

  line(c, g, y, hue) {
    const { t, gap, wrap } = this.spec, [first, last] = this.rows;
    c.strokeStyle = colour(hue);
    c.lineWidth = 1.4;
    c.lineJoin = "round";
    c.beginPath();
    let pen = false;
    for (let i = first; i <= last; i++) {
      if (y[i] === null) { pen = false; continue; }
      if (pen && (t[i] - t[i - 1] > gap || (wrap && Math.abs(y[i] - y[i - 1]) > wrap / 2))) pen = false;
      if (pen) c.lineTo(g.x(t[i]), g.y(y[i])); else c.moveTo(g.x(t[i]), g.y(y[i]));
      pen = true;
    }
    c.stroke();
  }

  dots(c, g, y, hue) {
    const { t, range } = this.spec, [first, last] = this.rows;
    const size = last - first < 400 ? 1.7 : 1.15;
    c.fillStyle = colour(hue);
    c.globalAlpha = last - first > 1200 ? 0.6 : 0.85;
    for (let i = first; i <= last; i++) {
      if (y[i] === null) continue;
      const x = g.x(t[i]);
      c.beginPath();
      if (y[i] > range[1] || y[i] < range[0]) {      // beyond the frame: an arrow at its edge
        const up = y[i] > range[1], e = up ? g.top : g.bottom, d = up ? 6 : -6;
        c.moveTo(x, e); c.lineTo(x - 3.5, e + d); c.lineTo(x + 3.5, e + d);
      } else c.arc(x, g.y(y[i]), size, 0, 6.3);
      c.fill();
    }
    c.globalAlpha = 1;
  }

  // middle +- half; the area under a bound has its middle at zero and shows its upper half.
  band(c, g, middle, half, hue, alpha = 0.13) {
    const { t, gap } = this.spec, [first, last] = this.rows;
    c.fillStyle = colour(hue);
    c.globalAlpha = alpha;
    const flush = (a, b) => {
      if (b <= a) return;
      c.beginPath();
      for (let i = a; i <= b; i++) c.lineTo(g.x(t[i]), g.y(middle[i] + half[i]));
      for (let i = b; i >= a; i--) c.lineTo(g.x(t[i]), g.y(middle[i] - half[i]));
      c.fill();
    };
    let a = first;
    for (let i = first; i <= last + 1; i++) {
      const broken = i > last || middle[i] === null || half[i] === null || (i > a && t[i] - t[i - 1] > gap);
      if (!broken) continue;
      flush(a, i - 1);
      a = i > last || middle[i] === null || half[i] === null ? i + 1 : i;
    }
    c.globalAlpha = 1;
  }

  nearest() {
    const { t, gap } = this.spec;
    if (view.now === null || !t.length) return -1;
    let i = Math.max(0, below(t, view.now));
    if (i + 1 < t.length && t[i + 1] - view.now < view.now - t[i]) i++;
    return Math.abs(t[i] - view.now) <= gap ? i : -1;
  }
  readOut() {
    const i = this.nearest();
    this.spec.series.forEach((s, k) => {
      const sd = i >= 0 && s.band && s.band[i] !== null ? ` ± ${short(s.band[i])}` : "";
      this.values[k].textContent = i < 0 ? "" : short(s.y[i]) + sd;
    });
  }

  drawCursor(c) {
    const g = this.frame();
    if (view.selecting && view.selecting.chart === this) {
      const [a, b] = view.selecting.pair;
      c.fillStyle = colour("c0");
      c.globalAlpha = 0.14;
      c.fillRect(g.x(a), g.top, g.x(b) - g.x(a), g.bottom - g.top);
      c.globalAlpha = 1;
    }
    if (view.now === null || view.now < view.from || view.now > view.to) return;
    const x = Math.round(g.x(view.now)) + 0.5, i = this.nearest();
    c.strokeStyle = colour("faint");
    c.lineWidth = 1;
    c.beginPath(); c.moveTo(x, g.top); c.lineTo(x, g.bottom); c.stroke();
    this.spec.series.forEach((s, k) => {
      if (i < 0 || s.y[i] === null || k === this.spec.area) return;
      const y = g.y(s.y[i]);
      if (y < g.top - 1 || y > g.bottom + 1) return;
      c.fillStyle = colour(this.hue(k));
      c.strokeStyle = colour("card");
      c.beginPath(); c.arc(g.x(this.spec.t[i]), y, 3.5, 0, 6.3); c.fill(); c.stroke();
    });
  }

  listen() {
    const { canvas } = this;
    const at = e => this.frame().t(e.clientX - canvas.getBoundingClientRect().left);
    canvas.addEventListener("pointermove", e => {
      setTime(Math.min(Math.max(at(e), view.from), view.to));
      if (view.selecting) view.selecting.pair[1] = view.now;
    });
    canvas.addEventListener("pointerdown", e => {
      if (e.pointerType === "mouse" && e.button === 0) {
        canvas.setPointerCapture(e.pointerId);
        view.selecting = { chart: this, pair: [at(e), at(e)] };
      }
    });
    canvas.addEventListener("pointerup", () => {
      const chosen = view.selecting;
      view.selecting = null;
      if (!chosen) return;
      const [a, b] = chosen.pair.slice().sort((p, q) => p - q);
      if (b - a > (view.to - view.from) / 80) setRange(a, b); else request();
    });
    canvas.addEventListener("dblclick", () => setRange(...data.span));
    canvas.addEventListener("keydown", e => {
      const step = (view.to - view.from) / (e.shiftKey ? 20 : 200);
      const from = view.now === null ? view.from : view.now;
      const to = { ArrowLeft: from - step, ArrowRight: from + step, Home: view.from, End: view.to }[e.key];
      if (e.key === "Escape") setRange(...data.span);
      if (to === undefined) return;
      e.preventDefault();
      setTime(to);
    });
  }
}
