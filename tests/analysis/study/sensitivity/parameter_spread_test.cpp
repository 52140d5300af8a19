#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

using namespace limcycle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

ParameterSpread of_uniform(std::size_t count) {
  ParameterSpread spread;
  for (std::size_t i = 0; i < count; ++i)
    spread.parameters.push_back({"p" + std::to_string(i), 0.0, Distribution::uniform, -1.0, 1.0, 0.0, 0.0});
  return spread;
}

}  // namespace

TEST_CASE("parameter spread: quantiles of each distribution") {
  const SpreadParameter even{"x", 3.0, Distribution::uniform, 2.0, 6.0, 0.0, 0.0};
  CHECK(even.quantile(0.0) == 2.0);
  CHECK(even.quantile(0.25) == Approx(3.0));
  CHECK(even.quantile(1.0) == 6.0);
  const SpreadParameter decades{"x", 3.0, Distribution::log_uniform, 1e3, 1e7, 0.0, 0.0};
  CHECK(decades.quantile(0.5) == Approx(1e5));
  CHECK(decades.quantile(0.25) == Approx(1e4));
  const SpreadParameter negative{"x", -3.0, Distribution::log_uniform, -100.0, -1.0, 0.0, 0.0};
  CHECK(negative.quantile(0.5) == Approx(-10.0));
  const SpreadParameter bell{"x", 5.0, Distribution::normal, -infinity, infinity, 5.0, 2.0};
  CHECK(bell.quantile(0.5) == Approx(5.0));
  CHECK(bell.quantile(0.8413447460685429) == Approx(7.0));
  CHECK(bell.quantile(1e-10) == Approx(5.0 - 2.0 * 6.3613409024040562));
  CHECK(bell.low_end() == Approx(1.0));
  CHECK(bell.high_end() == Approx(9.0));
  CHECK(std::isinf(bell.quantile(1.0)));
  CHECK_THROWS_AS(bell.quantile(1.1), std::invalid_argument);
  CHECK_THROWS_AS(bell.quantile(std::nan("")), std::invalid_argument);
}

TEST_CASE("parameter spread: a normal distribution cut off keeps its shape between the bounds") {
  const SpreadParameter half{"x", 0.0, Distribution::normal, 0.0, infinity, 0.0, 1.0};  // half-normal
  CHECK(half.quantile(0.0) == Approx(0.0).margin(1e-15));
  CHECK(half.quantile(0.5) == Approx(0.67448975019608171));
  CHECK(half.low_end() > 0.0);
  const SpreadParameter tail{"x", 0.0, Distribution::normal, 8.0, 9.0, 0.0, 1.0};
  CHECK(tail.quantile(0.0) == Approx(8.0));
  CHECK(tail.quantile(1.0) == Approx(9.0));
  CHECK(tail.quantile(0.5) == Approx(8.0848).epsilon(1e-4));  // Q = 3.11e-16: half of the share beyond 8
}

TEST_CASE("parameter spread: the middle and corners, balanced and independent of one another") {
  CHECK(corner_points({}).empty());
  CHECK(corner_points(of_uniform(1)).size() == 3);
  CHECK(corner_points(of_uniform(2)).size() == 5);
  CHECK(corner_points(of_uniform(3)).size() == 5);
  for (const std::size_t count : {1U, 2U, 3U, 4U, 7U, 10U}) {
    const auto points = corner_points(of_uniform(count));
    CAPTURE(count);
    CHECK(points[0] == std::vector<double>(count, 0.0));
    CHECK(std::set(points.begin(), points.end()).size() == points.size());
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0.0;
      for (std::size_t k = 1; k < points.size(); ++k) {
        CHECK(std::abs(points[k][i]) == 1.0);
        sum += points[k][i];
      }
      CHECK(sum == 0.0);
      for (std::size_t j = 0; j < i; ++j) {
        double product = 0.0;
        for (std::size_t k = 1; k < points.size(); ++k) product += points[k][i] * points[k][j];
        CHECK(product == (i == j + 7 ? -8.0 : 0.0));
      }
    }
  }
}
