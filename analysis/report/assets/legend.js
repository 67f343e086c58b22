// Which methods are shown: the legends are one for all plots.
const hidden = new Set();
const plots = [];  // {redraw(), all: [Plot]}
const legends = [...document.querySelectorAll(".legend")];

function swatch(index) {
  const {colour, outline, dash} = look(index);
  const svg = shape("svg", {width: 30, height: 14, viewBox: "-15 -7 30 14", "aria-hidden": "true"});
  shape("path", {d: "M-15 0H15", stroke: colour, "stroke-width": 2, "stroke-dasharray": dash}, svg);
  shape("path", {d: outline, fill: colour}, svg);
  return svg;
}

function redrawPlots() {
  for (const button of document.querySelectorAll(".legend button")) button.setAttribute("aria-pressed", String(!hidden.has(button.dataset.label)));
  for (const plot of plots) plot.redraw();
}

function heatPlots(label) {
  for (const plot of plots) for (const one of plot.all) one.heat(label);
}

function buildLegend(legend) {
  data.labels.forEach((label, index) => {
    const button = element("button", {type: "button", "data-label": label}, swatch(index), label);
    button.addEventListener("click", () => { hidden.delete(label) || hidden.add(label); redrawPlots(); });
    for (const on of ["pointerenter", "focus"]) button.addEventListener(on, () => heatPlots(label));
    for (const off of ["pointerleave", "blur"]) button.addEventListener(off, () => heatPlots(null));
    legend.append(button);
  });
}

function legendControls() {
  document.querySelector("#show-all").addEventListener("click", () => { hidden.clear(); redrawPlots(); });
  document.querySelector("#show-none").addEventListener("click", () => { data.labels.forEach(label => hidden.add(label)); redrawPlots(); });
  const search = document.querySelector("#legend-search");
  search.hidden = data.labels.length <= 12;
  search.querySelector("input").addEventListener("input", event => {
    const word = event.target.value.toLowerCase();
    hidden.clear();
    for (const label of data.labels) if (!label.toLowerCase().includes(word)) hidden.add(label);
    redrawPlots();
  });
}

if (legends.length) {
  legends.forEach(buildLegend);
  legendControls();
}
