// Beside the panes: values of a pixel, its spectrum or parts, counts of the layer, what is known of it.

const COLOURS = { R: "var(--red)", G: "var(--green)", B: "var(--blue)", X: "var(--red)", Y: "var(--grey)", Z: "var(--blue)" };
const ofResults = ["var(--a)", "var(--b)"];

const pixelOf = (layer, [x, y]) => {
  const [column, row] = [Math.floor(x / layer.step), Math.floor(y / layer.step)];
  return column >= 0 && row >= 0 && column < layer.width && row < layer.height ? row * layer.width + column : null;
};

const spectrumAt = (layer, planes, pixel) => {
  const of = values(layer);
  const errors = of.map((_, place) => errorOf(layer, place)).map((i) => (i === undefined ? null : planes[i][pixel]));
  return { values: of.map(({ i }) => planes[i][pixel]), errors: errors.every((e) => e !== null) ? errors : null };
};

// Rows of values: [name, text, number, unit].
function rowsOf(layer, planes, pixel) {
  if (layer.kind === "spectrum" || (layer.kind === "difference" && layer.of === "spectrum")) return spectrumRows(layer, planes, pixel);
  if (layer.kind === "identity") {
    const id = planes[0][pixel], name = layer.names.find(([known]) => known === id)?.[1];
    return [[layer.name, name ? `${id} ${name}` : String(id), id]];
  }
  if (layer.kind === "unequal") return [["differs", planes[0][pixel] ? "yes" : "no", planes[0][pixel]]];
  const rows = values(layer).map(({ name, i }, place) => {
    const error = errorOf(layer, place);
    const text = `${told(planes[i][pixel], 6)}${error === undefined ? "" : ` ± ${told(planes[error][pixel], 2)}`}`;
    return [rowName(layer, name), text, planes[i][pixel], layer.unit];
  });
  if (layer.kind === "flow") rows.push(numberRow("length", Math.hypot(planes[0][pixel], planes[1][pixel]), layer.unit));
  if (layer.kind === "raw" && layer.filters) {
    const { filters, width } = layer, tall = filters.channels.length / filters.columns;
    const name = filters.channels[(Math.floor(pixel / width) % tall) * filters.columns + (pixel % width) % filters.columns];
    rows.push(["filter", name, null]);
  }
  if (layer.kind === "parts") {
    const sum = values(layer).reduce((sum, { name, i }) => (name === "saturated" ? sum : sum + planes[i][pixel]), 0);
    rows.push(numberRow("sum", sum, layer.unit));
  }
  return rows;
}

const numberRow = (name, number, unit) => [name, told(number, 5), number, unit];

// `depth`, `flow.forward.X`, `picture R`.
function rowName(layer, plane) {
  if (values(layer).length === 1) return layer.name;
  return layer.kind === "parts" || plane.startsWith(layer.name) ? plane : `${layer.name} ${plane}`;
}

function spectrumRows(layer, planes, pixel) {
  const { values: bands } = spectrumAt(layer, planes, pixel);
  const rgb = [0, 1, 2].map((c) => layer.weights.reduce((sum, weights, band) => sum + weights[c] * bands[band], 0));
  const whole = bands.reduce((sum, v) => sum + v * layer.width_nm, 0);
  const perNm = layer.unit.replace("·nm⁻¹", "");
  const rows = [numberRow("over all bands", whole, perNm)];
  const luminance = luma(...rgb);
  rows.push(numberRow(layer.unit.includes("sr") ? "luminance" : "illuminance", luminance, whiteUnit({ ...layer, kind: "spectrum" })));
  const [X, Z] = [0.4124564 * rgb[0] + 0.3575761 * rgb[1] + 0.1804375 * rgb[2], 0.0193339 * rgb[0] + 0.119192 * rgb[1] + 0.9503041 * rgb[2]];
  const sum = X + luminance + Z;
  if (layer.kind === "spectrum" && sum > 0) rows.push(["CIE 1931 x", told(X / sum, 4), X / sum], ["CIE 1931 y", told(luminance / sum, 4), luminance / sum]);
  const { plane } = settingsOf(state.key);
  if (plane !== "colour") rows.push(numberRow(`at ${layer.centres_nm[plane]} nm`, bands[plane], layer.unit));
  return rows;
}

