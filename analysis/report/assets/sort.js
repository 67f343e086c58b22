// Tables sort by their headings' buttons: up, down, and back to the order of the sweep.
function sortTable(table, column, direction) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const numeric = table.tHead.rows[0].cells[column].dataset.kind === "number";
  const key = row => row.cells[column].dataset.value;
  const compare = (a, b) => {
    if (direction === "none") return a.dataset.order - b.dataset.order;
    const [x, y] = [key(a), key(b)];
    if (x === "" || y === "") return (x === "") - (y === "");  // what is not known stands last, either way
    const sign = direction === "ascending" ? 1 : -1;
    return sign * (numeric ? Number(x) - Number(y) : x.localeCompare(y, undefined, {numeric: true}))
      || a.dataset.order - b.dataset.order;
  };
  body.append(...rows.sort(compare));
}

for (const table of document.querySelectorAll("table.sortable")) {
  [...table.tBodies[0].rows].forEach((row, i) => row.dataset.order = i);
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
    const next = {ascending: "descending", descending: "none"}[head.getAttribute("aria-sort")] ?? "ascending";
    heads.forEach(other => other.removeAttribute("aria-sort"));
    if (next !== "none") head.setAttribute("aria-sort", next);
    sortTable(table, column, next);
    live.textContent = next === "none" ? "in the order of the sweep" : `sorted by ${head.textContent.trim()}, ${next}`;
  }));
}

// Rows by a word in them.
for (const input of document.querySelectorAll("input[data-filters]")) {
  const table = document.getElementById(input.dataset.filters);
  input.addEventListener("input", () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of table.tBodies[0].rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every(word => text.includes(word));
    }
  });
}
