#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_nyquist() {
  return R"js(
const times = (a, b) => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
const minusInverse = (z) => { const size = z[0] * z[0] + z[1] * z[1]; return [-z[0] / size, z[1] / size]; };
const size = (z) => Math.hypot(z[0], z[1]);
const isNumber = (z) => Number.isFinite(z[0]) && Number.isFinite(z[1]);
const point = (curve, i) => curve.re[i] === null || curve.im[i] === null || curve.re[i] === undefined ? [NaN, NaN] : [curve.re[i], curve.im[i]];
// What is a billionth of the other part is rounding.
const clean = (z) => z.map((one, i) => Math.abs(one) < 1e-9 * Math.abs(z[1 - i]) ? 0 : one);
const inWords = (z) => isNumber(z) ? digits(clean(z)[0]) + (z[1] < 0 ? " − " : " + ") + digits(Math.abs(clean(z)[1])) + "j" : "–";
const withUnit = (value, unit) => digits(value) + (unit ? " " + unit : "");

// −1/N at a computed amplitude. Between two computed frequencies N is interpolated, linearly in ω; never beyond them.
function inverseAt(d, a, w) {
  const members = d.family.members;
  if (members[0].w === null) return {z: point(members[0], a), between: null};
  const same = members.find((one) => Math.abs(one.w - w) <= 1e-6 * w);
  if (same) return {z: point(same, a), between: null};
  const above = members.findIndex((one) => one.w > w);
  if (above < 1) return {z: [NaN, NaN], between: null};
  const low = members[above - 1], high = members[above], share = (w - low.w) / (high.w - low.w);
  const [N0, N1] = [low, high].map((one) => minusInverse(point(one, a)));
  return {z: minusInverse([N0[0] + share * (N1[0] - N0[0]), N0[1] + share * (N1[1] - N0[1])]), between: [low.w, high.w]};
}

// What the sliders point at: w counts the samples of G, a the amplitudes.
function lookUp(d, {w, a}) {
  const frequency = d.G.w[w], G = point(d.G, w), {z, between} = inverseAt(d, a, frequency);
  const NG = times(minusInverse(z), G);
  return {frequency, amplitude: d.family.A[a], G, z, between, distance: isNumber(NG) ? [1 + NG[0], NG[1]] : [NaN, NaN]};
}

const nearest = (list, value) => list.reduce((best, one, i) => Math.abs(Math.log(one / value)) < Math.abs(Math.log(list[best] / value)) ? i : best, 0);

// Where the sliders stand at first: at the first prediction, else where 1 + N G is least among what was computed.
function firstChoice(d) {
  if (d.roots.length > 0) return {w: nearest(d.G.w, d.roots[0].w), a: nearest(d.family.A, d.roots[0].A)};
  let best = {w: 0, a: 0}, least = Infinity;
  d.G.w.forEach((_, w) => d.family.A.forEach((_, a) => {
    const off = size(lookUp(d, {w, a}).distance);
    if (off < least) [least, best] = [off, {w, a}];
  }));
  return best;
}

// Places in the complex plane, or phase in degrees (−360 to 0) and size, where a curve is cut where its phase wraps.
function places(points, polar) {
  if (!polar) return {x: points.map((z) => z[0]), y: points.map((z) => z[1])};
  const x = [], y = [];
  let before = null;
  for (const z of points) {
    const exists = isNumber(z) && size(z) > 0;
    const angle = exists ? Math.atan2(z[1], z[0]) * 180 / Math.PI : null, phase = angle > 0 ? angle - 360 : angle;
    const cut = exists && before !== null && Math.abs(phase - before) > 180;
    x.push(cut ? null : phase);
    y.push(cut ? null : exists ? size(z) : null);
    before = phase;
  }
  return {x, y};
}

const pointsOf = (curve) => curve.re.map((_, i) => point(curve, i));
const frequencyWords = (w) => "ω = " + digits(w) + " rad/s";
const amplitudeWords = (d, A) => "A = " + withUnit(A, d.family.unit);

