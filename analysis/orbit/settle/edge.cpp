#include "limcycle/analysis/orbit/settle/edge.hpp"

#include <array>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/turning_points.hpp"

namespace limcycle {
namespace {

enum class Trend { shrinks, grows, neither };

/// Trend of the swings of y before the motion has turned 60 times. A motion that does not turn for 20 periods has
/// shrunk; one that still swings as much after 60 turns had grown before its swings were first measured.
Trend trend(const Loop& loop, const LoopState& from, double period, const SettleOptions& options, long& steps) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, options.rtol));
  march.begin(from.x, 0.0);
  TurningPoints turning;
  struct Count {
    const March& march;
    long& steps;
    ~Count() { steps += march.steps(); }
  } const count{march, steps};
  double reference = 0.0;  // the fourth swing: the first ones are still settling
  while (march.steps() < options.max_steps && turning.points().size() < 60) {
    const double patience = (turning.points().empty() ? 0.0 : turning.points().back().t) + 20.0 * period;
    if (march.t() >= patience) return Trend::shrinks;
    if (march.step(patience) != Status::converged || (options.stop && options.stop())) return Trend::neither;
    if (!turning.feed(march.t(), field.y(march.x())) || turning.points().size() < 5) continue;
    if (reference == 0.0) reference = turning.swing(0);
    if (turning.swing(0) > 1.6 * reference) return Trend::grows;
    if (turning.swing(0) < 0.5 * reference) return Trend::shrinks;
  }
  return turning.points().size() < 60 ? Trend::neither : Trend::grows;
}

/// Neighbouring scales between which shrinking turns into growing (or back), nearest to 1 first.
std::optional<std::pair<double, double>> bracket(const std::function<Trend(double)>& trend_at) {
  constexpr std::array<double, 10> scales{smallest_edge_scale, 0.3, 0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0,
                                          largest_edge_scale};
  std::optional<std::pair<double, double>> best;
  Trend previous = Trend::neither;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const Trend here = trend_at(scales[i]);
    const bool changed = i > 0 && here != previous && here != Trend::neither && previous != Trend::neither;
    const auto distance = [](double a, double b) { return std::abs(std::log(a * b)); };
    if (changed && (!best || distance(scales[i - 1], scales[i]) < distance(best->first, best->second)))
      best = {scales[i - 1], scales[i]};
    previous = here;
  }
  return best;
}

/// The state after a time.
std::optional<LoopState> after(const Loop& loop, const LoopState& from, double time) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-11));
  march.begin(from.x, 0.0);
  while (march.t() < time)
    if (march.steps() > 200000 || march.step(time) != Status::converged) return std::nullopt;
  return LoopState{march.x(), field.modes()};
}

}  // namespace

ShootingResult edge_cycle(const Loop& loop, const std::function<LoopState(double)>& ray, double period,
                          const SettleOptions& options) {
  ShootingResult none;
  long& steps = none.steps;
  none.why = "no border between growing and shrinking motions was found near it";
  const auto trend_at = [&](double scale) { return trend(loop, ray(scale), period, options, steps); };
  const auto found = bracket(trend_at);
  if (!found) return none;
  auto [low, high] = *found;
  const Trend below = trend_at(low);
  for (int i = 0; i < 45 && high - low > 1e-12 * high; ++i) {
    if (options.stop && options.stop()) return none;
    const double mid = 0.5 * (low + high);
    (trend_at(mid) == below ? low : high) = mid;
  }
  ShootingOptions shooting = options.shooting;
  shooting.warm_maps = 0;
  shooting.max_maps = 40;  // those that converge took 5 to 10
  for (const double periods : {2.0, 3.0, 1.0, 4.0}) {
    const auto lingering = after(loop, ray(low), periods * period);
    Trace trace;
    if (!lingering || record(loop, *lingering, 1.2 * period, 1e-9, 400, trace) != Status::converged) continue;
    for (const bool half : {symmetry(loop).has_value(), false}) {
      auto shot = shoot(loop, *lingering, choose_section(loop, trace), half, shooting);
      steps += shot.steps;
      if (shot.status != Status::converged || shot.cycle.stable != false) continue;
      shot.steps = steps;
      return shot;
    }
  }
  none.status = Status::stalled;
  none.why = "growing and shrinking motions are separated near it, but shooting did not find the cycle between them";
  return none;
}

}  // namespace limcycle
