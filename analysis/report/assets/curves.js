// Error against samples and against seconds, a pair of plots per scene.
const [SPP, SECONDS, MEAN, LOW, HIGH, SEEDS, FLOOR] = [1, 2, 3, 4, 5, 6, 7];  // of a point: analysis/report/curves.py
const metric = document.querySelector("#metric");
const bandReach = data.reach.band, floorReach = data.reach.floor;

function span(values) { return [Math.min(...values), Math.max(...values)]; }

function widened([low, high], share = 0.05) {
  const margin = low === high ? 1.5 : (high / low) ** share;
  return [low / margin, high * margin];
}

function errorRange(points, floors) {
  const [low, high] = span(points.map(p => p[MEAN]));
  const bands = points.filter(p => p[LOW] > 0);
  const bottom = Math.min(low, ...bands.map(p => Math.max(p[LOW], low / bandReach)), ...floors.filter(f => f >= low / floorReach));
  return widened([bottom, Math.max(high, ...bands.map(p => Math.min(p[HIGH], high * bandReach)))]);
}

function curveTip(configuration, p, name) {
  const interval = p[LOW] === null ? "" : `\n95 %: ${p[LOW]} to ${p[HIGH]}`;
  return `${configuration.configuration}\n${p[SPP]} spp, ${p[SECONDS]} s\n${name} ${p[MEAN]}${interval}\n${p[SEEDS]} seed${p[SEEDS] === 1 ? "" : "s"}${p[FLOOR] ? ", at the reference's noise" : ""}`;
}

class CurvePanel {
  constructor(holder, scene) {
    this.scene = scene;
    this.configurations = data.configurations.filter(configuration => configuration.scene === scene);
    const pair = element("div", {class: "panels"});
    this.root = element("div", {}, element("h3", {}, scene), pair);
    holder.append(this.root);
    this.all = [["samples per pixel (spp)", SPP, 2], ["seconds, learning included", SECONDS, 10]].map(([xName, column, xBase]) => {
      const figure = element("figure");
      pair.append(figure);
      const plot = new Plot(figure, {xName, xBase, title: `${scene}: error against ${xName}`, x: [1, 2], y: [1, 2]});
      plot.column = column;
      return plot;
    });
  }

  redraw() {
    this.root.hidden = sceneChoice.value !== "" && sceneChoice.value !== this.scene;
    if (this.root.hidden) return;
    const key = metric.value, name = data.metrics[key].split(" (")[0];
    const curves = this.configurations.filter(configuration => data.curves[key][configuration.configuration])
      .map(configuration => ({configuration, points: data.curves[key][configuration.configuration].filter(p => p[MEAN] > 0 && p[SECONDS] > 0)})).filter(one => one.points.length);
    const shown = curves.filter(one => !hidden.has(one.configuration.label));
    const ranged = (shown.length ? shown : curves).flatMap(one => one.points);
    const floors = data.floors[key]?.[this.scene] ?? [];
    for (const plot of this.all) {
      if (ranged.length) Object.assign(plot.spec, {y: errorRange(ranged, floors), x: widened(span(ranged.map(p => p[plot.column])), 0.03)});
      Object.assign(plot.spec, {floors, yName: data.metrics[key]});
      plot.series = shown.map(({configuration, points}) => ({
        label: configuration.label, look: look(data.labels.indexOf(configuration.label)), line: true,
        points: points.map(p => ({x: p[plot.column], y: p[MEAN], low: p[LOW], high: p[HIGH], hollow: p[FLOOR], tip: curveTip(configuration, p, name)})),
      }));
      plot.at = null;
      plot.draw();
    }
  }
}

const sceneChoice = document.querySelector("#curve-scene");

if (metric) {
  for (const [value, name] of [["", "all"], ...data.scenes.map(scene => [scene, scene])]) sceneChoice.append(element("option", {value}, name));
  sceneChoice.parentElement.hidden = data.scenes.length < 2;
  if (data.scenes.length > 4) sceneChoice.value = data.scenes[0];
  sceneChoice.addEventListener("change", redrawPlots);
  for (const [key, name] of Object.entries(data.metrics)) metric.append(element("option", {value: key}, name));
  if (data.metrics.relmse) metric.value = "relmse";
  if (metric.options.length) for (const scene of data.scenes) plots.push(new CurvePanel(document.querySelector("#curve-panels"), scene));
  else document.querySelector("#curve-panels").append(element("p", {class: "lead"}, "No error was measured, or no convergence.csv could be read."));
  metric.addEventListener("change", redrawPlots);
  redrawPlots();
}