function probe() {
  const place = mark ?? hover, all = shownNow.flatMap(({ shown }) => shown).filter((one) => one);
  at("where").textContent = place ? `column ${Math.floor(place[0])}, row ${Math.floor(place[1])}${mark ? " (marked)" : ""}` : "";
  at("scale").textContent = sight.scale ? `${told(100 * sight.scale, 3)} %` : "";
  const { layer } = all[0] ?? {};
  at("note").textContent = layer?.step > 1 ? noteOfStep(layer) : "";
  const seen = place && all.map((one, i) => ({ ...one, i, pixel: pixelOf(one.layer, place) })).filter(({ pixel }) => pixel !== null);
  if (!seen?.length) {
    fill(at("probe"), node("p", { class: "quiet" }, "no pixel; move over the image, or click to mark one"));
    chart(null);
    return;
  }
  const of = seen.map(({ layer, planes, pixel }) => rowsOf(layer, planes, pixel));
  const heads = seen.length > 1 ? node("thead", {}, node("tr", {}, node("th"), ...seen.map(({ layer }) => node("th", { class: "number" }, "AB"[layer.result])), node("th"))) : null;
  const rows = of[0].map(([name], row) => node("tr", {}, node("th", { scope: "row" }, name), ...of.map((rows) => valueCell(rows[row])), unitCell(of[0][row])));
  const others = hereLoaded(all).flatMap((other) => otherRows(other, place));
  const ofOthers = others.length ? node("table", { class: "quiet" }, node("tbody", {}, ...others)) : null;
  fill(at("probe"), node("table", {}, heads, node("tbody", {}, ...rows)), ofOthers, moreButton());
  chart(seen);
}

const unitCell = (row) => node("td", { class: "unit" }, row?.[3] ?? "");
const valueCell = (row) => node("td", { class: "number", "data-name": row?.[0], "data-value": row?.[2] ?? undefined }, row?.[1] ?? "–");
const noteOfStep = (layer) => `the page has 1 of ${layer.step} × ${layer.step} pixels of this layer (${layer.has_means ? "their mean" : "the middle one"}); --max-mb raises the limit`;

// Other layers of this camera and frame that were loaded, in files of the same size.
const hereLoaded = (shown) => here().filter((l) => l.loaded && l.kind !== "parts" && l.key !== state.key && l.columns === shown[0].layer.columns && l.rows === shown[0].layer.rows && l.result === shown[0].layer.result);

function otherRows(layer, place) {
  const pixel = pixelOf(layer, place);
  if (pixel === null) return [];
  const rows = layer.kind === "spectrum" ? spectrumRows(layer, layer.loaded, pixel).slice(0, 2).map(([name, ...rest]) => [`${layer.name}: ${name}`, ...rest]) : rowsOf(layer, layer.loaded, pixel);
  return rows.map((row) => node("tr", {}, node("td", {}, row[0]), valueCell(row), unitCell(row)));
}

function moreButton() {
  const left = here().filter((l) => !l.loaded && l.chunk && !["spectrum", "parts"].includes(l.kind) && l.result === 0);
  if (!left.length) return null;
  const load = async () => { await Promise.all(left.map(planesOf)).catch((error) => { at("fault").textContent = error.message; }); probe(); };
  return node("button", { id: "all-values", onclick: load }, `values of all layers (${left.length} more)`);
}

function chart(seen) {
  const { layer } = seen?.[0] ?? {};
  const isSpectrum = layer?.kind === "spectrum" || (layer?.kind === "difference" && layer.of === "spectrum"), isParts = layer?.kind === "parts";
  at("chart-section").hidden = !isSpectrum && !isParts;
  if (at("chart-section").hidden) return;
  const same = seen.filter((one) => one.layer.planes.length === layer.planes.length);
  const curves = same.map(({ layer, planes, pixel }, i) => ({ ...spectrumAt(layer, planes, pixel), colour: ofResults[same.length > 1 ? i : layer.result] ?? ofResults[0], name: "AB"[layer.result] }));
  at("chart-title").textContent = isSpectrum ? "Spectrum" : "Components of the value";
  fill(at("chart"), isSpectrum ? spectrumPlot(layer, curves) : partsPlot(layer, curves));
}

