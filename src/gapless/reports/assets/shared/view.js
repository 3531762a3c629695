// What track and charts share: the stretch of time shown and the time cursor.
const view = { span: [0, 1], from: 0, to: 1, now: null };
const onTime = [], onRange = [];

function setTime(t) {
  view.now = t === null ? null : Math.min(Math.max(t, view.span[0]), view.span[1]);
  for (const tell of onTime) tell();
}
function setRange(from, to) {
  view.from = Math.max(view.span[0], from);
  view.to = Math.min(view.span[1], to);
  for (const tell of onRange) tell();
}
function setSpan(span) {
  view.span = span;
  view.now = null;
  setRange(...span);
  setTime(null);
}
// A clock is what a chart has instead of a time axis of its own: where its cursor is, which stretch it shows.
const driveClock = {
  get: () => view.now, set: setTime,
  range: () => [view.from, view.to],
  full: () => view.from <= view.span[0] && view.to >= view.span[1],
  zoom: (a, b) => setRange(a, b),
  all: () => setRange(...view.span),
};
// Over the age of an outage that begins at `start()`; null where no outage is open, then the cursor is the chart's own.
function ageClock(start, length) {
  const shown = [0, length];
  let own = null;
  const show = (a, b) => { shown[0] = Math.max(0, a); shown[1] = Math.min(length, b); for (const tell of onRange) tell(); };
  return {
    get: () => start() === null ? own : view.now === null ? null : view.now - start(),
    set: x => { if (start() === null) { own = x; for (const tell of onTime) tell(); } else setTime(x + start()); },
    range: () => shown,
    full: () => shown[0] <= 0 && shown[1] >= length,
    zoom: show,
    all: () => show(0, length),
  };
}
