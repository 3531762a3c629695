// The track of one run: solution, reference, fixes, stretches without GNSS and ellipses.
class FuseTrack extends GroundMap {
  constructor(canvas, track, outages) {
    super(canvas);
    this.track = track;
    this.outages = outages;
    this.background = track.background;
    this.key();
  }
  home() { this.show(); }
  show(from = -Infinity, to = Infinity) {
    let box = pathBounds(this.track, from, to);
    for (const [t, x, y, a] of this.track.ellipses) if (t >= from && t <= to) {
      box = [Math.min(box[0], x - a), Math.max(box[1], x + a), Math.min(box[2], y - a), Math.max(box[3], y + a)];
    }
    this.fit(someBounds(box));
  }
  cursors(now) {
    const p = alongPath(this.track, now);
    return p ? [[p, this.track.coasting.some(([a, b]) => now >= a && now <= b) ? "alone" : "c0"]] : [];
  }
  timeAt(X, Y) { return timeNear(this, this.track, X, Y); }

  paint(c) {
    const { track } = this;
    this.dots(c, track.fixes[0], false);
    this.dots(c, track.fixes[1], true);
    for (const e of track.ellipses) this.ellipse(c, e, "alone");
    if (track.reference) this.line(c, track.reference, "ink", { width: 1.2, gap: 30 });
    this.line(c, track, "c0", { width: 2.2 });
    for (const [from, to] of track.coasting) this.line(c, track, "alone", { width: 3.4, from, to });
    this.ends(c);
    this.numbers(c);
  }
  dots(c, p, hollow) {
    const r = Math.min(3.2, 1.2 + 0.6 * Math.sqrt(this.scale));
    c.globalAlpha = hollow ? 0.8 : 0.5;
    c.fillStyle = c.strokeStyle = colour("fix");
    c.lineWidth = 1;
    for (let i = 0; i < p.x.length; i++) {
      c.beginPath(); c.arc(this.px(p.x[i]), this.py(p.y[i]), r, 0, 6.3);
      if (hollow) c.stroke(); else c.fill();
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
    this.outages.forEach(([a, b], k) => {
      const p = alongPath(this.track, Math.min(Math.max((a + b) / 2, this.track.t[0]), b));
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
  key() {
    const { track } = this, host = byId("key");
    const add = (name, hue, kind = "") => {
      const entry = element("span"), mark = element("i", "", kind);
      mark.style.color = mark.style.borderColor = `var(--${hue})`;
      entry.append(mark, name);
      host.append(entry);
    };
    add("solution", "c0");
    if (track.coasting.length) add("without GNSS", "alone", "thick");
    if (track.ellipses.length) add("95 % ellipse", "alone", "ring");
    if (track.reference) add("reference", "ink", "thin");
    if (track.fixes[0].x.length) add("GNSS fix", "fix", "dot");
    if (track.fixes[1].x.length) add("withheld fix", "fix", "hollow");
    if (track.background.length) add("background", "ground");
  }
}
