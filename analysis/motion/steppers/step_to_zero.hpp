#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace limcycle {

/// Where a guard falls through zero within a step, on the interpolant between two lengths of the step.
struct GuardOnInterpolant {
  double guess;  ///< length of the step at which it is zero
  double slope;  ///< per length of the step
};

/// The interpolant's zero of a guard that is not negative at length `a` and negative at `b`: by halvings, then on the
/// straight line. `value(h)`: the guard on the interpolant.
GuardOnInterpolant on_interpolant(const auto& value, double a, double b) {
  constexpr int halvings = 10;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (a + b);
    (value(middle) >= 0.0 ? a : b) = middle;
  }
  const double at_a = value(a), slope = (value(b) - at_a) / (b - a);
  return {a - at_a / slope, slope};
}

/// Length of a step at which a guard is zero, if its value takes a whole step of the method: Newton's method from the
/// interpolant's zero with its slope, then secants within the bracket, to a `rounding` of the length. The bracket is
/// that of the interpolant, `low` to `high`; where whole steps put the zero before `low`, it reaches back to the start
/// of the step, at which the guard must not be negative. The error of a secant is the product of the two before, so
/// that the last step is taken without another to check it: four steps as a rule. `value(h)`: takes the step of length
/// h and returns the guard at its end; its last call is that with the length returned. `h`: the length of the step that
/// found the event. No step is shorter than 1e-16 h: implicit methods divide by its length.
double step_to_zero(const auto& value, double low, double high, GuardOnInterpolant expected, double h,
                    double rounding) {
  double at = expected.guess, slope = expected.slope;
  if (!(at > low && at < high)) at = 0.5 * (low + high);
  const double shortest = 1e-16 * h;
  at = std::max(at, shortest);
  double best = at, best_value = std::numeric_limits<double>::infinity(), taken = at, taken_value = 0.0;
  bool last = false, low_is_taken = false;
  for (int i = 0; i < 60; ++i) {
    const double now = value(at), before = taken;
    if (i > 0) slope = (now - taken_value) / (at - taken);
    taken = at;
    taken_value = now;
    const bool as_expected = last && std::abs(now) <= 0.1 * best_value;  // not at a jump
    if (std::abs(now) < best_value) {
      best = at;
      best_value = std::abs(now);
    }
    if (as_expected || now == 0.0) break;
    (now >= 0.0 ? low : high) = at;
    low_is_taken = low_is_taken || now >= 0.0;
    double next = at - now / slope;
    if (!low_is_taken && !(next > low)) low = 0.0;
    const bool aimed = next > low && next < high;
    if (!aimed) next = 0.5 * (low + high);
    next = std::max(next, shortest);
    const double move = std::abs(next - at);
    if (move <= rounding || high - low < shortest) {
      const bool jumps = best < low || best > high;
      if (jumps) best = high - at <= 2.0 * rounding ? high : at;
      break;
    }
    const double by_slope = i == 0 ? 1e-3 * h : std::abs(next - before);
    last = aimed && move * by_slope <= 1e-17 * h * h;
    at = next;
  }
  if (taken != best) value(best);
  return best;
}

/// Length a few roundings beyond `at`, the zero of a guard, at which the guard is negative, not beyond `last`: a body
/// that rounding left short of break-away would slide back, stick and break away again at the same instant. `value(h)`
/// takes the step of length h, as for step_to_zero(), and was last called for `at`, with the result `now`.
double just_beyond(const auto& value, double now, double at, double last, double rounding) {
  for (int i = 0; i < 20 && now >= 0.0 && at + rounding <= last; ++i, rounding *= 2.0) now = value(at += rounding);
  return at;
}

}  // namespace limcycle
