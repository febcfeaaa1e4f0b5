// Mouse, keys and buttons, and the first look.

function newPane() {
  const pane = node("div", { class: "pane" }, node("canvas", { role: "img", tabindex: 0 }), node("span", { class: "name" }), node("span", { class: "name right" }));
  const canvas = pane.firstChild;
  let held = null;
  const placeOf = (event) => { const box = pane.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  const overLine = (x) => shownNow.some(({ shown }) => shown.length === 2) && Math.abs(x - state.wipe * pane.clientWidth) < 7;
  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = placeOf(event);
    canvas.setPointerCapture(event.pointerId);
    held = { x, y, moved: false, wipes: overLine(x) };
  });
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = placeOf(event);
    hover = toFile(pane, x, y);
    canvas.style.cursor = overLine(x) ? "col-resize" : "";
    if (held?.wipes) state.wipe = Math.min(Math.max(x / pane.clientWidth, 0), 1);
    else if (held && (held.moved || Math.hypot(x - held.x, y - held.y) > 3)) {
      [sight.x, sight.y, sight.fits] = [sight.x - (x - held.x) / sight.scale, sight.y - (y - held.y) / sight.scale, false];
      held = { x, y, moved: true };
    }
    soon();
  });
  canvas.addEventListener("pointerup", (event) => {
    if (held && !held.moved && !held.wipes) {
      const [x, y] = toFile(pane, ...placeOf(event));
      const inside = firstShown() && pixelOf(firstShown().layer, [x, y]) !== null;
      mark = inside ? [Math.floor(x) + 0.5, Math.floor(y) + 0.5] : null;
      toAddress();
    }
    held = null;
    soon();
  });
  canvas.addEventListener("pointerleave", () => { hover = null; soon(); });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(2 ** (-event.deltaY / 300), placeOf(event), pane);
    soon();
  }, { passive: false });
  return pane;
}

let asked = false;
function soon() {
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => { asked = false; redraw(); });
}

function step(list, now, by, change) {
  const next = list[list.indexOf(now) + by];
  if (next !== undefined) change(next);
}
const byFrames = (by) => step(framesHere(), state.frame, by, (frame) => choose({ frame }));
const zoomBy = (factor) => { zoom(factor, null, at("panes").children[0]); redraw(); };
const whole = () => { [sight.scale, sight.fits] = [1 / (window.devicePixelRatio || 1), false]; redraw(); };
const fitAll = () => { sight.fits = true; redraw(); };
const setOf = (change) => { change(settingsOf(state.key)); tools(); toAddress(); redraw(); };

function moveMark(x, y, event) {
  const first = firstShown();
  if (!first) return;
  const { layer } = first, far = (event.shiftKey ? 10 : 1) * layer.step;
  const from = mark ?? hover ?? [layer.columns / 2, layer.rows / 2];
  const within = (v, most) => Math.min(Math.max(Math.floor(v), 0), most - 1) + 0.5;
  mark = [within(from[0] + x * far, layer.columns), within(from[1] + y * far, layer.rows)];
  toAddress();
  redraw();
}

const KEYS = {
  j: () => step(keysHere(), state.key, 1, (key) => choose({ key })),
  k: () => step(keysHere(), state.key, -1, (key) => choose({ key })),
  ".": () => byFrames(1), ",": () => byFrames(-1),
  "+": () => zoomBy(1.5), "=": () => zoomBy(1.5), "-": () => zoomBy(1 / 1.5), "0": fitAll, "1": whole,
  e: () => setOf((own) => { own.ev = Math.min((own.ev ?? 0) + 0.5, 10); }),
  E: () => setOf((own) => { own.ev = Math.max((own.ev ?? 0) - 0.5, -10); }),
  c: () => setOf((own) => { own.clipped = !own.clipped; }),
  x: () => { state.boxes = !state.boxes; tools(); toAddress(); redraw(); },
  v: () => { state.arrows = !state.arrows; tools(); toAddress(); redraw(); },
  "?": () => at("keys").showModal(),
  Escape: () => { mark = null; toAddress(); redraw(); },
  ArrowLeft: (event) => moveMark(-1, 0, event), ArrowRight: (event) => moveMark(1, 0, event),
  ArrowUp: (event) => moveMark(0, -1, event), ArrowDown: (event) => moveMark(0, 1, event),
  ...(hasTwo ? Object.fromEntries(["a", "b", "s", "w", "d"].map((key, i) => [key, () => choose({ mode: MODES[i] })])) : {}),
};

document.addEventListener("keydown", (event) => {
  const inField = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.key !== "Escape";
  if (inField || event.ctrlKey || event.metaKey || event.altKey || at("keys").open || !KEYS[event.key]) return;
  event.preventDefault();
  KEYS[event.key](event);
});

at("place").addEventListener("change", (event) => choose({ place: event.target.value }));
at("frame").addEventListener("change", (event) => choose({ frame: Number(event.target.value) }));
at("before").addEventListener("click", () => byFrames(-1));
at("after").addEventListener("click", () => byFrames(1));
at("modes").addEventListener("click", ({ target }) => { if (target.dataset.mode) choose({ mode: target.dataset.mode }); });
at("fit").addEventListener("click", fitAll);
at("whole").addEventListener("click", whole);
at("in").addEventListener("click", () => zoomBy(1.5));
at("out").addEventListener("click", () => zoomBy(1 / 1.5));
at("help").addEventListener("click", () => at("keys").showModal());
new ResizeObserver(soon).observe(at("panes"));
window.addEventListener("hashchange", () => { fromAddress(); refresh(); });

at("title").textContent = PAGE.title;
fromAddress();
refresh();
