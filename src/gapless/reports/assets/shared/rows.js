// Columns of a chart as uPlot takes them: a line is lifted where data are missing or an angle wraps.
function chartRows(spec) {
  const { gap, wrap, series, dots } = spec, t = spec.t, n = t.length;
  const columns = series.map(s => s.y), bands = series.map(s => s.band || null);
  const edges = bands.flatMap((b, k) => b ? [[k, 1], [k, -1]] : []);
  const out = [[], ...columns.map(() => []), ...edges.map(() => [])];
  const lift = x => { out[0].push(x); for (let c = 1; c < out.length; c++) out[c].push(null); };
  for (let i = 0; i < n; i++) {
    if (i && (!dots || spec.lift)) {
      const jumps = wrap && columns.some(y => y[i] !== null && y[i - 1] !== null && Math.abs(y[i] - y[i - 1]) > wrap / 2);
      if (t[i] - t[i - 1] > gap || jumps) lift((t[i] + t[i - 1]) / 2);
    }
    out[0].push(t[i]);
    columns.forEach((y, k) => out[k + 1].push(y[i]));
    edges.forEach(([k, sign], e) => {
      const known = bands[k][i] !== null && columns[k][i] !== null;
      out[columns.length + 1 + e].push(known ? (dots ? 0 : columns[k][i]) + sign * bands[k][i] : null);
    });
  }
  return { rows: out, edges };
}

// Every point joined but across a lift: uPlot's own path draws one line through all that share a pixel.
function wrappedPath(u, series, first, last) {
  const stroke = new Path2D(), [t] = u.data, y = u.data[series];
  let pen = false;
  for (let i = first; i <= last; i++) {
    if (y[i] === null) { pen = false; continue; }
    stroke[pen ? "lineTo" : "moveTo"](u.valToPos(t[i], "x", true), u.valToPos(y[i], "y", true));
    pen = true;
  }
  return { stroke, fill: null, clip: null, band: null, gaps: null, flags: 0 };
}

// Triangles at the edge of the frame for dots that lie beyond it.
function arrowsBeyond(u, spec) {
  const { ctx } = u, { left, top, width, height } = u.bbox, ratio = devicePixelRatio || 1;
  const low = u.scales.y.min, high = u.scales.y.max;
  ctx.save();
  spec.series.forEach((s, k) => {
    ctx.fillStyle = colour(s.hue || "c" + (k % 7));
    for (let i = 0; i < spec.t.length; i++) {
      const v = s.y[i];
      if (v === null || (v <= high && v >= low)) continue;
      const x = u.valToPos(spec.t[i], "x", true);
      if (x < left || x > left + width) continue;
      const e = v > high ? top : top + height, d = (v > high ? 6 : -6) * ratio;
      ctx.beginPath(); ctx.moveTo(x, e); ctx.lineTo(x - 3.5 * ratio, e + d); ctx.lineTo(x + 3.5 * ratio, e + d); ctx.fill();
    }
  });
  ctx.restore();
}

// Withheld stretches behind the lines.
function shadeStretches(u, stretches) {
  const { ctx } = u, { left, top, width, height } = u.bbox;
  ctx.save();
  ctx.fillStyle = colour("alone", 0.1);
  for (const [a, b] of stretches) {
    const x0 = Math.max(left, u.valToPos(a, "x", true)), x1 = Math.min(left + width, u.valToPos(b, "x", true));
    if (x1 > x0) ctx.fillRect(x0, top, x1 - x0, height);
  }
  ctx.restore();
}

// Upright lines at values of the horizontal axis.
function upright(u, values) {
  const { ctx } = u, { left, top, width, height } = u.bbox, ratio = devicePixelRatio || 1;
  ctx.save();
  ctx.fillStyle = colour("alone", 0.55);
  for (const v of values) {
    const x = Math.round(u.valToPos(v, "x", true));
    if (x >= left && x <= left + width) ctx.fillRect(x, top, ratio, height);
  }
  ctx.restore();
}

// Which of the series holds in which stretch, along the bottom.
function stripsBelow(u, spec) {
  const { ctx } = u, { left, top, width, height } = u.bbox, high = 5 * (devicePixelRatio || 1);
  ctx.save();
  for (const [a, b, k] of spec.strips) {
    const x0 = Math.max(left, u.valToPos(a, "x", true)), x1 = Math.min(left + width, u.valToPos(b, "x", true));
    ctx.fillStyle = colour(spec.series[k].hue || "c" + (k % 7));
    if (x1 > x0) ctx.fillRect(x0, top + height - high, x1 - x0, high);
  }
  ctx.restore();
}

// Values that a logarithmic axis shows: powers of ten, with 2, 3 and 5 between where they are few.
function logTicks(low, high) {
  const a = Math.floor(Math.log10(low)), b = Math.ceil(Math.log10(high)), found = [];
  const decades = Math.log10(high / low), factors = decades < 1.2 ? [1, 2, 3, 5] : decades < 3 ? [1, 3] : [1];
  for (let k = a; k <= b; k++) for (const f of factors) {
    const v = f * 10 ** k;
    if (v >= low * 0.999 && v <= high * 1.001) found.push(v);
  }
  return found.length > 1 ? found : [low, high];
}
