#include "limcycle/questions/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/questions/asking/argument_error.hpp"

namespace limcycle {

std::vector<CaseNumber> own_numbers(const Case& from) {
  std::vector<CaseNumber> numbers = numbers_of(from);
  std::erase_if(numbers, [](const CaseNumber& number) { return !std::isfinite(number.value) || number.follows; });
  return numbers;
}

std::vector<LoopNumber> loop_numbers(const Case& from) {
  std::vector<LoopNumber> numbers;
  for (const auto& number : own_numbers(from))
    numbers.push_back({number.path, number.unit, number.value, LoopVariation(from, "--set", number.path)});
  return numbers;
}

std::vector<CaseNumber> threshold_numbers(const Case& from, const std::string& argument,
                                          const std::vector<std::string>& paths) {
  std::vector<CaseNumber> chosen;
  for (const auto& path : paths) {
    chosen.push_back(number_at(from, argument, path));
    if (chosen.back().value == 0.0 || !std::isfinite(chosen.back().value))
      throw argument_error(argument, path, "is zero or absent: no factor changes it");
  }
  return chosen;
}

ThresholdSensitivity threshold_of(const Case& from, const Loop& loop, const CaseNumber& number,
                                  const std::function<bool()>& stop) {
  MarginOptions options;
  options.predict = from.predict;
  options.predict.methods = {false, false, false};
  options.accuracy = 1e-9;  // derivatives need the fold itself
  options.predict.stop = stop;
  const auto found = margin(loop,
                            {{number.path, number.unit, number.value, number.path.starts_with("loop.friction."),
                              LoopVariation(from, "threshold", number.path)}},
                            options);
  ThresholdSensitivity result{number.path, number.unit, number.value, false, false, 0.0, 0.0, {}, {}};
  if (found.parameters.empty()) {
    result.why = stop && stop() ? "it was interrupted" : "margins are not available for this loop";
    return result;
  }
  const ParameterMargin& one = found.parameters.front();
  const MarginSide* side = one.nearest();
  if (side == nullptr) {
    result.why = "upwards: " + one.up.why + "; downwards: " + one.down.why;
    return result;
  }
  result.known = true;
  result.begins = side->what == MarginSide::What::begins;
  result.at = side->value;
  result.error = side->error;
  result.why = side->why;
  const std::pair<std::string, double> there{number.path, side->value};
  const auto moved = case_with(from, std::span(&there, 1));
  if (!moved) return result;
  const auto numbers = loop_numbers(*moved);
  const auto own = std::ranges::find(numbers, number.path, &LoopNumber::path);
  if (own != numbers.end())
    result.numbers = threshold_sensitivities(build_loop(need_loop(*moved)), *side, numbers,
                                             static_cast<std::size_t>(own - numbers.begin()), stop);
  return result;
}

}  // namespace limcycle
