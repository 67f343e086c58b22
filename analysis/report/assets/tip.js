// One line of text beside the pointer or the focused thing, also said to screen readers.
const tip = document.querySelector(".tip");
const live = document.querySelector("#live");

function showTip(text, x, y, isSaid = false) {
  tip.textContent = text;
  const box = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 4)) + "px";
  tip.style.top = Math.max(4, y + 16 + box.height > innerHeight ? y - box.height - 10 : y + 16) + "px";
  if (isSaid) live.textContent = text;
}

function hideTip() { tip.textContent = ""; }

// Everything with data-tip shows it, by pointer and by focus.
document.addEventListener("pointerover", event => {
  const owner = event.target.closest?.("[data-tip]");
  if (owner) showTip(owner.dataset.tip, event.clientX, event.clientY);
});
document.addEventListener("pointerout", event => { if (event.target.closest?.("[data-tip]")) hideTip(); });
document.addEventListener("focusin", event => {
  const owner = event.target.closest?.("[data-tip]");
  if (!owner || !owner.matches(":focus-visible")) return;
  const box = owner.getBoundingClientRect();
  showTip(owner.dataset.tip, box.left, box.bottom - 8);
});
document.addEventListener("focusout", hideTip);
document.addEventListener("keydown", event => { if (event.key === "Escape") hideTip(); });

const data = JSON.parse(document.querySelector("#data").textContent);

// Three digits, as the tables have them.
function short(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  const rounded = Number(value.toPrecision(3)), size = Math.abs(rounded);
  const text = size !== 0 && (size < 1e-4 || size >= 1e6) ? rounded.toExponential() : String(rounded);
  return text.replace("-", "−");
}

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}
