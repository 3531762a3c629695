// What track and charts share: the data, the colours, the stretch of time shown, the cursor.
const data = JSON.parse(document.getElementById("data").textContent);
const view = { from: data.span[0], to: data.span[1], now: null, selecting: null };
const drawings = [];
const colour = name => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
const font = (size, weight = 400) => `${weight} ${size}px system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif`;

function element(tag, content = "", kind = "") {
  const e = document.createElement(tag);
  if (content) e.textContent = content;
  if (kind) e.className = kind;
  return e;
}

// A canvas that keeps a finished picture and puts the cursor on top of it.
class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.picture = document.createElement("canvas");
    this.stale = true;
    drawings.push(this);
    new ResizeObserver(() => { this.stale = true; this.refresh(); }).observe(canvas);
  }
  refresh() {
    const { canvas, picture } = this;
    const ratio = Math.max(window.devicePixelRatio || 1, this.sharp || 1);
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    if (!this.width) return;
    const w = Math.round(this.width * ratio), h = Math.round(this.height * ratio);
    if (this.stale || picture.width !== w || picture.height !== h) {
      picture.width = canvas.width = w;
      picture.height = canvas.height = h;
      const c = picture.getContext("2d");
      c.scale(ratio, ratio);
      this.draw(c);
      this.stale = false;
    }
    const c = canvas.getContext("2d");
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, w, h);
    c.drawImage(picture, 0, 0);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawCursor(c);
  }
}

let requested = false;
function request(everything = false) {
  if (everything) for (const d of drawings) d.stale = true;
  if (requested) return;
  requested = true;
  requestAnimationFrame(() => { requested = false; for (const d of drawings) d.refresh(); });
}

function setTime(t) {
  view.now = t === null ? null : Math.min(Math.max(t, data.span[0]), data.span[1]);
  const slider = document.getElementById("time"), now = document.getElementById("now");
  if (view.now !== null) slider.value = view.now;
  now.textContent = view.now === null ? "–" : `${view.now.toFixed(1)} s  (${clock(view.now)})`;
  slider.setAttribute("aria-valuetext", now.textContent);
  for (const d of drawings) if (d.readOut) d.readOut();
  request();
}

function setRange(from, to) {
  const [a, b] = data.span;
  view.from = Math.max(a, from);
  view.to = Math.min(b, to);
  document.getElementById("reset").hidden = view.from <= a && view.to >= b;
  request(true);
}

const clock = t => `${t < 0 ? "−" : ""}${Math.floor(Math.abs(t) / 60)}:${String(Math.floor(Math.abs(t) % 60)).padStart(2, "0")}`;

// Index of the last entry of a sorted list that is not above a value.
function below(list, value) {
  let a = 0, b = list.length;
  while (a < b) { const m = (a + b) >> 1; if (list[m] <= value) a = m + 1; else b = m; }
  return a - 1;
}

// Round steps that cut a range into about so many parts.
function ticks(low, high, count) {
  const raw = (high - low) / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(k => k * power).find(k => k >= raw * 0.75);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return { step, found };
}

function logTicks(low, high, room) {
  const a = Math.ceil(Math.log10(low) - 1e-9), b = Math.floor(Math.log10(high) + 1e-9), found = [];
  const factors = b - a < 1 ? [1, 2, 3, 5] : b - a < 3 && room > 5 ? [1, 3] : [1];
  for (let k = a - 1; k <= b; k++) for (const f of factors) {
    const v = f * 10 ** k;
    if (v >= low && v <= high) found.push(v);
  }
  return found.length > 1 ? found : [low, high];
}

const minus = text => text.replace("-", "−");
function tickLabel(v, step) {
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return minus(Math.abs(v) < step / 1e6 ? "0" : v.toFixed(Math.min(decimals, 6)));
}
function short(v) {
  if (v === null || v === undefined) return "–";
  const a = Math.abs(v);
  return minus(a === 0 ? "0" : a >= 99.95 ? v.toFixed(0) : a >= 9.995 ? v.toFixed(1) : a >= 0.9995 ? v.toFixed(2)
    : v.toFixed(Math.min(6, 1 - Math.floor(Math.log10(a)))));
}
