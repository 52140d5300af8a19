#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/study/global/estimate.hpp"
#include "limcycle/analysis/study/global/random_stream.hpp"

namespace limcycle {

/// Numbers computed from units of a sample, of which unit k counts weights[k] times; empty where it cannot be told.
using Statistics = std::function<std::vector<std::optional<double>>(std::span<const double> weights)>;

/// Statistics of the sample itself (all weights 1), each with a 95 % interval by bootstrap: as many units are drawn
/// again with replacement, `resamples` times over, and the interval lies between the percentiles of what came out.
/// These are set further apart than 2.5 and 97.5, by Student's t against the normal distribution and by sqrt(u / (u -
/// 1)), or few units u would make it too short (T. Hesterberg, What teachers should know about the bootstrap, The
/// American Statistician 69, 2015). Cost: resamples + 1 calls. The interval stays infinite with fewer than 8 units or
/// 100 resamples, and where more than one resample in forty tells nothing (the end of an interval may lie there).
std::vector<Estimate> bootstrap(std::size_t units, std::size_t resamples, RandomStream random,
                                const Statistics& statistics);

}  // namespace limcycle
