#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_tables() {
  return R"js(
const motion = ["t", "y", "rate", "input", "velocity", "output", "stuck"];
const motionHead = (d) => motion.map((key) => key === "t" ? "time (s)" : d.labels[key] ?? key);
const motionRows = (name, run) => run.t.map((_, i) => [name, ...motion.map((key) => run[key]?.[i] ?? null)]);
const motionTable = (d, named) => [["curve", ...motionHead(d)], ...named.flatMap(([name, run]) => motionRows(name, run))];

Object.assign(rows, {
  nyquist(d) {
    const out = [["curve", "amplitude" + (d.family.unit ? " (" + d.family.unit + ")" : ""), "frequency (rad/s)", "real part", "imaginary part", "radius"]];
    d.G.w.forEach((w, i) => out.push(["G", null, w, d.G.re[i], d.G.im[i], null]));
    for (const one of d.family.members)
      d.family.A.forEach((A, i) => { if (i < one.re.length) out.push(["-1/N", A, one.w, one.re[i], one.im[i], null]); });
    for (const one of d.roots) out.push(["1 + N G = 0: " + one.verdict, one.A, one.w, one.re, one.im, null]);
    for (const one of d.discs) out.push(["error disc (" + one.kind + ")", null, one.w, one.re, one.im, one.r]);
    return out;
  },
  time: (d) => motionTable(d, [[d.name, d.run]]),
  loop: (d) => motionTable(d, [[d.name, d.run]]),
  phase: (d) => motionTable(d, d.cycles.concat(d.runs).map((run) => [run.name, run])),
  multipliers: (d) => [["cycle", "real part", "imaginary part"],
    ...d.cycles.flatMap((one) => one.re.map((re, i) => [one.name, re, one.im[i]]))],
  harmonics: (d) => [["curve", "order", d.label ?? "amplitude"],
    ...d.curves.flatMap((one) => d.order.map((order, i) => [one.name, order, one.amplitude[i]]))],
});
const workRows = (d) => [["curve", d.x, d.y, "right", "description"],
  ...d.series.flatMap((one) => one.x.map((x, i) => [one.name, x, one.y[i], one.good[i], one.label[i]]))];

// RFC 4180; what does not exist is empty.
function csv(table) {
  const cell = (value) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? '"' + text.replaceAll('"', '""') + '"' : text;
  };
  return table.map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

const rowsOfFigure = (id, d) => (id.startsWith("work-") ? workRows : rows[id])(d);
const rowsOfTable = (table) => [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.trim()));
)js";
}

}  // namespace limcycle
