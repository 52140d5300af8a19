#pragma once
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/predict/predict.hpp"

/// Predictions by one method out of several.
namespace limcycle::test {

/// The describing function alone, for tests that are about it.
inline PredictOptions df_only(std::optional<SearchBox> box = {}) {
  PredictOptions options;
  options.methods = {.describing_function = true, .composite = false, .harmonic_balance = false};
  options.search = box;
  return options;
}

/// The roots of the describing function, hardly checked: the work is stopped as soon as they are found.
inline PredictOptions roots_only(std::optional<SearchBox> box = {}) {
  auto options = df_only(box);
  options.starts = 0;
  const auto found = std::make_shared<bool>(false);
  options.progress = [found](double fraction, std::string_view) { *found = fraction > 0.65; };
  options.stop = [found] { return *found; };
  return options;
}

inline std::vector<Prediction> predictions_of(const PredictReport& report, std::string_view method) {
  std::vector<Prediction> own;
  std::ranges::copy_if(report.predictions, std::back_inserter(own),
                       [&](const Prediction& p) { return p.method == method; });
  return own;
}

/// True if the report states that the method misses this cycle.
inline bool misses(const PredictReport& report, std::string_view method, std::size_t cycle) {
  return std::ranges::any_of(report.missed,
                             [&](const Missed& one) { return one.method == method && one.cycle == cycle; });
}

}  // namespace limcycle::test
