#pragma once
#include <vector>

namespace limcycle {

/// Amplitudes of the harmonics 1..`orders` of a periodic signal that is linear between its samples (two samples at one
/// time: a jump): |c_k|, c_k = 2/T int f(t) exp(-j k w t) dt, each piece integrated exactly. Linear interpolation
/// reduces the amplitude of a smooth signal by (k w h)^2/12 of it, with h the time between samples. The last sample is
/// one period after the first. Empty for fewer than two samples or a period that is not positive. Cost: O(samples
/// orders).
std::vector<double> harmonic_amplitudes(const std::vector<double>& t, const std::vector<double>& values, double period,
                                        int orders);

}  // namespace limcycle
