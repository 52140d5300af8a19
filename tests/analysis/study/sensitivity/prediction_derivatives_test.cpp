#include "limcycle/analysis/study/sensitivity/prediction_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/tests/cycle_knobs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

struct Place {
  double amplitude, frequency;
};

/// A root near a place, by Newton on the balance with slopes by differences (independent of limcycle's derivatives).
Place root_near(const Loop& loop, Place at) {
  const FirstHarmonicBalance balance(loop);
  for (int i = 0; i < 12; ++i) {
    const auto f = [&](double a, double w) { return balance(at.amplitude * a, at.frequency * w, 1e-12); };
    const std::complex<double> here = f(1.0, 1.0), by_a = (f(1.0 + 1e-6, 1.0) - f(1.0 - 1e-6, 1.0)) / 2e-6,
                               by_w = (f(1.0, 1.0 + 1e-6) - f(1.0, 1.0 - 1e-6)) / 2e-6;
    const double det = by_a.real() * by_w.imag() - by_a.imag() * by_w.real();
    const double da = -(here.real() * by_w.imag() - here.imag() * by_w.real()) / det;
    const double dw = -(by_a.real() * here.imag() - by_a.imag() * here.real()) / det;
    at.amplitude *= std::exp(std::clamp(da, -0.1, 0.1));
    at.frequency *= std::exp(std::clamp(dw, -0.1, 0.1));
  }
  REQUIRE(std::abs(balance(at.amplitude, at.frequency, 1e-12)) < 1e-10);
  return at;
}

void check_roots(const LoopParts& parts, const std::vector<Knob>& knobs, Place guess, double apart) {
  const Loop loop = build_loop(parts);
  const Place root = root_near(loop, guess);
  const auto found = prediction_derivatives(loop, root.amplitude, root.frequency, neighbours(parts, knobs));
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  REQUIRE(found.by.size() == knobs.size());
  CHECK(found.amplitude ==
        Approx(FirstHarmonicBalance(loop).output_amplitude(root.amplitude, root.frequency)).epsilon(1e-8));
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    const double at = value(parts, knobs[k]), h = apart * at;
    double amplitude = 0.0, frequency = 0.0;
    for (const auto& [steps, weight] : {std::pair(1.0, 45.0), {2.0, -9.0}, {3.0, 1.0}})
      for (const double side : {1.0, -1.0}) {
        const Loop there = with(parts, knobs[k], at + side * steps * h);
        const Place moved = root_near(there, root);
        const double share = side * weight / (60.0 * h);
        amplitude += share * FirstHarmonicBalance(there).output_amplitude(moved.amplitude, moved.frequency);
        frequency += share * moved.frequency;
      }
    CAPTURE(knobs[k].name);
    const auto& one = found.by[k];
    check(one.amplitude, one.amplitude_error, amplitude, 1e-5, 3e-10 / apart * found.amplitude / at);
    check(one.frequency, one.frequency_error, frequency, 1e-5, 3e-10 / apart * found.frequency / at);
  }
}

}  // namespace

TEST_CASE("derivatives of a predicted oscillation: relay before b/(s (s + 1)^2), closed form") {
  // 1 + N G = 0 at w = 1, where G = -b/2: A = 2 M b/pi.
  LoopParts parts;
  parts.plant = TransferFunction{{3.0}, {1.0, 2.0, 1.0, 0.0}, 0.0};
  parts.element = relay(0.5);
  const std::vector<Knob> knobs{
      of_relay("level", &Relay<double>::level),
      {"b", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).numerator[0]; }}};
  const double A = 3.0 / std::numbers::pi;
  const auto found = prediction_derivatives(build_loop(parts), A, 1.0, neighbours(parts, knobs));
  REQUIRE(found.status == Status::converged);
  CHECK(found.amplitude == Approx(A).epsilon(1e-10));
  CHECK(found.by[0].amplitude == Approx(A / 0.5).epsilon(1e-8));
  CHECK(found.by[1].amplitude == Approx(A / 3.0).epsilon(1e-8));
  for (const auto& one : found.by) {
    CHECK(std::abs(one.frequency) <= one.frequency_error);
    CHECK(one.frequency_error < 1e-6);
  }
  CHECK(std::abs(found.by[0].gain.gain - found.gain / 0.5) <= found.by[0].gain.error);

  CHECK(prediction_derivatives(build_loop(parts), 1.1 * A, 1.0, {}).status == Status::stalled);
}

TEST_CASE("derivatives of predicted oscillations against differences of roots") {
  LoopParts chain;
  chain.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  chain.element = relay(1.0, 0.02);
  check_roots(chain,
              {of_relay("level", &Relay<double>::level),
               of_relay("hysteresis", &Relay<double>::hysteresis),
               {"lag", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).denominator[1]; }}},
              {0.16, 1.7}, 1e-3);

  // The belt: a friction law with a mean velocity, at A w near it.
  const auto belt = belt_parts(lugre(1.5, 1.0, 0.0));
  const auto on_belt =
      find_df_roots(build_loop(belt), FirstHarmonicBalance(build_loop(belt)), {0.02, 0.5, 0.3, 5.0}, {});
  REQUIRE(on_belt.roots.size() == 1);
  check_roots(belt, belt_knobs(), {on_belt.roots[0].amplitude, on_belt.roots[0].frequency}, 3e-5);
}

TEST_CASE("derivatives of predicted oscillations: what is not treated is refused") {
  auto parts = servo_parts(lugre());
  auto control = pid(3.0, 4.0, 6.0);
  control.saturation = 2.0;
  parts.controller = control;
  const auto found = prediction_derivatives(build_loop(parts), 0.1, 1.0, {});
  CHECK(found.status == Status::undefined);
  CHECK_FALSE(found.why.empty());
}
