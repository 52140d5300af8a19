#include "limcycle/analysis/study/continuation/outcome_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"

namespace limcycle {
namespace {

constexpr double looked_beyond = 0.03;  ///< relative distance at which a change is looked at once more

}  // namespace

OutcomeSide::OutcomeSide(const MarginParameter& parameter, bool up, const MarginOptions& options, Starts starts,
                         std::function<void(double)> progress)
    : parameter_(parameter),
      options_(options),
      starts_(std::move(starts)),
      progress_(std::move(progress)),
      limit_(up ? parameter.value * options.factor : parameter.value / options.factor) {}

OutcomeSide::Does OutcomeSide::does(double p) {
  const auto loop = parameter_.family(p);
  if (!loop) return Does::invalid;
  const Loop time = loop_in_time(*loop, 0.0).treated.loop;
  SettleOptions settling = cycle_search(time, starts_.box, options_.accuracy, options_.predict.stop);
  settling.known_irregular = known_;
  Does all = Does::ends;
  for (const double place : starts_.displacements) {
    const Settled motion = settle(time, displaced(time, place), settling);
    switch (motion.outcome) {
      case Outcome::irregular:
        known_.push_back(motion.irregular);
        return Does::hunts;
      case Outcome::cycle:
        if (motion.shot && motion.shot->cycle.stable == true) return Does::hunts;
        all = Does::undecided;
        break;
      case Outcome::rest:
      case Outcome::sliding:
        break;
      case Outcome::divergence:
        if (all == Does::ends) all = Does::diverges;
        break;
      default:
        all = Does::undecided;
    }
    if (stopped()) return Does::undecided;
  }
  return all;
}

/// Halves the distance of the two values until they are close, or a simulation does not decide.
void OutcomeSide::bisect(bool hunts, Change& change) {
  constexpr double narrow = 2e-3;
  while (std::abs(std::log(change.changed / change.as_now)) > narrow && !stopped()) {
    const double middle = change.as_now * std::sqrt(change.changed / change.as_now);
    const Does here = does(middle);
    if (here == Does::undecided || here == Does::invalid) return;
    const bool same = (here == Does::hunts) == hunts;
    if (!same) change.then = here;
    (same ? change.as_now : change.changed) = middle;
  }
}

/// A value a little beyond the change at which the loop does again what it does at its own: near an edge a motion that
/// never repeats itself may end by chance. Nothing if there is none short of `far`.
std::optional<double> OutcomeSide::as_now_beyond(bool hunts, const Change& change, double far) {
  const double outward = change.changed / change.as_now > 1.0 ? 1.0 : -1.0;
  for (const double farther : {1.01, 1.0 + looked_beyond}) {
    const double p = change.changed * std::pow(farther, outward);
    if (stopped() || std::abs(std::log(p / parameter_.value)) >= std::abs(std::log(far / parameter_.value))) break;
    if ((does(p) == Does::hunts) == hunts) return p;
  }
  return std::nullopt;
}

MarginSide OutcomeSide::located(bool hunts, Change change) {
  constexpr int rounds = 4;
  const double far = change.changed;
  const Does at_far = change.then;
  for (int i = 0; i < rounds && !stopped(); ++i) {
    bisect(hunts, change);
    if (progress_) progress_(0.5 + 0.5 * (i + 1) / rounds);
    const auto again = as_now_beyond(hunts, change, far);
    if (!again) break;
    change = {*again, far, at_far};
  }
  if (stopped()) return {};
  using What = MarginSide::What;
  const Does then = change.then;
  const std::string now = hunts ? "it hunts" : "it does not hunt";
  const std::string other = then == Does::hunts ? "it hunts" : then == Does::diverges ? "it diverges" : "it does not";
  const bool begins_to_diverge = !hunts && then == Does::diverges;
  MarginSide side{hunts               ? What::ends
                  : begins_to_diverge ? What::none
                                      : What::begins,
                  change.changed, std::abs(change.changed / change.as_now - 1.0) + looked_beyond,
                  "by bisection of the outcome: at " + short_number(change.as_now, 5) + " " + now + ", at " +
                      short_number(change.changed, 5) + " " + other};
  side.diverges = then == Does::diverges;
  if (begins_to_diverge) side.error = std::numeric_limits<double>::quiet_NaN();
  return side;
}

/// Between the last value that was tried and one at which the case is not valid: at the last that is, from which the
/// loop may have changed.
MarginSide OutcomeSide::to_validity(bool hunts, double last, double invalid) {
  constexpr int halvings = 50;
  double valid = last;
  for (int i = 0; i < halvings && valid != invalid; ++i) {
    const double middle = 0.5 * (valid + invalid);
    (parameter_.family(middle) ? valid : invalid) = middle;
  }
  const Does there = does(valid);
  if (there != Does::undecided && (there == Does::hunts) != hunts) return located(hunts, {last, valid, there});
  const std::string end = ", beyond which the case is not valid";
  if (there == Does::undecided)
    return {MarginSide::What::unknown, hunts ? last : 0.0, std::numeric_limits<double>::quiet_NaN(),
            "simulations at " + short_number(valid, 5) + end + ", did not decide"};
  return {MarginSide::What::none, valid, 0.0,
          (hunts ? "it hunts all the way to " : "it does not hunt up to ") + short_number(valid, 5) + end};
}

MarginSide OutcomeSide::where_it_changes(bool hunts) {
  using What = MarginSide::What;
  const int steps = std::max(1, static_cast<int>(std::ceil(options_.scan_per_decade * std::log10(options_.factor))));
  double last = parameter_.value;
  for (int i = 1; i <= steps && !stopped(); ++i) {
    const double p = parameter_.value * std::pow(limit_ / parameter_.value, static_cast<double>(i) / steps);
    if (progress_) progress_(0.5 * static_cast<double>(i) / (steps + 1));
    const Does here = does(p);
    if (here == Does::undecided)
      return {What::unknown, hunts ? last : 0.0, std::numeric_limits<double>::quiet_NaN(),
              "simulations at " + short_number(p, 5) + " did not decide"};
    if (here == Does::invalid) return to_validity(hunts, last, p);
    if ((here == Does::hunts) != hunts) return located(hunts, {last, p, here});
    last = p;
  }
  return {What::none, last, 0.0,
          (hunts ? "it hunts at all values that were tried, to " : "it does not hunt up to ") + short_number(last, 5)};
}

}  // namespace limcycle
