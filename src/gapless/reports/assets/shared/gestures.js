// Places on a path, and how a map listens: wheel, drag, pinch, keys, pointing.

// Where a path {t, x, y} is at a time; straight and even between the rows kept.
function alongPath(p, time) {
  const i = below(p.t, time), last = p.t.length - 1;
  if (i < 0 || time > p.t[last]) return null;
  if (i === last) return [p.x[i], p.y[i]];
  const w = (time - p.t[i]) / (p.t[i + 1] - p.t[i]);
  return [p.x[i] + w * (p.x[i + 1] - p.x[i]), p.y[i] + w * (p.y[i + 1] - p.y[i])];
}
// The smallest rectangle that holds a path between two times, grown from one that is given.
function pathBounds(p, from = -Infinity, to = Infinity, box = [Infinity, -Infinity, Infinity, -Infinity]) {
  const take = (x, y) => { box = [Math.min(box[0], x), Math.max(box[1], x), Math.min(box[2], y), Math.max(box[3], y)]; };
  for (let i = 0; i < p.t.length; i++) if (p.t[i] >= from && p.t[i] <= to) take(p.x[i], p.y[i]);
  for (const time of [from, to]) { const q = Number.isFinite(time) && alongPath(p, time); if (q) take(...q); }
  return box;
}
const someBounds = box => box[0] <= box[1] ? box : [-50, 50, -50, 50];

// Time of the place of a path that is nearest to a pixel, if one is near.
function timeNear(map, p, X, Y) {
  let best = 24 ** 2, found = null;
  for (let i = 0; i + 1 < p.t.length; i++) {
    const ax = map.px(p.x[i]), ay = map.py(p.y[i]), dx = map.px(p.x[i + 1]) - ax, dy = map.py(p.y[i + 1]) - ay;
    const w = Math.min(1, Math.max(0, ((X - ax) * dx + (Y - ay) * dy) / (dx * dx + dy * dy || 1)));
    const d = (ax + w * dx - X) ** 2 + (ay + w * dy - Y) ** 2;
    if (d < best) { best = d; found = p.t[i] + w * (p.t[i + 1] - p.t[i]); }
  }
  return found;
}

function listenToMap(map) {
  const { canvas } = map, fingers = new Map();
  const place = e => { const box = canvas.getBoundingClientRect(); return [e.clientX - box.left, e.clientY - box.top]; };
  canvas.addEventListener("pointerdown", e => { fingers.set(e.pointerId, e); canvas.setPointerCapture(e.pointerId); });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => fingers.delete(e.pointerId));
  canvas.addEventListener("pointermove", e => {
    const before = fingers.get(e.pointerId);
    if (!before) {
      const found = map.timeAt(...place(e));
      if (found !== null) setTime(found);
      return;
    }
    if (fingers.size === 2) {
      const other = [...fingers.values()].find(f => f.pointerId !== e.pointerId);
      const reach = f => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
      map.zoom(reach(e) / reach(before), ...place(other));
    } else map.pan(e.clientX - before.clientX, e.clientY - before.clientY);
    fingers.set(e.pointerId, e);
  });
  canvas.addEventListener("wheel", e => {
    if (document.activeElement !== canvas && !e.ctrlKey && !e.metaKey) return;   // let the page scroll
    e.preventDefault();
    map.zoom(Math.exp(-e.deltaY * 0.0015), ...place(e));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => map.home());
  canvas.addEventListener("keydown", e => {
    const act = {
      "+": () => map.zoom(1.4), "=": () => map.zoom(1.4), "-": () => map.zoom(1 / 1.4), 0: () => map.home(),
      ArrowLeft: () => map.pan(60, 0), ArrowRight: () => map.pan(-60, 0),
      ArrowUp: () => map.pan(0, 60), ArrowDown: () => map.pan(0, -60),
    }[e.key];
    if (act) { e.preventDefault(); act(); }
  });
  for (const b of canvas.parentElement.querySelectorAll("[data-zoom]")) b.addEventListener("click", () => {
    if (b.dataset.zoom === "all") map.home(); else map.zoom(b.dataset.zoom === "in" ? 1.5 : 1 / 1.5);
  });
}
