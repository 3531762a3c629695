// The page's data, small helpers of the document, numbers as people read them.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);

function element(tag, content = "", kind = "", attributes = {}) {
  const e = document.createElement(tag);
  if (content !== "") e.textContent = content;
  if (kind) e.className = kind;
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  return e;
}
function button(content, kind, act, attributes = {}) {
  const e = element("button", content, kind, { type: "button", ...attributes });
  e.addEventListener("click", act);
  return e;
}

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return new DataView(out.buffer);
}
// IEEE 754 half precision; what is not finite is unknown.
function half(h) {
  const sign = h & 0x8000 ? -1 : 1, e = (h >> 10) & 31, f = h & 1023;
  return e === 31 ? null : e ? sign * (1024 + f) * 2 ** (e - 25) : sign * f * 2 ** -24;
}
function unpack(packed) {
  const view = bytes(packed.d), n = view.byteLength / 2, out = new Array(n);
  for (let i = 0; i < n; i++) {
    const h = half(view.getUint16(2 * i, true));
    out[i] = h === null ? null : packed.o + packed.s * h;
  }
  return out;
}
function unpackTimes(text) {
  const view = bytes(text), n = view.byteLength / 4, out = new Array(n);
  for (let i = 0; i < n; i++) out[i] = view.getInt32(4 * i, true) / 1000;
  return out;
}

const clockText = t => `${t < 0 ? "−" : ""}${Math.floor(Math.abs(t) / 60)}:${String(Math.floor(Math.abs(t) % 60)).padStart(2, "0")}`;
const minus = text => text.replace("-", "−");
function tickLabel(v, step) {
  const power = Math.floor(Math.log10(step) + 1e-9), quarters = Math.abs(step / 10 ** power - 2.5) < 1e-6;
  const decimals = Math.max(0, quarters - power);
  return minus(Math.abs(v) < step / 1e6 ? "0" : v.toFixed(Math.min(decimals, 6)));
}
function short(v) {
  if (v === null || v === undefined || !Number.isFinite(v)) return "–";
  const a = Math.abs(v);
  return minus(a === 0 ? "0" : a >= 99.95 ? v.toFixed(0) : a >= 9.995 ? v.toFixed(1) : a >= 0.9995 ? v.toFixed(2)
    : v.toFixed(Math.min(6, 1 - Math.floor(Math.log10(a)))));
}
const percentText = share => share === null || share === undefined ? "–" : `${(100 * share).toFixed(0)} %`;

// Index of the last entry of a sorted list that is not above a value.
function below(list, value) {
  let a = 0, b = list.length;
  while (a < b) { const m = (a + b) >> 1; if (list[m] <= value) a = m + 1; else b = m; }
  return a - 1;
}
// The step, 1, 2 or 5 times a power of ten, that cuts a range into about so many parts.
function niceStep(range, count) {
  const raw = range / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map(k => k * power).find(k => k >= raw * 0.75);
}
