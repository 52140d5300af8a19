#include "limcycle/analysis/study/map/simulated_points.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/lane_march/lane_loop.hpp"
#include "limcycle/analysis/orbit/settle/load_step.hpp"
#include "limcycle/analysis/orbit/simulate/ensemble.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"

namespace limcycle {
namespace {

constexpr double swing_accuracy = 1e-4;               // of amplitude and period
constexpr double same_cycle = 10.0 * swing_accuracy;  // two motions that differ by less reached the same cycle

/// A loop that is marched in lanes, and its own part of the members.
struct LaneTrial {
  std::size_t point;
  const Loop& loop;
  SearchBox box;
  std::size_t first = 0, count = 0;
};

/// Marches loops from the starts of predict(), all at once.
class LaneTrials {
 public:
  explicit LaneTrials(const SimulatedPoints& how) : how_(how) {}

  void add(LaneTrial& trial) {
    add_from(trial, start_displacements(output_per_input(trial.loop), trial.box, how_.predict.starts));
    if (!how_.predict.load_step) return;
    if (const auto step = load_step(trial.loop)) add_member(trial, step->start);
  }
  /// From up to three starts further down, as predict() does where all others diverge.
  void add_below(LaneTrial& trial) {
    const auto above = start_displacements(output_per_input(trial.loop), trial.box, how_.predict.starts);
    add_from(trial, extend_down(trial.box, above.back(), how_.predict.starts));
  }

  void run() {
    EnsembleOptions options;
    options.accuracy = swing_accuracy;
    options.isa = how_.isa;
    options.stop = how_.predict.stop;
    run_ = run_ensemble(members_, options);
  }

  std::span<const EnsembleResult> of(const LaneTrial& trial) const {
    return std::span(run_.members).subspan(trial.first, trial.count);
  }

 private:
  void add_from(LaneTrial& trial, const std::vector<double>& displacements) {
    const SettleOptions search = cycle_search(trial.loop, trial.box, swing_accuracy);
    bounds_ = {search.rtol, search.amplitude_floor, search.amplitude_ceiling};
    trial.first = members_.size();
    trial.count = 0;
    for (const double displacement : displacements) add_member(trial, displaced(trial.loop, displacement));
  }
  void add_member(LaneTrial& trial, LoopState start) {
    if (!is_finite(start.x)) return;
    members_.push_back({&trial.loop, std::move(start), bounds_});
    ++trial.count;
  }

  const SimulatedPoints& how_;
  MotionBounds bounds_;
  std::vector<EnsembleMember> members_;
  EnsembleRun run_;
};

bool all_diverge(std::span<const EnsembleResult> results) {
  return !results.empty() &&
         std::ranges::all_of(results, [](const auto& one) { return one.outcome == Outcome::divergence; });
}

/// Adds what these motions ended in. False if one of them is not decided.
bool add_outcomes(MapPoint& point, std::span<const EnsembleResult> results) {
  if (std::ranges::any_of(results, [](const auto& one) { return one.outcome == Outcome::undecided; })) return false;
  std::vector<const EnsembleResult*> cycles;
  for (const EnsembleResult& result : results) {
    if (!point.has(result.outcome)) point.outcomes.push_back(result.outcome);
    if (result.outcome != Outcome::cycle) continue;
    const bool known = std::ranges::any_of(cycles, [&](const EnsembleResult* other) {
      return std::abs(result.amplitude - other->amplitude) <= same_cycle * other->amplitude &&
             std::abs(result.period - other->period) <= same_cycle * other->period;
    });
    if (known) continue;
    cycles.push_back(&result);
    if (result.amplitude <= point.amplitude) continue;
    point.amplitude = result.amplitude;
    point.period = result.period;
  }
  point.cycles += static_cast<int>(cycles.size());
  point.stable = point.cycles;
  std::ranges::sort(point.outcomes);
  return !point.outcomes.empty();
}

/// The points that the lanes decide.
std::vector<std::optional<MapPoint>> points_in_lanes(std::span<const std::optional<Loop>> loops,
                                                     const SimulatedPoints& how) {
  std::vector<std::optional<MapPoint>> points(loops.size());
  std::vector<LaneTrial> trials, further;
  trials.reserve(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i] && fits_lanes(*loops[i]))
      trials.push_back({i, *loops[i], how.predict.search ? *how.predict.search : default_search_box(*loops[i])});
  LaneTrials first(how), below(how);
  for (LaneTrial& trial : trials) first.add(trial);
  first.run();
  for (const LaneTrial& trial : trials) {
    MapPoint point;
    if (!add_outcomes(point, first.of(trial))) continue;
    points[trial.point] = std::move(point);
    if (!how.predict.search && all_diverge(first.of(trial))) further.push_back(trial);
  }
  for (LaneTrial& trial : further) below.add_below(trial);
  below.run();
  for (const LaneTrial& trial : further)
    if (!add_outcomes(*points[trial.point], below.of(trial))) points[trial.point].reset();
  return points;
}

}  // namespace

bool fits_lanes(const Loop& loop) { return lane_shape(loop).has_value(); }

std::vector<MapPoint> simulated_points(std::span<const std::optional<Loop>> loops, const SimulatedPoints& how) {
  PredictOptions alone = how.predict;
  alone.methods = no_methods;
  alone.accuracy = std::max(alone.accuracy, swing_accuracy);
  auto in_lanes = points_in_lanes(loops, how);
  std::vector<MapPoint> points;
  points.reserve(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (in_lanes[i])
      points.push_back(std::move(*in_lanes[i]));
    else
      points.push_back(loops[i] ? map_point(*loops[i], alone) : MapPoint{});
    if (!in_lanes[i] && how.predict.stop && how.predict.stop()) {
      points.pop_back();
      break;
    }
  }
  return points;
}

}  // namespace limcycle
