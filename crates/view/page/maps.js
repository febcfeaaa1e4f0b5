// From numbers to colours: what crates/io/src/inspect/drawing draws, with exposure, ranges and marks that can be changed.

const MAGENTA = [255, 0, 255], WHITE = [255, 255, 255], BLACK = [0, 0, 0], OVER = [255, 60, 40], UNDER = [50, 90, 255];

// Stripes of a colour, told from anything in a picture.
const zebra = (i, width, colour) => (((i % width) + Math.floor(i / width)) & 3) < 2 ? colour : BLACK;

// Linear light 0 … 1 to sRGB bytes (IEC 61966-2-1).
const ENCODED = Uint8Array.from({ length: 4097 }, (_, i) => {
  const v = i / 4096;
  return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
});
const encode = (v) => ENCODED[v <= 0 ? 0 : v >= 1 ? 4096 : Math.round(v * 4096)];
const decodeSrgb = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const luma = (r, g, b) => 0.2126729 * r + 0.7151522 * g + 0.072175 * b;

// Of finite numbers that `wanted` takes, those of which so many per cent are not greater; some of them stand for all.
function percentiles(numbers, percents, wanted = () => true) {
  const step = Math.max(1, Math.floor(numbers.length / 200000));
  const some = [];
  for (let i = 0; i < numbers.length; i += step) if (Number.isFinite(numbers[i]) && wanted(numbers[i])) some.push(numbers[i]);
  if (!some.length) return percents.map(() => NaN);
  const sorted = Float64Array.from(some).sort();
  return percents.map((percent) => sorted[Math.floor((sorted.length - 1) * percent / 100)]);
}

// A list of colours with straight lines between them.
const along = (colours) => (share) => {
  const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const low = Math.min(Math.floor(place), colours.length - 2);
  return colours[low].map((from, i) => Math.round(from + (colours[low + 1][i] - from) * (place - low)));
};
const viridis = along(PAGE.viridis);
// Below nothing blue, above nothing red.
const diverging = along([[20, 60, 180], [120, 160, 235], [225, 225, 225], [235, 140, 100], [170, 10, 30]]);

// A look-up table of a map, for speed.
const table = (map) => Array.from({ length: 1024 }, (_, i) => map(i / 1023));
const TABLES = { viridis: table(viridis), diverging: table(diverging) };

// Which map and range a plane of numbers has, unless the user says otherwise.
function ranged(numbers, kind, settings) {
  const lengths = kind === "length";
  let [low, high] = percentiles(numbers, [1, 99], lengths ? (v) => v > 0 : undefined);
  // A few roundings below 0 are no sign.
  const signed = kind === "difference" || Math.min(-low, high) > 1e-3 * Math.max(-low, high);
  if (signed) {
    const [size] = percentiles(numbers.map((v) => Math.abs(v)), [99]);
    [low, high] = [-size, size];
  }
  if (!(high > low)) {
    // All alike, or almost all: the whole range.
    const [least, most] = percentiles(numbers, [0, 100]);
    [low, high] = signed ? [-Math.max(-least, most), Math.max(-least, most)] : [least, most];
    if (!(high > low)) [low, high] = signed ? [-1, 1] : [low || 0, (low || 0) + (Math.abs(low) || 1)];
  }
  [low, high] = [settings.low ?? low, settings.high ?? high];
  const log = settings.log ?? (lengths && low > 0);
  return { low, high, log: log && low > 0, map: signed ? "diverging" : "viridis", reversed: lengths };
}

const shareOf = ({ low, high, log }) => {
  if (!log) return (v) => (v - low) / (high - low);
  const [from, to] = [Math.log(low), Math.log(high)];
  return (v) => (v > 0 ? (Math.log(v) - from) / (to - from) : 0);
};

function paintNumbers(numbers, range, put) {
  const share = shareOf(range), colours = TABLES[range.map];
  for (let i = 0; i < numbers.length; i++) {
    const v = numbers[i];
    if (Number.isNaN(v)) { put(i, MAGENTA); continue; }
    if (v === Infinity) { put(i, WHITE); continue; }
    const at = Math.min(Math.max(share(v), 0), 1);
    put(i, colours[Math.round((range.reversed ? 1 - at : at) * 1023)]);
  }
}

