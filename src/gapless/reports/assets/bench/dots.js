// Dots with their intervals on a common logarithmic scale, as wide as their cell.
function logScale(values) {
  const known = values.filter(v => v > 0 && Number.isFinite(v));
  if (!known.length) return { at: () => 0, ticks: [] };
  let low = Math.min(...known), high = Math.max(...known);
  if (high / low < 1.5) { low /= 1.25; high *= 1.25; }
  const a = Math.log10(low), span = Math.log10(high) - a;
  const at = v => 3 + 94 * Math.min(1, Math.max(0, (Math.log10(Math.max(v, 1e-12)) - a) / span));
  return { at, ticks: logTicks(low, high).filter((v, i, all) => all.length < 6 || i % Math.ceil(all.length / 5) === 0) };
}
const percentX = v => `${v.toFixed(2)}%`;

// Each row: {k, y, dots: [{value, lo, hi, kind: "main" | "open" | "tick"}]}.
function strip(rows, scale, height, label, line = null) {
  const picture = svg("svg", { class: "strip", height, role: "img", "aria-label": label });
  for (const v of scale.ticks) picture.append(svg("line", { x1: percentX(scale.at(v)), x2: percentX(scale.at(v)), y1: 0, y2: height, class: "tick" }));
  if (line !== null) picture.append(svg("line", { x1: percentX(scale.at(line)), x2: percentX(scale.at(line)), y1: 0, y2: height, class: "one" }));
  for (const { k, y, dots } of rows) for (const d of dots) {
    if (d.value === null || d.value === undefined) continue;
    const hue = `var(--${look(k).hue})`, x = percentX(scale.at(d.value));
    if (d.lo !== null && d.lo !== undefined && d.hi !== null && d.hi !== undefined) {
      picture.append(svg("line", { x1: percentX(scale.at(d.lo)), x2: percentX(scale.at(d.hi)), y1: y, y2: y, stroke: hue, "stroke-width": d.kind === "main" ? 5 : 1.5, "stroke-opacity": d.kind === "main" ? 0.35 : 0.8, "stroke-linecap": "round" }));
    }
    if (d.kind === "tick") { picture.append(svg("line", { x1: x, x2: x, y1: y - 5, y2: y + 5, stroke: hue, "stroke-width": 2 })); continue; }
    const paint = d.kind === "main" ? { fill: hue, stroke: "var(--card)", "stroke-width": 1 } : { fill: "var(--card)", stroke: hue, "stroke-width": 1.6 };
    picture.append(svg("svg", { x, y, overflow: "visible" }, markShape(look(k).mark, 0, 0, d.kind === "main" ? 5 : 3.6, paint)));
  }
  return picture;
}
function axisStrip(scale, unit) {
  const picture = svg("svg", { class: "strip", height: 16, "aria-hidden": "true" });
  scale.ticks.forEach((v, i) => {
    const text = svg("text", { x: percentX(scale.at(v)), y: 12, "text-anchor": "middle" });
    text.textContent = `${+v.toPrecision(2)}${i === scale.ticks.length - 1 ? ` ${unit}` : ""}`;
    picture.append(text);
  });
  return picture;
}

// A table from rows of cells: text, an element, or [content, class]; titles of columns stand in cells where it is narrow.
function sheet(caption, head, rows, kind = "") {
  const frame = element("div", "", `scroll ${kind}`, { role: "region", tabindex: 0, "aria-label": caption });
  const table = element("table"), top = table.createTHead().insertRow(), body = table.createTBody();
  table.prepend(element("caption", caption));
  const put = (cell, content) => {
    const [inner, name] = Array.isArray(content) ? content : [content, ""];
    if (name) cell.className = name;
    if (inner instanceof Node) cell.append(inner); else cell.textContent = inner;
    return cell;
  };
  for (const title of head) top.append(put(element("th", "", "", { scope: "col" }), title));
  for (const row of rows) {
    const line = body.insertRow();
    row.forEach((content, i) => {
      const cell = put(element(i ? "td" : "th", "", "", i ? {} : { scope: "row" }), content);
      const title = Array.isArray(head[i]) ? head[i][0] : head[i];
      if (i && typeof title === "string") cell.dataset.title = title;
      line.append(cell);
    });
  }
  frame.append(table);
  return frame;
}
// A number over its interval.
function withInterval(value, lo, hi, text = short) {
  const e = element("span", "", "measure");
  e.append(element("b", text(value)));
  if (lo !== null && lo !== undefined && hi !== null && hi !== undefined) e.append(element("small", `${text(lo)} – ${text(hi)}`));
  return e;
}
