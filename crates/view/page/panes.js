// Panes: canvases that show layers through one window, so that what is seen beside each other is the same place.

// What is painted of each layer, by its settings.
const painted = new Map();

function paintedLayer(key, layer, planes, settings) {
  const wanted = JSON.stringify(settings);
  const before = painted.get(key);
  if (before?.settings === wanted && before.planes === planes) return before;
  const canvas = before?.canvas ?? document.createElement("canvas");
  [canvas.width, canvas.height] = [layer.width, layer.height];
  const context = canvas.getContext("2d");
  const image = context.createImageData(layer.width, layer.height);
  const words = new Uint32Array(image.data.buffer);
  const legend = paint(layer, planes, settings, (i, [r, g, b]) => { words[i] = 0xff000000 | (b << 16) | (g << 8) | r; });
  context.putImageData(image, 0, 0);
  const now = { settings: wanted, planes, canvas, legend };
  painted.set(key, now);
  return now;
}

// The window: which place of the file stands in the middle of a pane (px of the file), and how many pixels of the screen one has.
const sight = { x: 0, y: 0, scale: 0, fits: true };

function fit(pane, [columns, rows]) {
  const { clientWidth: width, clientHeight: height } = pane;
  sight.scale = Math.max(Math.min(width / columns, height / rows), 1e-3);
  [sight.x, sight.y, sight.fits] = [columns / 2, rows / 2, true];
}

function zoom(factor, at, pane) {
  const [x, y] = at ?? [pane.clientWidth / 2, pane.clientHeight / 2];
  const before = toFile(pane, x, y);
  sight.scale = Math.min(Math.max(sight.scale * factor, 1 / 64), 96);
  const after = toFile(pane, x, y);
  sight.x += before[0] - after[0];
  sight.y += before[1] - after[1];
  sight.fits = false;
}

const toFile = (pane, x, y) => [(x - pane.clientWidth / 2) / sight.scale + sight.x, (y - pane.clientHeight / 2) / sight.scale + sight.y];
const toScreen = (pane, x, y) => [(x - sight.x) * sight.scale + pane.clientWidth / 2, (y - sight.y) * sight.scale + pane.clientHeight / 2];

// Draws painted layers into a pane; the second of two from the line of the wipe (px of the pane) on.
function drawPane(pane, shown, wipe) {
  const canvas = pane.querySelector("canvas"), ratio = window.devicePixelRatio || 1;
  const [width, height] = [pane.clientWidth, pane.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  shown.forEach((one, place) => {
    if (!one) return;
    context.save();
    if (place === 1) {
      context.beginPath();
      context.rect(wipe, 0, width - wipe, height);
      context.clip();
      context.clearRect(wipe, 0, width - wipe, height);
    }
    drawLayer(context, pane, one);
    context.restore();
  });
  if (shown.length === 2) {
    line(context, [wipe, 0], [wipe, height], "#fff", 3);
    line(context, [wipe, 0], [wipe, height], "#111", 1);
  }
}

function drawLayer(context, pane, { layer, picture, boxes, arrows }) {
  const [left, top] = toScreen(pane, 0, 0), size = sight.scale * layer.step;
  context.imageSmoothingEnabled = size < 1;
  context.drawImage(picture.canvas, left, top, layer.width * size, layer.height * size);
  if (arrows) drawArrows(context, pane, layer, arrows);
  if (boxes) drawBoxes(context, pane, boxes);
}

function line(context, from, to, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}

// Boxes with their names, the small ones first; a name that would lie over another is left out.
function drawBoxes(context, pane, boxes) {
  const area = ({ visible: [x0, y0, x1, y1] }) => (x1 - x0) * (y1 - y0), named = [];
  for (const object of [...boxes].sort((a, b) => area(a) - area(b))) drawBox(context, pane, object, named);
}

function drawBox(context, pane, { colour, name, id, visible, amodal }, named) {
  const css = `rgb(${colour})`;
  const outline = ([x0, y0, x1, y1], dash) => {
    const [left, top] = toScreen(pane, x0, y0), [right, bottom] = toScreen(pane, x1, y1);
    context.setLineDash(dash);
    context.lineWidth = 1.5;
    context.strokeStyle = css;
    context.strokeRect(left, top, right - left, bottom - top);
    return [left, top, right - left];
  };
  if (amodal) outline(amodal, [3, 4]);
  const [left, top, width] = outline(visible, []);
  context.setLineDash([]);
  if (width < 36) return;
  const text = name || `id ${id}`;
  context.font = "11px system-ui, sans-serif";
  const wide = context.measureText(text).width + 6;
  if (named.some(([x, y, w]) => Math.abs(y - top) < 14 && x < left + wide && left < x + w)) return;
  named.push([left, top, wide]);
  context.fillStyle = "rgb(0 0 0 / 70%)";
  context.fillRect(left, top - 14, wide, 14);
  context.fillStyle = css;
  context.fillText(text, left + 3, top - 3);
}

// Vectors of the image at places some pixels of the screen apart, as long as they are in the picture.
function drawArrows(context, pane, layer, [u, v]) {
  const every = Math.max(1, Math.round(26 / (sight.scale * layer.step)));
  for (let y = Math.floor(every / 2); y < layer.height; y += every) {
    for (let x = Math.floor(every / 2); x < layer.width; x += every) {
      const i = y * layer.width + x;
      if (!Number.isFinite(u[i] + v[i])) continue;
      const from = toScreen(pane, (x + 0.5) * layer.step, (y + 0.5) * layer.step);
      const to = [from[0] + u[i] * sight.scale, from[1] + v[i] * sight.scale];
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
      line(context, from, to, "rgb(0 0 0 / 75%)", 1.2);
      if (length < 5) continue;
      const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
      for (const turn of [2.6, -2.6]) {
        line(context, to, [to[0] + 5 * Math.cos(angle + turn), to[1] + 5 * Math.sin(angle + turn)], "rgb(0 0 0 / 75%)", 1.2);
      }
    }
  }
}

// The pixel under the cursor or the marked one.
function drawMark(pane, layer, at, isFast) {
  const context = pane.querySelector("canvas").getContext("2d");
  const [x, y] = [Math.floor(at[0] / layer.step) * layer.step, Math.floor(at[1] / layer.step) * layer.step];
  const [left, top] = toScreen(pane, x, y), size = Math.max(layer.step * sight.scale, 7);
  const shift = (layer.step * sight.scale - size) / 2;
  for (const [colour, width] of [["#000", 3], [isFast ? "#ffd33d" : "#fff", 1.3]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.strokeRect(left + shift, top + shift, size, size);
  }
}
