#include "limcycle/analysis/study/composite/composite_predictions.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/balance/roots/root_spread.hpp"
#include "limcycle/analysis/study/predict/failure_note.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"

namespace limcycle {
namespace {

/// For a root of the composite balance: 1 - K N, and the amplitude of y.
RootOf root_of_composite() {
  constexpr double accuracy = 1e-9;
  const auto balance = [](const Loop& loop, double force, double w) {
    return CompositeBalance(loop)(force, w, accuracy);
  };
  return {balance, [balance](const Loop& loop, double force, double w) {
            const std::complex<double> gain = (1.0 - balance(loop, force, w)) / CompositeBalance(loop).rest_of_loop(w);
            const auto f = std::ssize(loop.elements) - 1;
            return std::abs(gain * loop.output_response(w)(f) / loop.element_response(w)(f, f)) * force;
          }};
}

}  // namespace

CompositePredictions composite_predictions(CompositeBalance& balance, const SearchBox& box, long max_steps,
                                           const std::function<bool()>& stop) {
  CompositeSearchOptions options;
  options.frequency_min = box.frequency_min;
  options.frequency_max = box.frequency_max;
  options.max_steps = max_steps;
  options.stop = stop;
  CompositePredictions result;
  CompositeSearch found;
  try {
    found = balance.find(options);
  } catch (const std::invalid_argument& refused) {  // numbers of the loop beyond the range of the method
    found.notes.push_back(failure_note(refused.what()));
    found.status = Status::incomplete;
  }
  for (const CompositeRoot& root : found.roots) {
    Prediction p;
    p.method = composite_name;
    p.input_amplitude = root.input_amplitude;
    p.amplitude = root.amplitude;
    p.frequency = root.frequency;
    p.residual = root.residual;
    p.stable = root.stable;
    if (!root.on_break_away_front) {
      p.spread = root_spread(balance.loop(), root_of_composite(), root.force, root.frequency);
      p.sampling = sampling_band(balance.loop(), root_of_composite(), root.force, root.frequency);
    }
    result.predictions.push_back(std::move(p));
  }
  result.roots = std::move(found.roots);
  result.notes = std::move(found.notes);
  result.effort = {std::string(composite_name), found.evaluations, "periods of mass and friction"};
  result.status = found.status;
  return result;
}

}  // namespace limcycle