function histogram() {
  const all = shownNow.flatMap(({ shown }) => shown).filter((one) => one), first = all[0];
  if (first?.layer.kind === "unequal") {
    const numbers = first.planes[0], count = numbers.reduce((sum, v) => sum + v, 0);
    fill(at("histogram"), node("p", {}, `${count} of ${numbers.length} pixels differ (${told(100 * count / numbers.length, 3)} %)`));
    return;
  }
  if (!first || first.layer.kind === "identity") { fill(at("histogram"), first ? identityCounts(first) : null); return; }
  const { layer } = first, own = settingsOf(state.key);
  const light = lightOf(layer, first.planes, own);
  const curves = light ? [{ numbers: light[0].map((v, i) => luma(v, light[1][i], light[2][i])), colour: "var(--a)", name: "luminance" }]
    : ["picture", "flow", "vector"].includes(layer.kind) ? values(layer).map(({ name, i }) => ({ numbers: first.planes[i], colour: values(layer).length > 1 ? COLOURS[name.at(-1)] ?? "var(--grey)" : "var(--grey)", name }))
    : [{ numbers: chosenPlane(layer, first.planes, own), colour: "var(--a)", name: "" }];
  if (!light && all.length > 1 && curves.length === 1) curves.push({ numbers: chosenPlane(all[1].layer, all[1].planes, own), colour: "var(--b)", name: "B" });
  const whole = layer.kind === "picture" || layer.kind === "raw";
  const { range: drawn } = light ? {} : legendOf(layer, first), isLog = Boolean(light) || Boolean(drawn?.log);
  if (isLog) curves.forEach((curve) => { curve.numbers = Float32Array.from(curve.numbers, (v) => (v > 0 ? Math.log10(v) : v === v ? -Infinity : NaN)); });
  const level = isLog ? Math.log10 : (v) => v;
  const range = whole ? [0, layer.kind === "picture" ? layer.full : rawTop(layer)] : drawn ? [level(drawn.low), level(drawn.high)] : rangeOf(curves);
  const unit = unitShown(layer);
  const { drawing, outside } = histogramPlot(curves, range, { unit, isLog, logCounts: state.logCounts, whole });
  const counts = outside.map(({ below, above, nan }, i) => [curves[i].name, below, above, nan]).filter(([, ...n]) => n.some(Boolean));
  const lines = counts.map(([name, below, above, nan]) => node("div", { class: "quiet" }, `${name ? `${name}: ` : ""}${below} below, ${above} above, ${nan} NaN`));
  fill(at("histogram"), drawing, clipLine(layer, first.planes), layer.kind === "difference" ? differenceLine(curves[0].numbers, unit) : null, ...lines, tick("logarithmic counts", state.logCounts, (logCounts) => { state.logCounts = logCounts; histogram(); }));
}

const rawTop = (layer) => Math.max(layer.planes[0].max ?? 0, Math.ceil(layer.white * 1.02));

function rangeOf(curves) {
  const ends = curves.map(({ numbers }) => percentiles(numbers, [0.1, 99.9]));
  const [low, high] = [Math.min(...ends.map(([low]) => low)), Math.max(...ends.map(([, high]) => high))];
  return high > low ? [low, high] : Number.isFinite(low) ? [low - 0.5, low + 0.5] : [0, 1];
}

// Of layers that are smaller on the page than in the file, what was counted.
const counted = (layer) => (layer.step > 1 ? node("caption", { class: "quiet" }, `of the page's pixels, each of which represents ${layer.step} × ${layer.step} of the file's`) : null);

