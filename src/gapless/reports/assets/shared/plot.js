// One chart: uPlot dressed in the page's colours, made when it comes near the screen, sharing the time cursor.
const plots = new Set();
const LINES = [[], [7, 3], [2, 2]];   // of series that are not systems
const near = new IntersectionObserver(entries => {
  for (const e of entries) if (e.isIntersecting) { near.unobserve(e.target); e.target.plot.build(); }
}, { rootMargin: "500px" });

class Plot {
  constructor(host, spec, clock) {
    this.spec = spec;
    this.clock = clock;
    this.figure = element("figure", "", spec.wide ? "chart wide" : "chart");
    const caption = element("figcaption"), title = element("h3", spec.title), legend = element("div", "", "legend");
    title.append(element("small", spec.unit));
    this.box = element("div", "", "plot", {
      tabindex: 0, role: "img",
      "aria-label": `${spec.title}, in ${spec.unit || "plain numbers"}, over ${spec.over || "time"}; left and right move the time cursor, plus and minus zoom`,
    });
    this.box.plot = this;
    caption.append(title, legend);
    this.figure.append(caption, this.box);
    if (spec.note) this.figure.append(element("p", spec.note));
    host.append(this.figure);
    this.values = spec.series.map((s, k) => {
      const entry = element("span"), mark = element("i", "", this.area(k) ? "area" : spec.dots ? "dot" : `line${k % LINES.length}`), value = element("b");
      mark.style.color = mark.style.borderColor = `var(--${this.hue(k)})`;
      entry.append(s.look === undefined ? mark : swatch(s.look), s.name, value);
      if (!s.silent) legend.append(entry);
      return value;
    });
    plots.add(this);
    near.observe(this.box);
    this.box.addEventListener("keydown", e => this.key(e));
  }
  area(k) { return this.spec.area === k || Boolean(this.spec.series[k].area); }
  hue(k) { return this.spec.series[k].hue || (this.spec.area === k ? "c0" : "c" + (k % 7)); }
  destroy() { plots.delete(this); near.unobserve(this.box); if (this.watch) this.watch.disconnect(); if (this.u) this.u.destroy(); this.figure.remove(); }

  build() {
    if (this.u) return;
    const { spec } = this;
    if (typeof spec.t === "function") spec.t = spec.t();
    for (const s of spec.series) for (const part of ["y", "band"]) if (s[part] && s[part].d !== undefined) s[part] = unpack(s[part]);
    const { rows, edges } = chartRows(spec);
    this.u = new uPlot(this.options(edges), rows, this.box);
    const touch = e => { if (e.pointerType !== "mouse") this.point(e); };
    this.u.over.addEventListener("pointerdown", touch);
    this.u.over.addEventListener("pointermove", e => this.point(e));
    this.watch = new ResizeObserver(() => this.u.setSize(this.size()));
    this.watch.observe(this.box);
    this.follow();
  }
  size() { return { width: Math.max(this.box.clientWidth, 60), height: this.box.clientHeight }; }

