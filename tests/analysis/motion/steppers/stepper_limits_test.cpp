#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

Loop stiff_servo(double sigma0) {
  auto law = lugre();
  law.sigma0 = sigma0;
  law.sigma1 = std::sqrt(sigma0);
  return servo(law);
}

}  // namespace

TEST_CASE("stepper limits: the tolerance on v stays below the creep of stick") {
  for (const double sigma0 : {1e6, 1e7, 1e8}) {
    const Loop loop = stiff_servo(sigma0);
    const double limit = loosest_stiff_tolerance(loop), slowest = pole_moduli(loop).front();
    // State 1 is the velocity of the mass; the force of the servo changes by Fs w/5 a second.
    CHECK(loop_weights(loop, limit).atol[1] == Approx(0.2 * 1.5 * slowest / sigma0).epsilon(1e-12));
  }
  CHECK(loosest_stiff_tolerance(stiff_servo(1e7)) == Approx(10.0 * loosest_stiff_tolerance(stiff_servo(1e8))));
  CHECK(loosest_stiff_tolerance(servo(coulomb(1.5, 1.0))) == infinite);
  CHECK(loosest_stiff_tolerance(forward(relay(1.0), {1.0}, {1.0, 1.0, 0.0})) == infinite);
}

TEST_CASE("stepper limits: notes name what to do, and are silent at the default tolerance") {
  const auto loose = stepper_notes(stiff_servo(1e7), StepperKind::rodas5p, 1e-3);
  REQUIRE(loose.size() == 1);
  CHECK_THAT(loose[0], Contains("rtol = 0.001 is too loose") && Contains("take rtol = 1e-05"));
  CHECK(stepper_notes(stiff_servo(1e7), StepperKind::automatic, 1e-3) == loose);
  CHECK(stepper_notes(stiff_servo(1e7), StepperKind::rodas5p, 1e-5).empty());
  for (const double sigma0 : {1e3, 1e5, 1e8})
    CHECK(stepper_notes(stiff_servo(sigma0), StepperKind::automatic, 1e-7).empty());

  CHECK(stepper_notes(stiff_servo(1e4), StepperKind::dopri5, 1e-7).empty());
  const auto slow = stepper_notes(stiff_servo(1e7), StepperKind::dopri5, 1e-7);
  REQUIRE(slow.size() == 1);
  CHECK_THAT(slow[0], Contains("dopri5 is explicit") && Contains("rodas5p"));
  CHECK(explicit_steps(stiff_servo(1e7)) == Approx(100.0 * explicit_steps(stiff_servo(1e5))));
  CHECK(explicit_steps(servo(coulomb(1.5, 1.0))) == 0.0);
}
