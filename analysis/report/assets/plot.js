// A plot on logarithmic axes: lines, bands, whiskers, markers, floors; points speak under pointer and arrow keys.
const svgSpace = "http://www.w3.org/2000/svg";

function shape(name, attributes, parent, text) {
  const made = document.createElementNS(svgSpace, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent?.append(made);
  return made;
}

// Outlines about the origin, told apart by form and not by colour alone.
const outlines = [
  "M5 0A5 5 0 1 1-5 0A5 5 0 1 1 5 0Z", "M-4.4-4.4H4.4V4.4H-4.4Z", "M0-5.6L5.4 4H-5.4Z", "M0-6L5.2 0L0 6L-5.2 0Z",
  "M0 5.6L5.4-4H-5.4Z", "M-5.6 0L4-5.4V5.4Z", "M5.6 0L-4-5.4V5.4Z", "M0-5.8L5.5-1.8L3.4 4.7H-3.4L-5.5-1.8Z",
  "M-1.8-5.4H1.8V-1.8H5.4V1.8H1.8V5.4H-1.8V1.8H-5.4V-1.8H-1.8Z",
  "M-5-2.6L-2.6-5L0-2.4L2.6-5L5-2.6L2.4 0L5 2.6L2.6 5L0 2.4L-2.6 5L-5 2.6L-2.4 0Z", "M-5 0L-2.5-4.5H2.5L5 0L2.5 4.5H-2.5Z"];
const dashes = ["", "9 3", "6 2 1.5 2", "2 2.5"];

function look(index) {
  return {colour: `var(--c${index % 8})`, outline: outlines[index % outlines.length], dash: dashes[Math.floor(index / 8) % 4]};
}

// Round numbers a few steps apart, for axes that are too short for powers and their parts.
function evenTicks(low, high, room) {
  const rough = (high - low) / Math.max(2, Math.min(6, room)), power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(factor => factor * power).find(size => size >= rough);
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) ticks.push(i * step);
  return ticks;
}

function logTicks(low, high, base, room) {
  if (base === 10 && high / low < 4) return evenTicks(low, high, room);
  const log = value => Math.log(value) / Math.log(base);
  const first = Math.floor(log(low)), last = Math.ceil(log(high));
  const fine = high / low < 20 ? [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9] : high / low < 300 ? [1, 2, 5] : [1];
  const factors = base === 10 ? fine : [1];
  let ticks = [];
  for (let power = first; power <= last; ++power) for (const f of factors) ticks.push(f * base ** power);
  ticks = ticks.filter(tick => tick >= low * 0.999 && tick <= high * 1.001);
  const step = Math.ceil(ticks.length / Math.max(2, room));
  return ticks.filter((_, i) => i % step === 0);
}

function axisText(value) {
  return value >= 1e6 || value < 1e-3 ? value.toExponential(0).replace("-", "−").replace("+", "") : String(Number(value.toPrecision(3)));
}

