// RODAS5P under step size control: tolerances met, bad steps rejected, nothing evaluated twice.
#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

using limcycle::ControlledRodas5p;
using limcycle::DenseSegment;
using limcycle::ErrorWeights;
using limcycle::State;

namespace odeint = boost::numeric::odeint;

namespace {

/// Stiff (lambda = -1e6) and forced: x follows cos t, y' = x, so that y = sin t.
struct Forced {
  static constexpr double lambda = -1e6;
  static State exact(double t) { return {std::cos(t), std::sin(t)}; }
  static void rhs(const State& x, State& rate, double t) {
    rate[0] = lambda * (x[0] - std::cos(t)) - std::sin(t);
    rate[1] = x[0];
  }
  static void jacobian(const State&, Eigen::MatrixXd& J, double t, State& dfdt) {
    J(0, 0) = lambda;
    J(1, 0) = 1;
    dfdt[0] = lambda * std::sin(t) - std::cos(t);
  }
  static auto system() { return std::make_pair(&rhs, &jacobian); }
  static double error(const State& x, double t) {
    return std::max(std::abs(x[0] - std::cos(t)), std::abs(x[1] - std::sin(t)));
  }
};

ErrorWeights weights(double tolerance, std::size_t n = 2) { return {tolerance, State(n, tolerance)}; }

}  // namespace

TEST_CASE("The controlled RODAS5P keeps to its tolerance, forwards and backwards", "[rodas5p]") {
  double before = 1;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    State x = Forced::exact(0);
    const std::size_t steps =
        odeint::integrate_adaptive(ControlledRodas5p(weights(tolerance)), Forced::system(), x, 0.0, 20.0, 1e-3);
    const double error = Forced::error(x, 20.0);
    CAPTURE(tolerance, steps, error);
    CHECK(error < 20 * tolerance);
    CHECK(error < before);
    before = error;
  }
  // Backwards on x' = -2 t x^2, x = 1/(1+t^2).
  const auto falling = std::make_pair([](const State& x, State& rate, double t) { rate[0] = -2 * t * x[0] * x[0]; },
                                      [](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
                                        J(0, 0) = -4 * t * x[0];
                                        dfdt[0] = -2 * x[0] * x[0];
                                      });
  State x{0.1};
  odeint::integrate_adaptive(ControlledRodas5p(weights(1e-9, 1)), falling, x, 3.0, 0.0, -1e-3);
  CHECK(x[0] == Approx(1).epsilon(1e-6));
}

namespace {

const auto van_der_pol_system = [](double mu) {
  return std::make_pair(
      [=](const State& x, State& rate, double) {
        rate[0] = x[1];
        rate[1] = mu * (1 - x[0] * x[0]) * x[1] - x[0];
      },
      [=](const State& x, Eigen::MatrixXd& J, double, State&) {
        J(0, 1) = 1;
        J(1, 0) = -2 * mu * x[0] * x[1] - 1;
        J(1, 1) = mu * (1 - x[0] * x[0]);
      });
};

}  // namespace

TEST_CASE("A NaN rejects a step of RODAS5P and shrinks it", "[rodas5p]") {
  // x' = -sqrt(1 - t), x = 2/3 (1-t)^(3/2) for t <= 1; NaN beyond.
  const auto ending =
      std::make_pair([](const State&, State& rate, double t) { rate[0] = -std::sqrt(1 - t); },
                     [](const State&, Eigen::MatrixXd&, double t, State& dfdt) { dfdt[0] = 0.5 / std::sqrt(1 - t); });
  ControlledRodas5p stepper(weights(1e-6, 1));
  State x{2.0 / 3};
  double t = 0;
  double dt = 1.5;
  CHECK(stepper.try_step(ending, x, t, dt) == odeint::fail);
  CHECK(t == 0);
  CHECK(x == State{2.0 / 3});
  CHECK(dt > 0);
  CHECK(dt < 1.5);
  CHECK(stepper.last_error() == std::numeric_limits<double>::infinity());
  int successes = 0;
  for (int tries = 0; tries < 3000 && t + dt > t; ++tries) {
    if (stepper.try_step(ending, x, t, dt) == odeint::success) ++successes;
    REQUIRE(std::isfinite(x[0]));
    REQUIRE(std::isfinite(dt));
    REQUIRE(t <= 1);
  }
  CHECK(successes > 3);
  CHECK(t == Approx(1).epsilon(1e-3));
  CHECK(x[0] == Approx(2.0 / 3 * std::pow(1 - t, 1.5)).margin(1e-5));

  // Odeint's integrate functions throw instead of returning a NaN.
  State y{2.0 / 3};
  CHECK_THROWS_AS(odeint::integrate_adaptive(ControlledRodas5p(weights(1e-6, 1)), ending, y, 0.0, 2.0, 0.1),
                  odeint::step_adjustment_error);
  CHECK(std::isfinite(y[0]));
}

