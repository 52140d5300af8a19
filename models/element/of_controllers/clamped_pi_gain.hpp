#pragma once
#include <complex>
#include <optional>

namespace limcycle {

/// Describing function of ClampedPi for the input A sin wt, limit > 0. Within the limit kp - j ki/w, the integral in
/// the middle of what it may be; beyond it the periodic state, from switch to switch at instants in closed form. Empty
/// if no periodic state is reached in a hundred turns. Error: roundings. Cost: some 30 sines a turn, mostly of two
/// turns.
std::optional<std::complex<double>> clamped_pi_gain(double kp, double ki, double limit, double A, double w);

}  // namespace limcycle
