#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"

#include <algorithm>
#include <iterator>

namespace limcycle {

std::vector<Claim> limit_cycle_claims() {
  using namespace cycle_claims;
  std::vector<Claim> all;
  for (auto* subject : {relay_cycle_claims, smooth_cycle_claims, spring_friction_claims, forced_friction_claims,
                        hunting_claims, stick_claims, sliding_claims})
    std::ranges::move(subject(), std::back_inserter(all));
  return all;
}

}  // namespace limcycle
