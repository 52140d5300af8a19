#include "limcycle/analysis/energy/loop/sliding_stability.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::function<Loop(double)> belts(Element law) {
  return [law](double speed) {
    LoopParts parts;
    parts.plant = Belt{1.0, 2.0, 0.0, speed};
    parts.friction = law;
    return build_loop(parts);
  };
}

/// Growth factor of a small deviation of y from steady sliding after `duration`.
double grown(const Loop& loop, double duration) {
  const SlidingStability at = sliding_stability(loop);
  LoopField field(loop);
  field.modes() = at.point.modes;
  March march(field, choose_stepper(loop, 1e-9), loop_weights(loop, 1e-9));
  State x = at.point.x;
  constexpr double nudge = 1e-7;
  x[0] += nudge;
  march.begin(x, 0.0);
  double late = 0.0;
  while (march.t() < duration) {
    REQUIRE(march.step(duration) == Status::converged);
    if (march.t() > duration - 5.0) late = std::max(late, std::abs(march.x()[0] - at.point.x[0]));
  }
  return late / nudge;
}

/// Incremental damping of LuGre sliding at V > 0, by hand (claim B10).
std::complex<double> lugre_damping(const LuGre<double>& law, double V, double w) {
  const double x = V / law.vs, g = law.Fc + (law.Fs - law.Fc) * std::exp(-x * x);
  const double slope = -2.0 * x / law.vs * (law.Fs - law.Fc) * std::exp(-x * x);
  const std::complex<double> jw(0.0, w);
  return law.sigma2 + (law.sigma0 + jw * law.sigma1) * (V * slope / g) / (jw + law.sigma0 * V / g);
}

}  // namespace

TEST_CASE("steady slide: every law ends on its own steady force") {
  int curves = 0;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_samples<Kind>([&](const auto& law, const Sample& sample) {
      if (!sample.is_steady) return;
      for (const double V : {-0.02, 0.002}) {
        const auto slide = steady_slide(law, V);
        INFO(law.kind << ", " << sample.name << ", V = " << V);
        if constexpr (requires {
                        law.level(V);
                        law.sigma2;
                      }) {
          if (!slide) continue;
          const double expected = std::copysign(law.level(V), V) + law.sigma2 * V;
          if (law.kind != "non-drift" && law.kind != "wojewoda") CHECK(slide->force == Approx(expected).epsilon(1e-9));
          ++curves;
        } else if (std::isfinite(sample.steady)) {
          if (slide) CHECK(std::abs(slide->force) == Approx(sample.steady).epsilon(1e-6).margin(std::abs(10.0 * V)));
        }
      }
    });
  });
  CHECK(curves >= 30);
  CHECK_FALSE(steady_slide(coulomb(1.5, 1.0), 0.0));
}

TEST_CASE("incremental damping of LuGre at a mean velocity (claim B10)") {
  const LuGre<double> law = lugre();
  const auto slide = steady_slide(law, 2e-4);
  REQUIRE(slide);
  CHECK(slide->response.at({0.0, 30.0})(0, 0).real() == Approx(-39.0).margin(0.5));
  CHECK(slide->response.at({0.0, 0.0})(0, 0).real() == Approx(-192.0).margin(0.5));
  for (const double V : {2e-4, 1e-3, 5e-3})
    for (const double w : {0.1, 30.0, 1e4}) {
      const std::complex<double> found = steady_slide(law, V)->response.at({0.0, w})(0, 0);
      CHECK(std::abs(found - lugre_damping(law, V, w)) < 1e-11 * std::abs(found));
    }
}

TEST_CASE("steady sliding on a belt: the Hopf speed solves the characteristic equation of impedance and law") {
  for (const Element& law : {Element(lugre()), Element(lugre(1.5, 1.0, 4.0))}) {
    const auto changes = sliding_stability_changes(belts(law), 1e-3, 1.0);
    REQUIRE(changes.size() == 1);
    const HopfPoint& hopf = changes.front();
    CHECK(hopf.stable_above);
    // m jw + k/(jw) + damping(jw) = 0: independent of the Jacobian of the loop
    const std::complex<double> jw(0.0, hopf.frequency),
        damping = lugre_damping(law_of<LuGre<double>>(law), hopf.speed, hopf.frequency);
    CHECK(std::abs(jw + 2.0 / jw + damping) < 1e-7);
  }
  const double speed = sliding_stability_changes(belts(lugre()), 1e-3, 1.0).front().speed;
  CHECK(speed == Approx(2.98631634e-3).epsilon(1e-8));
}

