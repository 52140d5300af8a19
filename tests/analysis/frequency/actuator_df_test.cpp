#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/models/element/memoryless/lookup.hpp"
#include "limcycle/models/element/with_memory/rate_limit.hpp"
#include "limcycle/models/element/with_memory/valve_stiction.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

ValveStiction<double> valve(double S, double J) {
  ValveStiction<double> element;
  element.S = S;
  element.J = J;
  return element;
}

RateLimit<double> rate_limit(double limit, double tau) {
  RateLimit<double> element;
  element.limit = limit;
  element.tau = tau;
  return element;
}

Lookup<double> lookup(std::vector<double> inputs, std::vector<double> outputs) {
  Lookup<double> element;
  element.inputs = std::move(inputs);
  element.outputs = std::move(outputs);
  return element;
}

/// First harmonic, per amplitude, of the last of some periods of a rule that maps the next input to an output.
template <class Rule>
Complex by_steps(double A, double bias, int instants, int periods, Rule rule) {
  Complex sum = 0.0;
  for (int period = 0; period < periods; ++period) {
    sum = 0.0;
    for (int i = 0; i < instants; ++i) {
      const double phase = 2.0 * pi * (i + 0.5) / instants;
      sum += rule(bias + A * std::sin(phase)) * Complex(std::sin(phase), std::cos(phase));
    }
  }
  return 2.0 / instants / A * sum;
}

/// Kano et al. (2004), for samples: `u` the command, the stem moves or stands, `us` where it stopped, `up` its last
/// way.
struct KanoValve {
  double S, J, u = 0.0, us = 0.0, y = 0.0;
  int up = 1, way = 1;
  bool stands = false;

  double operator()(double next) {
    const int now = next > u ? 1 : next < u ? -1 : 0;
    if (!stands && now != way) {
      stands = true;
      us = u;
    }
    way = now;
    u = next;
    if (stands) {
      const double gone_on = up * (u - us);
      if (gone_on > J || gone_on < -S) {
        stands = false;
        if (gone_on < -S) up = -up;
      }
    }
    if (!stands) y = u - up * 0.5 * (S - J);
    return y;
  }
};

}  // namespace

