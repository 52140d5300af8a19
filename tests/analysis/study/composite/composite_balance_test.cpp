#include "limcycle/analysis/study/composite/composite_balance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

/// x1/u1 of a unit mass with Coulomb friction that slips once each half period, in closed form (sticks in between).
Complex one_slip(double U, double w, double Fs, double Fc) {
  const double p = std::asin(std::min(1.0, Fs / U));
  double low = p + 0.3, high = p + pi;
  for (int i = 0; i < 200; ++i) {
    const double q = 0.5 * (low + high);
    (U * (std::cos(p) - std::cos(q)) - Fc * (q - p) > 0.0 ? low : high) = q;
  }
  const int n = 20000;
  Complex sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double phase = p + (low - p) * (i + 0.5) / n;
    const double v = (U * (std::cos(p) - std::cos(phase)) - Fc * (phase - p)) / w;
    sum += v * Complex(std::cos(phase), -std::sin(phase)) * (low - p) / double(n);
  }
  return 2.0 / (pi * w * U) * sum;
}

Complex pid(double w) { return {3.0, 6.0 * w - 4.0 / w}; }

CompositeSearchOptions range(double low, double high) {
  CompositeSearchOptions options;
  options.frequency_min = low;
  options.frequency_max = high;
  return options;
}

}  // namespace

TEST_CASE("composite balance: the rest of the loop is the controller") {
  const Loop loop = test::servo(test::lugre());
  const CompositeBalance balance(loop);
  CHECK(balance.mass() == Approx(1.0));
  for (const double w : {0.02, 0.7, 50.0})
    CHECK(std::abs(balance.rest_of_loop(w) + pid(w)) < 1e-10 * (std::abs(pid(w)) + w * w));
  const Loop belt = test::belt(test::lugre());
  CHECK(CompositeBalance(belt).rest_of_loop(3.0).real() == Approx(-2.0));
}

TEST_CASE("composite balance: a delay in the rest of the loop is exact") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 0.0, 0.0}, 0.3};
  parts.controller = test::pid(3.0, 4.0, 6.0);
  parts.friction = test::coulomb(1.0, 1.0);
  const Loop loop = build_loop(parts);
  const double w = 1.7;
  const Complex exact = -pid(w) * std::exp(Complex(0.0, -0.3 * w));
  CHECK(std::abs(CompositeBalance(loop).rest_of_loop(w) - exact) < 1e-11 * std::abs(exact));
}

