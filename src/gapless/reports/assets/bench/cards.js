// Outages one by one, the worst first; one opens at a time.
const PAGE = 25;
const spanText = card => `${+card.start.toFixed(1)}–${+card.end.toFixed(1)} s`;
let drawn = PAGE, openPlots = [];
const sorting = byId("sort");
sorting.append(new Option("worst of the systems shown", -1), ...data.systems.map((s, k) => new Option(s.name, k)), new Option("time", -2));
sorting.addEventListener("change", () => drawCards());
byId("more").addEventListener("click", () => { drawn += PAGE; drawCards(); });

const largest = (card, systems) => Math.max(-1, ...systems.map(k => scoreOf(card, k, "horizontal_max")).filter(v => v !== null));
function sorted() {
  const by = +sorting.value, cards = data.outages.map((card, i) => [card, i]).filter(([card]) => chosen(card));
  if (by === -2) return cards.sort(([a], [b]) => a.r - b.r || a.start - b.start);
  const systems = by >= 0 ? [by] : visible();
  return cards.sort(([a], [b]) => largest(b, systems) - largest(a, systems));
}

function drawCards() {
  for (const p of openPlots) p.destroy();
  openPlots = [];
  const cards = sorted(), apart = cards.filter(([c]) => c.labels.length).length, at = cards.findIndex(([, i]) => i === state.open);
  if (at >= drawn) drawn = at + 1;
  const scale = logScale(cards.flatMap(([c]) => visible().map(k => scoreOf(c, k, "horizontal_max"))).filter(v => v !== null));
  byId("count").textContent = `${cards.length} outages${apart ? `, ${apart} of them set apart` : ""}`;
  byId("axis").replaceChildren(element("span"), axisStrip(scale, "m"), element("span"));
  byId("cards").replaceChildren(...cards.slice(0, drawn).map(([card, i]) => cardOf(card, i, scale)));
  byId("more").hidden = cards.length <= drawn;
}

function cardOf(card, index, scale) {
  const item = element("li", "", "card"), open = state.open === index, shown = visible();
  const head = button("", "head", () => change({ open: state.open === index ? null : index }), { "aria-expanded": open, "data-outage": index });
  const title = element("span", "", "title");
  title.append(element("b", spanText(card)), element("small", data.recordings.length > 1 ? data.recordings[card.r].name : `${clockText(card.start)} into the drive`));
  for (const label of card.labels) title.append(element("small", label, "pill apart"));
  const figure = element("span", "", "figure");
  figure.append(element("b", `${short(largest(card, shown))} m`), element("small", card.distance === null ? "" : `in ${short(card.distance)} m`));
  const rows = shown.map((k, i) => ({ k, y: 9 + 11 * i, dots: [{ value: scoreOf(card, k, "horizontal_max"), kind: "main" }] }));
  const words = shown.map(k => `${data.systems[k].name} ${short(scoreOf(card, k, "horizontal_max"))} m`).join(", ");
  head.append(title, strip(rows, scale, 7 + 11 * shown.length, words), figure);
  item.append(head);
  if (open) item.append(panelOf(card));
  return item;
}

function panelOf(card) {
  const panel = element("div", "", "panel"), shown = visible().filter(k => card.scores[k]);
  const jump = button("Show on the track", "jump", () => { benchTrack.home(); byId("map").scrollIntoView({ behavior: "smooth", block: "center" }); byId("map").focus({ preventScroll: true }); });
  const columns = [["Horizontal, largest [m]", "horizontal_max"], ["RMS [m]", "horizontal_rmse"], ["at the end [m]", "horizontal_end"], ["% of the way", "percent"],
    ["Along, largest [m]", "along_max"], ["Cross, largest [m]", "cross_max"], ["Vertical, largest [m]", "vertical_max"], ["Velocity, largest [m/s]", "velocity_max"],
    ["Heading, largest", "heading_deg_max"], ["Truth in the 95 % ellipse", "coverage_95"], ["NEES", "nees"]];
  const text = (v, name) => name === "coverage_95" ? percentText(v) : short(v) + (name.startsWith("heading") && v !== null ? "°" : "");
  panel.append(chartsOf(card, shown), sheet(`Scores, ${spanText(card)}`, ["", ...shown.map(k => [data.systems[k].name, "n"])],
    columns.map(([title, name]) => [title, ...shown.map(k => [text(scoreOf(card, k, name), name), "n"])]), "small"));
  const foot = element("p", `Truth: ${card.truth}. NEES of an honest system is about 2; its truth lies in the 95 % ellipse 95 % of the time.${card.labels.length ? ` Set apart: ${card.labels.join(", ")}.` : ""} `, "quiet foot");
  foot.append(jump);
  panel.append(foot);
  return panel;
}

function chartsOf(card, shown) {
  const host = element("div", "", "group"), length = card.end - card.start, clock = ageClock(() => card.start, length), told = shown.filter(k => card.curves[k]);
  const column = name => told.map(k => curveOf(card, k, name));
  const ages = column("age"), grid = [...new Set(ages.flat())].sort((a, b) => a - b);
  const onGrid = name => column(name).map((y, i) => ages[i].length === grid.length ? y : grid.map(x => interpolate(ages[i], y, x)));
  const add = (title, unit, lines, range, more = {}) => openPlots.push(new Plot(host, { title, unit, t: grid, series: lines, range: range || errorRange(lines, top), gap: length, over: "the age of the outage", ...more }, clock));
  const error = onGrid("horizontal"), bound = onGrid("bound"), top = Math.min(topOf(...error, ...bound), 4 * topOf(...error));
  add("Horizontal error", "m", [...told.map((k, i) => ({ ...lineOf(k), y: error[i] })), ...told.map((k, i) => ({ name: "", hue: look(k).hue, area: true, silent: true, y: bound[i] }))],
    null, { wide: true, log: state.log, note: "Shaded: the bound that each system states for 95 %." });
  for (const [title, name, unit] of [["Along the course", "along", "m"], ["Across the course", "cross", "m"], ["Vertical", "vertical", "m"], ["Heading", "heading_deg", "deg"]]) {
    const y = onGrid(name), known = y.flat().filter(v => v !== null);
    if (!known.length) continue;
    const low = Math.min(0, ...known), high = Math.max(0, ...known), pad = 0.08 * (high - low) || 1;
    add(title, unit, told.map((k, i) => ({ ...lineOf(k), y: y[i] })), [low - pad, high + pad]);
  }
  return host;
}

byId("cards").addEventListener("keydown", e => {
  const step = { ArrowDown: 1, ArrowUp: -1 }[e.key];
  if (!step || !e.target.classList.contains("head")) return;
  const heads = [...document.querySelectorAll("#cards .head")], next = heads[heads.indexOf(e.target) + step];
  if (next) { e.preventDefault(); next.focus(); }
});
onState.push(filtered => {
  if (filtered) drawn = PAGE;
  const focused = document.activeElement && document.activeElement.dataset.outage;
  drawCards();
  if (focused) { const again = document.querySelector(`[data-outage="${focused}"]`); if (again) again.focus({ preventScroll: true }); }
});
