#include "limcycle/questions/margin.hpp"

#include <cmath>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/questions/threshold.hpp"

namespace limcycle {
namespace {

MarginParameter margin_parameter(const Case& from, const CaseNumber& number) {
  return {number.path, number.unit, number.value, number.path.starts_with("loop.friction."),
          LoopVariation(from, "parameter", number.path)};
}

}  // namespace

std::vector<MarginParameter> margin_parameters(const Case& from, const std::string& argument,
                                               const std::vector<std::string>& paths, std::vector<std::string>& notes) {
  std::vector<MarginParameter> chosen;
  for (const auto& number : threshold_numbers(from, argument, paths)) chosen.push_back(margin_parameter(from, number));
  if (!chosen.empty()) return chosen;
  std::string zero;
  for (const auto& number : numbers_of(from)) {
    if (number.follows || !std::isfinite(number.value)) continue;
    if (number.value != 0.0)
      chosen.push_back(margin_parameter(from, number));
    else
      zero += (zero.empty() ? "" : ", ") + number.path;
  }
  if (!zero.empty()) notes.push_back("skipped, because the value is 0: " + zero);
  return chosen;
}

MarginReport ask_margin(const Case& from, const std::vector<MarginParameter>& parameters, double factor,
                        const Asking& asking) {
  MarginOptions options;
  options.factor = factor;
  options.predict = from.predict;
  options.predict.stop = asking.stop;
  options.predict.progress = asking.progress;
  return margin(build_loop(need_loop(from)), parameters, options);
}

}  // namespace limcycle
