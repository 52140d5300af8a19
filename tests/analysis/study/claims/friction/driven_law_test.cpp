#include "limcycle/analysis/study/claims/friction/driven_law.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

Jenkins<double> jenkins() {
  Jenkins<double> law;
  law.k = 1000.0;
  law.Fc = 1.5;
  return law;
}

Dahl<double> dahl() {
  Dahl<double> law;
  law.Fc = 1.0;
  law.sigma0 = 1e5;
  return law;
}

}  // namespace

TEST_CASE("driven law: Dahl's virgin curve with the error of a method of order 4") {
  const double exact = 1.0 - std::exp(-1.0);
  const auto error = [&](int steps) {
    DrivenLaw motion(dahl());
    motion.slide(0.3, 1e-5, steps);
    return std::abs(motion.force() - exact);
  };
  CHECK(error(10) < 1e-5);
  CHECK(error(10) / error(20) == Approx(16.0).epsilon(0.1));
  CHECK(error(20) / error(40) == Approx(16.0).epsilon(0.1));
}

TEST_CASE("driven law: a slider gives way exactly at its limit, whatever the steps, and turns back") {
  const double A = 0.004, h = 1.5e-3;
  for (const int steps : {1, 7, 100}) {
    CAPTURE(steps);
    DrivenLaw motion(jenkins());
    motion.slide(1.0, A, steps);
    CHECK(motion.force() == Approx(1.5).epsilon(1e-13));
    const double before = motion.work();
    motion.slide(-1.0, 2.0 * A, 2 * steps);
    CHECK(motion.force() == Approx(-1.5).epsilon(1e-13));
    motion.slide(1.0, 2.0 * A, 2 * steps);
    CHECK(motion.x() == Approx(A).epsilon(1e-12));
    // Claim A8: W = 4 Fc (A - h).
    CHECK(motion.work() - before == Approx(4.0 * 1.5 * (A - h)).epsilon(1e-10));
  }
}

TEST_CASE("driven law: a smooth velocity gives the path, and the force of a law that knows the path only") {
  DrivenLaw smooth(dahl()), even(dahl());
  smooth.go([](double t) { return 1e-5 * std::sin(t); }, M_PI, 400);
  even.slide(1.0, 2e-5, 400);
  CHECK(smooth.x() == Approx(2e-5).epsilon(1e-9));
  CHECK(smooth.force() == Approx(even.force()).epsilon(1e-8));
}

TEST_CASE("driven law: to a force, by bisection, and not beyond what the law can bear") {
  DrivenLaw motion(dahl());
  REQUIRE(motion.slide_to_force(1e-6, 0.5, 1e-7));
  CHECK(motion.force() == Approx(0.5).epsilon(1e-12));
  CHECK(motion.x() == Approx(1e-5 * std::log(2.0)).epsilon(1e-7));
  REQUIRE(motion.slide_to_force(-1e-6, -0.5, 1e-6));
  CHECK(motion.force() == Approx(-0.5).epsilon(1e-12));
  CHECK_FALSE(motion.slide_to_force(1e-6, 1.01, 1e-6, 100));
}

TEST_CASE("driven law: a state that is lost is reported") {
  DrivenLaw motion(test::lugre());
  CHECK_THROWS_AS(motion.go([](double) { return NAN; }, 1.0, 3), std::domain_error);
  // Explicit steps far too long for the bristle: the state overflows.
  DrivenLaw stiff(test::lugre());
  CHECK_THROWS_AS(stiff.slide(1.0, 1e6, 1000), std::domain_error);
}
