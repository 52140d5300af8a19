#include "limcycle/reports/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/drawing/decimate.hpp"
#include "limcycle/reports/figures/multipliers.hpp"
#include "limcycle/reports/figures/nyquist_figure.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

constexpr std::size_t points_of_cycle = 1000;
constexpr std::size_t points_of_run = 1500;

Json picked(const std::vector<double>& values, const std::vector<std::size_t>& index) {
  Json out = Json::array();
  for (const std::size_t i : index) out.push_back(i < values.size() ? rounded(values[i]) : Json(nullptr));
  return out;
}

struct LeastAndGreatest {
  double least = INFINITY, greatest = -INFINITY;
};

LeastAndGreatest extent(const std::vector<double>& values) {
  LeastAndGreatest out;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    out.least = std::min(out.least, value);
    out.greatest = std::max(out.greatest, value);
  }
  return out;
}

std::string between(const std::vector<double>& values, const std::string& unit) {
  const LeastAndGreatest range = extent(values);
  return fmt::format("between {} and {}", with_digits(range.least, 3),
                     Units::attach(with_digits(range.greatest, 3), unit));
}

/// Motion drawn in the time domain: a cycle if there is one (a stable one first), else the first run that can be drawn.
struct Shown {
  const Trace* trace = nullptr;
  const Cycle* cycle = nullptr;
  std::string name;
};

Shown shown(const PredictReport& report, const Units& units) {
  for (const bool stable : {true, false})
    for (std::size_t i = 0; i < report.cycles.size(); ++i) {
      const auto& cycle = report.cycles[i];
      if (drawable(cycle.trace) && cycle.stable.value_or(false) == stable)
        return {&cycle.trace, &cycle, fmt::format("limit cycle {}", i)};
    }
  for (const auto& outcome : report.outcomes)
    if (drawable(outcome.trace))
      return {&outcome.trace, nullptr, "simulation from " + start_in_words(outcome.start, units)};
  return {};
}

Json labels(const Trace& trace, const Units& units) {
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{} ({})", name, unit);
  };
  const auto per_second = [](const std::string& unit) { return unit.empty() ? "1/s" : unit + "/s"; };
  return {{"y", with_unit(name_of_y(trace), units.y)},
          {"rate", with_unit("dy/dt", per_second(units.y))},
          {"input", with_unit("element's input", units.input)},
          {"velocity", with_unit("its rate", per_second(units.input))},
          {"output", with_unit(units.force.empty() ? "element's output" : "force", units.force)}};
}

/// One curve with its stuck samples marked. Of a run too long to draw, only the first part; a `period` is never cut, as
/// its second copy would begin at the cut.
Json curve(const Trace& trace, std::size_t most, double sticking, bool period, bool& whole) {
  const auto stuck = stuck_samples(trace, sticking);
  Decimated kept = decimate(trace, most, stuck);
  if (period && !kept.whole) kept = decimate(trace, 2 * most, stuck, INFINITY);
  whole = kept.whole;
  Json marks = Json::array();
  for (const std::size_t i : kept.index) marks.push_back(i < stuck.size() && stuck[i] ? 1 : 0);
  Json out = {{"t", picked(trace.t, kept.index)},
              {"y", picked(trace.y, kept.index)},
              {"rate", picked(trace.rate, kept.index)},
              {"stuck", marks}};
  if (has_element(trace)) {
    out["input"] = picked(trace.input, kept.index);
    out["velocity"] = picked(trace.velocity, kept.index);
    out["output"] = picked(trace.output, kept.index);
  }
  return out;
}

