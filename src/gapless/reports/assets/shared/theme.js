// Light and dark: the reader's system decides until the button does. Colours for canvases, looked up once per theme.
const root = document.documentElement;
const night = matchMedia("(prefers-color-scheme: dark)");
const onTheme = [];
let palette = new Map();

function colour(name, alpha = 1) {
  if (!palette.has(name)) palette.set(name, getComputedStyle(root).getPropertyValue("--" + name).trim());
  const found = palette.get(name);
  return alpha === 1 ? found : found + Math.round(255 * alpha).toString(16).padStart(2, "0");
}
const font = (size, weight = 400) => `${weight} ${size}px system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif`;

function setTheme(name) {
  if (name) root.dataset.theme = name; else delete root.dataset.theme;
  palette = new Map();
  const dark = name === "dark" || (!name && night.matches);
  byId("theme").setAttribute("aria-label", dark ? "Change to light colours" : "Change to dark colours");
  byId("theme").textContent = dark ? "Light" : "Dark";
  for (const tell of onTheme) tell();
}
function toggleTheme() {
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : night.matches;
  setTheme(dark ? "light" : "dark");
}
night.addEventListener("change", () => { if (!root.dataset.theme) setTheme(""); });
byId("theme").addEventListener("click", toggleTheme);

const onPrint = [];
let shown = "";
addEventListener("beforeprint", () => {
  shown = root.dataset.theme || "";
  for (const tell of onPrint) tell();
  setTheme("light");
});
addEventListener("afterprint", () => setTheme(shown));

// How the k-th system looks everywhere: colour, dashes and mark, so that no two differ by colour alone.
const DASHES = [[], [9, 4], [2.5, 3], [10, 3, 2.5, 3], [5, 3], [1.5, 2]];
const MARKS = ["circle", "square", "triangle", "diamond", "cross", "ring"];
const look = k => ({ hue: "c" + (k % 7), dash: DASHES[k % DASHES.length], mark: MARKS[k % MARKS.length] });
const SVG = "http://www.w3.org/2000/svg";
function svg(tag, attributes = {}, ...children) {
  const e = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  e.append(...children);
  return e;
}
function markShape(kind, x, y, r, attributes = {}) {
  const path = {
    circle: `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0z`,
    square: `M${x - r * 0.9} ${y - r * 0.9}h${r * 1.8}v${r * 1.8}h${-r * 1.8}z`,
    triangle: `M${x} ${y - r * 1.15}l${r * 1.15} ${r * 2}h${-r * 2.3}z`,
    diamond: `M${x} ${y - r * 1.3}l${r * 1.3} ${r * 1.3}l${-r * 1.3} ${r * 1.3}l${-r * 1.3} ${-r * 1.3}z`,
    cross: `M${x - r} ${y - r * 0.35}h${r * 0.65}v${-r * 0.65}h${r * 0.7}v${r * 0.65}h${r * 0.65}v${r * 0.7}h${-r * 0.65}v${r * 0.65}h${-r * 0.7}v${-r * 0.65}h${-r * 0.65}z`,
    ring: `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0z M${x - r / 2} ${y}a${r / 2} ${r / 2} 0 1 1 ${r} 0a${r / 2} ${r / 2} 0 1 1 ${-r} 0z`,
  }[kind];
  return svg("path", { d: path, ...attributes });
}
// A short piece of a system's line with its mark, for legends and buttons.
function swatch(k) {
  const { hue, dash, mark } = look(k);
  const line = svg("line", { x1: 0, x2: 30, y1: 7, y2: 7, stroke: `var(--${hue})`, "stroke-width": 2.2, "stroke-dasharray": dash.join(" ") });
  return svg("svg", { width: 30, height: 14, class: "swatch", "aria-hidden": "true" }, line, markShape(mark, 15, 7, 4, { fill: `var(--${hue})` }));
}
