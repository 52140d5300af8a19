#include "limcycle/analysis/study/map/simulated_points.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

PredictOptions without_methods() {
  PredictOptions options;
  options.methods = {false, false, false};
  options.accuracy = 1e-6;
  return options;
}

std::vector<std::optional<Loop>> random_servos(int count) {
  std::mt19937_64 numbers(23);  // NOLINT(cert-msc51-cpp): the same loops in every run
  const auto between = [&](double from, double to) {
    return std::exp(std::uniform_real_distribution<double>(std::log(from), std::log(to))(numbers));
  };
  std::vector<std::optional<Loop>> loops;
  for (int i = 0; i < count; ++i) {
    auto friction = lugre(between(1.0, 3.0), 1.0, between(0.1, 2.0));
    friction.sigma0 = between(1e3, 1e6);
    friction.sigma1 = std::sqrt(friction.sigma0);
    loops.emplace_back(loop_of(Mass{between(0.3, 3.0), 0.0, 0.0},
                               pid(between(1.0, 30.0), between(0.5, 10.0), between(2.0, 20.0)), friction));
  }
  return loops;
}

void check_same(const MapPoint& one, const MapPoint& other) {
  CHECK(one.outcomes == other.outcomes);
  CHECK(one.cycles == other.cycles);
  CHECK(one.stable == other.stable);
  CHECK(((std::isnan(one.amplitude) && std::isnan(other.amplitude)) || one.amplitude == other.amplitude));
  CHECK(((std::isnan(one.period) && std::isnan(other.period)) || one.period == other.period));
}

}  // namespace

TEST_CASE("simulated points: random servos in lanes end as those that predict() simulates and searches") {
  const auto loops = random_servos(samples(30));
  const auto points = simulated_points(loops, {without_methods()});
  REQUIRE(points.size() == loops.size());
  int hunting = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    REQUIRE(fits_lanes(*loops[i]));
    const MapPoint whole = map_point(*loops[i], without_methods());
    INFO("servo " << i << ": " << points[i].in_words() << ", predicted " << whole.in_words());
    for (const Outcome outcome : points[i].outcomes) CHECK(whole.has(outcome));
    CHECK(points[i].has(Outcome::cycle) == whole.has(Outcome::cycle));
    CHECK(points[i].methods.empty());
    if (!whole.has(Outcome::cycle)) continue;
    ++hunting;
    CHECK(points[i].amplitude == Approx(whole.amplitude).epsilon(1e-3));
    CHECK(points[i].period == Approx(whole.period).epsilon(1e-3));
    CHECK(points[i].stable >= 1);
  }
  CHECK(hunting > 0);
}

TEST_CASE("simulated points: a point is the same alone, among others and on every instruction set") {
  const auto loops = random_servos(5);
  const auto together = simulated_points(loops, {without_methods()});
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const auto alone = simulated_points(std::span(loops).subspan(i, 1), {without_methods(), Isa::scalar});
    REQUIRE(alone.size() == 1);
    check_same(alone.front(), together[i]);
  }
}

TEST_CASE("simulated points: loops that fit no lanes are predicted without methods, and empty ones are not valid") {
  const Loop relay_loop = forward(relay(1.0), {1.0}, {1.0, 2.0, 1.0, 0.0});
  const std::vector<std::optional<Loop>> loops{std::nullopt, relay_loop, servo(lugre())};
  CHECK_FALSE(fits_lanes(relay_loop));
  const auto points = simulated_points(loops, {without_methods()});
  REQUIRE(points.size() == 3);
  CHECK(points[0].in_words() == "not valid");
  PredictOptions rough = without_methods();
  rough.accuracy = 1e-4;
  check_same(points[1], map_point(relay_loop, rough));
  CHECK(points[2].period == Approx(24.4368).epsilon(1e-4));
}

TEST_CASE("simulated points: where every start diverges, starts further down are tried, as by predict()") {
  // Unstable about rest: kp below zero.
  const Loop loop = loop_of(Mass{1.0, 0.0, 0.0}, pid(-1.0, 0.0, 0.1), lugre(1.5, 1.0, 0.1));
  const auto points = simulated_points(std::vector<std::optional<Loop>>{loop}, {without_methods()});
  REQUIRE(points.size() == 1);
  CHECK(points[0].outcomes == map_point(loop, without_methods()).outcomes);
  CHECK(points[0].has(Outcome::divergence));
}

TEST_CASE("simulated points: a stop leaves no half point") {
  PredictOptions stopped = without_methods();
  stopped.stop = [] { return true; };
  CHECK(simulated_points(random_servos(3), {stopped}).empty());
}