Figure time_figure(const Shown& what, const Units& units) {
  bool whole = true;
  Json run = curve(*what.trace, points_of_cycle, what.cycle ? what.cycle->sticking_fraction : 0.0,
                   what.cycle != nullptr, whole);
  std::string finding = what.cycle ? fmt::format("Over the period of {} s", with_digits(what.cycle->period, 4))
                                   : fmt::format("In the {}{}", what.name, whole ? "" : " (its first part)");
  finding += fmt::format(" {} moves {}", name_of_y(*what.trace), between(what.trace->y, units.y));
  if (has_element(*what.trace))
    finding += fmt::format(" and the {} {}", units.force.empty() ? "element's output" : "force",
                           between(what.trace->output, units.force));
  if (what.cycle && what.cycle->sticking_fraction > 0.0)
    finding += fmt::format("; it sticks for {} of the time", as_percent(what.cycle->sticking_fraction));
  return {"time", what.cycle ? "Two periods" : "Simulation in time", finding + ".",
          figure_data(json_text({{"run", run},
                                 {"labels", labels(*what.trace, units)},
                                 {"name", what.name},
                                 {"repeat", what.cycle != nullptr}}))};
}

Figure phase_figure(const PredictReport& report, const Trace& measured, const Units& units) {
  Json cycles = Json::array(), runs = Json::array();
  bool all_whole = true;
  bool whole = true;
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const auto& cycle = report.cycles[i];
    if (!drawable(cycle.trace)) continue;
    Json one = curve(cycle.trace, points_of_cycle, cycle.sticking_fraction, true, whole);
    one["name"] = fmt::format("limit cycle {}", i);
    one["stable"] = cycle.stable.value_or(true);
    cycles.push_back(std::move(one));
  }
  for (const auto& outcome : report.outcomes) {
    if (!drawable(outcome.trace)) continue;
    Json one = curve(outcome.trace, points_of_run, 0.0, false, whole);
    all_whole = all_whole && whole;
    one["name"] = "from " + start_in_words(outcome.start, units) + (whole ? "" : " (first part)");
    runs.push_back(std::move(one));
  }
  std::string finding = cycles.empty()
                            ? "No closed orbit"
                            : fmt::format("{} closed {}", cycles.size(), cycles.size() == 1 ? "orbit" : "orbits");
  finding += fmt::format(" in the plane of {} and dy/dt, and {} {} from different starts", name_of_y(measured),
                         runs.size(), runs.size() == 1 ? "simulation" : "simulations");
  std::vector<std::string> ends;
  for (const auto& outcome : report.outcomes) {
    const std::string end(to_string(outcome.outcome));
    if (std::find(ends.begin(), ends.end(), end) == ends.end()) ends.push_back(end);
  }
  if (!ends.empty()) finding += fmt::format(", which end in: {}", fmt::join(ends, ", "));
  if (!cycles.empty() && !runs.empty()) finding += "; the initial view shows the cycles";
  if (!all_whole) finding += "; only the first part of long simulations is drawn";
  return {"phase", "Phase plane", finding + ".",
          figure_data(json_text({{"cycles", cycles}, {"runs", runs}, {"labels", labels(measured, units)}}))};
}

Figure loop_figure(const Shown& what, const Units& units) {
  bool whole = true;
  const Json run = curve(*what.trace, points_of_cycle, what.cycle ? what.cycle->sticking_fraction : 0.0,
                         what.cycle != nullptr, whole);
  const std::string output = units.force.empty() ? "output" : "force";
  return {"loop", "Hysteresis: " + output + " against displacement and rate",
          fmt::format("The element's {} lies {}, its input {} and its rate {}{}.", output,
                      between(what.trace->output, units.force), between(what.trace->input, units.input),
                      between(what.trace->velocity, units.input.empty() ? "1/s" : units.input + "/s"),
                      whole ? "" : " (only the first part is drawn)"),
          figure_data(json_text({{"run", run}, {"labels", labels(*what.trace, units)}, {"name", what.name}}))};
}

}  // namespace

std::vector<Figure> predict_figures(const PredictReport& report, const Units& units) {
  std::vector<Figure> out;
  if (report.nyquist.G.size() >= 2) out.push_back(nyquist_figure(report, units));
  const Shown what = shown(report, units);
  if (!what.trace) return out;
  out.push_back(time_figure(what, units));
  out.push_back(phase_figure(report, *what.trace, units));
  if (has_element(*what.trace)) out.push_back(loop_figure(what, units));
  if (auto multipliers = multiplier_figure(report)) out.push_back(*std::move(multipliers));
  return out;
}

}  // namespace limcycle
