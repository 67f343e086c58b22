// Speed against error: every configuration a point; along a dotted line error times time is the same.
const speedHolder = document.querySelector("#speed-plot");

class SpeedPanel {
  constructor(holder) {
    this.scene = document.querySelector("#speed-scene");
    this.x = document.querySelector("#speed-x");
    this.y = document.querySelector("#speed-y");
    for (const [value, name] of [["", "all"], ...data.scenes.map(scene => [scene, scene])]) this.scene.append(element("option", {value}, name));
    this.scene.parentElement.hidden = data.scenes.length < 2;
    for (const [key, {name}] of Object.entries(data.figures.x)) this.x.append(element("option", {value: key}, name));
    for (const [key, {name}] of Object.entries(data.figures.y)) this.y.append(element("option", {value: key}, name));
    if (data.figures.y.relmse) this.y.value = "relmse";
    const figure = element("figure");
    holder.append(figure);
    this.plot = new Plot(figure, {title: "speed against error, a point per configuration", x: [1, 2], y: [1, 2], height: 430, 
      guides: (plot, parent) => { drawEfficiency(plot, parent); this.drawFronts(plot, parent); }});
    this.all = [this.plot];
    for (const control of [this.scene, this.x, this.y]) control.addEventListener("change", () => this.redraw());
  }

  redraw() {
    const [xKey, yKey] = [this.x.value, this.y.value];
    const [xFigure, yFigure] = [data.figures.x[xKey], data.figures.y[yKey]];
    const configurations = data.configurations.filter(configuration => (!this.scene.value || configuration.scene === this.scene.value) && configuration.figures[xKey]?.[0] > 0 && configuration.figures[yKey]?.[0] > 0);
    const shown = configurations.filter(configuration => !hidden.has(configuration.label));
    const ends = (key, from) => from.flatMap(configuration => {
      const [mean, low, high] = configuration.figures[key].map(Number);
      return low > 0 ? [mean, Math.max(low, mean / bandReach), Math.min(high, mean * bandReach)] : [mean];
    });
    const ranged = shown.length ? shown : configurations;
    if (ranged.length) Object.assign(this.plot.spec, {x: widened(span(ends(xKey, ranged)), 0.08), y: widened(span(ends(yKey, ranged)), 0.08)});
    Object.assign(this.plot.spec, {xName: xFigure.name, yName: yFigure.name});
    this.fronts = data.scenes.map(scene => front(shown.filter(configuration => configuration.scene === scene).map(configuration => [configuration.figures[xKey], configuration.figures[yKey]].map(([mean]) => Number(mean)))));
    this.plot.series = shown.map(configuration => {
      const [x, xLow, xHigh] = configuration.figures[xKey].map(Number), [y, low, high] = configuration.figures[yKey].map(Number);
      const says = (name, [mean, low, high]) => `${name} ${mean}${low ? `\n95 %: ${low} to ${high}` : ""}`;
      const tip = `${configuration.configuration}\n${says(xFigure.name, configuration.figures[xKey])}\n${says(yFigure.name, configuration.figures[yKey])}${configuration.floor ? "\nat the reference's noise" : ""}`;
      return {label: configuration.label, look: look(data.labels.indexOf(configuration.label)), line: false, points: [{x, y, low, high, xLow, xHigh, tip, hollow: configuration.floor,
        text: data.scenes.length > 1 && !this.scene.value ? configuration.scene : shown.length <= 16 ? configuration.label : ""}]};
    });
    this.plot.at = null;
    this.plot.draw();
  }

  drawFronts(plot, parent) {
    for (const points of this.fronts ?? []) {
      if (points.length < 2) continue;
      const steps = points.slice(1).map(([x, y]) => `H${plot.px(x)}V${plot.py(y)}`).join("");
      shape("path", {class: "front", d: `M${plot.px(points[0][0])} ${plot.py(points[0][1])}${steps}`}, parent);
    }
  }
}

// The points that no other one beats in both ways.
function front(points) {
  let least = Infinity;
  return points.sort((a, b) => a[0] - b[0] || a[1] - b[1]).filter(([, y]) => y < least && (least = y, true));
}

// Lines of equal error times time, a factor of ten apart; straight and falling on these axes.
function drawEfficiency(plot, parent) {
  const {x: [xLow, xHigh], y: [yLow, yHigh]} = plot.spec;
  for (let power = Math.ceil(Math.log10(xLow * yLow)); power <= Math.log10(xHigh * yHigh); ++power) {
    const product = 10 ** power;
    shape("path", {class: "guide", d: `M${plot.px(xLow)} ${plot.py(product / xLow)}L${plot.px(xHigh)} ${plot.py(product / xHigh)}`}, parent);
  }
}

if (speedHolder) {
  plots.push(new SpeedPanel(speedHolder));
  plots.at(-1).redraw();
}
