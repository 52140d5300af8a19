#pragma once
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

/// Describing functions of one-state laws by the simplest means, independent of the program: classical Runge-Kutta with
/// fixed steps from reversal to reversal, the fixed point of the period map by secants, Simpson's rule.
namespace limcycle::test {

struct OneStateReference {
  std::complex<double> gain;
  double mean = 0.0, work = 0.0;
};

/// `rate(v, z)` is dz/dt, `force(x, v, z)` the output, under x = bias t + A sin wt; x is passed to `force` without the
/// drift. `steps` (even) per stretch between reversals, closer together near the reversals. `symmetric`: the half-wave
/// symmetric state is wanted. `guess`: a state to begin with, of the size of the state.
template <class Rate, class Force>
OneStateReference one_state_reference(double A, double w, double bias, Rate rate, Force force, bool symmetric,
                                      int steps, double guess) {
  const double pi = std::numbers::pi, ratio = bias / (A * w);
  const bool reverses = std::abs(ratio) < 1.0;
  // Phase of the reversal from forward to backward, and lengths of the backward and the forward stretch.
  const double origin = reverses ? std::acos(-ratio) : 0.0;
  const double lengths[2] = {reverses ? 2.0 * std::acos(ratio) : 2.0 * pi, reverses ? 2.0 * origin : 0.0};
  std::complex<double> sum;
  double mean = 0.0, work = 0.0;
  const auto stretch = [&](double from, double length, double z) {
    const double h = 1.0 / steps;
    const auto phase = [&](double s) { return from + length * (s - std::sin(2.0 * pi * s) / (2.0 * pi)); };
    const auto pace = [&](double s) { return length * 2.0 * std::sin(pi * s) * std::sin(pi * s); };
    const auto speed = [&](double s) { return bias + A * w * std::cos(phase(s)); };
    const auto slope = [&](double s, double state) { return rate(speed(s), state) * pace(s) / w; };
    for (int k = 0; k <= steps; ++k) {
      const double s = k * h, theta = phase(s), F = force(A * std::sin(theta), speed(s), z);
      const double part = (k == 0 || k == steps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / 3.0 * h * pace(s);
      sum += part * F * std::complex<double>(std::sin(theta), std::cos(theta)) / (pi * A);
      mean += part * F / (2.0 * pi);
      work += part * F * speed(s) / w;
      if (k == steps) break;
      const double k1 = slope(s, z), k2 = slope(s + 0.5 * h, z + 0.5 * h * k1);
      const double k3 = slope(s + 0.5 * h, z + 0.5 * h * k2), k4 = slope(s + h, z + h * k3);
      z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return z;
  };
  const auto map = [&](double z) {
    sum = mean = work = 0.0;
    z = stretch(origin, lengths[0], z);
    if (symmetric) return -z;
    return lengths[1] > 0.0 ? stretch(origin + lengths[0], lengths[1], z) : z;
  };
  double z = guess, image = map(z), before = z, image_before = image;
  for (int k = 0; k < 60 && std::abs(image - z) > 1e-14 * std::abs(guess); ++k) {
    const double change = (image - image_before) - (z - before);
    const double next = k == 0 || change == 0.0 ? image : z - (image - z) * (z - before) / change;
    before = z;
    image_before = image;
    z = next;
    image = map(z);
  }
  if (symmetric) return {2.0 * sum, 0.0, 2.0 * work};
  return {sum, mean, work};
}

}  // namespace limcycle::test
