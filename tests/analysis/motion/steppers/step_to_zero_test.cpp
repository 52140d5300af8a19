#include "limcycle/analysis/motion/steppers/step_to_zero.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace limcycle;

namespace {

constexpr double rounding = 2e-16;

struct FallingGuard {
  std::function<double(double)> value;
  double zero;
};

// What a guard may look like within a step of length 1.
std::vector<FallingGuard> falling_guards() {
  return {{[](double h) { return 0.3 - h; }, 0.3},
          {[](double h) { return 1e-9 * (0.7 - h); }, 0.7},
          {[](double h) { return std::cos(2.0 * h); }, std::acos(0.0) / 2.0},
          {[](double h) { return std::exp(-h) - 0.6; }, -std::log(0.6)},
          {[](double h) { return 0.25 - h * h; }, 0.5},
          {[](double h) { return std::cbrt(0.4 - h); }, 0.4},                        // an infinite slope
          {[](double h) { return std::pow(0.4 - h, 3.0); }, 0.4},                    // none
          {[](double h) { return h < 0.6 ? 1.0 : -1.0; }, 0.6},                      // a jump
          {[](double h) { return h < 0.35 ? 5.0 * (0.35 - h) : 0.35 - h; }, 0.35}};  // a kink
}

}  // namespace

TEST_CASE("step to zero: found to rounding from any guess, and the step returned is the last one taken") {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& guard : falling_guards()) {
    const bool flat = guard.value(guard.zero - 1e-3) < 1e-8 && guard.value(0.0) > 1e-2;
    for (const double guess : {guard.zero, guard.zero + 1e-4, guard.zero - 1e-2, 0.01, 0.99, -3.0, 7.0, nan}) {
      for (const double slope : {-1.0, -1e-6, -1e9, 0.0, 2.0, -infinite, nan}) {
        double last = nan;
        int steps = 0;
        const auto value = [&](double h) {
          last = h;
          ++steps;
          CHECK((h > 0.0 && h < 1.0));
          return guard.value(h);
        };
        const double found = step_to_zero(value, 0.0, 1.0, {guess, slope}, 1.0, rounding);
        CAPTURE(guard.zero, guess, slope, steps);
        CHECK(last == found);
        CHECK(std::abs(found - guard.zero) <= (flat ? 1e-5 : 1e-15));
      }
    }
  }
}

TEST_CASE("step to zero: whole steps may put it before the bracket of the interpolant") {
  for (const double zero : {0.1, 0.5 - 1e-3, 0.5 - 1e-9}) {
    const auto guard = [&](double h) { return std::sin(zero - h); };
    CHECK(std::abs(step_to_zero(guard, 0.5, 0.75, {0.5 + 1e-6, -1.0}, 1.0, rounding) - zero) <= 4e-16);
  }
}

TEST_CASE("step to zero: from the cubic of a smooth step four steps are enough, of a long one five") {
  // The guard a motion really has, and the cubic through the ends of the step: as far apart as h^4.
  for (const double h : {0.4, 0.1, 0.02}) {
    const double zero = 0.63 * h;
    const auto guard = [&](double t) { return std::sin(zero - t) * (2.0 + std::cos(3.0 * t)); };
    const auto rate = [&](double t) { return (guard(t + 1e-6) - guard(t - 1e-6)) / 2e-6; };
    const auto cubic = [&](double t) {
      const double theta = t / h, left = 1.0 - theta, chord = guard(h) - guard(0.0);
      return left * guard(0.0) + theta * guard(h) -
             theta * left * ((1.0 - 2.0 * theta) * chord + h * (theta * rate(h) - left * rate(0.0)));
    };
    const auto expected = on_interpolant(cubic, 0.5 * h, 0.75 * h);
    CHECK(std::abs(expected.guess - zero) < std::pow(h, 4.0));
    CHECK(std::abs(expected.slope - rate(zero)) < 0.05 * std::abs(rate(zero)));
    int steps = 0;
    const auto value = [&](double t) {
      ++steps;
      return guard(t);
    };
    const double found = step_to_zero(value, 0.5 * h, 0.75 * h, expected, h, rounding * h);
    CHECK(std::abs(found - zero) <= 4e-16 * h);
    CHECK(steps <= (h > 0.2 ? 5 : 4));
  }
}

TEST_CASE("step to zero: a body that moves by the smallest number there is stops within rounding, not after no time") {
  for (const double push : {1.0, 1e-6, 1e6}) {
    const auto guard = [&](double h) { return 4.94e-324 - push * h; };
    const auto expected = on_interpolant(guard, 0.0, 0.25);
    const auto value = [&](double h) {
      CHECK(h >= 1e-16);
      return guard(h);
    };
    CHECK(step_to_zero(value, 0.0, 0.25, expected, 1.0, rounding) <= 4.0 * rounding);
  }
}

TEST_CASE("just beyond a zero: the first negative value within some roundings, by steps that are the last ones taken") {
  const double rounding = 1e-16;
  for (const double zero : {0.5, 0.5 + 3e-16, 0.5 + 1e-13}) {
    double last = 0.0;
    const auto value = [&](double h) {
      last = h;
      return zero - h;
    };
    const double beyond = just_beyond(value, value(0.5), 0.5, 1.0, rounding);
    CHECK(last == beyond);
    CHECK(value(beyond) < 0.0);
    CHECK(beyond - zero <= std::max(4.0 * rounding, 2.0 * (zero - 0.5)));
  }
  const auto rests = [](double) { return 0.0; };
  CHECK(just_beyond(rests, 0.0, 0.5, 0.5 + 1e-15, rounding) <= 0.5 + 1e-15);
  CHECK(just_beyond(rests, -1.0, 0.5, 1.0, rounding) == 0.5);
}
