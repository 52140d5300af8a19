#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_base() {
  return R"js(
const root = document.documentElement;
root.dataset.errors = "0";
function failed(error) {
  root.dataset.errors = String(Number(root.dataset.errors) + 1);
  root.dataset.error = String(error);
}
window.addEventListener("error", (event) => failed(event.message));
window.addEventListener("unhandledrejection", (event) => failed(event.reason));

const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
const line = (name, width = 2, dash = "solid") => ({color: colour(name), width, dash});
const twice = (run, key) => run[key].concat(run[key]);
const isNarrow = () => window.innerWidth < 640;

// Four digits, as they are read.
function digits(value, count = 4) {
  if (value === null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e7) ? value.toExponential(count - 1) : Number(value.toPrecision(count)).toString();
  return text.replace("-", "−").replace("e−", "e-").replace("e+", "e");
}

function axis(title, more = {}) {
  return {title: {text: title, standoff: 6}, gridcolor: colour("line"), zerolinecolor: colour("three"), automargin: true,
          exponentformat: "power", showexponent: "all", nticks: isNarrow() ? 5 : 0, ...more};
}

// A touch screen scrolls the page where its finger passes over a figure: there the buttons move and zoom.
function layout(more) {
  const touched = window.matchMedia("(pointer: coarse)").matches;
  return {paper_bgcolor: colour("paper"), plot_bgcolor: colour("paper"),
          font: {color: colour("ink"), size: isNarrow() ? 12 : 13, family: 'system-ui, "DejaVu Sans", sans-serif'},
          margin: {l: isNarrow() ? 44 : 60, r: 14, t: 14, b: 48}, hovermode: "closest", dragmode: touched ? false : "pan",
          hoverlabel: {bgcolor: colour("box"), bordercolor: colour("three"), font: {color: colour("ink")}},
          legend: {orientation: "h", yanchor: "bottom", y: 0, yref: "container", x: 0}, ...more};
}

const draw = {};   // kind of figure -> from its data to [curves, layout]
const rows = {};   // kind of figure -> from its data to rows of cells, headings first

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}
const dataOf = (plot) => plot.held ??= JSON.parse(document.getElementById("data-" + plot.dataset.figure).textContent);
)js";
}

}  // namespace limcycle
