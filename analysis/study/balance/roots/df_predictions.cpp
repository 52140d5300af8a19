#include "limcycle/analysis/study/balance/roots/df_predictions.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/balance/roots/root_spread.hpp"
#include "limcycle/analysis/study/predict/failure_note.hpp"

namespace limcycle {

namespace {

/// For a root of the describing function: 1 + N G, and the amplitude of y.
RootOf root_of_df() {
  constexpr double accuracy = 1e-10;
  return {[](const Loop& loop, double A, double w) { return FirstHarmonicBalance(loop)(A, w, accuracy); },
          [](const Loop& loop, double A, double w) { return FirstHarmonicBalance(loop).output_amplitude(A, w); }};
}

void predict_into(DfPredictions& result, const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                  const PredictOptions& options, long max_evaluations) {
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
    p.spread = root_spread(loop, root_of_df(), root.amplitude, root.frequency);
    p.sampling = sampling_band(loop, root_of_df(), root.amplitude, root.frequency);
    result.predictions.push_back(std::move(p));
  }
  if (options.stop && options.stop()) return;
  if (result.predictions.empty()) result.absence = absence(loop, box);
  result.exists = found.status != Status::not_finite;
}

}  // namespace

DfPredictions df_predictions(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                             const PredictOptions& options, long max_evaluations) {
  DfPredictions result;
  try {
    predict_into(result, loop, balance, box, options, max_evaluations);
  } catch (const std::invalid_argument& refused) {  // numbers of the loop beyond the range of the method
    result.notes.push_back(failure_note(refused.what()));
    result.status = Status::incomplete;
  }
  return result;
}

}  // namespace limcycle
