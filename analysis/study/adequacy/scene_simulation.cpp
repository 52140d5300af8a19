#include "limcycle/analysis/study/adequacy/scene_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"

namespace limcycle {
namespace {

/// One plain simulation, watched until its swings repeat.
class SimulationWatch {
 public:
  SimulationWatch(const Loop& loop, const PredictOptions& options, const SearchBox& box)
      : loop_(loop), options_(options), settling_(cycle_search(loop, box, 1e-8)) {
    const auto moduli = pole_moduli(loop);
    horizon_ = 200.0 / (moduli.empty() ? 1.0 : moduli.front());
    longest_ = 25.0 * horizon_;
  }

  MethodAnswer operator()(double displacement) {
    const LoopState start = displaced(loop_, displacement);
    LoopField field(loop_);
    field.modes() = start.modes;
    March march(field, StepperKind::automatic, loop_weights(loop_, settling_.rtol));
    march.begin(start.x, 0.0);
    while (march.t() < horizon_) {
      if (march.steps() > 200000) return unanswered("the simulation gave up after 200000 steps");
      if (options_.stop && march.steps() % 64 == 0 && options_.stop()) return unanswered("interrupted");
      if (const Status status = march.step(longest_); status != Status::converged) return ended(status);
      const double y = field.y(march.x());
      if (std::abs(y) > settling_.amplitude_ceiling) return ended(Status::not_finite);
      if (!turning_.feed(march.t(), y)) continue;
      for (const std::size_t order : {2U, 4U, 6U})
        if (repeats(order)) return cycle(order);
      wait_for_slow_swings(march.t());
    }
    const auto& points = turning_.points();
    const bool calm = points.empty() || points.back().t < 0.5 * march.t() ||
                      (points.size() > 2 && turning_.swing(0) < settling_.amplitude_floor);
    const bool grows = points.size() > 3 && turning_.swing(0) > 10.0 * displacement &&
                       turning_.swing(0) > turning_.swing(1) && turning_.swing(1) > turning_.swing(2);
    if (grows) return ended(Status::not_finite);
    if (!calm) return unanswered("the simulation neither came to rest nor repeated itself");
    MethodAnswer answer;
    answer.answered = true;
    answer.verdict = std::string(no_cycle_verdict);
    return answer;
  }

 private:
  static MethodAnswer ended(Status status) {
    if (status != Status::not_finite) return unanswered("ended with status " + std::string(to_string(status)));
    MethodAnswer answer;
    answer.answered = true;
    answer.verdict = "divergence";
    return answer;
  }

  /// Hunting has long pauses between its slips: waits at least eight times as long as the last swing took.
  void wait_for_slow_swings(double now) {
    const auto& points = turning_.points();
    if (points.size() > 1)
      horizon_ = std::clamp(now + 8.0 * (points.back().t - points[points.size() - 2].t), horizon_, longest_);
  }

  double length(std::size_t order, std::size_t back) const {
    const auto& points = turning_.points();
    const std::size_t last = points.size() - 1 - back;
    return points[last].t - points[last - order].t;
  }

  /// True if the last three periods, of `order` turning points each, agree in length and swing.
  bool repeats(std::size_t order) const {
    if (turning_.points().size() < 3 * order + 2) return false;
    for (std::size_t k = 0; k < order; ++k)
      if (std::abs(turning_.swing(k) / turning_.swing(k + order) - 1.0) > agree ||
          std::abs(turning_.swing(k) / turning_.swing(k + 2 * order) - 1.0) > agree)
        return false;
    return std::abs(length(order, 0) / length(order, order) - 1.0) < agree &&
           std::abs(length(order, 0) / length(order, 2 * order) - 1.0) < agree;
  }

  MethodAnswer cycle(std::size_t order) const {
    MethodAnswer answer;
    answer.answered = true;
    answer.verdict = "cycle";
    answer.period = length(order, 0);
    const auto& points = turning_.points();
    double low = points.back().y, high = low;
    for (std::size_t k = 0; k < order; ++k) {
      low = std::min(low, points[points.size() - 1 - k].y);
      high = std::max(high, points[points.size() - 1 - k].y);
    }
    answer.amplitude = 0.5 * (high - low);
    return answer;
  }

  static constexpr double agree = 5e-3;
  const Loop& loop_;
  const PredictOptions& options_;
  SettleOptions settling_;
  double horizon_ = 0.0, longest_ = 0.0;  ///< s
  TurningPoints turning_;
};

}  // namespace

MethodAnswer plain_simulation(const Loop& loop, const PredictOptions& options, const SearchBox& box) {
  MethodAnswer all;
  std::vector<std::string> ends;
  for (const double displacement : start_displacements(output_per_input(loop), box, options.starts)) {
    MethodAnswer one = SimulationWatch(loop, options, box)(displacement);
    if (!one.answered) return one;
    ends.push_back(one.verdict);
    if (one.amplitude >= all.amplitude) all = std::move(one);
  }
  if (ends.empty()) return unanswered("nothing was simulated");
  all.verdict = joined_verdict(std::move(ends));
  return all;
}

}  // namespace limcycle