function marks(d, choice) {
  const at = lookUp(d, choice), [G, z] = [at.G, at.z].map((one) => places([one], choice.polar));
  return {x: [G.x[0], z.x[0]], y: [G.y[0], z.y[0]]};
}

Object.assign(draw, {
  nyquist(d, plot) {
    const choice = plot.choice ??= firstChoice(d), hover = "%{customdata}<extra></extra>";
    const put = (points) => places(points, choice.polar);
    const drawn = d.family.members.filter((one) => one.drawn), points = [], words = [];
    for (const one of drawn) {
      pointsOf(one).forEach((z, i) => {
        points.push(z);
        words.push(amplitudeWords(d, d.family.A[i]) + (one.w === null ? "" : ", " + frequencyWords(one.w)));
      });
      points.push([NaN, NaN]);  // lifts the pen
      words.push("");
    }
    const traces = [
      {name: "−1/N(A,ω)", ...put(points), mode: "lines", line: line("two", 1.2), hovertemplate: hover, customdata: words},
      {name: "G(jω)", ...put(pointsOf(d.G)), mode: "lines", line: line("one", 2.5), hovertemplate: hover,
       customdata: d.G.w.map(frequencyWords)},
    ];
    const circle = (c) => [...Array(73).keys()].map((i) => i * Math.PI / 36).map((t) =>
      [c.re + c.r * Math.cos(t), c.im + c.r * Math.sin(t)]).concat([[NaN, NaN]]);
    for (const [kind, name, dash] of [["rigorous", "error discs (Mees–Bergen, rigorous)", "solid"],
      ["heuristic", "error discs (heuristic)", "dash"]]) {
      const own = d.discs.filter((c) => c.kind === kind);
      if (own.length === 0) continue;
      traces.push({name, ...put(own.flatMap(circle)), mode: "lines", line: line("three", 1.2, dash), hovertemplate: hover,
        customdata: own.flatMap((c) => circle(c).map(() => "error disc (" + kind + ") of " + frequencyWords(c.w)))});
    }
    plot.marked = traces.length;  // the crosses stay on top
    traces.push({name: "at the sliders", ...marks(d, choice), mode: "lines+markers", line: line("ink", 1, "dot"),
      marker: {color: [colour("one"), colour("two")], size: 13, symbol: ["circle", "square"], line: {color: colour("ink"), width: 2}},
      hovertemplate: "%{text}<extra></extra>", text: ["G at the sliders", "−1/N at the sliders"]});
    if (d.roots.length > 0) {
      traces.push({name: "1 + N G = 0", ...put(d.roots.map((r) => [r.re, r.im])), mode: "markers",
        marker: {color: colour("ink"), size: 11, symbol: "x"}, hovertemplate: hover,
        customdata: d.roots.map((r) => amplitudeWords(d, r.A) + ", " + frequencyWords(r.w) + ": " + r.verdict)});
    }
    return [traces, layout(choice.polar
      ? {xaxis: axis("phase (degrees)", {range: [-370, 10], dtick: isNarrow() ? 90 : 45}), yaxis: axis("size", {type: "log", dtick: 1})}
      : {xaxis: axis("real part", {range: d.window.re}), yaxis: axis("imaginary part", {range: d.window.im, scaleanchor: "x"})})];
  },
});

function isInView(plot, x, y) {
  const inside = (one, value) => {
    const [from, to] = plot._fullLayout[one].range, at = plot._fullLayout[one].type === "log" ? Math.log10(value) : value;
    return from <= at && at <= to;
  };
  return x === null || !Number.isFinite(x) || (inside("xaxis", x) && inside("yaxis", y));
}

