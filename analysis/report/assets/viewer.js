// Images beside, upon and instead of each other, all at one exposure and one place, as in tev and jeri.
class Viewer {
  constructor(root) {
    this.root = root;
    this.find = name => root.querySelector(`#${name}`);
    this.stage = root.querySelector(".stage");
    Object.assign(this, {mode: "wipe", show: "image", stops: 0, zoom: 1, centre: [0, 0], wipe: 50, pixel: null, panes: []});
    this.showsFireflies = this.find("fireflies").checked;
    this.divider = element("div", {class: "divider"});
    data.galleries.forEach((gallery, index) => this.find("gallery").append(element("option", {value: index}, gallery.name)));
    new ResizeObserver(() => this.place()).observe(this.stage);
    this.readout = new Readout(this);
    this.open(0);
  }

  open(index) {
    this.gallery = data.galleries[index];
    const pictures = this.gallery.pictures;
    [this.width, this.height] = pictures[0].size;
    this.halves = pictures.map((picture, i) => new Halves(index, i, ...picture.size));
    this.pixel = null;
    for (const name of ["first", "second"]) {
      this.find(name).replaceChildren(...pictures.map((picture, i) => element("option", {value: i}, picture.name)));
    }
    this.chosen = [0, pictures.length > 1 ? 1 : 0];
    this.readout.build();
    this.fit();
    this.arrange();
    this.loadAll();
  }

  // In the background, so that the readout has all.
  async loadAll() {
    const halves = this.halves;
    for (const one of halves) {
      await one.load();
      if (halves !== this.halves) return;
    }
    this.readout.update();
  }

  fit() {
    this.zoom = 1;
    this.centre = [this.width / 2, this.height / 2];
  }

  // The panes that the mode needs.
  arrange() {
    const indices = this.mode === "all" ? this.gallery.pictures.map((_, i) => i) : this.chosen;
    this.stage.className = `stage ${this.mode}`;
    this.panes = indices.map((_, i) => new Pane(this, i ? "second" : "first"));
    for (const pane of this.panes) pane.root.style.aspectRatio = `${this.width} / ${this.height}`;
    const across = this.mode === "side" ? 2 : 1;
    this.stage.style.maxWidth = this.mode === "all" ? "" : `calc(72vh * ${across * this.width / this.height})`;
    this.find("wipe").style.maxWidth = this.stage.style.maxWidth;
    this.stage.replaceChildren(...this.panes.map(pane => pane.root), ...this.mode === "wipe" ? [this.divider] : []);
    this.front = 1;
    this.repaint();
  }

  repaint() {
    const indices = this.mode === "all" ? this.gallery.pictures.map((_, i) => i) : this.chosen;
    this.panes.forEach((pane, i) => pane.set(indices[i]));
    this.find("first").value = this.chosen[0];
    this.find("second").value = this.chosen[1];
    this.find("sources").textContent = this.chosen.map((index, i) => `${"AB"[i]}: ${this.gallery.pictures[index].source}`).join(". ");
    this.find("firefly-count").textContent = this.chosen.map(index => this.gallery.pictures[index].fireflies.length).join(" in A, ") + " in B";
    this.find("error-scale").hidden = this.show !== "error";
    this.place();
    this.readout.update();
    listFireflies(this);
  }

  place() {
    for (const pane of this.panes) pane.place();
    if (this.mode === "wipe") {
      this.panes[1].root.style.clipPath = `inset(0 0 0 ${this.wipe}%)`;
      this.divider.style.left = `${this.wipe}%`;
    }
    if (this.mode === "flip") this.panes.forEach((pane, i) => pane.root.classList.toggle("back", i !== this.front));
    this.stage.style.touchAction = this.zoom > 1 ? "none" : "pan-y";
    this.find("wipe").parentElement.hidden = this.mode !== "wipe";
    this.find("flip-now").hidden = this.mode !== "flip";
  }

  // Zooms about a point of the image, and keeps the image on the stage.
  zoomAbout([x, y], factor) {
    const before = this.zoom;
    this.zoom = Math.min(64, Math.max(1, before * factor));
    const share = before / this.zoom;
    this.moveTo([x + (this.centre[0] - x) * share, y + (this.centre[1] - y) * share]);
  }

  moveTo([x, y]) {
    const clamp = (value, size) => Math.min(size - size / 2 / this.zoom, Math.max(size / 2 / this.zoom, value));
    this.centre = [clamp(x, this.width), clamp(y, this.height)];
    this.place();
  }

  setPixel(pixel) {
    const [x, y] = pixel.map(Math.floor);
    if (!(x >= 0 && y >= 0 && x < this.width && y < this.height)) return;
    this.pixel = [x, y];
    this.place();
    this.readout.update();
  }

  set(changes) {
    Object.assign(this, changes);
    for (const name of ["mode", "show"]) {
      for (const button of this.root.querySelectorAll(`[data-${name}]`)) button.setAttribute("aria-pressed", String(button.dataset[name] === this[name]));
    }
    const stops = this.find("exposure");
    stops.value = this.stops;
    this.find("exposure-value").textContent = `${this.stops > 0 ? "+" : ""}${this.stops} EV`.replace("-", "−");
    this.find("wipe").value = this.wipe;
    this.find("fireflies").checked = this.showsFireflies;
    if ("mode" in changes) this.arrange();
    else if ("wipe" in changes || "front" in changes || "showsFireflies" in changes) this.place();
    else this.repaint();
  }

  flip() { this.set(this.mode === "flip" ? {front: 1 - this.front} : {mode: "flip"}); }
}
