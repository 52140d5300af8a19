#pragma once
#include <cmath>

#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// @file
/// Branch curves phi(xi), xi a fraction of the path: phi(0) = 0, phi(1) = 1, concave, increasing, continued as odd.

/// xi (1 - ln |xi|) (Koizumi and Shibazaki), 1 beyond 1. Its slope -ln xi is infinite at 0; here it is kept below
/// 1 + ln 1e18 = 42.4, which changes the value by less than 1e-17.
template <class S>
S koizumi_shibazaki_curve(const S& xi) {
  using std::abs;
  using std::log;
  const S size = abs(xi), least(1e-18);
  if (size >= 1.0) return sign(xi);
  return xi * (1.0 - log(select(size > least, size, least)));
}

/// (1 - exp(-shape xi))/(1 - exp(-shape)), shape > 0.
template <class S>
S exponential_curve(const S& xi, const S& shape) {
  using std::abs;
  using std::exp;
  return sign(xi) * (1.0 - exp(-shape * abs(xi))) / (1.0 - exp(-shape));
}

/// (1 + shape) xi/(1 + shape xi), shape > 0.
template <class S>
S rational_curve(const S& xi, const S& shape) {
  using std::abs;
  return (1.0 + shape) * xi / (1.0 + shape * abs(xi));
}

/// @name Energy under the curves
/// int_0^xi eta phi'(eta) d eta for xi >= 0: the energy stored in the springs of the equivalent stop elements, loaded
/// from rest along the curve, in units of level times path. Error: rounding relative to 1.
/// @{
template <class S>
S koizumi_shibazaki_energy(const S& xi) {
  using std::log;
  const S least(1e-18);
  if (xi >= 1.0) return S(0.25);
  return 0.25 * xi * xi * (1.0 - 2.0 * log(select(xi > least, xi, least)));
}
template <class S>
S exponential_energy(const S& xi, const S& shape) {
  using std::exp;
  const S u = shape * xi, left = exp(-u);
  return (1.0 - left - u * left) / (shape * (1.0 - exp(-shape)));
}
template <class S>
S rational_energy(const S& xi, const S& shape) {
  using std::log;
  const S u = shape * xi;
  return (1.0 + shape) / (shape * shape) * (log(1.0 + u) - u / (1.0 + u));
}
/// @}

}  // namespace limcycle
