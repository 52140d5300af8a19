#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/remedy/hunts.hpp"

namespace limcycle {

/// Why a loop hunts.
enum class CauseKind {
  integral_action_and_stiction,
  negative_slope,
  delay,
  relay,
  over_compensation,
  saturation,
  quantization,
  undecided
};
std::string_view to_string(CauseKind kind);

/// The loop without one of its features, simulated from the same starts.
struct Counterfactual {
  std::string without;  ///< "without integral action"
  Hunts hunts = Hunts::undecided;
};

/// The cause, and the tests that decided it.
struct Cause {
  CauseKind kind = CauseKind::undecided;
  std::string why;  ///< one sentence
  std::vector<Counterfactual> tests = {};
};

/// Decides why a loop that hunts does so, by taking one feature away at a time and judging whether it still hunts.
/// Tested in this order, as far as the loop has them: the friction compensation; dead times and sampling; integral
/// action; stiction and the falling part of the friction curve (Fs lowered to Fc, a measured curve to its least force);
/// a relay (replaced by a saturation that reaches the same level at twice the amplitude of its input); limits of the
/// command. Integral action and stiction count as the cause if the loop does not hunt without either of them; the
/// falling curve alone, if taking it away ends hunting and taking the integral action away does not. `cycles`: of the
/// loop as it stands. Cost: hunts() for each feature.
Cause cause_of(const LoopParts& parts, const Judging& judging, const std::vector<Cycle>& cycles);

}  // namespace limcycle
