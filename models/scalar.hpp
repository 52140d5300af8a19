#pragma once
#include <cmath>

namespace limcycle {

/// Plain value of a Scalar, for sizes and checks that need no derivative; dual numbers overload it next to their type.
inline double value_of(double value) { return value; }

/// True if a Scalar has no derivative other than zero; dual numbers overload it.
inline bool is_constant(double) { return true; }

/// Branch-free choice on a Scalar; packs and dual numbers overload it next to their own type.
inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

/// Sign with sign(0) = +1: a law that may be at v = 0 selects its side by its mode, not by this function.
template <class S>
S sign(const S& value) {
  return select(value < 0.0, S(-1.0), S(1.0));
}

/// a^p for a >= 0. The two most common exponents cost a multiplication instead of a pow().
inline double power(double a, double p) { return p == 2.0 ? a * a : p == 1.0 ? a : std::pow(a, p); }

}  // namespace limcycle
