#include "limcycle/analysis/orbit/settle/growth.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "limcycle/analysis/golden_maximum.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/displaced.hpp"

namespace limcycle {

bool grows_like_a_power(const TurningPoints& turning) {
  constexpr std::size_t few = 64;
  constexpr double least_growth = 1.2, least_part = 0.01, rise = 1.2;
  const std::size_t count = turning.points().size();
  if (count < few) return false;
  const auto size = [&](std::size_t swings) {  // the mean of a few, as a swing is known by the ends of steps only
    const std::size_t averaged = std::max<std::size_t>(4, swings / 16);
    double sum = 0.0;
    for (std::size_t k = 0; k < averaged; ++k) sum += turning.swing(count - 1 - swings + k);
    return sum / static_cast<double>(averaged);
  };
  // The growth in each doubling of the number of swings is 2^p times that before for n^p, and comes down to that for
  // (a + n)^p, from afar. For a motion that is bounded it falls, for an exponential growth its ratio rises.
  const std::size_t all = count - 1;
  const double last = size(all) - size(all / 2), before = size(all / 2) - size(all / 4),
               first = size(all / 4) - size(all / 8);
  return first > 0.0 && last > least_part * size(all) && last > least_growth * before &&
         before > least_growth * first && last * first < rise * before * before;
}

bool drifts(const TurningPoints& turning) {
  constexpr std::size_t few = 64;
  const auto& points = turning.points();
  if (points.size() < few) return false;
  const auto one_way = [&](std::size_t period) {
    const double whole = points.back().y - points[points.size() - 1 - period].y;
    if (whole == 0.0) return false;
    for (std::size_t i = points.size() / 2; i + period < points.size(); i += period)
      if ((points[i + period].y - points[i].y) * whole <= 0.0) return false;
    return true;
  };
  return one_way(2) || one_way(4) || one_way(6);
}

namespace {

/// Turning points of y over a march, within its steps and not at their ends: a few steps may make a swing.
class FineSwings {
 public:
  explicit FineSwings(const LoopField& field) : field_(field) {}

  void step(March& march, double rate_before, double rate_after) {
    if (rate_before * rate_after < 0.0) {
      const double sign = rate_before > 0.0 ? 1.0 : -1.0;
      const double at = golden_maximum([&](double part) { return sign * y_within(march, part); }, 0.0, 0.5, 1.0, 40);
      turning.feed(march.last().t0 + at * (march.last().t1 - march.last().t0), y_within(march, at));
    }
    turning.feed(march.t(), field_.y(march.x()));
  }

  TurningPoints turning;

 private:
  double y_within(March& march, double part) {
    if (march.last().switched)
      march.last().interpolate(part, x_);
    else
      march.within(part, x_);
    return field_.y(x_);
  }

  const LoopField& field_;
  State x_;
};

/// The last swing of a few, over the one before it in the same direction that is farthest back; and over `swing`.
struct Growth {
  double factor = 0.0, distance = 0.0;
};

std::optional<Growth> growth_from(const Loop& loop, const LoopState& far, double swing, double rtol, long most_steps,
                                  const std::function<bool()>& stop) {
  constexpr std::size_t turns = 10, apart = 6;  // an even number, so that swings of one direction are compared
  LoopField field(loop);
  field.modes() = far.modes;
  // So far out, swings are so slow that fast poles limit the steps of an explicit method.
  const bool usual = choose_stepper(loop, rtol) == StepperKind::exact || has_infinite_slope(loop);
  const auto kind = usual ? StepperKind::automatic : StepperKind::rodas5p;
  March march(field, kind, loop_weights(loop, rtol));
  march.begin(far.x, 0.0);
  FineSwings swings(field);
  constexpr double end = 1e15;  // s, of a motion that hardly moves
  while (swings.turning.points().size() < turns) {
    if (march.steps() > most_steps || march.t() >= end || (stop && stop())) return std::nullopt;
    if (march.step(end) != Status::converged) return std::nullopt;
    swings.step(march, field.y_rate(march.last().dx0), field.y_rate(march.last().dx1));
  }
  return Growth{swings.turning.swing(0) / swings.turning.swing(apart), swings.turning.swing(0) / swing};
}

}  // namespace

bool grows_from_afar(const Loop& loop, const LoopState& here, double swing, double rtol, long most_steps,
                     const std::function<bool()>& stop) {
  constexpr double farther = 30.0, still_far = 0.2;
  const std::array factors{farther, farther * farther, farther * farther * farther};
  return std::ranges::all_of(factors, [&](double factor) {
    const auto growth = growth_from(loop, scaled(loop, here, factor), swing, rtol, most_steps, stop);
    // The farther out, the less the growth of a power is in a few swings; what bounds it is the stronger there.
    const double least = factor == farther ? 1.0 + 100.0 * rtol : 1.0 - 100.0 * rtol;
    return growth && growth->factor > least && growth->distance >= still_far * factor;
  });
}

}  // namespace limcycle
