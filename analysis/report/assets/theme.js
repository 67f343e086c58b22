// Light, dark, or what the system has; kept where the browser keeps things for pages from disk.
const themes = ["auto", "light", "dark"];
const themeButton = document.querySelector("#theme");

function setTheme(theme) {
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  themeButton.textContent = `Theme: ${theme}`;
  try { localStorage.setItem("qtrace-report-theme", theme); } catch { /* not kept, then */ }
}

function storedTheme() {
  try { return localStorage.getItem("qtrace-report-theme"); } catch { return null; }
}

let theme = themes.includes(storedTheme()) ? storedTheme() : "auto";
setTheme(theme);
themeButton.addEventListener("click", () => {
  theme = themes[(themes.indexOf(theme) + 1) % themes.length];
  setTheme(theme);
});

// Which section is being read.
const links = new Map([...document.querySelectorAll("nav a")].map(link => [link.hash.slice(1), link]));
const inView = new Set();
const sections = new IntersectionObserver(entries => {
  for (const {target, isIntersecting} of entries) isIntersecting ? inView.add(target.id) : inView.delete(target.id);
  const current = [...links.keys()].find(id => inView.has(id));
  for (const [id, link] of links) {
    if (id === current) link.setAttribute("aria-current", "true");
    else link.removeAttribute("aria-current");
  }
}, {rootMargin: "-60px 0px -50% 0px"});
for (const section of document.querySelectorAll("main > section")) sections.observe(section);