function sayChoice(d, plot) {
  const at = lookUp(d, plot.choice), seen = marks(d, plot.choice);
  const hidden = ["G", "−1/N"].filter((_, i) => !isInView(plot, seen.x[i], seen.y[i]));
  const off = size(at.distance), rounded = at.distance.map((part) => Math.abs(part) < 1e-6 ? 0 : part);  // of seven digits
  const worth = !Number.isFinite(off) ? "" : off < 1e-3 ? " (a predicted oscillation)" : "";
  let more = "";
  if (at.between) more += " N is interpolated between what was computed at ω = " + digits(at.between[0]) + " and " + digits(at.between[1]) + " rad/s.";
  if (d.small_motions) more += " G is that of small motions.";
  if (hidden.length > 0) more += " " + hidden.join(" and ") + (hidden.length > 1 ? " lie" : " lies") + " outside the view.";
  return {at, text: frequencyWords(at.frequency) + ", " + amplitudeWords(d, at.amplitude) + ": G = " + inWords(at.G) + ", −1/N = " + inWords(at.z)
    + ", 1 + N G = " + inWords(rounded) + ", of size " + (off < 1e-6 ? "less than 1e-6" : digits(off)) + worth + "." + more};
}

// Sliders for ω and A, a readout, and buttons; what changes is announced when it has settled.
function nyquistControls(plot) {
  const d = dataOf(plot);
  if (d.G.w.length === 0 || d.family.A.length === 0 || d.family.members.length === 0) return null;
  const readout = element("p", {className: "readout", id: "readout-nyquist"});
  const spoken = element("output", {className: "unseen"});
  spoken.setAttribute("aria-live", "polite");
  let waiting = 0;
  const slider = (key, name, list, words) => {
    const input = element("input", {type: "range", min: 0, max: list.length - 1, step: 1, id: "nyquist-" + key});
    input.oninput = () => { plot.choice[key] = Number(input.value); show(); };
    return {key, input, row: element("p", {className: "slider"}, element("label", {htmlFor: input.id, textContent: name}), input), words: (i) => words(list[i])};
  };
  const sliders = [slider("w", "frequency ω", d.G.w, (w) => digits(w) + " rad/s"),
    slider("a", "amplitude A", d.family.A, (A) => withUnit(A, d.family.unit))];
  function show(move = true) {
    for (const one of sliders) {
      one.input.value = plot.choice[one.key];
      one.input.setAttribute("aria-valuetext", one.words(plot.choice[one.key]));
    }
    if (move) {
      const {x, y} = marks(d, plot.choice);
      Plotly.restyle(plot, {x: [x], y: [y]}, [plot.marked]);
    }
    const said = sayChoice(d, plot);
    readout.textContent = said.text;
    Object.assign(readout.dataset, {frequency: said.at.frequency, amplitude: said.at.amplitude, distance: size(said.at.distance)});
    clearTimeout(waiting);
    if (move) waiting = setTimeout(() => { spoken.textContent = said.text; }, 400);
  }
  const jump = (choice) => { Object.assign(plot.choice, choice); show(); };
  const buttons = d.roots.map((r, i) => element("button", {type: "button", textContent: "Prediction" + (d.roots.length > 1 ? " " + (r.prediction ?? i) : ""),
    onclick: () => jump({w: nearest(d.G.w, r.w), a: nearest(d.family.A, r.A)})}));
  if (d.roots.length === 0) buttons.push(element("button", {type: "button", textContent: "Closest approach", onclick: () => jump(firstChoice(d))}));
  const polar = element("button", {type: "button", textContent: "Gain and phase", onclick: () => {
    plot.choice.polar = !plot.choice.polar;
    polar.setAttribute("aria-pressed", String(plot.choice.polar));
    drawOne(plot);
    show(false);
  }});
  polar.setAttribute("aria-pressed", "false");
  plot.refresh = () => show(false);
  const group = element("fieldset", {className: "sliders"}, element("legend", {textContent: "Frequency and amplitude"}),
    ...sliders.map((one) => one.row), readout, spoken, element("div", {className: "tools"}, ...buttons, polar));
  show(false);
  return group;
}
)js";
}

}  // namespace limcycle
