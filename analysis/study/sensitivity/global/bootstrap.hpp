#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/study/sensitivity/global/estimate.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

namespace limcycle {

/// Numbers computed from units of a sample, of which unit k counts weights[k] times; empty if undetermined.
using Statistics = std::function<std::vector<std::optional<double>>(std::span<const double> weights)>;

/// Statistics of the sample itself (all weights 1), each with a 95 % interval by bootstrap: as many units are drawn
/// again with replacement, `resamples` times over, and the interval lies between percentiles of the results. These are
/// farther apart than 2.5 and 97.5, by Student's t against the normal distribution and by sqrt(u / (u - 1)), because
/// few units u would make it too short (T. Hesterberg, What teachers should know about the bootstrap, The American
/// Statistician 69, 2015). Cost: resamples + 1 calls. The interval stays infinite with fewer than 8 units or 100
/// resamples, and if more than one resample in forty has no result (the end of an interval may lie there).
std::vector<Estimate> bootstrap(std::size_t units, std::size_t resamples, RandomStream random,
                                const Statistics& statistics);

}  // namespace limcycle
