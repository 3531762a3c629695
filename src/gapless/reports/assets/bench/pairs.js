// Each system against the base on the same outages: ratios below one are improvements.
const pText = p => p === null ? "–" : p < 0.001 ? "< 0.001" : p.toFixed(3);

function drawPairs() {
  const here = r => data.pairs.filter(b => b.r === r && b.protocol === state.p && b.group === state.group && state.systems.has(b.system));
  const own = here(state.r), rows = own.length ? own : here(-1);
  byId("pairs").hidden = !data.pairs.length;
  if (!rows.length) { byId("pairs-table").replaceChildren(element("p", "No pair of the systems shown was compared.", "quiet")); return; }
  const scale = logScale([1, ...rows.flatMap(b => [b.geometric_lo, b.geometric_hi, b.median_ratio])]);
  const note = element("p", "Ratio of the largest horizontal errors, outage by outage. Filled mark: geometric mean with its 95 % interval; open mark: median. Left of the line, below 1, the system is better than its base. "
    + "Wilcoxon's p, as it is and corrected for the number of systems." + (own.length || state.r < 0 ? "" : " Over all recordings: single ones were not compared."), "note");
  byId("pairs-table").replaceChildren(sheet("Ratios of errors on the same outages",
    ["System", [axisStrip(scale, "×"), "wide"], ["Geometric mean", "n"], ["Median ratio", "n"], ["Better in", "n"], ["Worst ratio", "n"], ["p", "n"], ["p corrected", "n"], ["Outages", "n"]],
    rows.map(b => {
      const name = element("span", "", "versus");
      name.append(systemName(b.system), element("small", `against ${b.base}`));
      return [
        name,
        [strip([{ k: b.system, y: 13, dots: [{ value: b.median_ratio, kind: "open" }, { value: b.geometric, lo: b.geometric_lo, hi: b.geometric_hi, kind: "main" }] }], scale, 26,
          `ratio ${short(b.geometric)}`, 1), "wide"],
        [withInterval(b.geometric, b.geometric_lo, b.geometric_hi), "n"], [short(b.median_ratio), "n"], [percentText(b.better), "n"],
        [short(b.worst_ratio), "n"], [pText(b.p), "n"], [pText(b.p_corrected), "n"], [String(b.n), "n"],
      ];
    }), "stack"), note);
}
onState.push(drawPairs);