TEST_CASE("sticking valve: closed form, quadrature and the rules for samples agree") {
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  for (const auto& [S, J] : {std::pair(1.0, 0.0), {1.0, 0.3}, {1.0, 1.0}, {0.5, 0.8}, {3.0, 2.0}})
    for (const double A : {0.4, 0.7, 1.0, 1.6, 20.0}) {
      const auto element = valve(S, J);
      const auto expected = *element.exact_describing_function(A, 1.0, 0.0);
      const auto found = describing_function(element, {A, 1.0, 0.0}, marched);
      CAPTURE(S, J, A, expected, found.gain);
      CHECK(found.status == Status::converged);
      CHECK(std::abs(found.gain - expected) <= found.error * std::abs(expected) + 1e-9);
      CHECK(std::abs(by_steps(A, 0.0, 200'000, 3, KanoValve{S, J}) - expected) < 1e-4 * (1.0 + std::abs(expected)));
    }
}

TEST_CASE("sticking valve: without a slip jump it is backlash of half the dead band") {
  for (const double A : {0.3, 0.6, 1.1, 9.0})
    CHECK(std::abs(*valve(1.0, 0.0).exact_describing_function(A, 2.0, 0.0) -
                   *test::backlash(0.5).exact_describing_function(A, 2.0, 0.0)) < 1e-12);
  CHECK_FALSE(valve(1.0, 0.5).exact_describing_function(1.0, 1.0, 0.1));
  const auto biased = describing_function(valve(1.0, 0.5), {2.0, 1.0, 7.0}),
             plain = describing_function(valve(1.0, 0.5), {2.0, 1.0, 0.0});
  CHECK(std::abs(biased.gain - plain.gain) < 1e-6);  // a bias shifts both input and output
}

TEST_CASE("rate limit: the lag below the limit, the ideal limiter's triangle beyond it") {
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  const double tau = 0.1, w = 2.0;
  const Complex lag = 1.0 / Complex(1.0, tau * w);
  const auto within = describing_function(rate_limit(1.0, tau), {0.45, w, 0.0}, marched);
  CHECK(std::abs(within.gain - lag) < 1e-8);
  // Ideal limiter, beyond A w = limit (1 + pi^2/4)^(1/2): a triangle of amplitude pi limit/(2 w), which meets the input
  // at its crests, so that sin(phase of its crest) = pi limit/(2 w A).
  double before = infinite;
  for (const double small : {1e-2, 1e-3, 1e-4}) {
    const double A = 3.0, part = pi / (2.0 * w * A);
    const Complex ideal = 8.0 / (pi * pi) * part * std::polar(1.0, -std::acos(part));
    const auto found = describing_function(rate_limit(1.0, small), {A, w, 0.0}, marched);
    CHECK(found.status == Status::converged);
    const double apart = std::abs(found.gain - ideal);
    CAPTURE(small, apart);
    CHECK(apart < 2.0 * w * small);  // first order in tau
    CHECK(apart < 0.3 * before);
    before = apart;
  }
}

TEST_CASE("rate limit: with a bias and in between, against its rule at small steps") {
  constexpr int instants = 100'000;
  for (const auto& [A, w, bias] : {std::tuple(0.7, 2.0, 0.0), {0.7, 2.0, 0.4}, {1.5, 3.0, -1.0}}) {
    const auto element = rate_limit(1.0, 0.05);
    const double h = 2.0 * pi / w / instants;
    double y = bias;
    const auto expected = by_steps(A, bias, instants, 40, [&](double x) {
      return y += h * std::clamp((x - y) / element.tau, -element.limit, element.limit);
    });
    const auto found = describing_function(element, {A, w, bias}, test::with(DfMethod::quadrature, 1e-9));
    CAPTURE(A, w, bias, found.gain, expected);
    CHECK(found.status == Status::converged);
    CHECK(std::abs(found.gain - expected) < 1e-4);  // first order in the step
  }
}

TEST_CASE("lookup: a table that is a saturation or ends a dead zone has their describing functions") {
  for (const double A : {0.1, 0.9, 1.3, 40.0}) {
    CAPTURE(A);
    const auto limited = lookup({0.0, 0.5}, {0.0, 1.0});
    CHECK(std::abs(*limited.exact_describing_function(A, 1.0, 0.0) -
                   *test::saturation(2.0, 1.0).exact_describing_function(A, 1.0, 0.0)) < 1e-14);
    const auto table = lookup({0.0, 0.8, 100.0}, {0.0, 0.0, 99.2});
    CHECK(std::abs(*table.exact_describing_function(A, 1.0, 0.0) -
                   *test::dead_zone(1.0, 0.8).exact_describing_function(A, 1.0, 0.0)) < 1e-12);
  }
}

TEST_CASE("lookup: random tables, odd or not, by closed form, quadrature and sums over a period") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    const bool odd = i % 2 == 0;
    std::vector<double> x{odd ? 0.0 : -1.0 - u(random)}, y{odd ? 0.0 : 2.0 * u(random) - 1.0};
    while (x.size() < 5) {
      x.push_back(x.back() + 0.1 + u(random));
      y.push_back(2.0 * u(random) - 1.0);
    }
    const auto element = lookup(x, y);
    REQUIRE_FALSE(element.validate());
    const double A = 0.2 + 3.0 * u(random), bias = odd ? 0.0 : u(random);
    const auto expected = by_steps(A, bias, 400'000, 1, [&](double in) {
      const double side = odd && in < 0.0 ? -1.0 : 1.0, at = side * in;
      if (at <= x.front()) return side * y.front();
      for (std::size_t k = 1; k < x.size(); ++k)
        if (at <= x[k]) return side * (y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]));
      return side * y.back();
    });
    const auto found = describing_function(element, {A, 1.0, bias}, test::with(DfMethod::quadrature, 1e-9));
    CAPTURE(x, y, A, bias, found.gain, expected);
    CHECK(std::abs(found.gain - expected) < 1e-7);
    if (odd) CHECK(std::abs(*element.exact_describing_function(A, 1.0, 0.0) - expected) < 1e-7);
  }
}

TEST_CASE("lookup: tables that are none") {
  CHECK(lookup({0.0}, {0.0}).validate()->key == "inputs");
  CHECK(lookup({0.0, 1.0, 1.0}, {0.0, 1.0, 2.0}).validate()->key == "inputs");
  CHECK(lookup({0.0, 1.0}, {0.0, 1.0, 2.0}).validate()->key == "outputs");
  CHECK(lookup({0.0, 1.0}, {0.5, 1.0}).validate()->key == "outputs");
  CHECK_FALSE(lookup({-1.0, 1.0}, {0.5, 1.0}).validate());
}
