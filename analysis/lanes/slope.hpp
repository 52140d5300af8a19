#pragma once

namespace limcycle {

/// A pack and its derivative by one variable: a Scalar for laws, in lanes, as Dual is for doubles; see there for the
/// treatment of kinks. The exponent of power() is a constant, the same in all lanes.
template <class P>
struct Slope {
  P value{}, slope{};
  using Mask = typename P::Mask;

  Slope() = default;
  Slope(double constant) : value(constant), slope(0.0) {}  // NOLINT(google-explicit-constructor): as Dual
  explicit Slope(const P& v, const P& s = P(0.0)) : value(v), slope(s) {}

  Slope operator-() const { return Slope(-value, -slope); }
  friend Slope operator+(const Slope& a, const Slope& b) { return Slope(a.value + b.value, a.slope + b.slope); }
  friend Slope operator-(const Slope& a, const Slope& b) { return Slope(a.value - b.value, a.slope - b.slope); }
  friend Slope operator*(const Slope& a, const Slope& b) {
    return Slope(a.value * b.value, a.slope * b.value + a.value * b.slope);
  }
  friend Slope operator/(const Slope& a, const Slope& b) {
    const P inverse = 1.0 / b.value, q = a.value * inverse;
    return Slope(q, (a.slope - q * b.slope) * inverse);
  }

  friend Mask operator<(const Slope& a, const Slope& b) { return a.value < b.value; }
  friend Mask operator>(const Slope& a, const Slope& b) { return a.value > b.value; }
  friend Slope select(const Mask& condition, const Slope& yes, const Slope& no) {
    return Slope(select(condition, yes.value, no.value), select(condition, yes.slope, no.slope));
  }
  friend Slope abs(const Slope& a) {
    const P side = select(a.value > 0.0, P(1.0), select(a.value < 0.0, P(-1.0), P(0.0)));
    return Slope(abs(a.value), side * a.slope);
  }
  friend Slope exp(const Slope& a) {
    const P e = exp(a.value);
    return Slope(e, e * a.slope);
  }
  /// a^p for a >= 0.
  friend Slope power(const Slope& a, const Slope& p) {
    if (p.value[0] == 2.0) return a * a;
    if (p.value[0] == 1.0) return a;
    const P f = power(a.value, p.value);
    return Slope(f, select(a.value > 0.0, p.value * (f / a.value) * a.slope, P(0.0)));
  }
};

}  // namespace limcycle
