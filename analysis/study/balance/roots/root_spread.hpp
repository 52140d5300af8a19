#pragma once
#include <complex>
#include <functional>
#include <optional>

#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// What a root (a, w) of a loop solves and gives, for the loop itself and for copies of it whose data differ slightly.
struct RootOf {
  std::function<std::complex<double>(const Loop& loop, double a, double w)> balance;  ///< zero at the root
  std::function<double(const Loop& loop, double a, double w)> amplitude;              ///< of y
};

/// How much a root moves with the uncertainty of measured data: standard deviations of ln amplitude and ln w, from
/// those of the data at w (real and imaginary part independent), to first order by central differences. Empty if no
/// plant states an uncertainty there, or if the balance does not determine both numbers. A describing function reads
/// the data at one frequency, so that the deviation is that of one measurement there, not of a mean over neighbours.
/// Cost: 4 evaluations of both functions, and 4 more for each measured plant.
std::optional<RootSpread> root_spread(const Loop& loop, const RootOf& root, double a, double w);

/// How much a root of a sampled loop moves with the instants of its samples, relative, to first order: what the
/// controller puts out is held for a sample, and an element that waits for it may meet it at its beginning or at its
/// end, half a sample from the mean that the hold stands for. Empty without a sampled controller. Cost: 6 evaluations
/// of both functions.
std::optional<RootSpread> sampling_band(const Loop& loop, const RootOf& root, double a, double w);

}  // namespace limcycle
