#pragma once
#include <functional>

#include "limcycle/analysis/study/remedy/hunting_edge.hpp"
#include "limcycle/analysis/study/remedy/remedy.hpp"

namespace limcycle {

/// The least size of impulses (see Impulses), in the place of integral action, with which the loop comes to rest within
/// the candidate's band from every start of predict(): sizes at four a decade from half the friction force up to
/// 100 times that, then bisection to 1 %, by two starts alone. That size and two beyond, 3 and 10 % larger, must do so
/// from all. `edges` has where larger impulses make the body hop over the band for ever, as RemedySearch finds it:
/// smaller ones never make a loop without integral action hunt, they leave an error. `reference`: where y is to be.
Remedy impulse_remedy(const RemedyCandidate& candidate, double reference, const HuntingLoop& loop,
                      const std::function<void(double)>& progress);

}  // namespace limcycle