// Colour wheel of Baker et al. 2011: hue by direction, saturation by length.
function wheelColour(u, v) {
  const length = Math.hypot(u, v);
  if (!Number.isFinite(length)) return BLACK;
  const opposite = v === 0 && u > 0 ? -Math.PI : Math.atan2(-v, -u);
  const place = (opposite / Math.PI + 1) / 2 * (PAGE.wheel.length - 1), low = Math.floor(place);
  const from = PAGE.wheel[low], to = PAGE.wheel[(low + 1) % PAGE.wheel.length];
  return from.map((c, i) => {
    const hue = (c + (to[i] - c) * (place - low)) / 255;
    return Math.floor(255 * (length <= 1 ? 1 - length * (1 - hue) : 0.75 * hue));
  });
}

// Linear red, green and blue of a spectrum, in cd/m² (lx of irradiance) at white.
function colourOfSpectrum(layer, planes) {
  const pixels = layer.width * layer.height;
  const rgb = [0, 1, 2].map(() => new Float32Array(pixels));
  layer.weights.forEach((weights, band) => {
    const numbers = planes[band];
    weights.forEach((weight, c) => {
      if (weight !== 0) for (let i = 0; i < pixels; i++) rgb[c][i] += weight * numbers[i];
    });
  });
  return rgb;
}

// The planes that are shown as red, green and blue, and the value of white; null where the layer has no colour.
function lightOf(layer, planes, settings) {
  if (layer.kind === "spectrum" && settings.plane === "colour") {
    layer.rgb ??= colourOfSpectrum(layer, planes);
    return layer.rgb;
  }
  return layer.kind === "colour" ? planes.slice(0, 3) : null;
}

function whiteOf(rgb) {
  const [r, g, b] = rgb;
  const [white] = percentiles(r.map((v, i) => luma(v, g[i], b[i])), [99], (v) => v > 0);
  return Number.isNaN(white) ? 1 : white;
}

// Numbers of one plane of a layer that has several to choose among; of a difference of all planes one number that stands for them.
function chosenPlane(layer, planes, settings) {
  if (settings.plane !== undefined && settings.plane !== "colour") return planes[settings.plane];
  if (layer.kind !== "difference" || planes.length === 1 || layer.of === "parts") return planes[0];
  layer.whole ??= wholeDifference(layer, planes);
  return layer.whole;
}

// Of spectra the difference of luminance, of colours that of the means, of vectors the length.
function wholeDifference(layer, planes) {
  if (layer.of === "spectrum") {
    const [r, g, b] = colourOfSpectrum(layer, planes);
    return r.map((v, i) => luma(v, g[i], b[i]));
  }
  const is_vector = layer.of === "flow" || layer.of === "vector";
  return planes[0].map((_, i) => {
    const all = planes.map((plane) => plane[i]);
    return is_vector ? Math.hypot(...all) : all.reduce((sum, v) => sum + v, 0) / all.length;
  });
}

// Paints a layer; `put(pixel, [r, g, b])`. Answers with what a legend says of it.
function paint(layer, planes, settings, put) {
  const gain = 2 ** (settings.ev ?? 0), pixels = layer.width * layer.height;
  const marked = settings.clipped;
  const light = lightOf(layer, planes, settings);
  if (light) {
    const [r, g, b] = light, white = settings.white ?? whiteOf(light), scale = gain / white;
    for (let i = 0; i < pixels; i++) {
      const colour = [r[i] * scale, g[i] * scale, b[i] * scale];
      if (colour.some(Number.isNaN)) put(i, MAGENTA);
      else if (marked && colour.some((v) => v > 1)) put(i, zebra(i, layer.width, OVER));
      else put(i, colour.map(encode));
    }
    return { white, gain };
  }
  switch (layer.kind) {
    case "picture": return paintPicture(layer, planes, gain, marked, put);
    case "raw": return paintRaw(layer, planes[0], settings, gain, put);
    case "identity": {
      const colours = new Map(layer.names.map(([id, , colour]) => [id, colour]));
      for (let i = 0; i < pixels; i++) put(i, colours.get(planes[0][i]) ?? BLACK);
      return { names: layer.names };
    }
    case "flow": {
      const [u, v] = planes;
      let [scale] = settings.high === undefined ? percentiles(u.map((x, i) => Math.hypot(x, v[i])), [99]) : [settings.high];
      if (!(scale > 0)) scale = 1;
      for (let i = 0; i < pixels; i++) put(i, wheelColour(u[i] / scale, v[i] / scale));
      return { wheel: scale };
    }
    case "vector": {
      let scale = layer.is_unit ? 1 : settings.high ?? Math.max(...planes.map((plane) => percentiles(plane.map(Math.abs), [99])[0]));
      if (!(scale > 0)) scale = 1;
      const byte = (v) => Math.round(127.5 + 127.5 * Math.min(Math.max(v / scale, -1), 1));
      for (let i = 0; i < pixels; i++) {
        const vector = planes.map((plane) => plane[i]);
        put(i, vector.some(Number.isNaN) ? MAGENTA : vector.map(byte));
      }
      return { axes: scale };
    }
    default: {
      const numbers = chosenPlane(layer, planes, settings);
      const range = ranged(numbers, layer.kind, settings);
      paintNumbers(numbers, range, put);
      return { range };
    }
  }
}

