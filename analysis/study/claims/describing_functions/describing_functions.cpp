#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"

namespace limcycle {

std::vector<Claim> describing_function_claims() {
  std::vector<Claim> all;
  for (const auto list :
       {memoryless_gain_claims, coulomb_gain_claims, stop_gain_claims, masing_gain_claims, dahl_gain_claims})
    for (GainClaim& claim : list()) all.push_back(as_claim(std::move(claim)));
  for (const auto list : {gain_relation_claims, friction_gain_claims}) {
    auto some = list();
    all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  // A2 before A10, A11 before A11a.
  std::ranges::sort(all, {}, [](const Claim& claim) { return std::pair(std::stoi(claim.id.substr(1)), claim.id); });
  return all;
}

}  // namespace limcycle
