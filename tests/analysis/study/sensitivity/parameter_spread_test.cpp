#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

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

TEST_CASE("spread: correlated numbers keep their distributions and have the correlation asked for") {
  ParameterSpread spread;
  spread.parameters = {{.path = "a",
                        .distribution = Distribution::normal,
                        .low = -infinity,
                        .high = infinity,
                        .mean = 5.0,
                        .deviation = 2.0},
                       {.path = "b", .distribution = Distribution::uniform, .low = 2.0, .high = 6.0},
                       {.path = "c",
                        .distribution = Distribution::normal,
                        .low = -infinity,
                        .high = infinity,
                        .mean = -1.0,
                        .deviation = 0.5}};
  const JointSpread independent(spread);
  CHECK_FALSE(independent.correlated());
  CHECK(independent.values({0.5, 0.25, 0.5}) == std::vector<double>{5.0, 3.0, -1.0});
  spread.correlations = {{0, 2, -0.8}, {1, 2, 0.5}};
  const JointSpread joint(spread);
  REQUIRE(joint.correlated());
  const int n = 20000;
  double mean[3] = {}, square[3] = {}, product = 0.0, b_below_3 = 0.0, scores = 0.0;
  RandomStream random(1, "test");
  for (int k = 0; k < n; ++k) {
    const auto x = joint.values({random.uniform(), random.uniform(), random.uniform()});
    for (int i = 0; i < 3; ++i) mean[i] += x[static_cast<std::size_t>(i)] / n;
    for (int i = 0; i < 3; ++i) square[i] += x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(i)] / n;
    product += (x[0] - 5.0) * (x[2] + 1.0) / n;
    b_below_3 += x[1] < 3.0 ? 1.0 / n : 0.0;
    scores += (x[1] - 4.0) * (x[2] + 1.0) / n;
  }
  CHECK(mean[0] == Approx(5.0).margin(0.06));
  CHECK(square[0] - mean[0] * mean[0] == Approx(4.0).epsilon(0.04));
  CHECK(mean[2] == Approx(-1.0).margin(0.015));
  CHECK(b_below_3 == Approx(0.25).margin(0.012));
  CHECK(product / (2.0 * 0.5) == Approx(-0.8).margin(0.02));
  // Of a uniform and a normal number with the score correlation r: r sqrt(3/pi).
  CHECK(scores / (0.5 * 4.0 / std::sqrt(12.0)) == Approx(0.5 * std::sqrt(3.0 / std::numbers::pi)).margin(0.02));
}

TEST_CASE("spread: correlations that no distribution has are refused") {
  ParameterSpread spread;
  for (const char* path : {"a", "b", "c"}) spread.parameters.push_back({.path = path, .low = 0.0, .high = 1.0});
  spread.correlations = {{0, 1, 0.9}, {1, 2, 0.9}, {0, 2, 0.7}};
  CHECK_NOTHROW(JointSpread(spread));
  spread.correlations[2].value = 0.6;  // 0.9^2 - (1 - 0.9^2) = 0.62
  CHECK_THROWS_AS(JointSpread(spread), std::invalid_argument);
}
