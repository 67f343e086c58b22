// The values of the pixel under the cursor in every picture.
class Readout {
  constructor(viewer) {
    this.viewer = viewer;
    this.place = viewer.find("pixel-place");
    this.body = viewer.root.querySelector(".readout tbody");
  }

  build() {
    this.rows = this.viewer.gallery.pictures.map((picture, index) => {
      const colour = element("span", {class: "colour"}), fields = Array.from({length: 4}, () => element("td"));
      const row = element("tr", {}, element("th", {scope: "row", class: "text"}, colour, picture.name), ...fields);
      row.addEventListener("click", () => this.viewer.set({chosen: [this.viewer.chosen[0], index]}));
      return {row, colour, fields};
    });
    this.body.replaceChildren(...this.rows.map(entry => entry.row));
  }

  where([x, y]) {
    const {factor, size} = this.viewer.gallery;
    if (factor === 1) return `Pixel ${x}, ${y}`;
    const range = (from, limit) => `${from * factor} to ${Math.min(limit, (from + 1) * factor) - 1}`;
    return `Mean of pixels ${range(x, size[0])}, ${range(y, size[1])}`;
  }

  update() {
    const {pixel, halves, gallery, chosen, stops} = this.viewer;
    this.rows.forEach(({row}, i) => row.classList.toggle("shown", chosen.includes(i)));
    this.place.textContent = pixel ? this.where(pixel) : "Point at the images, or focus them and press arrow keys";
    const table = screenTableNow(stops);
    gallery.pictures.forEach((picture, i) => {
      const {colour, fields} = this.rows[i];
      if (!pixel || !halves[i].values) return fields.forEach(field => field.textContent = pixel ? "…" : "");
      const rgb = halves[i].rgb(...pixel);
      rgb.forEach((value, c) => fields[c].textContent = exactly(value));
      const reference = halves[picture.reference];
      fields[3].textContent = reference?.values && picture.configuration ? short(pixelError(rgb, reference.rgb(...pixel))) : "";
      colour.style.background = `rgb(${halves[i].bits(...pixel).map(bits => table[bits])})`;
    });
  }

  // For a screen reader: where, and what the two chosen pictures have there.
  spoken() {
    const {chosen, gallery} = this.viewer;
    return [this.place.textContent, ...chosen.map(i => `${gallery.pictures[i].name}: ${this.rows[i].fields.map(field => field.textContent).join(" ")}`)].join("; ");
  }
}

// Half floats hold a little more than three digits.
function exactly(value) {
  return Number.isFinite(value) ? String(Number(value.toPrecision(4))).replace("-", "−") : String(value);
}
