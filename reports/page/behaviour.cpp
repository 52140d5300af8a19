#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_page() {
  return R"js(
const axes = ["xaxis", "yaxis", "xaxis2", "yaxis2"];

// A layout with the ranges that are seen.
function seenBy(plot, shape) {
  const now = plot._fullLayout ?? {}, own = {...shape};
  for (const name of axes)
    if (now[name] && shape[name] && now[name].type === (shape[name].type ?? "linear")) own[name] = {...shape[name], range: [...now[name].range]};
  return own;
}

// Grow or shrink by a factor, move by shares of the view.
function change(plot, zoom, shift) {
  const next = {};
  for (const name of axes) {
    const one = plot._fullLayout[name];
    if (!one) continue;
    const [from, to] = one.range, size = to - from, move = size * shift[name[0] === "x" ? 0 : 1], grow = 0.5 * size * (zoom - 1);
    next[name + ".range"] = [from + move - grow, to + move + grow];
  }
  plot.moved = true;
  return Plotly.relayout(plot, next);
}

function showAll(plot) {
  const next = {};
  for (const name of axes) if (plot._fullLayout[name]) next[name + ".autorange"] = true;
  plot.moved = true;
  return Plotly.relayout(plot, next);
}

function firstView(plot) {
  plot.moved = false;
  drawOne(plot);
}

// + and - zoom, arrows move, a shows all, 0 the first view: for those who use no pointer.
function keys(event) {
  const plot = event.currentTarget;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const shift = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowDown: [0, -0.1], ArrowUp: [0, 0.1]}[event.key];
  const zoom = {"+": 0.8, "=": 0.8, "-": 1.25}[event.key];
  if (event.key === "0") firstView(plot);
  else if (event.key === "a") showAll(plot);
  else if (shift || zoom) change(plot, zoom ?? 1, shift ?? [0, 0]);
  else return;
  event.preventDefault();
}

// Anew, the view as its reader left it.
function drawOne(plot) {
  const [traces, fresh] = draw[plot.dataset.figure](dataOf(plot), plot);
  const shape = plot.moved ? seenBy(plot, fresh) : fresh;
  Plotly.react(plot, traces, {...shape, width: plot.clientWidth, height: plot.clientHeight}, {displayModeBar: false, scrollZoom: false, doubleClick: false});
  plot.onkeydown = keys;
  if (plot.heard) return;
  plot.heard = true;
  plot.on("plotly_relayout", (what) => {
    if (Object.keys(what).some((key) => key.includes("axis"))) plot.moved = true;
    plot.refresh?.();
  });
  plot.on("plotly_doubleclick", () => firstView(plot));
}

function drawAll() {
  const plots = [...document.querySelectorAll(".plot")];
  let drawn = 0;
  for (const plot of plots) {
    try {
      drawOne(plot);
      drawn += 1;
    } catch (error) {
      failed(error);
      plot.textContent = "This figure could not be drawn: " + error;
    }
  }
  document.getElementById("js-plotly-tester")?.setAttribute("aria-hidden", "true");  // where Plotly measures words
  root.dataset.figures = drawn + "/" + plots.length;
}

// On paper everything is open and light; afterwards as it was.
const opened = [];
function toPaper() {
  document.querySelectorAll("details:not([open])").forEach((one) => { one.open = true; opened.push(one); });
  root.classList.add("print");
  drawAll();
}
function toScreen() {
  opened.splice(0).forEach((one) => { one.open = false; });
  root.classList.remove("print");
  drawAll();
}
window.addEventListener("beforeprint", toPaper);
window.addEventListener("afterprint", toScreen);
window.matchMedia("print").addEventListener("change", (event) => (event.matches ? toPaper : toScreen)());
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);
let width = window.innerWidth, waiting = 0;
window.addEventListener("resize", () => {
  if (window.innerWidth === width) return;  // a phone's address bar comes and goes
  width = window.innerWidth;
  clearTimeout(waiting);
  waiting = setTimeout(drawAll, 100);
});
// What is not shown has no width: a figure in closed details is drawn when they open.
document.addEventListener("toggle", (event) => {
  if (event.target.open && event.target.querySelector?.(".plot")) drawAll();
}, true);

drawAll();
try {
  addSaving();
} catch (error) {
  failed(error);
}
root.dataset.ready = "yes";
)js";
}

}  // namespace limcycle
