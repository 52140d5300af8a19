#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/argument_error.hpp"
#include "limcycle/analysis/frequency/describing_function/df_table.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {

void validate(const DfOptions& options) {
  if (options.harmonics < 1 || options.harmonics > 1000)
    refuse("describing function", "harmonics", options.harmonics, "must lie in 1..1000");
  if (options.threads < 0 || options.threads > 1024)
    refuse("describing function", "threads", options.threads, "must lie in 0..1024");
  if (!is_available(options.isa))
    throw std::invalid_argument("describing function: instruction set " + std::string(to_string(options.isa)) +
                                " is not available here");
  if (!(options.accuracy >= 1e-13 && options.accuracy <= 0.1))
    refuse("describing function", "accuracy", options.accuracy, "must lie in 1e-13..0.1");
}

void validate(const DfPoint& point) {
  if (!(point.amplitude > 0.0) || !std::isfinite(point.amplitude))
    refuse("describing function", "amplitude", point.amplitude, "must be positive and finite");
  if (!(point.frequency > 0.0) || !std::isfinite(point.frequency))
    refuse("describing function", "frequency", point.frequency, "must be positive and finite");
  if (!std::isfinite(point.bias)) refuse("describing function", "bias", point.bias, "must be finite");
}

DescribingFunction describing_function(const Element& element, const DfPoint& point, const DfOptions& options) {
  return DfTable(element, {}, options).at(point);
}

std::vector<DescribingFunction> describing_function_table(const Element& element, std::vector<DfPoint> points,
                                                          const DfOptions& options, const std::function<bool()>& stop,
                                                          const std::function<void(std::size_t)>& progress) {
  const std::size_t count = points.size();
  DfTable table(element, std::move(points), options);
  std::vector<DescribingFunction> results(count);
  std::vector<bool> known(count, false);
  SweepTask task{count, 1, table.block(), {}};
  task.compute = [&](std::span<const std::size_t> which, std::span<double>) {
    // A block is contiguous, as nothing is known beforehand.
    return which.empty() ? 0 : table.compute(which, std::span(results).subspan(which.front(), which.size()), stop);
  };
  const auto sink = [&](std::span<const std::size_t> which, std::span<const double>) {
    for (const std::size_t k : which) known[k] = true;
  };
  SweepOptions how;
  how.threads = options.threads;
  if (progress)
    how.progress = [&](std::size_t done, std::size_t) {
      if (done > 0) progress(done);
    };
  run_sweep(task, {}, sink, how);
  results.resize(static_cast<std::size_t>(std::ranges::find(known, false) - known.begin()));
  return results;
}

}  // namespace limcycle
