#include "limcycle/analysis/orbit/settle/edge.hpp"

#include <array>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"

namespace limcycle {
namespace {

enum class Trend { shrinks, grows, neither };

/// The part of a motion in which three swings are most alike: its last state, and the time of two swings.
struct Lingering {
  LoopState state;
  double period;
};

struct Followed {
  Trend trend = Trend::neither;
  std::optional<Lingering> lingering;
};

/// Follows a motion until its swings of y show a trend or it has turned 60 times. A motion that does not turn for 20
/// periods has shrunk; one that still swings as much after 60 turns had grown before its swings were first measured.
Followed follow(const Loop& loop, const LoopState& from, double period, const SettleOptions& options, long& steps) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, options.rtol));
  march.begin(from.x, 0.0);
  TurningPoints turning;
  const auto& points = turning.points();
  struct Count {
    const March& march;
    long& steps;
    ~Count() { steps += march.steps(); }
  } const count{march, steps};
  Followed found;
  double reference = 0.0;  // the fourth swing: the first ones are still settling
  double least = infinite;
  const auto ends_as = [&](Trend trend) {
    found.trend = trend;
    return found;
  };
  while (march.steps() < options.max_steps && points.size() < 60) {
    const double patience = (points.empty() ? 0.0 : points.back().t) + 20.0 * period;
    if (march.t() >= patience) return ends_as(Trend::shrinks);
    if (march.step(patience) != Status::converged || (options.stop && options.stop())) return found;
    if (!turning.feed(march.t(), field.y(march.x())) || points.size() < 5) continue;
    if (reference == 0.0) reference = turning.swing(0);
    if (turning.swing(0) > 1.6 * reference) return ends_as(Trend::grows);
    if (turning.swing(0) < 0.5 * reference) return ends_as(Trend::shrinks);
    const auto change = [&](std::size_t k) { return std::abs(std::log(turning.swing(k) / turning.swing(k + 1))); };
    if (const double now = change(0) + change(1); now < least) {
      least = now;
      found.lingering = {{march.x(), field.modes()}, points.back().t - points[points.size() - 3].t};
    }
  }
  return ends_as(points.size() < 60 ? Trend::neither : Trend::grows);
}

/// Neighbouring scales between which shrinking turns into growing, nearest to 1 first. (Where growing turns into
/// shrinking lies an attractor.)
std::optional<std::pair<double, double>> bracket(const std::function<Trend(double)>& trend_at) {
  constexpr std::array<double, 10> scales{smallest_edge_scale, 0.3, 0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0,
                                          largest_edge_scale};
  std::optional<std::pair<double, double>> best;
  Trend previous = Trend::neither;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const Trend here = trend_at(scales[i]);
    const bool changed = previous == Trend::shrinks && here == Trend::grows;
    const auto distance = [](double a, double b) { return std::abs(std::log(a * b)); };
    if (changed && (!best || distance(scales[i - 1], scales[i]) < distance(best->first, best->second)))
      best = {scales[i - 1], scales[i]};
    previous = here;
  }
  return best;
}

/// Shooting from a motion near the border.
ShootingResult shoot_from(const Loop& loop, const Lingering& from, const SettleOptions& options) {
  ShootingResult none;
  Trace trace;
  if (record(loop, from.state, 1.2 * from.period, 1e-9, 400, trace) != Status::converged) return none;
  ShootingOptions shooting = options.shooting;
  shooting.warm_maps = 0;
  shooting.max_maps = 40;  // those that converge took 5 to 10
  shooting.longest_map = 10.0 * from.period;
  for (const bool half : {symmetry(loop).has_value(), false}) {
    auto shot = shoot(loop, from.state, choose_section(loop, trace), half, shooting);
    none.steps += shot.steps;
    none.maps += shot.maps;
    if (shot.status == Status::converged && shot.cycle.stable == false) return shot;
    if (!half) break;
  }
  return none;
}

}  // namespace

ShootingResult edge_cycle(const Loop& loop, const std::function<LoopState(double)>& ray, double period,
                          const SettleOptions& options) {
  ShootingResult none;
  none.why = "no border between growing and shrinking motions was found near it";
  const auto follow_from = [&](double scale) { return follow(loop, ray(scale), period, options, none.steps); };
  const auto found = bracket([&](double scale) { return follow_from(scale).trend; });
  if (!found) return none;
  auto [low, high] = *found;
  std::optional<Lingering> nearest;
  for (const double width : {1e-5, 1e-12}) {
    while (high - low > width * high) {
      if (options.stop && options.stop()) return none;
      const double mid = 0.5 * (low + high);
      Followed followed = follow_from(mid);
      (followed.trend == Trend::shrinks ? low : high) = mid;
      if (followed.lingering) nearest = std::move(followed.lingering);
    }
    if (!nearest) break;
    auto shot = shoot_from(loop, *nearest, options);
    if (shot.status == Status::converged) {
      shot.steps += none.steps;
      return shot;
    }
    none.steps += shot.steps;
    none.maps += shot.maps;
  }
  none.status = Status::stalled;
  none.why = "growing and shrinking motions are separated near it, but shooting did not find the cycle between them";
  return none;
}

}  // namespace limcycle
