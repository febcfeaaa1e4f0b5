// Plots beside the panes: spectra, parts, histograms, as SVG.

const SVG = "http://www.w3.org/2000/svg";
function svg(name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

// Round numbers from low to high, about `count` of them.
function ticks(low, high, count) {
  if (!(high > low)) return [];
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((part) => part * power).find((size) => size >= raw * 0.999);
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) all.push(i * step);
  return all;
}

// A number to so many digits, with a real minus and powers of ten.
function told(value, digits = 5) {
  if (value === undefined || value === null) return "–";
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : value > 0 ? "+∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text;
  if (Number.isInteger(value) && size < 1e9) text = String(value);
  else if (size >= 1e6 || size < 1e-4) {
    const [fraction, power] = value.toExponential(digits - 1).split("e");
    text = `${Number(fraction)}·10${[...String(Number(power))].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("")}`;
  } else text = String(Number(value.toPrecision(digits)));
  return text.replace("-", "−");
}

const FRAME = { width: 330, height: 210, left: 50, right: 10, top: 12, bottom: 34 };

// Axes with ticks; answers with the drawing and the two maps from values to its pixels.
function axes({ x: [x0, x1], y: [y0, y1], xLabel, yLabel, label, height = FRAME.height, xTold = (v) => told(v, 4) }) {
  const { width, left, right, top, bottom } = FRAME;
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const X = (v) => left + (v - x0) / (x1 - x0) * (width - left - right);
  const Y = (v) => height - bottom - (v - y0) / (y1 - y0) * (height - top - bottom);
  for (const v of ticks(x0, x1, 5)) {
    drawing.append(svg("line", { x1: X(v), x2: X(v), y1: top, y2: height - bottom, stroke: "var(--grid)" }));
    drawing.append(svg("text", { x: X(v), y: height - bottom + 13, "text-anchor": "middle" }, xTold(v)));
  }
  for (const v of ticks(y0, y1, 4)) {
    drawing.append(svg("line", { x1: left, x2: width - right, y1: Y(v), y2: Y(v), stroke: "var(--grid)" }));
    drawing.append(svg("text", { x: left - 4, y: Y(v) + 4, "text-anchor": "end" }, told(v, 3)));
  }
  drawing.append(svg("rect", { x: left, y: top, width: width - left - right, height: height - top - bottom, fill: "none", stroke: "var(--edge)" }));
  drawing.append(svg("text", { x: (left + width - right) / 2, y: height - 5, "text-anchor": "middle" }, xLabel));
  if (yLabel) drawing.append(svg("text", { x: left, y: 9 }, yLabel));
  return { drawing, X, Y };
}

// Spectra over wavelength: [{ values, errors, colour, name }], means of bands as steps, ± one standard error.
function spectrumPlot(layer, curves) {
  const half = layer.width_nm / 2, centres = layer.centres_nm;
  const finite = curves.flatMap(({ values, errors }) => values.map((v, i) => v + (errors?.[i] ?? 0))).filter(Number.isFinite);
  const lows = curves.flatMap(({ values, errors }) => values.map((v, i) => v - (errors?.[i] ?? 0))).filter(Number.isFinite);
  let [low, high] = [Math.min(0, ...lows), Math.max(0, ...finite)];
  if (!(high > low)) high = low + 1;
  const { drawing, X, Y } = axes({
    x: [centres[0] - half, centres.at(-1) + half], y: [low, high + 0.04 * (high - low)],
    xLabel: "wavelength, nm", yLabel: layer.unit, label: `spectrum in ${layer.unit} over nm`,
  });
  for (const { values, errors, colour, name } of curves) {
    if (errors) {
      const upper = centres.map((nm, i) => `${X(nm)},${Y(values[i] + errors[i])}`), lower = centres.map((nm, i) => `${X(nm)},${Y(values[i] - errors[i])}`);
      if (values.every(Number.isFinite)) drawing.append(svg("polygon", { points: [...upper, ...lower.reverse()].join(" "), fill: colour, "fill-opacity": 0.22 }));
    }
    const steps = centres.flatMap((nm, i) => Number.isFinite(values[i]) ? [`${X(nm - half)},${Y(values[i])}`, `${X(nm + half)},${Y(values[i])}`] : []);
    drawing.append(svg("polyline", { points: steps.join(" "), fill: "none", stroke: colour, "stroke-width": 1.6, "data-curve": name }));
  }
  return drawing;
}

