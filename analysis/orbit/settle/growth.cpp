#include "limcycle/analysis/orbit/settle/growth.hpp"

#include <algorithm>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/displaced.hpp"

namespace limcycle {

bool grows_like_a_power(const TurningPoints& turning) {
  constexpr std::size_t few = 64, averaged = 4;
  constexpr double least_growth = 1.2, least_part = 0.01, rise = 1.2;
  const std::size_t count = turning.points().size();
  if (count < few) return false;
  const auto size = [&](std::size_t swings) {
    double sum = 0.0;
    for (std::size_t k = 0; k < averaged; ++k) sum += turning.swing(count - 1 - swings + k);
    return sum;
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

bool grows_from_afar(const Loop& loop, const LoopState& here, double rtol, long most_steps,
                     const std::function<bool()>& stop) {
  constexpr double farther = 30.0;
  constexpr std::size_t turns = 10, apart = 6;  // an even number, so that swings of one direction are compared
  const LoopState far = scaled(loop, here, farther);
  LoopField field(loop);
  field.modes() = far.modes;
  // So far out, swings are so slow that fast poles limit the steps of an explicit method.
  const bool usual = choose_stepper(loop, rtol) == StepperKind::exact || has_infinite_slope(loop);
  const auto kind = usual ? StepperKind::automatic : StepperKind::rodas5p;
  March march(field, kind, loop_weights(loop, rtol));
  march.begin(far.x, 0.0);
  TurningPoints turning;
  constexpr double end = 1e15;  // s, of a motion that hardly moves
  while (turning.points().size() < turns) {
    if (march.steps() > most_steps || march.t() >= end || (stop && stop())) return false;
    if (march.step(end) != Status::converged) return false;
    turning.feed(march.t(), field.y(march.x()));
  }
  return turning.swing(0) > (1.0 + 100.0 * rtol) * turning.swing(apart);
}

}  // namespace limcycle
