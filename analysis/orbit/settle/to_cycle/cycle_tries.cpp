#include "limcycle/analysis/orbit/settle/to_cycle/cycle_tries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/orbit/settle/to_cycle/known_cycle.hpp"
#include "limcycle/analysis/orbit/settle/to_cycle/surroundings.hpp"

namespace limcycle {
namespace {

/// True if all multipliers but the largest, which is 1 as far as is known, are less than 1.
bool contracts_but_once(const ShootingResult& shot) {
  constexpr double clearly = 1e-3;
  const auto& multipliers = shot.cycle.multipliers;
  return shot.neutral.size() > 0 && !multipliers.empty() &&
         std::all_of(multipliers.begin() + 1, multipliers.end(),
                     [](std::complex<double> one) { return std::abs(one) < 1.0 - clearly; });
}

/// The cycle is stable but for a number that it keeps, whose multiplier is left out.
void keep_one(Cycle& cycle) {
  cycle.multipliers.erase(cycle.multipliers.begin());
  ++cycle.remembered;
  cycle.stable = true;
}

}  // namespace

std::optional<CycleFound> CycleTries::look_from(const NearlyClosed& motion) {
  if (const auto known = known_cycle(loop_, motion.here, motion.swing, options_, steps_))
    return CycleFound{Outcome::cycle, converges_to(*known), known, {}};
  if (swings_like_known(motion) || leaves_known(motion)) return std::nullopt;
  return judge(motion, shoot_at(motion));
}

std::string CycleTries::converges_to(std::size_t known) const {
  const std::string name = "cycle " + std::to_string(known);
  return options_.known[known].remembered > 0 ? "converges to " + name + ", or to one of its family of the same size"
                                              : "converges to " + name;
}

/// True if a sampled loop swings as widely as a motion of another start in which no period was found: shooting at it
/// again takes long, each period having thousands of samples.
bool CycleTries::swings_like_known(const NearlyClosed& motion) const {
  constexpr double alike = 0.15;
  return loop_.continuous && std::ranges::any_of(options_.known_irregular, [&](const IrregularMotion& one) {
           return std::abs(2.0 * one.half_range / motion.swing - 1.0) < alike;
         });
}

/// True if the motion moves on, no slower than before, beside a known unstable cycle of its size.
bool CycleTries::leaves_known(const NearlyClosed& motion) {
  constexpr double slower = 0.8, alike = 0.01;
  const double before = std::exchange(last_change_, motion.change);
  const auto is_near = [&](double swing) { return std::abs(swing / motion.swing - 1.0) < alike; };
  const bool known = std::ranges::any_of(
      options_.known, [&](const Cycle& one) { return one.stable == false && is_near(2.0 * one.amplitude); });
  return motion.change > slower * before && before > 0.0 && (known || is_near(unstable_swing_));
}

ClosedMotion CycleTries::shoot_at(NearlyClosed motion) {
  ClosedMotion closed = close_motion(loop_, motion, options_.shooting);
  steps_ += closed.steps;
  if (!closed.half || !is_displaced(motion) || !lies_beside(closed.shot, motion.change)) return closed;
  motion.odd = false;
  ClosedMotion whole = close_motion(loop_, motion, options_.shooting);
  steps_ += whole.steps;
  return whole.shot.status == Status::converged ? whole : closed;
}

/// True if a motion may have to do with a cycle that is not symmetric, though one that is has been found: it slows down
/// beside an unstable one, or the other is stable and does not attract it yet.
bool CycleTries::lies_beside(const ShootingResult& symmetric, double change) {
  if (symmetric.status != Status::converged) return false;
  const bool slows = change < 0.5 * beside_;
  beside_ = change;
  return slows || symmetric.cycle.stable == true;
}

std::optional<CycleFound> CycleTries::judge(const NearlyClosed& motion, ClosedMotion closed) {
  ShootingResult& shot = closed.shot;
  if (shot.status == Status::interrupted) return CycleFound{Outcome::undecided, "interrupted", {}, {}};
  if (shot.status != Status::converged) return std::nullopt;
  const bool beside = closed.half && is_displaced(motion);
  const double mismatch =
      std::max(std::abs(2.0 * shot.cycle.amplitude / motion.swing - 1.0), beside ? motion.offset : 0.0);
  if (shot.cycle.stable == false) {
    unstable_swing_ = 2.0 * shot.cycle.amplitude;
    if (mismatch < 0.1) pass(shot.cycle);
    return std::nullopt;
  }
  if (!shot.cycle.stable && mismatch < 0.01)
    if (auto found = look_around(closed)) return found;
  // Still far from the cycle, but nearer to it than at the last try: a slow approach.
  const bool nearer =
      candidate_ && std::abs(candidate_->period / shot.cycle.period - 1.0) < 1e-6 && mismatch < 0.8 * mismatch_;
  if (!shot.cycle.stable || ((beside || mismatch > 0.1) && !nearer)) {
    candidate_ = shot.cycle;
    mismatch_ = mismatch;
    return std::nullopt;
  }
  return CycleFound{Outcome::cycle,
                    nearer ? "approaches a cycle, confirmed by shooting" : "periodic, confirmed by shooting",
                    {},
                    std::move(shot)};
}

/// Of a cycle whose multipliers do not tell if it is stable: what the motions beside it do. It is stable after that
/// where nothing is returned.
std::optional<CycleFound> CycleTries::look_around(ClosedMotion& closed) {
  ShootingResult& shot = closed.shot;
  Surroundings around(loop_, shot.cycle, closed.section, closed.shooting, options_.rtol);
  std::optional<CycleFound> found;
  if (contracts_but_once(shot) && around.has_twins(shot.neutral))
    keep_one(shot.cycle);
  else if (around.attracts())
    shot.cycle.stable = true;
  else if (around.has_neighbour(closed.half))
    found = {Outcome::family, "periodic, one of a family of periodic motions whose size depends on the start", {}, {}};
  else
    found = {Outcome::undecided, "periodic, but its stability was not determined (multiplier 1)", {}, {}};
  steps_ += around.steps();
  return found;
}

/// Keeps an unstable cycle that the motion passes, once.
void CycleTries::pass(const Cycle& cycle) {
  constexpr double same = 1e-4;
  if (loop_.continuous) return;  // the samples make many of them, in a narrow band
  const bool known = std::ranges::any_of(passed_, [&](const Cycle& one) {
    return std::abs(one.period / cycle.period - 1.0) < same && std::abs(one.amplitude / cycle.amplitude - 1.0) < same;
  });
  if (!known) passed_.push_back(cycle);
}

}  // namespace limcycle
