/// @file
/// Part "df": LuGre friction of cases/df-lugre.toml under v = A w cos(wt), in a straightforward implementation.
#pragma once

#include <cmath>
#include <complex>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

/// Bristle force f = sigma0 z (N), so that one tolerance is suitable, over the phase t = w time.
template <class Real>
struct Bristle {
  Real amplitude, frequency;
  Real Fs = Real(1.5), Fc = 1, vs = static_cast<Real>(0.001), sigma0 = 100000;
  Real sigma1 = static_cast<Real>(316.22776601683796), sigma2 = static_cast<Real>(0.4);

  Real velocity(Real phase) const {
    using std::cos;
    return amplitude * frequency * cos(phase);
  }
  /// df/dphase at velocity v.
  Real rate_at(Real f, Real v) const {
    using std::abs;
    using std::exp;
    const Real s = v / vs;
    return sigma0 / frequency * (v - abs(v) * f / (Fc + (Fs - Fc) * exp(-s * s)));
  }
  Real force_at(Real f, Real v) const { return f + sigma1 * frequency / sigma0 * rate_at(f, v) + sigma2 * v; }
  Real rate(Real f, Real phase) const { return rate_at(f, velocity(phase)); }
  Real force(Real f, Real phase) const { return force_at(f, velocity(phase)); }
};

/// One point of the 200 x 200 table with its describing function by bench/df_reference.
struct DfReference {
  int index;  ///< in the table, amplitude slowest; negative: one of the 25 points of the plain programs
  double amplitude, frequency;
  std::complex<double> gain;
};

inline std::vector<DfReference> read_df_reference(const char* file) {
  std::ifstream in(file);
  std::vector<DfReference> all;
  DfReference point{};
  double re = 0.0, im = 0.0;
  while (in >> point.index >> point.amplitude >> point.frequency >> re >> im) {
    point.gain = {re, im};
    all.push_back(point);
  }
  if (all.empty()) throw std::runtime_error(std::string("no reference in ") + file);
  return all;
}

}  // namespace bench
