// The error norm that decides whether a step is good.
#include "limcycle/analysis/motion/error_weights.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

using limcycle::ErrorWeights;
using limcycle::State;
using limcycle::WeightedErrorChecker;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("The error norm is the largest component over its own allowance", "[error_weights]") {
  const ErrorWeights weights{0.01, {0.1, 1e-6}};
  // Allowances: 0.1 + 0.01 * 20 = 0.3 and 1e-6 + 0.01 * 0.001 = 1.1e-5.
  CHECK(weights.norm({10, 0.001}, {-20, 0}, {0.15, 0}) == Approx(0.5));
  CHECK(weights.norm({10, 0.001}, {-20, 0}, {0.15, -2.2e-5}) == Approx(2));
  CHECK(weights.norm({10, 0.001}, {-20, 0}, {0, 0}) == 0);
}

TEST_CASE("The error norm of what is not finite is infinite, wherever it stands", "[error_weights]") {
  const ErrorWeights weights{0.01, {0.1, 0.1, 0.1}};
  const State fine{1, 2, 3};
  for (std::size_t i = 0; i < 3; ++i)
    for (const double bad : {not_a_number, infinity, -infinity}) {
      State spoilt = fine;
      spoilt[i] = bad;
      CHECK(weights.norm(fine, fine, spoilt) == infinity);
      CHECK(weights.norm(fine, spoilt, {0, 0, 0}) == infinity);
      CHECK(weights.norm(spoilt, fine, {0, 0, 0}) >= 0);  // never NaN, so that it can always be compared
    }
}

TEST_CASE("Odeint's error checker is the same norm with the new state predicted", "[error_weights]") {
  const WeightedErrorChecker checker(ErrorWeights{0.01, {0.1, 1e-6}});
  int algebra = 0;
  // x_old + dt rate = {20, 0.001}: allowances 0.3 and 1.1e-5.
  const State x_old{10, 0.001};
  const State rate{5, 0};
  CHECK(checker.error(algebra, x_old, rate, State{0.15, 0}, 2.0) == Approx(0.5));
  CHECK(checker.error(algebra, x_old, rate, State{0.15, 2.2e-5}, 2.0) == Approx(2));
  CHECK(checker.error(algebra, x_old, rate, State{not_a_number, 0}, 2.0) == infinity);
  CHECK(checker.error(algebra, x_old, rate, State{0, not_a_number}, 2.0) == infinity);
  CHECK(checker.error(algebra, x_old, State{infinity, 0}, State{0, 0}, 2.0) == infinity);
  CHECK(checker.error(algebra, State{not_a_number, 0}, rate, State{0, 0}, 2.0) == infinity);
  CHECK_THROWS_AS(checker.error(algebra, State{1}, State{1}, State{1}, 2.0), std::invalid_argument);
}

TEST_CASE("Tolerances out of range are refused with their value", "[error_weights]") {
  CHECK_NOTHROW(ErrorWeights{0, {1e-9}}.require_valid());
  CHECK_THROWS_WITH((ErrorWeights{-0.5, {1e-9}}.require_valid()), Catch::Contains("-0.5"));
  CHECK_THROWS_AS((ErrorWeights{not_a_number, {1e-9}}.require_valid()), std::invalid_argument);
  CHECK_THROWS_AS((ErrorWeights{1e-6, {}}.require_valid()), std::invalid_argument);
  CHECK_THROWS_WITH((ErrorWeights{1e-6, {1e-9, -2}}.require_valid()), Catch::Contains("component 1"));
  CHECK_THROWS_AS((ErrorWeights{1e-6, {0}}.require_valid()), std::invalid_argument);
  CHECK_THROWS_AS((ErrorWeights{1e-6, {infinity}}.require_valid()), std::invalid_argument);
  CHECK_THROWS_AS(WeightedErrorChecker(ErrorWeights{1e-6, {0}}), std::invalid_argument);
}

TEST_CASE("error weights: a component counts from its origin, also at another tolerance") {
  const ErrorWeights weights{1e-3, {1e-9, 1e-9}, {2.0, 0.0}};
  CHECK(weights.size(0, 2.5) == 0.5);
  CHECK(weights.norm({2.0, 1.0}, {2.0, 1.0}, {1e-9, 0.0}) == Approx(1.0));  // relative to nothing
  CHECK(weights.norm({2.5, 1.0}, {2.0, 1.0}, {5e-4, 0.0}) == Approx(1.0).epsilon(1e-5));
  CHECK(weights.scaled_to(1e-6).size(0, 2.5) == 0.5);
}
