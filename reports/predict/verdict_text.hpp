#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// The answer of a prediction in words: `what_happens` on the behaviour of the loop, and why it hunts if that is known;
/// `worth` one sentence for each method on the quality of its prediction.
struct VerdictText {
  std::string what_happens;
  std::vector<std::string> worth;
};

VerdictText answer(const PredictReport& report, const Units& units);

/// "describing-function" -> "the describing function".
std::string method_in_words(const std::string& method);

}  // namespace limcycle
