#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// The answer of a prediction in words. `what_happens` says what the loop does, `worth` one sentence for each method on
/// what its prediction was worth.
struct CycleAnswer {
  std::string what_happens;
  std::vector<std::string> worth;
};

CycleAnswer answer(const PredictReport& report, const Units& units);

/// "describing-function" -> "the describing function".
std::string method_in_words(const std::string& method);

}  // namespace limcycle
