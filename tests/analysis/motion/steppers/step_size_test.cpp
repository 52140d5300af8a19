// The choice of the next step.
#include "limcycle/analysis/motion/steppers/step_size.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using limcycle::StepSizeControl;

TEST_CASE("A step grows and shrinks within limits", "[step_size]") {
  StepSizeControl control;
  CHECK(control.after_success(0.1, 0) == Approx(0.6));
  control.reset();
  CHECK(control.after_success(-0.1, 1e-30) == Approx(-0.6));
  control.reset();
  CHECK(control.after_success(0.1, 1) == Approx(0.09));
  CHECK(control.after_failure(0.1, 1e30) == Approx(0.02));
  CHECK(control.after_failure(0.1, std::numeric_limits<double>::infinity()) == Approx(0.02));
  CHECK(control.after_failure(0.1, 2) == Approx(0.09 / std::pow(2, 0.2)));
  CHECK(control.after_failure(0.1, 0) < 0.1);
}

TEST_CASE("A step does not grow right after a failure, but may later", "[step_size]") {
  StepSizeControl control;
  const double shorter = control.after_failure(1, 32);
  CHECK(shorter == Approx(0.45));
  CHECK(control.after_success(shorter, 1e-6) == shorter);
  CHECK(control.after_success(shorter, 1e-6) > shorter);
}

TEST_CASE("The trend of the error is predicted", "[step_size]") {
  // error = phi h^5 with phi growing by half at every step: with the trend the next error is about 0.9^5.
  StepSizeControl control;
  double h = 1;
  double phi = 0.1;
  double error = 0;
  for (int i = 0; i < 30; ++i) {
    error = phi * std::pow(h, 5);
    REQUIRE(error <= 1);
    h = control.after_success(h, error);
    phi *= 1.5;
  }
  CHECK(error == Approx(std::pow(0.9, 5)).epsilon(0.01));
}
