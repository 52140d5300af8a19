#include "limcycle/analysis/study/predict/prediction_check.hpp"

#include <numbers>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/orbit_guess.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

void conclude_without_cycle(Prediction& p, const OutcomeOfStart& outcome) {
  const bool decided = outcome.outcome != Outcome::undecided;
  if (p.stable == true && decided) {
    p.verdict = Verdict::wrong;
    p.why = "spurious: a simulation from it ends in " + std::string(to_string(outcome.outcome)) +
            (outcome.cycle ? " " + std::to_string(*outcome.cycle) : "");
  } else {
    p.why = p.stable == true ? "unverified: the simulation from it is undecided"
                             : "unverified: no unstable cycle was found near it";
  }
}

}  // namespace

PredictionCheck::PredictionCheck(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop)
    : loop_(loop), hunt_(hunt), for_simulations_(max_steps), for_searches_(max_steps), stop_(stop) {}

void PredictionCheck::check(Prediction& p, const LoopState& start, std::string name) {
  if (for_simulations_ < 0) {
    ++unchecked_;
    if (const auto cycle = nearest(hunt_.cycles(), p);
        cycle && (!p.stable || hunt_.cycles()[*cycle].stable == p.stable))
      return compare(p, hunt_.cycles(), *cycle);
    p.why = "unverified: step limit reached";
    return;
  }
  if (p.method == df_name && p.stable != true && for_searches_ >= 0 && !loop_.continuous && find_unstable(p)) return;
  const long before = hunt_.steps();
  const OutcomeOfStart& outcome = hunt_.settle_from(start, std::move(name));
  for_simulations_ -= hunt_.steps() - before;
  // A stable prediction refers to the cycle that it leads to, unless it is extremely far from it.
  if (outcome.cycle && p.stable != false && nearest({hunt_.cycles()[*outcome.cycle]}, p))
    return compare(p, hunt_.cycles(), *outcome.cycle);
  if (const auto cycle = nearest(hunt_.cycles(), p); cycle && (!p.stable || hunt_.cycles()[*cycle].stable == p.stable))
    return compare(p, hunt_.cycles(), *cycle);
  // The criterion of a balance may err: a stable cycle at its place is what it predicted.
  if (outcome.cycle && is_close(p, hunt_.cycles()[*outcome.cycle])) return compare(p, hunt_.cycles(), *outcome.cycle);
  if (loop_.continuous && outcome.outcome == Outcome::irregular && p.stable != false && compare(p, outcome.irregular))
    return;
  conclude_without_cycle(p, outcome);
}

bool PredictionCheck::find_unstable(Prediction& p) {
  const long before = hunt_.steps();
  const bool found = unstable_cycle_near(p);
  for_searches_ -= hunt_.steps() - before;
  return found;
}

/// Newton's method for the cycle from the predicted oscillation itself, before the motion departs; if that ends
/// elsewhere, the border between the outcomes of larger and smaller oscillations.
bool PredictionCheck::unstable_cycle_near(Prediction& p) {
  const bool odd = symmetry(loop_).has_value();
  const FirstHarmonicBalance balance(loop_);
  const auto linear = [&](double phase, double scale) {
    return balance.linear_state(p.input_amplitude, p.frequency, phase, scale);
  };
  const auto accept = [&](std::optional<std::size_t> cycle) {
    if (!cycle || hunt_.cycles()[*cycle].stable != false || !nearest({hunt_.cycles()[*cycle]}, p)) return false;
    compare(p, hunt_.cycles(), *cycle);
    return true;
  };
  for (const double scale : {1.0, 0.9, 1.1}) {
    if (stopped()) return false;
    const auto states = [&](double phase) { return linear(phase, scale); };
    if (accept(hunt_.shoot_from(guess_orbit(loop_, states, p.frequency, odd)))) return true;
  }
  const auto ray = [&](double scale) { return without_history(loop_, linear(0.0, scale)); };
  return !stopped() && accept(hunt_.edge_along(ray, 2.0 * std::numbers::pi / p.frequency));
}

}  // namespace limcycle
