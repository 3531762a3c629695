// The map of a bench: the truth of one recording, its outages, and every system inside the open one.
const trackColumns = {};
function trackPart(card, k) {
  if (!trackColumns.t) {
    for (const name of ["t", "x", "y"]) trackColumns[name] = unpackTimes(data.tracks[name]);
    for (const name of ["a", "b", "angle"]) trackColumns[name] = unpack({ o: 0, s: 1, d: data.tracks[name] });
  }
  const [first, n] = card.tracks[k] || [0, 0];
  return Object.fromEntries(Object.entries(trackColumns).map(([name, column]) => [name, column.slice(first, first + n)]));
}

class BenchTrack extends GroundMap {
  constructor(canvas) { super(canvas); this.parts = []; this.turn(); }
  get card() { return state.open === null ? null : data.outages[state.open]; }
  turn() {
    const { card } = this;
    this.r = card ? card.r : Math.max(state.r, 0);
    this.truth = data.tracks.truth[this.r] || { t: [], x: [], y: [], background: [] };
    this.background = this.truth.background;
    this.parts = card ? visible().filter(k => card.tracks[k]).map(k => [k, trackPart(card, k)]) : [];
    this.stretches = data.outages.filter(c => chosen(c) && c.r === this.r).map(c => [c.start, c.end]);
    this.key();
  }
  home() {
    const { card } = this;
    if (!card) return this.fit(someBounds(pathBounds(this.truth)));
    let box = pathBounds(this.truth, card.start, card.end);
    for (const [, p] of this.parts) {
      box = pathBounds(p, -Infinity, Infinity, box);
      const i = p.t.length - 1;
      if (p.a[i] !== null) box = [Math.min(box[0], p.x[i] - p.a[i]), Math.max(box[1], p.x[i] + p.a[i]), Math.min(box[2], p.y[i] - p.a[i]), Math.max(box[3], p.y[i] + p.a[i])];
    }
    this.fit(someBounds(box));
  }
  cursors(now) {
    const found = this.parts.map(([k, p]) => [alongPath(p, now), look(k).hue]);
    return [[alongPath(this.truth, now), "ink"], ...found].filter(([p]) => p);
  }
  timeAt(X, Y) {
    for (const p of [...this.parts.map(([, part]) => part), this.truth]) {
      const found = timeNear(this, p, X, Y);
      if (found !== null) return found;
    }
    return null;
  }

  paint(c) {
    const { card } = this;
    for (const [from, to] of this.stretches) this.line(c, this.truth, "alone", { width: 7, alpha: card ? 0.12 : 0.3, from, to });
    this.line(c, this.truth, "ink", { width: card ? 1.4 : 1.8, gap: 30 });
    if (!card) return;
    this.line(c, this.truth, "ink", { width: 3.2, from: card.start, to: card.end });
    for (const [k, p] of this.parts) {
      const last = p.t.length - 1, every = Math.max(1, Math.round(last / 4));
      for (let i = last; i > 0; i -= every) if (p.a[i] !== null) this.ellipse(c, [p.t[i], p.x[i], p.y[i], p.a[i], p.b[i], p.angle[i]], look(k).hue, i === last ? 1.6 : 0.8);
      this.line(c, p, look(k).hue, { width: 2.2, dash: look(k).dash });
    }
    c.font = font(12, 600);
    c.textBaseline = "middle";
    for (const [name, time] of [["GNSS lost", card.start], ["GNSS back", card.end]]) {
      const p = alongPath(this.truth, time);
      if (!p) continue;
      c.beginPath(); c.arc(this.px(p[0]), this.py(p[1]), 4.5, 0, 6.3);
      c.fillStyle = colour("card"); c.fill();
      c.strokeStyle = colour("ink"); c.lineWidth = 2; c.stroke();
      this.label(c, name, this.px(p[0]) + 10, this.py(p[1]) - 9, "left");
    }
  }
  key() {
    const add = (name, hue, kind = "") => {
      const entry = element("span"), mark = element("i", "", kind);
      mark.style.color = mark.style.borderColor = `var(--${hue})`;
      entry.append(mark, name);
      return entry;
    };
    const parts = [element("b", data.recordings[this.r].name), add("truth", "ink"), add("outages", "alone", "thick")];
    for (const [k] of this.parts) { const e = element("span"); e.append(swatch(k), data.systems[k].name); parts.push(e); }
    if (this.parts.length) parts.push(add("95 % ellipse", "quiet", "ring"));
    if (this.background.length) parts.push(add("background", "ground"));
    byId("key").replaceChildren(...parts);
  }
}
