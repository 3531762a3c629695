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
// Time as the charts of a whole drive have it; a chart over the age of an outage has its own.
const driveClock = {
  x: t => t, t: x => x,
  range: () => [view.from, view.to],
  full: () => view.from <= view.span[0] && view.to >= view.span[1],
  zoom: (a, b) => setRange(a, b),
  all: () => setRange(...view.span),
};
const ageClock = (start, length) => {
  const shown = [0, length];
  return {
    x: t => t - start, t: x => x + start,
    range: () => shown,
    full: () => shown[0] <= 0 && shown[1] >= length,
    zoom: (a, b) => { shown[0] = Math.max(0, a); shown[1] = Math.min(length, b); for (const tell of onRange) tell(); },
    all: () => { shown[0] = 0; shown[1] = length; for (const tell of onRange) tell(); },
  };
};