// Pixels at the ends of what a number can hold.
function clipLine(layer, planes) {
  if (layer.kind !== "picture" && layer.kind !== "raw") return null;
  const top = layer.kind === "raw" ? layer.white : layer.full, names = layer.kind === "raw" ? [""] : values(layer).map(({ name }) => name);
  const count = (numbers, is) => numbers.reduce((sum, v) => sum + (is(v) ? 1 : 0), 0);
  const part = (n, numbers) => `${n} (${told(100 * n / numbers.length, 3)} %)`;
  const rows = names.map((name, i) => node("tr", {}, node("th", { scope: "row" }, name || "DN"), node("td", { class: "number", "data-name": "at the top" }, part(count(planes[i], (v) => v >= top), planes[i])), node("td", { class: "number" }, part(count(planes[i], (v) => v <= 0), planes[i]))));
  return node("table", {}, counted(layer), node("thead", {}, node("tr", {}, node("th"), node("th", { class: "number" }, `at ${told(top)} or more`), node("th", { class: "number" }, "at 0"))), node("tbody", {}, ...rows));
}

// Mean and root mean square of a difference, of what is finite.
function differenceLine(numbers, unit) {
  let [sum, squares, count, most] = [0, 0, 0, 0];
  for (const v of numbers) if (Number.isFinite(v)) { sum += v; squares += v * v; count++; most = Math.max(most, Math.abs(v)); }
  const of = (name, v) => node("tr", {}, node("th", { scope: "row" }, name), node("td", { class: "number", "data-name": name, "data-value": v }, `${told(v, 4)} ${unit}`));
  return node("table", {}, node("tbody", {}, of("mean", sum / count), of("root mean square", Math.sqrt(squares / count)), of("largest", most)));
}

function identityCounts({ layer, planes }) {
  const counts = new Map();
  for (const id of planes[0]) counts.set(id, (counts.get(id) ?? 0) + 1);
  const sorted = [...counts].sort((a, b) => b[1] - a[1]), names = new Map(layer.names.map(([id, name]) => [id, name]));
  const rows = sorted.slice(0, 30).map(([id, n]) => node("tr", {}, node("td", {}, `${names.get(id) || ""} (${id})`), node("td", { class: "number" }, `${n} px`), node("td", { class: "number" }, `${told(100 * n / planes[0].length, 3)} %`)));
  return node("table", {}, counted(layer), node("tbody", {}, ...rows, sorted.length > 30 ? node("tr", {}, node("td", { class: "quiet" }, `and ${sorted.length - 30} more`)) : null));
}

function about() {
  const first = firstShown();
  histogram();
  if (!first) { fill(at("about")); return; }
  const { layer } = first, facts = PAGE.files[layer.facts] ?? {};
  const row = (name, text) => node("tr", {}, node("th", { scope: "row" }, name), node("td", {}, text));
  const size = `${layer.columns} × ${layer.rows} px${layer.step > 1 ? `, ${layer.width} × ${layer.height} on the page` : ""}`;
  const kept = layer.planes.some(({ type }) => type === "f16") ? "rounded to 11 significant bits (0.05 %)" : "as in the file";
  const rows = [row("file", `${layer.place ? `${layer.place}/` : ""}${layer.file}`), row("size", size), row("unit", layer.unit || "none"), row("numbers", kept)];
  if (layer.meaning) rows.push(row("meaning", layer.meaning));
  const stated = values(layer).slice(0, 12).filter(({ min }) => min !== null && min !== undefined && layer.kind !== "difference");
  const cells = (plane) => [plane.min, plane.mean, plane.max].map((v) => node("td", { class: "number" }, told(v, 4)));
  const stats = stated.map((plane) => node("tr", {}, node("th", { scope: "row" }, plane.name), ...cells(plane), node("td", { class: "number" }, String(plane.nan)), node("td", { class: "number" }, String(plane.infinite))));
  const heads = ["", "minimum", "mean", "maximum", "NaN", "infinite"].map((text) => node("th", { class: text ? "number" : undefined }, text));
  const known = Object.entries(facts).map(([name, text]) => row(name, text));
  fill(at("about"), node("table", {}, node("tbody", {}, ...rows)),
    stats.length ? node("table", { class: "stats" }, node("thead", {}, node("tr", {}, ...heads)), node("tbody", {}, ...stats)) : null,
    known.length ? node("details", {}, node("summary", {}, "file header"), node("table", {}, node("tbody", {}, ...known))) : null);
}
