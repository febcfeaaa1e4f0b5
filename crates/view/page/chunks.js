// Numbers of layers: loaded when they are shown, unpacked as crates/view/src/pack.rs packs them.

const waiting = new Map();
window.etendueData = (id, text) => waiting.get(id)?.(text);

// The text of a chunk: within this page, or from a script beside it (a page from the file system may load scripts, and nothing else).
function chunkText(id) {
  const within = document.getElementById(`data-${id}`);
  if (within) return Promise.resolve(within.textContent);
  return new Promise((resolve, reject) => {
    const script = document.createElement("script");
    const done = (end, value) => { waiting.delete(id); script.remove(); end(value); };
    waiting.set(id, (text) => done(resolve, text));
    script.onerror = () => done(reject, new Error(`data/${id}.js is missing next to this page; keep the folder together`));
    script.src = `data/${id}.js`;
    document.head.append(script);
  });
}

async function inflated(text) {
  const packed = atob(text);
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = packed.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// All half floats, by their bits.
let halves = null;
function halfFloats() {
  if (halves) return halves;
  halves = new Float32Array(65536);
  for (let bits = 0; bits < 65536; bits++) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24
      : exponent === 31 ? (fraction ? NaN : Infinity)
      : (1 + fraction / 1024) * 2 ** (exponent - 15);
    halves[bits] = sign * size;
  }
  return halves;
}

const WIDTHS = { u8: 1, u16: 2, u32: 4, f16: 2, f32: 4 };

function plane(bytes, at, pixels, { type, scale }) {
  const width = WIDTHS[type];
  if (width === 1) return bytes.slice(at, at + pixels);
  const together = new Uint8Array(pixels * width);
  for (let place = 0; place < width; place++) {
    for (let i = 0, from = at + place * pixels; i < pixels; i++) together[i * width + place] = bytes[from + i];
  }
  if (type === "u32") return new Uint32Array(together.buffer);
  if (type === "f32") return new Float32Array(together.buffer);
  const words = new Uint16Array(together.buffer);
  if (type === "u16") return words;
  const numbers = new Float32Array(pixels), table = halfFloats();
  for (let i = 0; i < pixels; i++) numbers[i] = table[words[i]] * scale;
  return numbers;
}

// The planes of the layers that were shown last.
const KEPT_BYTES = 768e6;
const kept = new Map();

function planesOf(layer) {
  let planes = kept.get(layer.id);
  if (planes) kept.delete(layer.id);
  planes ??= unpack(layer);
  kept.set(layer.id, planes);
  let bytes = 0;
  for (const id of [...kept.keys()].reverse()) {
    const of = LAYERS[id];
    bytes += of.width * of.height * 4 * of.planes.length;
    if (bytes > KEPT_BYTES && id !== layer.id) forget(of);
  }
  return planes;
}

function forget(layer) {
  kept.delete(layer.id);
  painted.delete(layer.id);
  delete layer.loaded;
  delete layer.rgb;
}

async function unpack(layer) {
  if (!layer.chunk) return [];
  const bytes = await inflated(await chunkText(layer.chunk));
  const pixels = layer.width * layer.height;
  let at = 0;
  const planes = layer.planes.map((said) => {
    const numbers = plane(bytes, at, pixels, said);
    at += pixels * WIDTHS[said.type];
    return numbers;
  });
  layer.loaded = planes;
  return planes;
}
