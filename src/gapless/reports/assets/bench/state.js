// What the reader chose: recording (-1: all), protocol, length, systems, and the outage that is open.
const state = {
  r: -1, p: 0,
  group: data.groups.includes("60 s") ? "60 s" : data.groups[data.groups.length >> 1],
  systems: new Set(data.systems.map((_, k) => k)), open: null, log: false,
};
// A linear axis shows nothing of systems that differ tenfold.
const medians = data.board.filter(b => b.r < 0 && b.group === state.group && b.median > 0).map(b => b.median);
state.log = medians.length > 1 && Math.max(...medians) > 8 * Math.min(...medians);
const onState = [];
function change(part) {
  const filtered = ["r", "p", "group"].some(key => key in part && part[key] !== state[key]);
  Object.assign(state, part);
  if (filtered && !("open" in part)) state.open = null;
  for (const tell of onState) tell(filtered);
}
const visible = () => data.systems.map((_, k) => k).filter(k => state.systems.has(k));
const chosen = card => (state.r < 0 || card.r === state.r) && card.p === state.p && card.group === state.group;
const SCORE = Object.fromEntries(data.scores.map((name, k) => [name, k]));
const scoreOf = (card, k, name) => card.scores[k] ? card.scores[k][SCORE[name]] : null;
const ahead = k => !data.systems[k].causal;

function systemName(k) {
  const e = element("span", "", "system");
  e.append(swatch(k), element("span", data.systems[k].name));
  if (ahead(k)) e.append(element("small", "looks ahead", "pill", { title: "Not causal: it uses data from after the moment; a bound, not a competitor" }));
  return e;
}

// The bar of choices at the top.
const choices = [];
const ROOM = 48;   // letters that buttons may take; more of them become a list
function segmented(label, key, options) {
  if (options.length < 2) return null;
  if (options.reduce((n, [, name]) => n + name.length + 2, 0) > ROOM) return listed(label, key, options);
  const box = element("div", "", "segments", { role: "group", "aria-label": label });
  box.append(element("span", label));
  for (const [value, name] of options) {
    const b = button(name, "", () => change({ [key]: value }));
    choices.push(() => b.setAttribute("aria-pressed", state[key] === value));
    box.append(b);
  }
  return box;
}
function listed(title, key, options) {
  if (options.length < 2) return null;
  const label = element("label", `${title} `), select = element("select", "", "", { "data-filter": key });
  select.append(...options.map(([, name], i) => new Option(name, i)));
  select.addEventListener("change", () => change({ [key]: options[select.value][0] }));
  choices.push(() => { select.value = options.findIndex(([value]) => value === state[key]); });
  label.append(select);
  return label;
}
function systemToggles() {
  const box = element("div", "", "segments toggles", { role: "group", "aria-label": "Systems shown" });
  data.systems.forEach((s, k) => {
    const b = button("", "", () => {
      const next = new Set(state.systems);
      if (!next.delete(k)) next.add(k);
      if (next.size) change({ systems: next });
    }, { title: s.description || s.name, "data-system": s.name });
    b.append(swatch(k), s.name);
    choices.push(() => b.setAttribute("aria-pressed", state.systems.has(k)));
    box.append(b);
  });
  return box;
}
byId("filters").append(...[
  data.recordings.length > 1 && listed("Recording", "r", [[-1, "all"], ...data.recordings.map((one, k) => [k, one.name])]),
  segmented("Outages", "group", data.groups.map(name => [name, name])),
  segmented("Protocol", "p", data.protocols.map((name, k) => [k, name])),
  systemToggles(),
].filter(Boolean));
byId("scale").append(segmented("Error axis", "log", [[false, "linear"], [true, "log"]]));
byId("filters").addEventListener("submit", e => e.preventDefault());
onState.push(() => { for (const show of choices) show(); });
