// Error against age: curves of single outages, and their quantiles over all outages of a choice.
const ageColumns = {};
function ageColumn(name) {
  return ageColumns[name] || (ageColumns[name] = unpack({ o: 0, s: 1, d: data.ages[name] }));
}
function curveOf(card, k, name) {
  const [first, n] = card.curves[k] || [0, 0];
  return ageColumn(name).slice(first, first + n);
}
function interpolate(t, y, x) {
  const i = below(t, x);
  if (i < 0 || (i === t.length - 1 && x > t[i] + 1e-6)) return null;
  if (i === t.length - 1) return y[i];
  return y[i] === null || y[i + 1] === null ? null : y[i] + (y[i + 1] - y[i]) * (x - t[i]) / (t[i + 1] - t[i]);
}
function quantile(sorted, q) {
  if (!sorted.length) return null;
  const x = q * (sorted.length - 1), i = Math.floor(x);
  return i + 1 < sorted.length ? sorted[i] + (x - i) * (sorted[i + 1] - sorted[i]) : sorted[i];
}
const AGES = 60;
function quantiles(cards, k, name, grid, q) {
  const lists = grid.map(() => []);
  for (const card of cards) {
    const t = curveOf(card, k, "age"), y = curveOf(card, k, name);
    grid.forEach((x, i) => { const v = interpolate(t, y, x); if (v !== null) lists[i].push(v); });
  }
  return lists.map(list => quantile(list.sort((a, b) => a - b), q));
}

const lineOf = k => ({ name: data.systems[k].name, hue: look(k).hue, dash: look(k).dash, look: k, width: 2 });
const topOf = (...columns) => 1.06 * Math.max(...columns.flat().filter(v => v !== null), 1e-3);
// From zero, or, on a logarithmic axis, from the smallest error worth showing.
function errorRange(series, top) {
  const known = series.filter(s => !s.area).flatMap(s => s.y.filter(v => v > 0));
  return state.log ? [Math.min(0.5 * top, Math.max(0.05, Math.min(...known, top) * 0.8)), top] : [0, top];
}
let agePlots = [];
function drawAges() {
  for (const p of agePlots) p.destroy();
  const cards = data.outages.filter(c => chosen(c) && !c.labels.length), length = Math.max(1, ...cards.map(c => c.end - c.start));
  const grid = Array.from({ length: AGES + 1 }, (_, i) => length * i / AGES), shown = visible();
  const found = (name, q) => shown.map(k => quantiles(cards, k, name, grid, q));
  const middle = found("horizontal", 0.5), high = found("horizontal", 0.95), bound = found("bound", 0.5);
  const clock = ageClock(() => state.open === null ? null : data.outages[state.open].start, length);
  const spec = (title, note, series, top) => ({ title, unit: "m", note, t: grid, series, range: errorRange(series, top), log: state.log, gap: length, over: "the age of the outage" });
  agePlots = [
    new Plot(byId("ages-charts"), spec("Median horizontal error", `Over ${cards.length} outages: ${state.group}.`, shown.map((k, i) => ({ ...lineOf(k), y: middle[i] })), topOf(...middle)), clock),
    new Plot(byId("ages-charts"), spec("95 % of outages lie below", "Shaded: the median bound that each system states for 95 %. An honest system's line runs along the edge of its own shade.",
      [...shown.map((k, i) => ({ ...lineOf(k), y: high[i] })), ...shown.map((k, i) => ({ name: "", hue: look(k).hue, area: true, silent: true, y: bound[i] }))], topOf(...high, ...bound)), clock),
  ];
}
onState.push(drawAges);
