// The page: what is chosen, and how it follows from clicks, keys and the address (#layer=…).

const LAYERS = PAGE.layers.map((layer, id) => ({ ...layer, id }));
const at = (id) => document.getElementById(id);
const hasTwo = PAGE.results.length === 2;
const MODES = ["a", "b", "side", "wipe", "difference"];
const state = { place: "", frame: null, key: "", mode: hasTwo ? "side" : "a", boxes: false, arrows: false, wipe: 0.5, logCounts: false };
const settings = new Map();
let mark = null, hover = null, shownNow = [], turn = 0;

const settingsOf = (key) => {
  if (!settings.has(key)) settings.set(key, { plane: "colour" });
  return settings.get(key);
};
const found = (result, key) =>
  LAYERS.find((l) => l.result === result && l.place === state.place && l.key === key && (l.frame === null || l.frame === state.frame));
const here = () => LAYERS.filter((l) => l.place === state.place && (l.frame === null || l.frame === state.frame));
const keysHere = () => [...new Set(here().filter((l) => l.kind !== "boxes").map((l) => l.key))];
const framesHere = () => [...new Set(LAYERS.filter((l) => l.place === state.place && l.frame !== null).map((l) => l.frame))].sort((a, b) => a - b);
const values = (layer) => layer.planes.map((plane, i) => ({ ...plane, i })).filter((plane) => !plane.is_error);
const errorOf = (layer, place) => layer.planes.map((plane, i) => ({ ...plane, i })).filter((plane) => plane.is_error)[place]?.i;

function node(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== undefined && value !== false) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

const fill = (holder, ...children) => holder.replaceChildren(...children.filter((child) => child !== null && child !== undefined));

// The state from the address, and the address from the state.
function fromAddress() {
  const asked = new URLSearchParams(location.hash.slice(1));
  const places = [...new Set(LAYERS.map((l) => l.place))];
  state.place = places.includes(asked.get("camera")) ? asked.get("camera") : places[0];
  const frames = framesHere(), frame = Number(asked.get("frame"));
  state.frame = frames.includes(frame) && asked.has("frame") ? frame : frames[0] ?? null;
  state.key = keysHere().find((key) => key === asked.get("layer") || here().some((l) => l.key === key && l.name === asked.get("layer"))) ?? keysHere()[0] ?? "";
  if (hasTwo && MODES.includes(asked.get("show"))) state.mode = asked.get("show");
  const ev = Number(asked.get("ev"));
  if (asked.get("ev") && Number.isFinite(ev)) settingsOf(state.key).ev = ev;
  if (asked.has("plane")) settingsOf(state.key).plane = Number.isInteger(Number(asked.get("plane"))) ? Number(asked.get("plane")) : "colour";
  [state.arrows, state.boxes] = ["arrows", "boxes"].map((name) => asked.get(name) === "1");
  const place = asked.get("at")?.split(",").map(Number);
  if (place?.length === 2 && place.every(Number.isFinite)) mark = place.map((v) => Math.floor(v) + 0.5);
}

function toAddress() {
  const said = new URLSearchParams({ camera: state.place });
  if (state.frame !== null) said.set("frame", state.frame);
  said.set("layer", state.key);
  if (hasTwo) said.set("show", state.mode);
  const { ev, plane } = settingsOf(state.key);
  if (ev) said.set("ev", ev);
  if (plane !== "colour") said.set("plane", plane);
  for (const name of ["arrows", "boxes"]) if (state[name]) said.set(name, 1);
  if (mark) said.set("at", mark.map(Math.floor));
  // Pages from the file system of some browsers may not change their address.
  try { history.replaceState(null, "", `#${said}`); } catch { /* The page is the same without. */ }
}

function choose(changes) {
  Object.assign(state, changes);
  const frames = framesHere();
  if (!frames.includes(state.frame)) state.frame = frames[0] ?? null;
  if (!keysHere().includes(state.key)) state.key = keysHere()[0] ?? "";
  refresh();
}

function lists() {
  const places = [...new Set(LAYERS.map((l) => l.place))];
  fill(at("place"), ...places.map((place) => node("option", { value: place, selected: place === state.place }, place || "(the folder itself)")));
  const frames = framesHere();
  at("frames").hidden = !frames.length;
  fill(at("frame"), ...frames.map((frame) => node("option", { value: frame, selected: frame === state.frame }, String(frame))));
  [at("before").disabled, at("after").disabled] = [state.frame === frames[0], state.frame === frames.at(-1)];
  at("modes").hidden = !hasTwo;
  for (const button of at("modes").children) button.setAttribute("aria-pressed", button.dataset.mode === state.mode);
  const groups = Map.groupBy ? Map.groupBy(keysHere(), groupOf) : grouped(keysHere(), groupOf);
  fill(at("layers"), ...[...groups].map(([group, keys]) => node("div", {}, keys.length > 1 ? node("h2", {}, group) : null, ...keys.map(layerButton))));
}

function grouped(keys, by) {
  const groups = new Map();
  for (const key of keys) groups.set(by(key), [...(groups.get(by(key)) ?? []), key]);
  return groups;
}
const groupOf = (key) => here().find((l) => l.key === key).group;

