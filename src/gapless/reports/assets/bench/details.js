// Inside a run: innovations, biases, decisions; what was set apart; the prefix check.
const inside = { r: 0, system: 0, scenario: "" };
function chooser(label, key, options) {
  const box = element("label", `${label} `), select = element("select", "", "", { "data-choice": key });
  select.append(...options.map(([value, name]) => new Option(name, value)));
  select.value = inside[key];
  select.addEventListener("change", () => { inside[key] = key === "scenario" ? select.value : +select.value; drawDetails(); });
  box.append(select);
  return box;
}

function drawDetails() {
  byId("details").hidden = !data.runs.length;
  if (!data.runs.length) return;
  if (state.r >= 0) inside.r = state.r;
  const here = data.runs.filter(run => run.r === inside.r && run.p === state.p && run.system === inside.system);
  const scenarios = here.map(run => run.scenario);
  if (!scenarios.includes(inside.scenario)) inside.scenario = scenarios.find(s => data.outages.some(c => c.scenario === s && c.group === state.group)) || scenarios[0] || "";
  byId("details-choice").replaceChildren(
    ...(data.recordings.length > 1 && state.r < 0 ? [chooser("Recording", "r", data.recordings.map((r, k) => [k, r.name]))] : []),
    chooser("System", "system", data.systems.map((s, k) => [k, s.name])),
    chooser("Outages", "scenario", scenarios.map(s => [s, s])));
  const run = here.find(one => one.scenario === inside.scenario);
  if (!run) { byId("details-body").replaceChildren(element("p", "There is no such run.", "quiet")); return; }
  const [biases, innovations, decisions] = ["biases", "innovations", "decisions"].map(name => data.parts[run[name]]);
  const parts = [element("p", `Outside outages: ${short(run.rmse)} m RMS, ${percentText(run.coverage)} inside the stated 95 % ellipse.`, "quiet")];
  const add = (title, body) => parts.push(element("h3", title, "sub"), body);
  if (innovations.length) add("Innovations", sheet("Innovation statistics", ["Channel", ["Count", "n"], ["Mean NIS / dof", "n"], ["Median NIS", "n"], ["In 95 %", "n"], ["Inflated", "n"], ["Rejected", "n"]],
    innovations.map(([title, n, mean, median, share, inflated, rejected]) => [title, ...[String(n), short(mean), short(median), percentText(share), String(inflated), String(rejected)].map(v => [v, "n"])]), "stack"));
  if (biases.length) add("Biases at the end", sheet("Biases at the end", ["State", "Unit", ["Value", "n"]],
    biases.map(([title, unit, value]) => [title, unit || "–", [value, "n"]])));
  if (decisions.length) add("Decisions", sheet("Decisions and their evidence", ["Decision", "Value", "Source", "Evidence"],
    decisions.map(([name, value, source, evidence]) => [name, [value, "value"], [element("span", source, `source ${source}`), "short"], evidence]), "decisions"));
  byId("details-body").replaceChildren(...parts);
}

const WHY = {
  "no motion": "the car hardly moved, so that there was nothing to lose",
  "before motion + 30 s": "it begins before alignment had half a minute of motion",
  "too little truth": "too few epochs of truth to say how large the error was",
  "imu gap": "the IMU itself was silent for a while",
};
function drawApart() {
  const rows = data.apart.map(([label, n]) => [label, [String(n), "n"], WHY[label] || "labelled by its scenario"]);
  byId("apart-body").replaceChildren(rows.length
    ? sheet("Outages set apart", ["Label", ["Outages", "n"], "Why"], rows)
    : element("p", "Every outage counts.", "quiet"),
  ...(rows.length ? [element("p", "They were run and scored like the others and are in the list above, but not in leaderboard, pairs or curves.", "quiet")] : []));
}
function drawPrefix() {
  const host = byId("prefix-body");
  if (!data.prefix.length) { host.replaceChildren(element("p", "No outcome is in the results.", "quiet")); return; }
  const names = [...new Set(data.prefix.map(one => one.recording))], systems = [...new Set(data.prefix.map(one => one.system))];
  const cell = (r, s) => {
    const one = data.prefix.find(o => o.recording === r && o.system === s);
    if (!one) return "–";
    return element("span", one.said, one.said.startsWith("held") ? "passed" : "quiet");
  };
  host.replaceChildren(sheet("Prefix check", ["Recording", ...systems], names.map(r => [r, ...systems.map(s => cell(r, s))])),
    element("p", "With all that comes later spoilt, the same rows must come out, bit for bit. A causal system that fails ends the bench; one that says that it looks ahead is not asked.", "quiet"));
}
onState.push(drawDetails);
