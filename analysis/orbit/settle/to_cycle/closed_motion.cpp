#include "limcycle/analysis/orbit/settle/to_cycle/closed_motion.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/to_cycle/known_cycle.hpp"

namespace limcycle {
namespace {

constexpr double settled_change = 1e-3;  ///< relative change of the swings of a motion that has all but settled
constexpr double centred = 0.02;         ///< offset of a symmetric motion, relative to its swing
constexpr long periods_of_a_try = 40;    ///< of return maps; most that converge take 5 to 20, up to 15 maps

ShootingOptions of_a_try(ShootingOptions shooting, const NearlyClosed& motion) {
  const double period = motion.period.t.back() - motion.period.t.front();
  shooting.max_maps = std::min(shooting.max_maps, 40);
  shooting.max_steps = periods_of_a_try * motion.steps;
  shooting.max_steps_per_map = std::min(shooting.max_steps_per_map, std::max(2000L, 5 * shooting.max_steps));
  shooting.longest_map = 10.0 * period;
  return shooting;
}

}  // namespace

NearlyClosed nearly_closed(const Loop& loop, LoopState here, Trace period, std::size_t turns, double change) {
  const auto [low, high] = extremes(period);
  const auto reflection = symmetry(loop);
  const double middle = reflection ? (loop.C_y * reflection->centre).value() : 0.0;
  NearlyClosed motion{std::move(here), std::move(period)};
  motion.steps = std::ssize(motion.period.t);
  motion.odd = reflection && turns % 4 == 2;
  motion.change = change;
  motion.swing = high - low;
  motion.offset = reflection ? std::abs(0.5 * (low + high) - middle) / motion.swing : 0.0;
  return motion;
}

bool is_displaced(const NearlyClosed& motion) { return motion.offset >= centred; }
bool has_settled(const NearlyClosed& motion) { return motion.change < settled_change; }

ClosedMotion close_motion(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options) {
  ClosedMotion found;
  found.shooting = of_a_try(options, motion);
  found.section = choose_section(loop, motion.period);
  const bool settled = has_settled(motion);
  const int returns = returns_of(found.section, motion.period);
  const auto attempt = [&](bool half) {
    found.half = half;
    // While y rings it may cross the section several times in a row; the half map goes from there to the mirrored one.
    found.shooting.returns = half && returns % 2 == 0 ? 1 : returns;
    found.shot = shoot(loop, motion.here, found.section, half, found.shooting);
    found.steps += found.shot.steps;
    return found.shot.status == Status::converged;
  };
  bool closes = motion.odd && (settled || !is_displaced(motion)) && attempt(true);
  // Swings that are as large on both sides, and repeat, may differ in form.
  if (!closes && (!found.half || settled)) closes = attempt(false);
  if (closes) shorten(loop, found.shot, found.section, found.half, found.shooting, found.steps);
  return found;
}

}  // namespace limcycle