function layerButton(key) {
  const all = here().filter((l) => l.key === key), only = hasTwo && new Set(all.map((l) => l.result)).size === 1;
  const text = `${all[0].name}${only ? ` (only ${"AB"[all[0].result]})` : ""}`;
  return node("button", { "data-key": key, "aria-current": String(key === state.key), title: all[0].meaning, onclick: () => choose({ key }) }, text);
}

// The layers of the modes: of each pane the layers that it shows.
async function shownLayers() {
  const [a, b] = [0, 1].map((result) => found(result, state.key));
  const of = async (layer) => (layer ? { layer, planes: await planesOf(layer) } : null);
  const [first, second] = await Promise.all([of(a), of(b)]);
  if (!hasTwo) return [{ name: "", shown: [first] }];
  const names = PAGE.results.map((name, i) => `${"AB"[i]}: ${name}`);
  switch (state.mode) {
    case "a": return [{ name: names[0], shown: [first] }];
    case "b": return [{ name: names[1], shown: [second] }];
    case "wipe": return [{ name: names[0], right: names[1], shown: [first, second] }];
    case "difference": {
      const made = first && second && differenceLayer(first, second);
      if (!made) return [{ name: "B − A: these layers cannot be subtracted", shown: [null] }];
      const without = made[0].left_out?.length ? `, without ${made[0].left_out.join(", ")}` : "";
      return [{ name: made[0].kind === "unequal" ? "where B differs from A" : `B − A${without}`, shown: [{ layer: made[0], planes: made[1] }] }];
    }
    default: return [{ name: names[0], shown: [first] }, { name: names[1], shown: [second] }];
  }
}

let difference = null;
function differenceLayer(a, b) {
  if (difference?.a !== a.planes || difference.b !== b.planes) {
    difference = { a: a.planes, b: b.planes, made: differenceOf(a.layer, b.layer, a.planes, b.planes) };
  }
  return difference.made;
}

async function refresh() {
  const mine = ++turn;
  document.body.dataset.state = "loading";
  at("note").textContent = "loading …";
  lists();
  toAddress();
  let panes;
  try {
    panes = await shownLayers();
    at("fault").textContent = "";
  } catch (error) {
    // What failed once is tried again when it is asked for.
    kept.clear();
    at("fault").textContent = error.message;
    panes = [];
  }
  if (mine !== turn) return;
  shownNow = panes;
  makePanes();
  tools();
  redraw();
  about();
  document.body.dataset.state = at("fault").textContent ? "fault" : "ready";
}

const firstShown = () => shownNow.flatMap(({ shown }) => shown).find((one) => one) ?? null;

function makePanes() {
  const holder = at("panes");
  while (holder.children.length > shownNow.length) holder.lastChild.remove();
  while (holder.children.length < shownNow.length) holder.append(newPane());
  shownNow.forEach(({ name, right }, i) => {
    const [, left, other] = holder.children[i].children;
    [left.textContent, other.textContent] = [name, right ?? ""];
    holder.children[i].children[0].setAttribute("aria-label", `${state.key} ${name}`);
  });
}

// Settings of one layer, with the range or white that both results share.
function sharedSettings(one) {
  const own = { ...settingsOf(state.key) }, first = firstShown();
  if (one === first || one.layer.kind === "difference") return own;
  const legend = painted.get(paintKey(first.layer))?.legend;
  if (legend?.white) own.white = legend.white;
  if (legend?.range) [own.low, own.high, own.log] = [legend.range.low, legend.range.high, legend.range.log];
  if (legend?.wheel || legend?.axes) own.high = legend.wheel ?? legend.axes;
  return own;
}
const paintKey = (layer) => (layer.kind === "difference" || layer.kind === "unequal" ? "difference" : layer.id);

function redraw() {
  const holder = at("panes"), first = firstShown();
  if (!first) { holder.querySelectorAll("canvas").forEach((c) => c.getContext("2d").clearRect(0, 0, c.width, c.height)); legend(null); probe(); return; }
  const { layer } = first;
  if (!sight.scale || sight.fits || sight.of !== `${layer.columns}x${layer.rows}`) {
    fit(holder.children[0], [layer.columns, layer.rows]);
    sight.of = `${layer.columns}x${layer.rows}`;
  }
  shownNow.forEach(({ shown }, i) => {
    const pane = holder.children[i];
    const drawn = shown.map((one) => one && {
      layer: one.layer,
      picture: paintedLayer(paintKey(one.layer), one.layer, one.planes, sharedSettings(one)),
      boxes: boxesOf(one.layer),
      arrows: state.arrows && one.layer.kind === "flow" ? one.planes : null,
    });
    drawPane(pane, drawn, state.wipe * pane.clientWidth);
    const marked = mark ?? hover;
    if (marked) shown.slice(0, 1).forEach((one) => one && drawMark(pane, one.layer, marked, Boolean(mark)));
  });
  legend(painted.get(paintKey(layer)).legend, layer);
  probe();
}

function boxesOf(layer) {
  if (!state.boxes) return null;
  const of = here().find((l) => l.kind === "boxes" && l.result === layer.result && l.columns === layer.columns && l.rows === layer.rows);
  return of?.objects.filter((object) => object.visible) ?? null;
}
