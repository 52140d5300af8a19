#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_figures() {
  return R"js(
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

Object.assign(draw, {
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
      traces.push({name: "simulations", x: run.y, y: run.rate, mode: "lines", line: line("three", 1), legendgroup: "runs",
        showlegend: i === 0, hoverinfo: "text", text: run.name});
      traces.push({name: "starts", x: [run.y[0]], y: [run.rate[0]], mode: "markers", showlegend: false, hoverinfo: "text", text: run.name,
        legendgroup: "runs", marker: {color: colour("three"), size: 8}});
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
    const narrow = isNarrow();
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

  // Amplitudes that are 0 have no place on a logarithmic axis.
  harmonics(d) {
    const traces = d.curves.map((one, i) => ({name: one.name, type: "bar", x: d.order,
      y: one.amplitude.map((value) => value > 0 ? value : null),
      marker: {color: i === 0 ? colour("one") : i === 1 ? colour("two") : palette[(i + 1) % palette.length]},
      hovertemplate: "order %{x}: %{y:.4g}<extra></extra>"}));
    return [traces, layout({barmode: "group", showlegend: true, xaxis: axis("order of the harmonic", {dtick: d.order.length > 12 ? 2 : 1}),
      yaxis: axis(d.label ?? "amplitude", {type: "log"})})];
  },
});

// Each at least three times lighter or darker than white paper and than a dark screen.
const palette = ["#2f81c7", "#d9661f", "#278a4f", "#a05bc4", "#9c8000", "#d1477a", "#2a8f8f", "#8a6d3b", "#6f8090", "#5b6ee1"];

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
    margin: {l: 64, r: 14, t: 14, b: isNarrow() ? 150 : 96}})];
}
for (const id of ["work-cycle", "work-df", "work-stiffness", "work-ladder"]) draw[id] = work;
)js";
}

}  // namespace limcycle
