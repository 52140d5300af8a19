#include "limcycle/analysis/orbit/settle/watch/stillness_watch.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Most motions at rest are recognised earlier; only then is the algebra of a slow decay worth its cost.
constexpr int patience = 12;
constexpr double drift = 1e-6;  ///< rates below this are rounding, in sizes per slowest time constant
constexpr double fades = 1e-6;  ///< largest rate of a state of rest that no algebra confirms, likewise

}  // namespace

StillnessWatch::StillnessWatch(const Loop& loop, State sizes, double slow, double rtol)
    : loop_(loop), scale_{sizes, slow}, rest_(std::move(sizes), slow, rtol) {}

std::optional<Stillness> StillnessWatch::look(double t, const State& x, const State& dx,
                                              const std::vector<Mode>& modes) {
  if (t < rest_.next() || loop_.continuous) return std::nullopt;
  constexpr double for_ever = 1e6;  // slowest time constants
  const auto verdict = rest_.look(t, x, dx);
  const bool waits = t - rest_.since() > for_ever * scale_.slow && rest_.rate(dx) <= rest_.noise();
  const bool algebra = ++looks_ >= patience && t >= next_algebra_;
  if (verdict == RestWatch::Verdict::moving && !algebra && !waits) return std::nullopt;
  LoopField field(loop_);
  field.modes() = modes;
  if (waits && is_stuck(field)) return Stillness{Outcome::rest, "came to rest, but for a drift within rounding"};
  if (verdict == RestWatch::Verdict::at_rest) return at_rest(field, x, dx);
  if (verdict == RestWatch::Verdict::steady && slides_steadily(field, x, dx, scale_))
    return Stillness{Outcome::sliding, "slides at constant speed"};
  if (verdict == RestWatch::Verdict::steady && held_while_winding_up(field, x, dx, scale_))
    return Stillness{Outcome::rest, rest_.rate(dx) > drift ? "held at rest for ever, although the controller winds up"
                                                           : "came to rest, but for a drift within rounding"};
  if (!algebra) return std::nullopt;
  next_algebra_ = 1.5 * t;
  const auto approach = approach_from(field, x, scale_);
  if (!approach) return std::nullopt;
  return Stillness{approach->to.slides ? Outcome::sliding : Outcome::rest,
                   "the motion decays linearly, at a rate of at least " + short_number(approach->decay, 3) + " 1/s"};
}

std::optional<Stillness> StillnessWatch::read(double t, const State& x, const LoopField& field) {
  constexpr double nearly = 1.0 - 1e-9;
  const double passed = t - read_at_;
  if (!read_.empty() && passed < nearly * repetition_time(loop_)) return std::nullopt;
  State mean(x.size());
  for (std::size_t i = 0; i < read_.size(); ++i) mean[i] = (x[i] - read_[i]) / passed;
  const bool first = read_.empty();
  read_ = x;
  read_at_ = t;
  if (first) return std::nullopt;
  const auto verdict = rest_.look(t, x, mean);
  if (verdict == RestWatch::Verdict::moving) return std::nullopt;
  const bool steady = verdict == RestWatch::Verdict::steady, fading = rest_.rate(mean) <= fades;
  if (!steady && !fading) return std::nullopt;
  // A body that creeps to rest rubs as well, ever more slowly.
  if (fading ? slides_at_rest(loop_) : rubs_at(field, x))
    return Stillness{Outcome::sliding, "slides at constant speed"};
  return steady ? std::nullopt : std::optional(Stillness{Outcome::rest, "came to rest"});
}

std::optional<Stillness> StillnessWatch::switched(double t, const State& x, const State& dx) {
  constexpr int many = 50;
  restart(t);
  idle_ = rest_.rate(dx) <= rest_.noise() ? idle_ + 1 : 0;
  return idle_ >= many || trembles(t, x) ? std::optional(but_for_switching()) : std::nullopt;
}

bool StillnessWatch::trembles(double t, const State& x) {
  constexpr int many = 200;
  constexpr double slowest_times = 3.0;
  bool stays = about_.size() == x.size();
  // Plant and controller: the places of return points fill and empty as the law takes them up and lets them go.
  const auto moving = static_cast<std::size_t>(loop_.states());
  for (std::size_t i = 0; stays && i < moving; ++i)
    stays = std::abs(x[i] - about_[i]) <= rest_.rtol() * scale_.sizes[i];
  if (!stays) {
    about_ = x;
    about_since_ = t;
    about_times_ = 0;
  }
  return ++about_times_ >= many && t - about_since_ >= slowest_times * scale_.slow;
}

std::optional<Stillness> StillnessWatch::within_rounding(const State& dx) const {
  return rest_.rate(dx) <= rest_.noise() ? std::optional(but_for_switching()) : std::nullopt;
}

Stillness StillnessWatch::but_for_switching() const {
  if (slides_at_rest(loop_)) return {Outcome::sliding, "slides at constant speed, but for switching within rounding"};
  return {Outcome::rest, "came to rest, but for switching within rounding"};
}

std::optional<Stillness> StillnessWatch::at_rest(LoopField& field, const State& x, const State& dx) const {
  constexpr double near = 0.01, rounding = 1e-13;
  const auto still = [](bool slides) {
    return slides ? Stillness{Outcome::sliding, "slides at constant speed"} : Stillness{Outcome::rest, "came to rest"};
  };
  if (is_stuck(field) && rest_.rate(dx) > rounding && !approach_from(field, x, scale_) &&
      !held_while_winding_up(field, x, dx, scale_))
    return std::nullopt;
  const auto found = standstill_near(field, x, scale_);
  if (found && found->moved <= near) return still(found->slides);
  // Newton's method fails for a law whose slope jumps at the point of rest: then the rates themselves must vanish.
  if (!(rest_.rate(dx) <= fades)) return std::nullopt;
  return still(slides_at_rest(loop_));
}

}  // namespace limcycle
