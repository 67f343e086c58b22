// Pointer, wheel, touch and keys on the stage, and the controls above it.
function stagePointers(viewer) {
  const {stage, divider} = viewer;
  const pointers = new Map();
  const paneOf = event => event.target.closest(".pane")?.pane ?? viewer.panes[0];

  stage.addEventListener("pointerdown", event => {
    if (event.target === divider) return;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    stage.setPointerCapture(event.pointerId);
    viewer.setPixel(viewer.panes.find(pane => contains(pane, event))?.pixelAt(event) ?? [-1, -1]);
  });
  stage.addEventListener("pointermove", event => {
    const before = pointers.get(event.pointerId);
    if (!before) return viewer.setPixel(paneOf(event).pixelAt(event));
    const now = [event.clientX, event.clientY];
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;
    if (other) {
      viewer.zoomAbout(viewer.panes[0].pixelAt({clientX: other[0], clientY: other[1]}), distance(now, other) / distance(before, other));
    } else {
      const {scale} = viewer.panes[0].frame;
      viewer.moveTo([viewer.centre[0] - (now[0] - before[0]) / scale, viewer.centre[1] - (now[1] - before[1]) / scale]);
    }
    pointers.set(event.pointerId, now);
  });
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, event => pointers.delete(event.pointerId));
  stage.addEventListener("wheel", event => {
    // A page that is scrolled past must go on scrolling: the wheel zooms where the stage was clicked or Ctrl is held.
    if (!event.ctrlKey && document.activeElement !== stage) return;
    event.preventDefault();
    viewer.zoomAbout(paneOf(event).pixelAt(event), Math.exp(-event.deltaY / 300));
  }, {passive: false});

  const wipeTo = event => {
    const box = stage.getBoundingClientRect();
    viewer.set({wipe: Math.round(1000 * Math.min(1, Math.max(0, (event.clientX - box.left) / box.width))) / 10});
  };
  divider.addEventListener("pointerdown", event => divider.setPointerCapture(event.pointerId));
  divider.addEventListener("pointermove", event => { if (divider.hasPointerCapture(event.pointerId)) wipeTo(event); });
}

function contains(pane, event) {
  const box = pane.root.getBoundingClientRect();
  return event.clientX >= box.left && event.clientX < box.right && event.clientY >= box.top && event.clientY < box.bottom;
}

function stageKeys(viewer) {
  const round = value => Math.round(4 * value) / 4;
  const middle = () => viewer.pixel ? viewer.pixel.map(at => at + 0.5) : viewer.centre;
  const step = (dx, dy) => () => viewer.setPixel([Math.floor(middle()[0]) + dx, Math.floor(middle()[1]) + dy]);
  const keys = {
    ArrowLeft: step(-1, 0), ArrowRight: step(1, 0), ArrowUp: step(0, -1), ArrowDown: step(0, 1),
    "+": () => viewer.zoomAbout(middle(), 2), "=": () => viewer.zoomAbout(middle(), 2), "-": () => viewer.zoomAbout(middle(), 0.5),
    "0": () => { viewer.fit(); viewer.place(); },
    f: () => viewer.flip(), " ": () => viewer.flip(), w: () => viewer.set({mode: "wipe"}),
    e: () => viewer.set({show: viewer.show === "error" ? "image" : "error"}),
    "]": () => viewer.set({stops: round(viewer.stops + 0.5)}), "[": () => viewer.set({stops: round(viewer.stops - 0.5)}),
    x: () => viewer.set({chosen: [viewer.chosen[1], viewer.chosen[0]]}),
  };
  viewer.stage.addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const number = Number(event.key);
    const act = keys[event.key] ?? (number >= 1 && number < viewer.gallery.pictures.length
      ? () => viewer.set({chosen: [viewer.chosen[0], number]}) : null);
    if (!act) return;
    event.preventDefault();
    act();
    if (event.key.startsWith("Arrow")) live.textContent = viewer.readout.spoken();
  });
}

function viewerControls(viewer) {
  const on = (name, type, act) => viewer.find(name).addEventListener(type, act);
  on("gallery", "change", event => viewer.open(Number(event.target.value)));
  on("first", "change", event => viewer.set({chosen: [Number(event.target.value), viewer.chosen[1]]}));
  on("second", "change", event => viewer.set({chosen: [viewer.chosen[0], Number(event.target.value)]}));
  on("swap", "click", () => viewer.set({chosen: [viewer.chosen[1], viewer.chosen[0]]}));
  on("exposure", "input", event => viewer.set({stops: Number(event.target.value)}));
  on("exposure-zero", "click", () => viewer.set({stops: 0}));
  on("exposure-auto", "click", () => viewer.set({stops: autoStops(viewer.halves[viewer.chosen[0]])}));
  on("wipe", "input", event => viewer.set({wipe: Number(event.target.value)}));
  on("flip-now", "click", () => viewer.flip());
  on("fireflies", "change", event => viewer.set({showsFireflies: event.target.checked}));
  on("firefly-list", "toggle", () => listFireflies(viewer));
  on("zoom-in", "click", () => viewer.zoomAbout(viewer.centre, 2));
  on("zoom-out", "click", () => viewer.zoomAbout(viewer.centre, 0.5));
  on("zoom-fit", "click", () => { viewer.fit(); viewer.place(); });
  for (const name of ["mode", "show"]) {
    for (const button of viewer.root.querySelectorAll(`[data-${name}]`)) button.addEventListener("click", () => viewer.set({[name]: button.dataset[name]}));
  }
}

// The name of a row shows its image as B.
function linkToImages(viewer, row) {
  const isRow = picture => picture.configuration === row.dataset.key;
  const gallery = data.galleries.findIndex(({pictures}) => pictures.some(isRow));
  if (gallery < 0) return;
  const name = row.querySelector("th .shown"), link = element("a", {href: "#images", "data-tip": "show its image"}, name.textContent);
  name.replaceChildren(link);
  link.addEventListener("click", () => {
    viewer.find("gallery").value = gallery;
    viewer.open(gallery);
    viewer.set({chosen: [0, viewer.gallery.pictures.findIndex(isRow)]});
  });
}

const viewerRoot = document.querySelector(".viewer-section");
if (viewerRoot) {
  const viewer = new Viewer(viewerRoot);
  stagePointers(viewer);
  stageKeys(viewer);
  viewerControls(viewer);
  viewer.set({});
  for (const row of document.querySelectorAll("#configurations-table tbody tr")) linkToImages(viewer, row);
}