TEST_CASE("steady sliding on a belt: above the Hopf speed deviations die out, below they grow into a cycle") {
  const auto family = belts(lugre());
  const double speed = sliding_stability_changes(family, 1e-3, 1.0).front().speed;
  CHECK(sliding_stability(family(1.03 * speed)).stable.decision == Decision::yes);
  CHECK(sliding_stability(family(0.97 * speed)).stable.decision == Decision::no);
  CHECK(grown(family(1.03 * speed), 30.0) < 0.5);
  CHECK(grown(family(0.97 * speed), 30.0) > 2.0);
  const Loop below = family(0.97 * speed);
  CHECK(settle(below, displaced(below, 1e-4), {}).outcome == Outcome::cycle);
}

TEST_CASE("steady sliding: a pendulum on a shaft swings between two speeds of the shaft") {
  FroudePendulum plant = froude_pendulum(4.0);
  auto law = with_levels<LuGre<double>>(17.0, 7.4);
  law.vs = 0.1;
  law.sigma0 = 1e5;
  law.sigma1 = 100.0;
  law.sigma2 = 1.0;
  const auto family = [&](double speed) {
    plant.shaft_speed = speed;
    return build_loop(parts_of(plant, law));
  };
  const auto changes = sliding_stability_changes(family, 0.1, 100.0);
  REQUIRE(changes.size() == 2);
  CHECK_FALSE(changes[0].stable_above);
  CHECK(changes[1].stable_above);
  for (const HopfPoint& hopf : changes) {
    // inertia jw + damping + weight arm cos(angle)/(jw) + radius^2 damping of the law = 0
    const double v = plant.shaft_radius * hopf.speed, torque = plant.shaft_radius * steady_slide(law, v)->force;
    const double weight = plant.mass * plant.gravity * plant.arm,
                 cosine = std::sqrt(1.0 - std::pow(torque / weight, 2));
    const std::complex<double> jw(0.0, hopf.frequency);
    const std::complex<double> sum = plant.inertia * jw + plant.damping + weight * cosine / jw +
                                     plant.shaft_radius * plant.shaft_radius * lugre_damping(law, v, hopf.frequency);
    CHECK(std::abs(sum) < 1e-9);
  }
  const Loop inside = family(4.0);
  CHECK(sliding_stability(inside).stable.decision == Decision::no);
  CHECK(settle(inside, displaced(inside, 0.01), {}).outcome == Outcome::cycle);
}

TEST_CASE("steady sliding: what the law or the loop does not decide is left open") {
  CHECK(sliding_stability(belt(coulomb(1.5, 1.0))).stable.decision == Decision::undecided);  // undamped: on the axis
  CHECK(sliding_stability_changes(belts(coulomb(1.5, 1.0)), 1e-3, 1.0).empty());
  CHECK(sliding_stability(servo(lugre())).stable.decision == Decision::not_applicable);
  CHECK(sliding_stability(forward(relay(1.0), {1.0}, {1.0, 1.0})).stable.decision == Decision::not_applicable);
  CHECK_THROWS_AS(sliding_stability_changes(belts(lugre()), 1.0, 0.5), std::invalid_argument);
  CHECK_THROWS_AS(sliding_stability_changes(belts(lugre()), 0.0, 0.5), std::invalid_argument);
  // A servo that follows a ramp slides in the mean.
  LoopParts parts = servo_parts(lugre());
  parts.reference_rate = 0.1;
  const SlidingStability ramp = sliding_stability(build_loop(parts));
  CHECK(ramp.velocity == Approx(0.1).epsilon(1e-9));
  CHECK(ramp.stable.decision == Decision::yes);
}

TEST_CASE("steady sliding: Jacobian against differences of the field, for a law with many states") {
  const auto law = made<Xiong<double>>(samples_of_kind("xiong").front().settings);
  const Loop loop = belts(law)(0.002);
  const SlidingStability at = sliding_stability(loop);
  REQUIRE(at.stable.decision != Decision::not_applicable);
  LoopField field(loop);
  field.modes() = at.point.modes;
  State rate;
  field.rate(at.point.x, rate, 0.0);
  const State typical = typical_sizes(loop);
  for (std::size_t i = 0; i < rate.size(); ++i) CHECK(std::abs(rate[i]) < 1e-6 * typical[i]);
  CHECK(std::abs(at.force) == Approx(law.level(0.002) + law.sigma2 * 0.002).epsilon(1e-9));
}
