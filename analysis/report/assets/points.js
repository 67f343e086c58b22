// Pointing at plots and walking through their points.
Object.assign(Plot.prototype, {
  nearest(x, y) {
    let best = null, least = 40 ** 2;
    this.series.forEach((one, s) => one.points.forEach((p, i) => {
      const distance = (this.px(p.x) - x) ** 2 + (this.py(p.y) - y) ** 2;
      if (distance < least) [best, least] = [[s, i], distance];
    }));
    return best;
  },

  point(event) {
    const box = this.svg.getBoundingClientRect();
    const before = this.at && this.series[this.at[0]].label;
    this.mark(this.nearest(event.clientX - box.left, event.clientY - box.top));
    const label = this.at && this.series[this.at[0]].label;
    if (label !== before) heatPlots(label);  // the same method in all plots
    if (this.at) showTip(this.chosen().tip, event.clientX, event.clientY);
    else hideTip();
  },

  chosen() { return this.series[this.at[0]].points[this.at[1]]; },

  mark(at) {
    this.at = at;
    this.ring?.remove();
    if (!at) return;
    const p = this.chosen();
    this.ring = shape("circle", {class: "ring", r: 9, cx: this.px(p.x), cy: this.py(p.y)}, this.svg);
  },

  key(event) {
    const step = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0]}[event.key];
    if (!step || !this.series.length) return;
    event.preventDefault();
    let [s, i] = this.at ?? [0, -step[1] < 0 ? -1 : 0];
    s = (s + step[0] + this.series.length) % this.series.length;
    const last = this.series[s].points.length - 1;
    // Where a line is a single point, left and right go to the next one.
    if (last === 0 && step[1]) [s, i] = [(s + step[1] + this.series.length) % this.series.length, 0];
    else i = Math.max(0, Math.min(last, i + step[1]));
    this.mark([s, i]);
    const box = this.svg.getBoundingClientRect(), p = this.chosen();
    showTip(p.tip, box.left + this.px(p.x), box.top + this.py(p.y), true);
  },
});