class Plot {
  // spec: {title, xName, yName, xBase, x: [low, high], y: [low, high], floors, guides(plot), height}
  constructor(holder, spec) {
    this.spec = spec;
    this.series = [];  // {look, label, points: [{x, y, low, high, xLow, xHigh, hollow, tip}], line: bool}
    this.svg = shape("svg", {class: "chart", role: "group", tabindex: 0, "aria-label": spec.title}, holder);
    this.at = null;
    this.svg.addEventListener("pointermove", event => this.point(event));
    this.svg.addEventListener("pointerleave", () => { this.mark(null); hideTip(); heatPlots(null); });
    this.svg.addEventListener("keydown", event => this.key(event));
    this.svg.addEventListener("blur", () => this.mark(null));
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  draw() {
    const width = Math.round(this.svg.parentNode.clientWidth), height = this.spec.height ?? 330;
    if (width === 0) return;
    this.svg.replaceChildren();
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("height", height);
    const yTexts = logTicks(...this.spec.y, 10, (height - 60) / 28).map(axisText);
    this.box = {left: 34 + 7 * Math.max(4, ...yTexts.map(text => text.length)), right: width - 14, top: 14, bottom: height - 46};
    this.axes();
    shape("clipPath", {id: this.clip ??= `clip${Plot.count = (Plot.count ?? 0) + 1}`}, this.svg)
      .append(shape("rect", {x: this.box.left, y: this.box.top, width: this.box.right - this.box.left, height: this.box.bottom - this.box.top}));
    const inside = shape("g", {"clip-path": `url(#${this.clip})`}, this.svg);
    this.spec.guides?.(this, inside);
    this.floors(inside);
    for (const one of this.series) this.drawSeries(one, inside);
    shape("rect", {class: "frame", x: this.box.left, y: this.box.top, width: this.box.right - this.box.left, height: this.box.bottom - this.box.top}, this.svg);
    this.heat(this.hot);
  }

  px(x) {
    const [low, high] = this.spec.x;
    return this.box.left + (this.box.right - this.box.left) * Math.log(x / low) / Math.log(high / low);
  }

  py(y) {
    const [low, high] = this.spec.y;
    return this.box.bottom - (this.box.bottom - this.box.top) * Math.log(y / low) / Math.log(high / low);
  }

  axes() {
    const {left, right, top, bottom} = this.box;
    for (const tick of logTicks(...this.spec.x, this.spec.xBase ?? 10, (right - left) / 55)) {
      shape("path", {class: "grid", d: `M${this.px(tick)} ${top}V${bottom}`}, this.svg);
      shape("text", {x: this.px(tick), y: bottom + 17, "text-anchor": "middle"}, this.svg, axisText(tick));
    }
    for (const tick of logTicks(...this.spec.y, 10, (bottom - top) / 28)) {
      shape("path", {class: "grid", d: `M${left} ${this.py(tick)}H${right}`}, this.svg);
      shape("text", {x: left - 7, y: this.py(tick) + 4, "text-anchor": "end"}, this.svg, axisText(tick));
    }
    shape("text", {class: "axis-title", x: (left + right) / 2, y: bottom + 37, "text-anchor": "middle"}, this.svg, this.spec.xName);
    shape("text", {class: "axis-title", transform: `translate(14 ${(top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle"}, this.svg, this.spec.yName);
  }

  floors(parent) {
    const floors = this.spec.floors ?? [];
    const inside = floors.filter(floor => floor >= this.spec.y[0]);
    for (const floor of inside) shape("path", {class: "floor", d: `M${this.box.left} ${this.py(floor)}H${this.box.right}`}, parent);
    if (!floors.length) return;
    const y = inside.length ? this.py(inside.at(-1)) - 5 : this.box.bottom - 6;
    const values = [...new Set([floors[0], floors.at(-1)])].map(short).join(" to ");
    shape("text", {x: this.box.left + 6, y}, parent, `reference's noise ${values}${inside.length ? "" : ", below this axis ↓"}`);
  }

  drawSeries(one, parent) {
    const group = shape("g", {"data-label": one.label}, parent);
    one.group = group;
    const fill = one.look.colour;
    const banded = one.points.filter(point => point.low > 0);
    if (one.line && banded.length > 1) {
      const up = banded.map(p => `${this.px(p.x)} ${this.py(p.high)}`), down = banded.map(p => `${this.px(p.x)} ${this.py(p.low)}`);
      shape("path", {class: "band", fill, d: `M${up.join("L")}L${down.reverse().join("L")}Z`}, group);
    }
    if (one.line) shape("path", {class: "line", stroke: fill, "stroke-dasharray": one.look.dash, d: `M${one.points.map(p => `${this.px(p.x)} ${this.py(p.y)}`).join("L")}`}, group);
    for (const p of one.points) {
      const at = [this.px(p.x), this.py(p.y)];
      if (!one.line && p.low > 0) shape("path", {class: "whisker", stroke: fill, d: `M${at[0]} ${this.py(p.low)}V${this.py(p.high)}`}, group);
      if (!one.line && p.xLow > 0) shape("path", {class: "whisker", stroke: fill, d: `M${this.px(p.xLow)} ${at[1]}H${this.px(p.xHigh)}`}, group);
      shape("path", {class: "marker", d: one.look.outline, transform: `translate(${at}) scale(${one.line ? 0.8 : 1.15})`, stroke: fill, fill: p.hollow ? "var(--card)" : fill}, group);
      if (p.text) shape("text", {x: at[0], y: at[1] - 10, "text-anchor": "middle"}, group, p.text);
    }
  }

  // Fades all lines but those of one method.
  heat(label) {
    this.hot = label;
    for (const one of this.series) one.group?.classList.toggle("cold", label != null && one.label !== label);
  }
}