  options(edges) {
    const { spec } = this, n = spec.series.length, alpha = spec.dots ? 0.16 / n : 0.14;
    return {
      ...this.size(), legend: { show: false }, padding: [8, 14, 0, 0],
      cursor: {
        y: false, points: { size: 7, width: 1.5 }, drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => this.clock.all(), mouseleave: () => null },
      },
      scales: { x: { time: false, range: () => this.clock.range() }, y: { distr: spec.log ? 3 : 1, range: (u, a, b) => this.range(a, b) } },
      axes: [this.axis({ size: 26, space: 70, values: (u, splits, _, __, step) => splits.map((v, i) => v === null ? "" : tickLabel(v, step) + (i === splits.length - 1 ? ` ${spec.unitX || "s"}` : "")) }),
        this.axis({ size: 48, space: 30, values: (u, splits, _, __, step) => splits.map(v => v === null ? "" : spec.log ? String(+v.toPrecision(2)) : tickLabel(v, step)),
          ...(spec.wrap ? { splits: () => [0, 90, 180, 270, 360] } : {}),
          ...(spec.log ? { filter: (u, splits) => splits, splits: (u, _, low, high) => logTicks(low, high) } : {}) })],
      series: [{}, ...spec.series.map((s, k) => this.series(s, k)), ...edges.map(() => ({ width: 0, stroke: "transparent", points: { show: false } }))],
      bands: edges.flatMap(([k, sign], e) => sign > 0 ? [{ series: [n + 1 + e, n + 2 + e], fill: () => colour(spec.dots ? "quiet" : this.hue(k), alpha) }] : []),
      hooks: {
        drawClear: spec.shades ? [u => shadeStretches(u, spec.shades)] : [],
        drawAxes: spec.marks ? [u => upright(u, spec.marks)] : [],
        draw: [...(spec.dots ? [u => arrowsBeyond(u, spec)] : []), ...(spec.strips ? [u => stripsBelow(u, spec)] : [])],
        setSelect: [u => this.selected(u)],
      },
    };
  }
  axis(more) {
    return { stroke: () => colour("faint"), font: font(11), gap: 4, grid: { stroke: () => colour("grid"), width: 1 }, ticks: { show: false }, ...more };
  }
  series(s, k) {
    const hue = this.hue(k), { spec } = this;
    if (spec.dots) {
      const size = spec.t.length < 400 ? 4.5 : 3.4;
      return { stroke: () => colour(hue), paths: () => null, points: { show: true, size, width: 0, fill: () => colour(hue, spec.t.length > 1200 ? 0.6 : 0.85) } };
    }
    if (this.area(k)) return { width: 0, stroke: () => colour(hue), fill: () => colour(hue, spec.area === k ? 0.17 : 0.1), points: { show: false } };
    const paths = spec.wrap ? { paths: wrappedPath } : {};
    return { ...paths, stroke: () => colour(hue), width: s.width || 1.5, dash: s.dash || LINES[k % LINES.length], points: { show: false } };
  }
  range(low, high) {
    const { spec } = this;
    if (spec.wrap || this.clock.full() || low === null || low === undefined) return spec.range;
    if (spec.log) return [low * 0.85, high * 1.18];
    const pad = 0.08 * (high - low) || Math.abs(high) * 0.1 || 1;
    return [spec.range[0] === 0 ? 0 : low - pad, high + pad];
  }

  point(e) {
    const box = this.u.over.getBoundingClientRect(), x = e.clientX - box.left;
    if (x >= 0 && x <= box.width) this.clock.set(this.u.posToVal(x, "x"));
  }
  selected(u) {
    if (u.select.width > 5) this.clock.zoom(u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x"));
    if (u.select.width) u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }
  key(e) {
    const [a, b] = this.clock.range(), step = (b - a) / (e.shiftKey ? 20 : 200);
    const now = this.clock.get(), from = now === null ? a : Math.min(Math.max(now, a), b);
    const to = { ArrowLeft: from - step, ArrowRight: from + step, Home: a, End: b }[e.key];
    const half = { "+": (b - a) / 3, "=": (b - a) / 3, "-": b - a }[e.key];
    if (e.key === "Escape") this.clock.all();
    else if (half) this.clock.zoom(from - half, from + half);
    else if (to !== undefined) this.clock.set(to);
    else return;
    e.preventDefault();
  }

  // Put the cursor where the page's time is, once uPlot has taken over a range that was just set.
  follow() { queueMicrotask(() => this.place()); }
  place() {
    const { u, spec, clock } = this, [a, b] = clock.range();
    const x = clock.get(), inside = x !== null && x >= a - 1e-6 && x <= b + 1e-6;
    if (u) u.setCursor({ left: inside ? u.valToPos(x, "x") : -10, top: inside ? 1 : -10 }, false);
    const i = u && inside ? this.nearest(x) : -1;
    spec.series.forEach((s, k) => {
      const sd = i >= 0 && s.band && s.band[i] !== null ? ` ± ${short(s.band[i])}` : "";
      this.values[k].textContent = i < 0 ? "" : short(s.y[i]) + sd;
    });
  }
  nearest(x) {
    const { t, gap } = this.spec;
    let i = Math.max(0, below(t, x));
    if (i + 1 < t.length && t[i + 1] - x < x - t[i]) i++;
    return t.length && Math.abs(t[i] - x) <= gap ? i : -1;
  }
}

onTime.push(() => { for (const p of plots) p.follow(); });
onRange.push(() => { for (const p of plots) if (p.u) { const [min, max] = p.clock.range(); p.u.setScale("x", { min, max }); p.follow(); } });
onTheme.push(() => { for (const p of plots) if (p.u) p.u.redraw(false); });
onPrint.push(() => { for (const p of plots) p.build(); });