// What a number is made of: a bar a part, of both results where there are two.
function partsPlot(layer, curves) {
  const names = layer.planes.map(({ name }) => name), height = 26 + 24 * names.length + FRAME.bottom;
  // By sign and logarithm: noise of some electrons stands beside a signal of thousands.
  const level = (v) => Math.sign(v) * Math.log10(1 + Math.abs(v));
  const all = curves.flatMap(({ values }) => values).filter(Number.isFinite).map(level);
  let [low, high] = [Math.min(0, ...all), Math.max(0, ...all)];
  if (!(high > low)) high = 1;
  const { width, right, top, bottom } = FRAME, left = 92;
  const X = (v) => left + (level(v) - low) / (high - low) * (width - left - right - 62);
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `parts in ${layer.unit}` });
  drawing.append(svg("line", { x1: X(0), x2: X(0), y1: top, y2: height - bottom + 6, stroke: "var(--edge)" }));
  names.forEach((name, row) => {
    const y = top + 24 * row + 8;
    drawing.append(svg("text", { x: left - 6, y: y + 9, "text-anchor": "end" }, name));
    curves.forEach(({ values, colour }, i) => {
      const thick = 14 / curves.length, from = Math.min(X(0), X(values[row])), to = Math.max(X(0), X(values[row]));
      if (Number.isFinite(values[row])) drawing.append(svg("rect", { x: from, y: y + i * thick, width: Math.max(to - from, 0.5), height: thick - 1, fill: colour }));
    });
    drawing.append(svg("text", { x: width - right, y: y + 9, "text-anchor": "end" }, told(curves[0].values[row], 4)));
  });
  drawing.append(svg("text", { x: width - right, y: height - 12, "text-anchor": "end" }, `${layer.unit || "the file's unit"}, bars on a signed logarithmic scale`));
  return drawing;
}

// Counts of values in even bins: [{ numbers, colour, name }].
function histogramPlot(curves, [low, high], { unit, isLog, logCounts, whole }) {
  const bins = whole && high - low < 256 ? high - low + 1 : 128;
  const counted = curves.map(({ numbers }) => {
    const counts = new Float64Array(bins), outside = { below: 0, above: 0, nan: 0 };
    const end = whole ? high + 1 : high;
    for (let i = 0; i < numbers.length; i++) {
      const v = numbers[i];
      if (Number.isNaN(v)) outside.nan++;
      else if (v < low) outside.below++;
      else if (v > high) outside.above++;
      else counts[Math.min(bins - 1, Math.floor((v - low) / (end - low) * bins))]++;
    }
    return { counts, outside };
  });
  const most = Math.max(1, ...counted.map(({ counts }) => counts.reduce((a, b) => Math.max(a, b), 0)));
  const level = (count) => (logCounts ? Math.log10(1 + count) : count);
  const { drawing, X, Y } = axes({ x: [low, whole ? high + 1 : high], y: [0, level(most)], xLabel: `${unit || "value"}${isLog ? ", logarithmic" : ""}`, yLabel: logCounts ? "log₁₀(1 + pixels)" : "pixels", label: "histogram", height: 170, xTold: isLog ? (v) => told(10 ** v, 2) : undefined });
  counted.forEach(({ counts }, i) => {
    const { colour } = curves[i], step = (X(whole ? high + 1 : high) - X(low)) / bins;
    const points = [...counts].flatMap((count, bin) => [`${X(low) + bin * step},${Y(level(count))}`, `${X(low) + (bin + 1) * step},${Y(level(count))}`]);
    const ends = [`${X(low)},${Y(0)}`, ...points, `${X(low) + bins * step},${Y(0)}`];
    drawing.append(svg("polygon", { points: ends.join(" "), fill: colour, "fill-opacity": curves.length > 1 ? 0.28 : 0.5, stroke: colour }));
  });
  return { drawing, outside: counted.map(({ outside }) => outside) };
}
