// The rows above and below the panes: exposure, planes, ranges; what the colours mean.

function slider(label, value, [min, max, step], text, change) {
  const out = node("output", {}, text(value));
  const input = node("input", { type: "range", min, max, step, "aria-label": label });
  input.value = value;
  input.addEventListener("input", () => { out.textContent = text(Number(input.value)); change(Number(input.value)); });
  return node("label", { class: "group" }, `${label} `, input, out);
}

function tick(label, value, change) {
  const input = node("input", { type: "checkbox" });
  input.checked = Boolean(value);
  input.addEventListener("change", () => change(input.checked));
  return node("label", { class: "group" }, input, label);
}

function numberField(label, value, change) {
  const input = node("input", { type: "text", inputmode: "decimal", "aria-label": label, value: value ?? "", placeholder: "auto" });
  input.addEventListener("change", () => {
    const number = input.value.trim() === "" ? undefined : Number(input.value.replace(",", "."));
    if (Number.isNaN(number)) input.value = ""; else change(number);
  });
  return node("label", { class: "group" }, `${label} `, input);
}

const withLight = (layer, own) => ["picture", "raw", "colour"].includes(layer.kind) || (layer.kind === "spectrum" && own.plane === "colour");

function tools() {
  const row = [], first = firstShown();
  if (first) {
    const { layer } = first, own = settingsOf(state.key);
    const set = (changes, rebuild) => { Object.assign(own, changes); toAddress(); if (rebuild) tools(); redraw(); if (!("ev" in changes)) histogram(); };
    const planes = values(layer);
    if (layer.kind === "spectrum" || (layer.kind === "difference" && planes.length > 1) || layer.kind === "parts") row.push(planeChoice(layer, own, planes, set));
    if (withLight(layer, own)) {
      row.push(slider("exposure", own.ev ?? 0, [-10, 10, 0.25], (ev) => `${ev > 0 ? "+" : ev < 0 ? "−" : ""}${Math.abs(ev)} EV`, (ev) => set({ ev })));
      row.push(tick("mark clipped", own.clipped, (clipped) => set({ clipped })));
    }
    if (layer.kind === "raw" && layer.filters) row.push(tick("filter colours", own.tinted, (tinted) => set({ tinted })));
    const { range } = legendOf(layer, first);
    if (range) {
      row.push(numberField("from", own.low, (low) => set({ low })), numberField("to", own.high, (high) => set({ high })));
      if (range.map !== "diverging") row.push(tick("logarithmic", range.log, (log) => set({ log })));
    }
    if (layer.kind === "flow") row.push(tick("arrows", state.arrows, (arrows) => { state.arrows = arrows; toAddress(); redraw(); }));
    if (here().some((l) => l.kind === "boxes" && l.columns === layer.columns && l.rows === layer.rows)) {
      row.push(tick("boxes", state.boxes, (boxes) => { state.boxes = boxes; toAddress(); redraw(); }));
    }
  }
  fill(at("tools"), ...row);
}

const legendOf = (layer, one) => paintedLayer(paintKey(layer), layer, one.planes, sharedSettings(one)).legend;

function planeChoice(layer, own, planes, set) {
  const chosen = own.plane === "colour" ? -1 : own.plane;
  const least = layer.kind === "parts" ? 0 : -1;
  const names = { spectrum: "colour", difference: "all" };
  if (layer.kind === "spectrum" || layer.of === "spectrum") {
    const text = (place) => (place < 0 ? names[layer.kind] : `${layer.centres_nm[place]} nm`);
    return slider("band", chosen, [least, planes.length - 1, 1], text, (place) => set({ plane: place < 0 ? "colour" : place }, place < 0 !== chosen < 0));
  }
  const options = [...(least < 0 ? [["colour", "all"]] : []), ...planes.map((plane, place) => [place, plane.name])];
  const select = node("select", { "aria-label": "part" }, ...options.map(([value, text]) => node("option", { value, selected: String(value) === String(own.plane) || (value === 0 && chosen < 0 && least === 0) }, text)));
  select.addEventListener("change", () => set({ plane: select.value === "colour" ? "colour" : Number(select.value), low: undefined, high: undefined }, true));
  return node("label", { class: "group" }, "part ", select);
}

function legend(said, layer) {
  const row = [];
  if (said?.range) row.push(...rangeLegend(said.range, layer));
  if (said?.white) row.push(`white is ${told(said.white / said.gain, 4)} ${whiteUnit(layer)} (at 0 EV the 99th percentile of luminance)`);
  if (said?.raw) row.push(`black ${told(said.raw[0])} DN, white ${told(said.raw[1])} DN; shown sRGB-encoded`);
  if (said?.picture) row.push(`stored ${said.picture}${said.gain === 1 ? ", shown unchanged" : ", exposed as if sRGB"}`);
  if (said?.wheel) row.push(wheelPicture(), `full colour is ${told(said.wheel, 4)} ${layer.unit}; darker: longer; black: not known`);
  if (said?.axes) row.push(`x, y, z as red, green, blue from ${told(-said.axes, 4)} to ${told(said.axes, 4)} ${layer.unit}; grey is 0; magenta is NaN`);
  if (said?.names) row.push(...said.names.slice(0, 400).map(([id, name, colour]) => node("span", {}, node("span", { class: "swatch", style: `background:rgb(${colour})` }), name ? `${name} (${id})` : String(id))));
  fill(at("legend"), ...row);
}

// The unit of the one number a pixel that is shown: of a spectrum's colour that of its luminance.
function unitShown(layer) {
  const isSpectrum = layer.kind === "spectrum" || (layer.kind === "difference" && layer.of === "spectrum");
  return isSpectrum && settingsOf(state.key).plane === "colour" ? whiteUnit({ ...layer, kind: "spectrum" }) : layer.unit;
}

const whiteUnit = (layer) => (layer.kind !== "spectrum" ? layer.unit : layer.unit.includes("sr") ? "cd·m⁻²" : "lx");

function rangeLegend(range, layer) {
  const canvas = node("canvas", { width: 256, height: 14, "aria-hidden": true }), context = canvas.getContext("2d");
  for (let i = 0; i < 256; i++) {
    context.fillStyle = `rgb(${TABLES[range.map][Math.round((range.reversed ? 255 - i : i) / 255 * 1023)]})`;
    context.fillRect(i, 0, 1, 14);
  }
  const marks = layer.kind === "unequal" ? "violet: equal, yellow: different" : `${range.log ? "logarithmic scale; " : ""}white is infinite, magenta NaN`;
  const unit = unitShown(layer);
  return [`${told(range.low, 4)} ${unit}`, canvas, `${told(range.high, 4)} ${unit}`, node("span", { class: "quiet" }, marks)];
}

function wheelPicture() {
  const canvas = node("canvas", { width: 56, height: 56, role: "img", "aria-label": "colours of directions" }), context = canvas.getContext("2d");
  const image = context.createImageData(56, 56);
  for (let y = 0; y < 56; y++) {
    for (let x = 0; x < 56; x++) {
      const [u, v] = [(x - 27.5) / 27, (y - 27.5) / 27];
      if (Math.hypot(u, v) <= 1) image.data.set([...wheelColour(u, v), 255], 4 * (y * 56 + x));
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}