function paintPicture(layer, planes, gain, marked, put) {
  const full = layer.full, byte = 255 / full;
  // At the exposure of the file its own bytes are shown.
  const tone = gain === 1 ? (v) => Math.round(v * byte) : (v) => encode(decodeSrgb(v / full) * gain);
  const tones = full < 65536 ? Uint8Array.from({ length: full + 1 }, (_, v) => tone(v)) : null;
  const shown = tones ? (v) => tones[v] : tone;
  const [r, g, b] = [planes[0], planes[1] ?? planes[0], planes[2] ?? planes[0]];
  for (let i = 0; i < r.length; i++) {
    if (marked && (r[i] >= full || g[i] >= full || b[i] >= full)) put(i, zebra(i, layer.width, OVER));
    else if (marked && r[i] === 0 && g[i] === 0 && b[i] === 0) put(i, zebra(i, layer.width, UNDER));
    else put(i, [shown(r[i]), shown(g[i]), shown(b[i])]);
  }
  return { picture: layer.encoding, gain };
}

const FILTERS = { red: [1, 0.15, 0.15], green: [0.15, 1, 0.15], blue: [0.2, 0.3, 1] };

function paintRaw(layer, numbers, settings, gain, put) {
  const { black, white, filters, width } = layer, scale = gain / (white - black);
  const tints = settings.tinted && filters ? filters.channels.map((name) => FILTERS[name] ?? [1, 1, 1]) : null;
  const rows = filters ? filters.channels.length / filters.columns : 1;
  for (let i = 0; i < numbers.length; i++) {
    const v = numbers[i], share = (v - black) * scale;
    if (settings.clipped && v >= white) put(i, zebra(i, width, OVER));
    else if (settings.clipped && v <= 0) put(i, zebra(i, width, UNDER));
    else if (tints) {
      const tint = tints[(Math.floor(i / width) % rows) * filters.columns + (i % width) % filters.columns];
      put(i, tint.map((part) => encode(share * part)));
    } else {
      const grey = encode(share);
      put(i, [grey, grey, grey]);
    }
  }
  return { raw: [black, white], gain };
}

// Kinds whose planes mean something one by one: those that one result alone has are left out of the difference.
const APART = ["number", "parts"];

// B − A as a layer of its own, plane by plane of the same name; null where the two cannot be subtracted. `left_out` names the planes that one alone has.
function differenceOf(a, b, planesA, planesB) {
  if (a.width !== b.width || a.height !== b.height || a.kind !== b.kind || a.kind === "boxes") return null;
  if (a.kind === "spectrum" && String(a.centres_nm) !== String(b.centres_nm)) return null;
  const values = (layer) => layer.planes.map((plane, i) => [plane, i]).filter(([plane]) => !plane.is_error);
  const [ofA, ofB] = [values(a), values(b)];
  if (a.kind === "identity") {
    const numbers = Float32Array.from(planesA[0], (id, i) => (id === planesB[0][i] ? 0 : 1));
    return [{ ...a, kind: "unequal", planes: [a.planes[0]] }, [numbers]];
  }
  const named = (planes, name) => planes.find(([plane]) => plane.name === name);
  const pairs = ofA.map((one) => [one, named(ofB, one[0].name)]).filter(([, other]) => other);
  const alone = [[ofA, ofB, "A"], [ofB, ofA, "B"]].flatMap(([own, others, result]) =>
    own.filter(([plane]) => !named(others, plane.name)).map(([plane]) => `${plane.name} (only ${result})`));
  if (!pairs.length || (alone.length && !APART.includes(a.kind))) return null;
  const planes = pairs.map(([[, i], [, j]]) => {
    const [x, y] = [planesA[i], planesB[j]];
    return Float32Array.from(x, (v, pixel) => (v === y[pixel] ? 0 : y[pixel] - v));
  });
  return [{ ...a, kind: "difference", of: a.kind, planes: pairs.map(([[plane]]) => plane), left_out: alone }, planes];
}
