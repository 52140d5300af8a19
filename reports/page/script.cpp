#include "limcycle/reports/page/page.hpp"

namespace limcycle {

std::string_view page_script() {
  return R"js(
"use strict";
const root = document.documentElement;
root.dataset.errors = "0";
window.addEventListener("error", (event) => {
  root.dataset.errors = String(Number(root.dataset.errors) + 1);
  root.dataset.error = String(event.message);
});

const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
const line = (name, width = 2, dash = "solid") => ({color: colour(name), width, dash});
const twice = (run, key) => run[key].concat(run[key]);

function axis(title, more = {}) {
  return {title: {text: title, standoff: 6}, gridcolor: colour("line"), zerolinecolor: colour("three"), automargin: true,
          exponentformat: "power", showexponent: "all", ...more};
}

function layout(more) {
  return {paper_bgcolor: colour("paper"), plot_bgcolor: colour("paper"), font: {color: colour("ink"), size: 13},
          margin: {l: 56, r: 14, t: 34, b: 48}, hovermode: "closest", dragmode: "pan",
          legend: {orientation: "h", yanchor: "bottom", y: 0, yref: "container", x: 0}, ...more};
}

// The parts of a curve that are (or are not) stuck; a gap lifts the pen.
function only(run, key, stuck) {
  return run[key].map((value, i) => (run.stuck[i] === 1) === stuck || (stuck ? false : run.stuck[i - 1] !== run.stuck[i]
    || run.stuck[i + 1] === 0) ? value : null);
}

// The range of an axis that keeps the cycles readable when a simulation comes from afar: at most three times their size.
function focus(d, key) {
  const ends = (runs) => {
    const values = runs.flatMap((run) => run[key]).filter((value) => value !== null);
    return [Math.min(...values), Math.max(...values)];
  };
  if (d.cycles.length === 0) return {};
  const [low, high] = ends(d.cycles), [least, most] = ends(d.cycles.concat(d.runs)), size = high - low;
  const from = Math.max(least, low - size), to = Math.min(most, high + size), margin = 0.05 * (to - from);
  return to > from ? {range: [from - margin, to + margin]} : {};
}

const draw = {
  nyquist(d) {
    const hover = "%{customdata[0]}<extra></extra>";
    const label = (A, w) => [(A === null ? "" : "A = " + A + ", ") + (w === null ? "" : "ω = " + w + " rad/s")];
    const traces = [
      {name: "−1/N(A,ω)", x: d.family.re, y: d.family.im, mode: "lines", line: line("two", 1.2), hovertemplate: hover,
       customdata: d.family.A.map((A, i) => label(A, d.family.w[i]))},
      {name: "G(jω)", x: d.G.re, y: d.G.im, mode: "lines", line: line("one", 2.5), hovertemplate: hover,
       customdata: d.G.w.map((w) => label(null, w))},
    ];
    const circle = (c) => [...Array(73).keys()].map((i) => i * Math.PI / 36).map((t) =>
      [c.re + c.r * Math.cos(t), c.im + c.r * Math.sin(t)]).concat([[null, null]]);
    for (const [kind, name, dash] of [["rigorous", "error discs (Mees–Bergen, rigorous)", "solid"],
      ["heuristic", "error discs (heuristic)", "dash"]]) {
      const own = d.discs.filter((c) => c.kind === kind), points = own.flatMap(circle);
      if (own.length === 0) continue;
      traces.push({name, x: points.map((p) => p[0]), y: points.map((p) => p[1]), mode: "lines",
        line: line("three", 1.2, dash), hovertemplate: hover,
        customdata: own.flatMap((c) => circle(c).map(() => ["error disc (" + kind + ") of " + label(null, c.w)[0]]))});
    }
    if (d.roots.length > 0) {
      traces.push({name: "1 + N G = 0", x: d.roots.map((r) => r.re), y: d.roots.map((r) => r.im), mode: "markers",
        marker: {color: colour("ink"), size: 11, symbol: "x"}, hovertemplate: hover,
        customdata: d.roots.map((r) => [label(r.A, r.w)[0] + ": " + r.verdict])});
    }
    return [traces, layout({xaxis: axis("real part", {range: d.window.re}),
      yaxis: axis("imaginary part", {range: d.window.im, scaleanchor: "x"})})];
  },

  time(d) {
    const run = d.run, last = run.t[run.t.length - 1], begin = run.t[0];
    const t = run.t.map((value) => value - begin);
    const x = d.repeat ? t.concat(t.map((value) => value + last - begin)) : t;
    const column = (key) => d.repeat ? twice(run, key) : run[key];
    const traces = [{name: d.labels.y, x, y: column("y"), mode: "lines", line: line("one")}];
    const shape = {xaxis: axis("time (s)", {anchor: run.output ? "y2" : "y"}),
      yaxis: axis(d.labels.y, {domain: run.output ? [0.54, 1] : [0, 1]}), showlegend: false};
    if (run.output) {
      traces.push({name: d.labels.output, x, y: column("output"), mode: "lines", line: line("two"), yaxis: "y2"});
      shape.yaxis2 = axis(d.labels.output, {domain: [0, 0.46]});
    }
    return [traces, layout(shape)];
  },

  phase(d) {
    const traces = [];
    d.runs.forEach((run, i) => {
      traces.push({name: run.name, x: run.y, y: run.rate, mode: "lines", line: line("three", 1), legendgroup: "run" + i});
      traces.push({name: "start", x: [run.y[0]], y: [run.rate[0]], mode: "markers", showlegend: false,
        legendgroup: "run" + i, marker: {color: colour("three"), size: 8}});
    });
    d.cycles.forEach((run) => {
      traces.push({name: run.name, x: run.y, y: run.rate, mode: "lines",
        line: line("one", 2.5, run.stable ? "solid" : "dash")});
      if (run.stuck.includes(1)) {
        traces.push({name: "sticking", x: only(run, "y", true), y: only(run, "rate", true), mode: "lines+markers",
          line: line("two", 6), marker: {color: colour("two"), size: 6}});
      }
    });
    return [traces, layout({xaxis: axis(d.labels.y, focus(d, "y")), yaxis: axis(d.labels.rate, focus(d, "rate"))})];
  },

  loop(d) {
    const run = d.run, common = {mode: "lines", showlegend: false};
    const traces = [
      {...common, name: d.labels.output, x: run.input, y: run.output, line: line("one")},
      {...common, name: d.labels.output, x: run.velocity, y: run.output, line: line("one"), xaxis: "x2", yaxis: "y2"},
    ];
    const narrow = window.innerWidth < 640;
    return [traces, layout({
      xaxis: axis(d.labels.input, {domain: narrow ? [0, 1] : [0, 0.47], anchor: "y"}),
      yaxis: axis(d.labels.output, {domain: narrow ? [0.58, 1] : [0, 1], anchor: "x"}),
      xaxis2: axis(d.labels.velocity, {domain: narrow ? [0, 1] : [0.53, 1], anchor: "y2"}),
      yaxis2: axis("", {domain: narrow ? [0, 0.42] : [0, 1], anchor: "x2", matches: "y"}),
    })];
  },

  multipliers(d) {
    const angle = [...Array(145).keys()].map((i) => i * Math.PI / 72);
    const traces = [{name: "unit circle", x: angle.map(Math.cos), y: angle.map(Math.sin), mode: "lines", hoverinfo: "skip",
      line: line("three", 1.5)}];
    d.cycles.forEach((one, i) => traces.push({name: one.name, x: one.re, y: one.im, mode: "markers",
      marker: {color: colour(i % 2 === 0 ? "one" : "two"), size: 10, symbol: i}}));
    return [traces, layout({xaxis: axis("real part"), yaxis: axis("imaginary part", {scaleanchor: "x"})})];
  },
};

const palette = ["#2f81c7", "#d9661f", "#2e9e5b", "#a05bc4", "#c4a000", "#d1477a", "#3aa6a6", "#8a6d3b", "#7a8a99", "#5b6ee1"];

// Marks of methods over two logarithmic axes: circles where they are right, crosses where they fail.
function work(d) {
  const shades = [];
  const traces = d.series.map((one) => {
    const follows = one.colour >= 0;
    shades.push(follows ? shades[one.colour] : palette[d.series.slice(0, shades.length).filter((s) => s.colour < 0).length % palette.length]);
    const shade = shades[shades.length - 1];
    return {name: one.name, x: one.x, y: one.y, mode: one.joined ? "lines+markers" : "markers",
      line: {color: shade, width: 1.6, dash: ["solid", "dash", "dot"][one.dash]}, showlegend: !follows,
      marker: {color: shade, size: one.good.map((good) => good ? 7 : 10), symbol: one.good.map((good) => good ? "circle" : "x")},
      customdata: one.label, hovertemplate: "%{customdata}<extra></extra>"};
  });
  return [traces, layout({xaxis: axis(d.x, {type: "log", dtick: 1}), yaxis: axis(d.y, {type: "log"}),
    margin: {l: 64, r: 14, t: 34, b: window.innerWidth < 640 ? 150 : 96}})];
}
for (const id of ["work-cycle", "work-df", "work-stiffness", "work-ladder"]) draw[id] = work;

// + and - zoom, arrows move, a shows all, 0 the first view: for those who use no pointer.
function keys(event) {
  const plot = event.currentTarget, change = {};
  const shift = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowDown: [0, -0.1], ArrowUp: [0, 0.1]}[event.key];
  const zoom = {"+": 0.8, "=": 0.8, "-": 1.25}[event.key];
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "0") { event.preventDefault(); drawOne(plot); return; }
  if (event.key === "a") { event.preventDefault(); Plotly.relayout(plot, {"xaxis.autorange": true, "yaxis.autorange": true}); return; }
  if (!shift && !zoom) return;
  event.preventDefault();
  for (const name of ["xaxis", "yaxis", "xaxis2", "yaxis2"]) {
    const one = plot._fullLayout[name];
    if (!one) continue;
    const [from, to] = one.range, size = to - from, move = size * (shift ? shift[name[0] === "x" ? 0 : 1] : 0);
    const grow = zoom ? 0.5 * size * (zoom - 1) : 0;
    change[name + ".range"] = [from + move - grow, to + move + grow];
  }
  Plotly.relayout(plot, change);
}

function drawOne(plot) {
  const data = JSON.parse(document.getElementById("data-" + plot.dataset.figure).textContent);
  const [traces, shape] = draw[plot.dataset.figure](data);
  Plotly.react(plot, traces, shape, {responsive: true, displaylogo: false, scrollZoom: false,
    modeBarButtons: [["toImage", "zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "autoScale2d", "resetScale2d"]]});
  plot.onkeydown = keys;
}

function drawAll() {
  const plots = [...document.querySelectorAll(".plot")];
  let drawn = 0;
  for (const plot of plots) {
    try {
      drawOne(plot);
      drawn += 1;
    } catch (error) {
      root.dataset.errors = String(Number(root.dataset.errors) + 1);
      root.dataset.error = String(error);
      plot.textContent = "This figure could not be drawn: " + error;
    }
  }
  root.dataset.figures = drawn + "/" + plots.length;
}

window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);
window.addEventListener("beforeprint", () => {
  document.querySelectorAll("details").forEach((one) => { one.open = true; });
  root.classList.add("print");
  drawAll();
});
window.addEventListener("afterprint", () => { root.classList.remove("print"); drawAll(); });
drawAll();
)js";
}

}  // namespace limcycle
