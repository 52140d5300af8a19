#pragma once
#include <cmath>

#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// @file
/// Curves phi of a part xi of a way, phi(0) = 0 and phi(1) = 1, concave and rising, continued as odd functions.

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

}  // namespace limcycle