TEST_CASE("composite balance: loops it is not for say why") {
  const Loop relay = test::forward(test::relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  REQUIRE(CompositeBalance::not_applicable(relay));
  CHECK_THROWS_WITH(CompositeBalance(relay), Catch::Contains("no friction"));
  LoopParts parts = test::servo_parts(test::lugre());
  parts.element = test::saturation(1.0);
  const Loop both = build_loop(parts);
  CHECK(CompositeBalance::not_applicable(both)->find("loop.element") != std::string::npos);
  CHECK_FALSE(CompositeBalance::not_applicable(test::servo(test::lugre())));
}

TEST_CASE("composite balance: a root put back into the closed form, and the cycle it invents") {
  // Fs = Fc: no cycle exists (the motion comes to rest); the first harmonics balance nevertheless.
  const Loop loop = test::servo(test::coulomb(1.0, 1.0));
  CompositeBalance balance(loop);
  const auto found = balance.find(range(0.01, 100.0));
  REQUIRE(found.status == Status::converged);
  REQUIRE(found.roots.size() == 1);
  const CompositeRoot& root = found.roots[0];
  CHECK(std::abs(1.0 + pid(root.frequency) * one_slip(root.force, root.frequency, 1.0, 1.0)) < 1e-6);
  CHECK(root.residual < 1e-6);
  CHECK_FALSE(root.on_break_away_front);
  CHECK(root.amplitude == Approx(root.force / std::abs(pid(root.frequency))).epsilon(1e-6));
  CHECK(root.input_amplitude == Approx(root.amplitude).epsilon(1e-9));
  CHECK(root.bias == 0.0);
  const LoopState state = balance.state(root);
  CHECK(state.x[0] == Approx(root.force * one_slip(root.force, root.frequency, 1.0, 1.0).imag()).epsilon(1e-5));
}

TEST_CASE("composite balance: a root in the leap at break-away is flagged") {
  const Loop loop = test::servo(test::coulomb(1.5, 1.0));
  CompositeBalance balance(loop);
  const auto found = balance.find(range(0.01, 100.0));
  REQUIRE(found.roots.size() == 1);
  const CompositeRoot& root = found.roots[0];
  CHECK(root.on_break_away_front);
  CHECK_FALSE(root.note.empty());
  CHECK(root.force == Approx(1.5).epsilon(1e-4));
  CHECK(root.stable == true);
  // N jumps from 0 to full slip; 1 + PID N is zero on the line between: PID N of full slip is real and below -1.
  const Complex full = pid(root.frequency) * one_slip(1.5 * (1.0 + 1e-4), root.frequency, 1.5, 1.0);
  CHECK(full.real() < -1.0);
  CHECK(std::abs(full.imag()) < 1e-3 * std::abs(full));
  // The true cycle: 0.2689 rad/s, first harmonic 0.0846 m. It is found, but with large errors.
  CHECK(root.frequency / 0.268865 > 2.0);
  CHECK(root.amplitude / 0.0845926 > 4.0);
}

TEST_CASE("composite balance: bristles change little where the leap decides") {
  const Loop soft_loop = test::servo(test::lugre());
  CompositeBalance soft(soft_loop);
  const Loop stiff_loop = test::servo(test::coulomb(1.5, 1.0, 0.4));
  const auto a = CompositeBalance(stiff_loop).find(range(0.01, 100.0));
  const auto b = soft.find(range(0.01, 1000.0));
  REQUIRE(a.roots.size() == 1);
  REQUIRE(b.roots.size() == 1);
  CHECK(b.roots[0].on_break_away_front);
  CHECK(b.roots[0].frequency == Approx(a.roots[0].frequency).epsilon(0.01));
  CHECK(b.roots[0].amplitude == Approx(a.roots[0].amplitude).epsilon(0.01));
  CHECK(b.evaluations < 1500);
}

TEST_CASE("composite balance: without integral action there is nothing") {
  LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
  parts.controller = test::pid(3.0, 0.0, 6.0);
  const Loop loop = build_loop(parts);
  const auto found = CompositeBalance(loop).find(range(0.01, 100.0));
  CHECK(found.status == Status::no_cycle);
  CHECK(found.roots.empty());
}

TEST_CASE("composite balance: stick-slip on a belt has a bias") {
  const Loop loop = test::belt(test::coulomb(1.5, 1.0));
  CompositeBalance balance(loop);
  CHECK(balance.mean_velocity() == Approx(-0.1));
  CompositeSearchOptions options = range(0.2, 5.0);
  options.force_min = 0.3;
  options.force_max = 3.0;
  const auto found = balance.find(options);
  REQUIRE(found.roots.size() == 1);
  const CompositeRoot& root = found.roots[0];
  CHECK(root.bias == Approx(-1.0).epsilon(1e-3));
  CHECK(root.force == Approx(2.0 * root.amplitude).epsilon(1e-6));  // the spring, 2 N/m
  CHECK(root.on_break_away_front);
  // The true cycle: 0.8255 rad/s, first harmonic 0.2173 m.
  CHECK(root.amplitude == Approx(0.2173).epsilon(0.2));
  CHECK(root.frequency == Approx(0.8255).epsilon(0.3));
}

TEST_CASE("composite balance: a wish to stop is obeyed on a belt too, wherever it comes") {
  const Loop loop = test::belt(test::lugre());
  CompositeBalance balance(loop);
  for (const long after : {1L, 30L, 1000L}) {  // in the search of a break-away bias, in a response, ...
    CompositeSearchOptions options = range(0.1, 10.0);
    long asked = 0;
    options.stop = [&asked, after] { return ++asked > after; };
    CHECK(balance.find(options).status == Status::interrupted);
    CHECK(asked < after + 50000);
  }
}

TEST_CASE("composite balance: a wish to stop is obeyed, bad options are refused by name") {
  const Loop loop = test::servo(test::lugre());
  CompositeBalance balance(loop);
  CompositeSearchOptions options = range(0.01, 100.0);
  options.stop = [] { return true; };
  CHECK(balance.find(options).status == Status::interrupted);
  // The stop function also takes effect within the work of one response, not only between them.
  long asked = 0;
  options.stop = [&asked] { return ++asked > 100; };
  const auto stopped = balance.find(options);
  CHECK(stopped.status == Status::interrupted);
  CHECK(stopped.steps < 100 * 256 + 1000);
  CHECK(asked < 1000);
  options.stop = {};
  CHECK(balance.find(options).status != Status::interrupted);  // the stop function is no longer in use
  CHECK_THROWS_WITH(balance.find(range(0.0, 1.0)), Catch::Contains("frequency_min"));
  CHECK_THROWS_WITH(balance.find(range(2.0, 1.0)), Catch::Contains("frequency_max"));
  options = range(0.01, 1.0);
  options.accuracy = 1.0;
  CHECK_THROWS_WITH(balance.find(options), Catch::Contains("accuracy"));
}
