#include "limcycle/cli/decided.hpp"

#include <algorithm>

namespace limcycle {

bool decided(const PredictReport& report) {
  return !report.cycles.empty() ||
         std::ranges::any_of(report.outcomes, [](const auto& one) { return one.outcome != Outcome::undecided; });
}

}  // namespace limcycle
