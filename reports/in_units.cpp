#include "limcycle/reports/in_units.hpp"

#include <charconv>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

void scale(std::vector<double>& values, double k) {
  for (double& value : values) value *= k;
}

void scale(Trace& trace, double k) {
  scale(trace.y, k);
  scale(trace.rate, k);
  trace.y_origin *= k;
}

void scale(Cycle& cycle, double k) {
  for (double* value : {&cycle.amplitude, &cycle.first_harmonic, &cycle.offset}) *value *= k;
  scale(cycle.trace, k);
}

void scale(Interval& interval, double k) {
  interval.low *= k;
  interval.high *= k;
}

}  // namespace

bool names_displacement(const std::string& start) {
  return start.starts_with("y(0) = ") || start.starts_with("held until it breaks away at y(0) = ");
}

namespace {

/// The displacement at the end of the name of a start, "y(0) = 0.01" or "y(0) = rest + 0.01".
void scale_displacement(std::string& start, double k) {
  if (!names_displacement(start)) return;
  const std::size_t at = start.find_last_of(' ') + 1;
  double value = 0.0;
  const auto [end, fault] = std::from_chars(start.data() + at, start.data() + start.size(), value);
  if (fault == std::errc() && end == start.data() + start.size()) start = start.substr(0, at) + short_number(value * k);
}

void scale(LocalSensitivity& one, double k) {
  for (double* value : {&one.amplitude, &one.first_harmonic, &one.offset, &one.first_harmonic_error, &one.offset_error,
                        &one.amplitude_error})
    *value *= k;
}

void scale(PredictedOscillation& one, double k) {
  one.found.amplitude *= k;
  for (auto& number : one.numbers) {
    number.by.amplitude *= k;
    number.by.amplitude_error *= k;
  }
}

void scale(IrregularMotion& one, double k) {
  for (double* size : {&one.half_range, &one.mean_amplitude, &one.smallest_amplitude, &one.largest_amplitude})
    *size *= k;
}

void scale(Estimate& one, double k) {
  one.value *= k;
  one.low *= k;
  one.high *= k;
}

}  // namespace

Units in_si(const Units& units) {
  Units back = units;
  back.y_per_si = 1.0 / units.y_per_si;
  return back;
}

PredictReport in_units(PredictReport report, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return report;
  for (Cycle& cycle : report.cycles) scale(cycle, k);
  for (Prediction& one : report.predictions) {
    one.amplitude *= k;
    if (one.trust) scale(one.trust->band.amplitude, k);
    if (one.motion) scale(*one.motion, k);
  }
  for (OutcomeOfStart& one : report.outcomes) {
    scale_displacement(one.start, k);
    scale(one.trace, k);
    scale(one.irregular, k);
  }
  return report;
}

Simulation in_units(Simulation run, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return run;
  run.amplitude *= k;
  scale(run.trace, k);
  for (std::size_t i = 0; i < run.columns.size(); ++i)
    if (run.columns[i] == "y" || run.columns[i] == "dy_dt")
      for (auto& row : run.rows) row[i] *= k;
  return run;
}

ContinueReport in_units(ContinueReport report, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return report;
  for (Branch& branch : report.found.branches) {
    for (BranchPoint& point : branch.points) scale(point.cycle, k);
    for (BranchEvent& event : branch.events) event.amplitude *= k;
  }
  return report;
}

MarginReport in_units(MarginReport report, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return report;
  for (Cycle& cycle : report.cycles) scale(cycle, k);
  for (ParameterMargin& one : report.parameters)
    for (MarginSide* side : {&one.up, &one.down})
      if (side->cycle) scale(*side->cycle, k);
  return report;
}

MapReport in_units(MapReport report, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return report;
  for (auto& point : report.map.points)
    if (point) point->amplitude *= k;
  return report;
}

SensitivityReport in_units(SensitivityReport report, const Units& units) {
  const double k = units.y_per_si;
  if (k == 1.0) return report;
  if (report.cycle) scale(*report.cycle, k);
  for (auto& one : report.local) scale(one, k);
  for (auto& one : report.predicted) scale(one, k);
  for (auto& one : report.one_at_a_time) one.found.amplitude *= k;
  constexpr std::size_t amplitude = 1;  // of EnsembleOutcome::names
  const std::size_t column = report.spread.parameters.size() + amplitude;
  for (auto& row : report.sample)
    if (row.size() > column) row[column] *= k;
  if (!report.global) return report;
  for (auto& output : report.global->outputs)
    if (output.output == "amplitude") {
      for (auto& one : output.morris.parameters)
        for (Estimate* value : {&one.mu, &one.mu_star, &one.sigma}) scale(*value, k);
      if (output.band)
        for (double* value : {&output.band->low, &output.band->median, &output.band->high}) *value *= k;
    }
  return report;
}

PrecisionReport in_units(PrecisionReport report, const Units& units) {
  if (units.y_per_si != 1.0 && report.cycle) scale(report.cycle->cycle, units.y_per_si);
  return report;
}

AdequateReport in_units(AdequateReport report, const Units& units) {
  report.best.amplitude *= units.y_per_si;
  for (auto& point : report.points) point.answer.amplitude *= units.y_per_si;
  return report;
}

LoopReport in_units(LoopReport report, const Units& units) {
  if (units.y_per_si == 1.0) return report;
  report.predict = in_units(std::move(report.predict), units);
  const auto each = [&](auto& part) {
    if (part.found) part.found = in_units(*std::move(part.found), units);
  };
  each(report.margin);
  each(report.sensitivity);
  each(report.map);
  each(report.precision);
  if (report.energy.found) report.energy.found->run = in_units(std::move(report.energy.found->run), units);
  return report;
}

}  // namespace limcycle
