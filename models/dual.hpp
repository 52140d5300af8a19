#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// Forward-mode dual number: a value and its N partial derivatives, for laws templated on their scalar.
///
/// Conventions where a function has no derivative: abs'(0) = 0; power(a, p) at a = 0 has derivative a' for p = 1 and 0
/// otherwise; sqrt'(0) = 0. So derivatives are finite wherever values are. Comparisons use values only, and
/// select() takes value and derivatives of the chosen side. Cost: about N + 1 times the plain arithmetic, one exp() or
/// pow() each.
template <int N>
struct Dual {
  static_assert(N > 0);
  double value = 0.0;
  std::array<double, static_cast<std::size_t>(N)> d{};

  Dual() = default;
  Dual(double constant)
      : value(constant) {}  // NOLINT(google-explicit-constructor): constants mix freely with variables

  /// Variable number `index` (0-based): derivative 1 with respect to itself.
  static Dual variable(double value, int index) {
    Dual x(value);
    x.d[static_cast<std::size_t>(index)] = 1.0;
    return x;
  }

  /// f(a) with the chain rule: value f, derivative slope * a'.
  static Dual chain(double f, double slope, const Dual& a) {
    Dual r(f);
    for (std::size_t i = 0; i < r.d.size(); ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  /// f(a, b) with the chain rule.
  static Dual chain(double f, double slope_a, const Dual& a, double slope_b, const Dual& b) {
    Dual r(f);
    for (std::size_t i = 0; i < r.d.size(); ++i) r.d[i] = slope_a * a.d[i] + slope_b * b.d[i];
    return r;
  }

  Dual operator-() const { return chain(-value, -1.0, *this); }
  Dual operator+() const { return *this; }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend Dual operator+(const Dual& a, const Dual& b) { return chain(a.value + b.value, 1.0, a, 1.0, b); }
  friend Dual operator-(const Dual& a, const Dual& b) { return chain(a.value - b.value, 1.0, a, -1.0, b); }
  friend Dual operator*(const Dual& a, const Dual& b) { return chain(a.value * b.value, b.value, a, a.value, b); }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.value / b.value;
    return chain(q, 1.0 / b.value, a, -q / b.value, b);
  }
  friend Dual operator+(const Dual& a, double b) { return chain(a.value + b, 1.0, a); }
  friend Dual operator+(double a, const Dual& b) { return chain(a + b.value, 1.0, b); }
  friend Dual operator-(const Dual& a, double b) { return chain(a.value - b, 1.0, a); }
  friend Dual operator-(double a, const Dual& b) { return chain(a - b.value, -1.0, b); }
  friend Dual operator*(const Dual& a, double b) { return chain(a.value * b, b, a); }
  friend Dual operator*(double a, const Dual& b) { return chain(a * b.value, a, b); }
  friend Dual operator/(const Dual& a, double b) { return chain(a.value / b, 1.0 / b, a); }
  friend Dual operator/(double a, const Dual& b) { return chain(a / b.value, -a / b.value / b.value, b); }

  // Comparisons with a double on either side use the conversion above.
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }

  friend double value_of(const Dual& a) { return a.value; }
  friend bool is_constant(const Dual& a) { return a.d == std::array<double, static_cast<std::size_t>(N)>{}; }
  friend Dual select(bool condition, const Dual& yes, const Dual& no) { return condition ? yes : no; }
  friend Dual abs(const Dual& a) {
    return chain(std::abs(a.value), a.value > 0.0 ? 1.0 : a.value < 0.0 ? -1.0 : 0.0, a);
  }
  friend Dual exp(const Dual& a) {
    const double e = std::exp(a.value);
    return chain(e, e, a);
  }
  friend Dual log(const Dual& a) { return chain(std::log(a.value), 1.0 / a.value, a); }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return chain(root, root > 0.0 ? 0.5 / root : 0.0, a);
  }
  friend Dual sin(const Dual& a) { return chain(std::sin(a.value), std::cos(a.value), a); }
  friend Dual cos(const Dual& a) { return chain(std::cos(a.value), -std::sin(a.value), a); }
  friend Dual tanh(const Dual& a) {
    const double t = std::tanh(a.value);
    return chain(t, (1.0 - t) * (1.0 + t), a);
  }
  /// a^p for a >= 0.
  friend Dual power(const Dual& a, const Dual& p) {
    const double f = limcycle::power(a.value, p.value);
    if (p.value == 1.0 && !(a.value > 0.0)) return chain(f, 1.0, a);
    if (!(a.value > 0.0)) return chain(f, 0.0, a);
    bool exponent_varies = false;
    for (const double slope : p.d) exponent_varies = exponent_varies || slope != 0.0;
    return chain(f, p.value * (f / a.value), a, exponent_varies ? f * std::log(a.value) : 0.0, p);
  }
};

}  // namespace limcycle
