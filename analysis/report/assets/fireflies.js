// The list of the fireflies of A and B; pressing one shows its pixel.
function listFireflies(viewer) {
  const {gallery, chosen} = viewer;
  const holder = viewer.find("firefly-list");
  if (!holder.open) return;
  const body = holder.querySelector("tbody");
  body.replaceChildren(...[...new Set(chosen)].flatMap(index => gallery.pictures[index].fireflies.map(firefly => {
    const go = element("button", {type: "button"}, `${firefly.x}, ${firefly.y}`);
    go.addEventListener("click", () => {
      viewer.set({showsFireflies: true});
      const at = [(firefly.x + 0.5) / gallery.factor, (firefly.y + 0.5) / gallery.factor];
      viewer.zoom = Math.max(viewer.zoom, 8);
      viewer.moveTo(at);
      viewer.setPixel(at);
    });
    const fields = [firefly.frame, firefly.multiple, firefly.radiance].map(value =>
      element("td", {"data-tip": String(value)}, typeof value === "number" ? short(value) : String(value)));
    return element("tr", {}, element("th", {scope: "row", class: "text"}, gallery.pictures[index].name), element("td", {}, go), ...fields);
  })));
}