TEST_CASE("An infinite state rejects a step although its error estimate is 0", "[rodas5p]") {
  // The right-hand side ignores the state, so the last stage (the error estimate) is 0 and the new state infinite.
  const auto blind =
      std::make_pair([](const State&, State& rate, double) { rate[0] = std::numeric_limits<double>::max(); },
                     [](const State&, Eigen::MatrixXd&, double, State&) {});
  ControlledRodas5p stepper(weights(1e-6, 1));
  State x{std::numeric_limits<double>::max()};
  double t = 0;
  double dt = 10;
  CHECK(stepper.try_step(blind, x, t, dt) == odeint::fail);
  CHECK(std::isfinite(x[0]));
}

TEST_CASE("The controlled RODAS5P evaluates the start of a rejected step once", "[rodas5p]") {
  int rhs_calls = 0;
  int jacobian_calls = 0;
  double mu = 5;
  const auto system = std::make_pair(
      [&](const State& x, State& rate, double t) { ++rhs_calls, van_der_pol_system(mu).first(x, rate, t); },
      [&](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
        ++jacobian_calls, van_der_pol_system(mu).second(x, J, t, dfdt);
      });
  ControlledRodas5p stepper(weights(1e-8));
  State x{1.5, -2};
  double t = 0;
  double dt = 1;
  int failures = 0;
  while (stepper.try_step(system, x, t, dt) == odeint::fail) ++failures;
  REQUIRE(failures >= 1);
  CHECK(jacobian_calls == 1);
  CHECK(rhs_calls == 8 + 7 * failures);
  const double accepted = t;

  // Not if the state, the time or the system is another one.
  dt = 1;
  REQUIRE(stepper.try_step(system, x, t, dt) == odeint::fail);
  CHECK(jacobian_calls == 2);
  State moved = x;
  moved[0] += 0.1;
  dt = 1e-6;
  CHECK(stepper.try_step(system, moved, t, dt) == odeint::success);
  CHECK(jacobian_calls == 3);
  t = accepted;
  dt = 1;
  REQUIRE(stepper.try_step(system, x, t, dt) == odeint::fail);
  mu = 1;
  stepper.reset();
  dt = 1e-3;
  CHECK(stepper.try_step(system, x, t, dt) == odeint::success);
  CHECK(jacobian_calls == 5);
}

TEST_CASE("A step of given length from the old state repeats the controlled step", "[rodas5p]") {
  // As when landing on an event: the step was accepted, then is repeated with another length.
  ControlledRodas5p stepper(weights(1e-6));
  const State x0{2, -0.1};
  State x1;
  double t = 0.5;
  double dt = 0.01;
  REQUIRE(stepper.try_step(van_der_pol_system(5), x0, t, x1, dt) == odeint::success);
  CHECK(t == 0.51);
  DenseSegment segment;
  stepper.interpolant(segment);
  State landed;
  State error;
  stepper.stepper().do_step(van_der_pol_system(5), x0, 0.5, landed, t - 0.5, error);
  CHECK(landed[0] == Approx(x1[0]).epsilon(1e-14));
  stepper.stepper().do_step(van_der_pol_system(5), x0, 0.5, landed, 0.004, error);
  CHECK(landed[0] == Approx(segment.at(0.504, 0)).epsilon(1e-9));
  stepper.stepper().repeat_step(van_der_pol_system(5), landed, 0.006, error);
  CHECK(landed[0] == Approx(segment.at(0.506, 0)).epsilon(1e-9));
}

TEST_CASE("The controlled RODAS5P observes the longest step and refuses what it cannot use", "[rodas5p]") {
  ControlledRodas5p stepper(weights(1e-3), 0.05);
  State x = Forced::exact(0);
  double t = 0;
  double dt = 1;
  for (int i = 0; i < 20; ++i) {
    const double before = t;
    if (stepper.try_step(Forced::system(), x, t, dt) == odeint::success) CHECK(t - before <= 0.05 * (1 + 1e-12));
  }
  dt = 0;
  CHECK_THROWS_AS(stepper.try_step(Forced::system(), x, t, dt), std::invalid_argument);
  dt = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(stepper.try_step(Forced::system(), x, t, dt), std::invalid_argument);
  State wrong{1};
  dt = 0.1;
  CHECK_THROWS_AS(stepper.try_step(Forced::system(), wrong, t, dt), std::invalid_argument);
  CHECK_THROWS_AS(ControlledRodas5p(weights(0)), std::invalid_argument);
  CHECK_THROWS_AS(ControlledRodas5p(weights(1e-6), -1), std::invalid_argument);

  // A step too short to advance the time fails, however small its error.
  double late = 1e6;
  double tiny = 1e-12;
  State y = Forced::exact(late);
  CHECK(stepper.try_step(Forced::system(), y, late, tiny) == odeint::fail);
  CHECK(late == 1e6);
  CHECK(tiny < 1e-12);
}
