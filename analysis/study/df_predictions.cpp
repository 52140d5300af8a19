#include "limcycle/analysis/study/df_predictions.hpp"

#include <cmath>

#include "limcycle/analysis/study/df_roots.hpp"

namespace limcycle {

DfPredictions df_predictions(const Loop& loop, const LoopBalance& balance, const SearchBox& box,
                             const PredictOptions& options, long max_evaluations) {
  DfPredictions result;
  auto found = find_df_roots(loop, balance, box, options.stop, max_evaluations);
  result.notes = std::move(found.notes);
  result.status = found.status;
  for (const Root& root : found.roots) {
    Prediction p;
    p.method = DfPredictions::method;
    p.input_amplitude = root.amplitude;
    p.amplitude = balance.output_amplitude(root.amplitude, root.frequency);
    p.frequency = root.frequency;
    p.residual = std::abs(balance(root.amplitude, root.frequency, 1e-12));
    p.stable = balance.stable(root.amplitude, root.frequency, root.index);
    p.trust = trust(loop, balance, root.amplitude, root.frequency);
    result.predictions.push_back(std::move(p));
  }
  if (options.stop && options.stop()) return result;
  if (result.predictions.empty()) result.absence = absence(loop, box);
  if (!options.nyquist) return result;
  std::vector<SearchPoint> roots;
  for (const Root& root : found.roots) roots.push_back({root.amplitude, root.frequency});
  result.nyquist = nyquist_picture(loop, box, roots, options.stop);
  return result;
}

}  // namespace limcycle
