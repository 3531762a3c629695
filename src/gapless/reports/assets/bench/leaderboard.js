// Systems ranked, with intervals; then the median of each recording.
const boardRows = r => data.board.filter(b => b.r === r && b.protocol === state.p && b.group === state.group && state.systems.has(b.system))
  .sort((a, b) => a.median - b.median);

function drawBoard() {
  const rows = boardRows(state.r), host = byId("board-table");
  if (!rows.length) { host.replaceChildren(element("p", "No outage of this choice counts.", "quiet")); byId("board-note").textContent = ""; return; }
  const scale = logScale(rows.flatMap(b => [b.median_lo, b.median, b.p95, b.p95_lo, b.p95_hi, b.worst]));
  const measure = (b, key) => [withInterval(b[key], b[key + "_lo"], b[key + "_hi"]), "n"];
  host.replaceChildren(sheet("Largest horizontal error of each outage, in metres",
    ["System", [axisStrip(scale, "m"), "wide"], ["Median, m", "n"], ["RMS, m", "n"], ["P95, m", "n"], ["Worst, m", "n"], ["In 95 %", "n"], ["Outages", "n"]],
    rows.map(b => [
      systemName(b.system),
      [strip([{ k: b.system, y: 15, dots: [
        { value: b.worst, kind: "tick" }, { value: b.p95, lo: b.p95_lo, hi: b.p95_hi, kind: "open" },
        { value: b.median, lo: b.median_lo, hi: b.median_hi, kind: "main" }] }], scale, 30,
      `median ${short(b.median)} m, 95th percentile ${short(b.p95)} m, worst ${short(b.worst)} m`), "wide"],
      measure(b, "median"), measure(b, "rms"), measure(b, "p95"), measure(b, "worst"),
      [coverage(b), "n"], [outageCount(b), "n"],
    ]), "stack"));
  byId("board-note").textContent = "Largest horizontal error of each outage. Filled mark: median; open mark: 95th percentile; tick: worst; bars and small figures: 95 % intervals. "
    + "In 95 %: how often the truth lay inside the stated 95 % ellipse; the small figures are for 50 and 99 %."
    + (rows.some(b => ahead(b.system)) ? " What looks ahead is a bound, not a competitor." : "");
}
function coverage(b) {
  const e = element("span", "", "measure");
  e.append(element("b", percentText(b.coverage_95)), element("small", `${percentText(b.coverage_50)} · ${percentText(b.coverage_99)}`));
  return e;
}
function outageCount(b) {
  const e = element("span", "", "measure");
  e.append(element("b", String(b.n)));
  if (b.left_out) e.append(element("small", `${b.left_out} set apart`));
  return e;
}

function drawRecordings() {
  const found = data.recordings.map((rec, r) => [rec, r, boardRows(r)]).filter(([, , rows]) => rows.length), shown = visible();
  const part = byId("board-recordings");
  part.previousElementSibling.hidden = part.hidden = data.recordings.length < 2 || !found.length;
  if (part.hidden) return;
  const scale = logScale(found.flatMap(([, , rows]) => rows.flatMap(b => [b.median_lo, b.median, b.median_hi])));
  part.replaceChildren(sheet("Median of the largest horizontal error, by recording, in metres",
    ["Recording", [axisStrip(scale, "m"), "wide"], ...shown.map(k => [data.systems[k].name + ", m", "n"]), ["Outages", "n"]],
    found.map(([rec, r, rows]) => {
      const byK = k => rows.find(b => b.system === k);
      return [
        rec.name,
        [strip(shown.filter(byK).map((k, i) => ({ k, y: 10 + 13 * i, dots: [{ value: byK(k).median, lo: byK(k).median_lo, hi: byK(k).median_hi, kind: "main" }] })),
          scale, 7 + 13 * shown.length, `medians in ${rec.name}`), "wide"],
        ...shown.map(k => [byK(k) ? withInterval(byK(k).median, byK(k).median_lo, byK(k).median_hi) : "–", "n"]),
        [String(rows[0].n), "n"],
      ];
    }), "stack"));
}
onState.push(drawBoard, drawRecordings);
