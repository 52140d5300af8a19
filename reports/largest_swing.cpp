#include "limcycle/reports/largest_swing.hpp"

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

double of_cycles(const std::vector<Cycle>& cycles) {
  double most = 0.0;
  for (const Cycle& cycle : cycles) most = std::max(most, cycle.amplitude);
  return most;
}

double farthest(const Trace& trace) {
  double most = 0.0;
  for (const double y : trace.y) most = std::max(most, std::abs(y));
  return most;
}

}  // namespace

double largest_swing(const PredictReport& report) {
  double most = of_cycles(report.cycles);
  for (const OutcomeOfStart& one : report.outcomes) most = std::max(most, one.irregular.half_range);
  if (most > 0.0) return most;
  for (const Prediction& one : report.predictions) most = std::max(most, one.amplitude);
  for (const OutcomeOfStart& one : report.outcomes)
    if (one.outcome != Outcome::divergence) most = std::max(most, farthest(one.trace));
  return most;
}

double largest_swing(const Simulation& run) {
  const auto y = std::ranges::find(run.columns, "y");
  if (y == run.columns.end()) return 0.0;
  double most = 0.0;
  for (const auto& row : run.rows)
    most = std::max(most, std::abs(row[static_cast<std::size_t>(y - run.columns.begin())]));
  return most;
}

double largest_swing(const ContinueReport& report) {
  double most = 0.0;
  for (const Branch& branch : report.found.branches)
    for (const BranchPoint& point : branch.points) most = std::max(most, point.cycle.amplitude);
  return most;
}

double largest_swing(const MarginReport& report) { return of_cycles(report.cycles); }

double largest_swing(const MapReport& report) {
  double most = 0.0;
  for (const auto& point : report.map.points)
    if (point) most = std::max(most, point->amplitude);
  return most;
}

double largest_swing(const SensitivityReport& report) {
  double most = report.cycle ? report.cycle->amplitude : 0.0;
  for (const PredictedOscillation& one : report.predicted) most = std::max(most, one.found.amplitude);
  return most;
}

double largest_swing(const PrecisionReport& report) { return report.cycle ? report.cycle->cycle.amplitude : 0.0; }

double largest_swing(const AdequateReport& report) {
  double most = report.best.amplitude;
  for (const auto& point : report.points) most = std::max(most, point.answer.amplitude);
  return most;
}

double largest_swing(const LoopReport& report) { return largest_swing(report.predict); }
double largest_swing(const RemedyReport& report) { return report.step; }
double largest_swing(const TuneReport& report) { return report.step; }

}  // namespace limcycle
