#include "limcycle/analysis/orbit/cycle/spectrum.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace limcycle {
namespace {

/// int exp(-j x s) ds and int s exp(-j x s) ds over 0..1; their series where x is small.
std::pair<std::complex<double>, std::complex<double>> moments(double x) {
  const std::complex<double> j(0.0, 1.0);
  if (std::abs(x) < 1e-2) {
    std::complex<double> zeroth, first, term = 1.0;
    for (int n = 0; n < 8; ++n) {
      zeroth += term / (n + 1.0);
      first += term / (n + 2.0);
      term *= -j * x / (n + 1.0);
    }
    return {zeroth, first};
  }
  const std::complex<double> turn = std::polar(1.0, -x);
  const std::complex<double> zeroth = (1.0 - turn) / (j * x);
  return {zeroth, (zeroth - turn) / (j * x)};
}

}  // namespace

std::vector<double> harmonic_amplitudes(const std::vector<double>& t, const std::vector<double>& values, double period,
                                        int orders) {
  if (t.size() < 2 || values.size() != t.size() || !(period > 0.0)) return {};
  std::vector<double> amplitudes;
  for (int k = 1; k <= orders; ++k) {
    const double w = 2.0 * std::numbers::pi * k / period;
    std::complex<double> sum;
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const double h = t[i + 1] - t[i];
      const auto [zeroth, first] = moments(w * h);
      sum += std::polar(h, -w * (t[i] - t[0])) * (values[i] * zeroth + (values[i + 1] - values[i]) * first);
    }
    amplitudes.push_back(2.0 / period * std::abs(sum));
  }
  return amplitudes;
}

}  // namespace limcycle
