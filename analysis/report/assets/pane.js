// One picture on the stage: its pixels, its name, and the marks upon it.
class Pane {
  constructor(viewer, place) {
    this.viewer = viewer;
    this.canvas = element("canvas");
    this.name = element("span", {class: "name"});
    this.root = element("div", {class: `pane ${place}`}, this.canvas, this.name);
    this.marks = shape("svg", {"aria-hidden": "true"}, this.root);
    this.root.pane = this;
  }

  async set(index) {
    const {gallery, halves} = this.viewer;
    this.index = index;
    this.picture = gallery.pictures[index];
    const shownError = this.viewer.show === "error" && this.picture.reference !== null && this.picture.configuration;
    this.name.textContent = this.picture.name + (shownError ? ": error" : "");
    const reference = shownError ? halves[this.picture.reference] : null;
    await Promise.all([halves[index].load(), reference?.load()]);
    if (this.index !== index || this.viewer.gallery !== gallery) return;  // another one was asked for meanwhile
    const image = reference ? paintError(halves[index], reference) : paintImage(halves[index], this.viewer.stops);
    if (this.canvas.width !== image.width || this.canvas.height !== image.height) Object.assign(this.canvas, {width: image.width, height: image.height});
    this.canvas.getContext("2d").putImageData(image, 0, 0);
    this.root.dataset.painted = `${index} ${reference ? "error" : `image ${this.viewer.stops}`}`;
  }

  get size() { return [this.root.clientWidth, this.root.clientHeight]; }

  // Screen pixels per image pixel, and where the image's corner lies.
  get frame() {
    const {zoom, centre} = this.viewer, [width, height] = this.size;
    const scale = width / this.viewer.width * zoom;
    return {scale, left: width / 2 - centre[0] * scale, top: height / 2 - centre[1] * scale};
  }

  pixelAt(event) {
    const box = this.root.getBoundingClientRect(), {scale, left, top} = this.frame;
    return [(event.clientX - box.left - left) / scale, (event.clientY - box.top - top) / scale];
  }

  place() {
    const {scale, left, top} = this.frame;
    this.canvas.style.transform = `translate(${left}px, ${top}px) scale(${scale})`;
    this.marks.replaceChildren();
    const at = ([x, y]) => [left + (x + 0.5) * scale, top + (y + 0.5) * scale];
    if (this.viewer.showsFireflies) {
      for (const firefly of this.picture?.fireflies ?? []) {
        const [cx, cy] = at([(firefly.x + 0.5) / this.viewer.gallery.factor - 0.5, (firefly.y + 0.5) / this.viewer.gallery.factor - 0.5]);
        for (const under of [" under", ""]) shape("circle", {class: `firefly${under}`, cx, cy, r: Math.max(6, scale * 0.8)}, this.marks);
      }
    }
    if (this.viewer.pixel) {
      const [x, y] = at(this.viewer.pixel), half = Math.max(scale / 2, 3);
      for (const under of [" under", ""]) shape("rect", {class: `cross${under}`, x: x - half, y: y - half, width: 2 * half, height: 2 * half}, this.marks);
    }
  }
}
