// RODAS5P with dense output: the state between steps, a cycle found from it, and Odeint's integrate functions.
#include "limcycle/analysis/motion/steppers/dense_rodas5p.hpp"

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/integrate/integrate_times.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

using limcycle::ControlledRodas5p;
using limcycle::DenseRodas5p;
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

/// Records the worst error and the times of an Odeint run.
struct Record {
  std::vector<double>* times;
  double* worst;
  void operator()(const State& x, double t) const {
    times->push_back(t);
    *worst = std::max(*worst, Forced::error(x, t));
  }
};

/// Runs `drive(stepper, x, observer)` for both kinds of stepper; the times must be as given (unless empty).
template <class Drive>
void check_driven(Drive drive, const std::vector<double>& expected) {
  const auto check = [&](auto stepper) {
    State x = Forced::exact(0);
    std::vector<double> times;
    double worst = 0;
    drive(stepper, x, Record{&times, &worst});
    CHECK(worst < 1e-6);
    CHECK(times.size() >= 2);
    CHECK(times.front() == 0.0);
    CHECK(times.back() == Approx(3.0).epsilon(1e-14));
    if (expected.empty()) return;
    REQUIRE(times.size() == expected.size());
    for (std::size_t i = 0; i < times.size(); ++i) CHECK(times[i] == Approx(expected[i]).epsilon(1e-14));
  };
  check(ControlledRodas5p(weights(1e-8)));
  check(DenseRodas5p(ControlledRodas5p(weights(1e-8))));
}

const auto van_der_pol = [](double mu) {
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

struct Oscillation {
  double period = 0;
  double amplitude = 0;
};

/// Period and amplitude of van der Pol's cycle from the dense output: maxima of x (falling zeros of its rate), after
/// the cycle was reached.
Oscillation oscillation(double mu, double tolerance) {
  DenseRodas5p stepper((ControlledRodas5p(weights(tolerance))));
  stepper.initialize({2, 0}, 0.0, 1e-3);
  std::vector<double> maxima;
  double amplitude = 0;
  while (maxima.size() < 5) {
    stepper.do_step(van_der_pol(mu));
    if (!(stepper.previous_state()[1] > 0 && stepper.current_state()[1] <= 0)) continue;
    double low = stepper.previous_time();
    double high = stepper.current_time();
    for (int i = 0; i < 100; ++i) {
      const double middle = (low + high) / 2;
      (stepper.segment().at(middle, 1) > 0 ? low : high) = middle;
    }
    maxima.push_back(low);
    amplitude = stepper.segment().at(low, 0);
  }
  return {maxima[4] - maxima[3], amplitude};
}

}  // namespace

TEST_CASE("Odeint drives the controlled and the dense RODAS5P", "[rodas5p][odeint]") {
  std::vector<double> grid;
  for (int i = 0; i <= 12; ++i) grid.push_back(0.25 * i);
  const auto system = Forced::system();

  check_driven([&](auto stepper, State& x,
                   Record record) { odeint::integrate_adaptive(stepper, system, x, 0.0, 3.0, 1e-3, record); },
               {});
  check_driven([&](auto stepper, State& x,
                   Record record) { odeint::integrate_const(stepper, system, x, 0.0, 3.0, 0.25, record); },
               grid);
  check_driven([&](auto stepper, State& x,
                   Record record) { odeint::integrate_n_steps(stepper, system, x, 0.0, 0.25, 12, record); },
               grid);
  const std::vector<double> times{0.0, 0.1, 0.11, 2.0, 2.5, 3.0};
  check_driven(
      [&](auto stepper, State& x, Record record) {
        odeint::integrate_times(stepper, system, x, times.begin(), times.end(), 1e-3, record);
      },
      times);
}

TEST_CASE("The dense RODAS5P finds van der Pol's cycle", "[rodas5p]") {
  // Period and amplitude of the exact cycle, 9 digits.
  const Oscillation five = oscillation(5, 1e-11);
  CHECK(five.period == Approx(11.61223066).epsilon(2e-9));
  CHECK(five.amplitude == Approx(2.02150806).epsilon(5e-9));
  const Oscillation one = oscillation(1, 1e-11);
  CHECK(one.period == Approx(6.66328686).epsilon(2e-9));
  CHECK(one.amplitude == Approx(2.00861986).epsilon(5e-9));
}

TEST_CASE("The dense RODAS5P knows the state between its steps", "[rodas5p]") {
  DenseRodas5p stepper((ControlledRodas5p(weights(1e-8))));
  stepper.initialize(Forced::exact(0), 0.0, 1e-4);
  State x;
  stepper.calc_state(0.0, x);
  CHECK(x == Forced::exact(0));
  CHECK_THROWS_AS(stepper.calc_state(0.1, x), std::invalid_argument);  // no step has been taken yet
  double at_ends = 0;
  double between = 0;
  double end = 0;
  while (end < 10) {
    const auto [start, finish] = stepper.do_step(Forced::system());
    CHECK(start == end);
    CHECK(stepper.previous_time() == start);
    CHECK(stepper.current_time() == finish);
    CHECK(stepper.current_time_step() > 0);
    end = finish;
    at_ends = std::max(at_ends, Forced::error(stepper.current_state(), finish));
    for (int i = 0; i <= 10; ++i) {
      const double t = start + (finish - start) * i / 10;
      stepper.calc_state(t, x);
      between = std::max(between, Forced::error(x, t));
    }
    stepper.calc_state(finish, x);
    CHECK(x == stepper.current_state());
    stepper.calc_state(start, x);
    CHECK(x == stepper.previous_state());
    CHECK_THROWS_AS(stepper.calc_state(finish + 0.01, x), std::invalid_argument);
  }
  // The tolerance is 1e-8. The interpolant's order falls for stiff components, so it is worse than the ends.
  CHECK(at_ends < 1e-8);
  CHECK(between < 2e-7);
}

TEST_CASE("The dense RODAS5P stops before a NaN", "[rodas5p]") {
  // x' = -sqrt(1 - t), x = 2/3 (1-t)^(3/2) for t <= 1; NaN beyond.
  const auto ending =
      std::make_pair([](const State&, State& rate, double t) { rate[0] = -std::sqrt(1 - t); },
                     [](const State&, Eigen::MatrixXd&, double t, State& dfdt) { dfdt[0] = 0.5 / std::sqrt(1 - t); });
  DenseRodas5p dense(ControlledRodas5p(weights(1e-6, 1)));
  dense.initialize({2.0 / 3}, 0.0, 0.1);
  const auto go_on = [&] {
    for (int i = 0; i < 10000; ++i) dense.do_step(ending);
  };
  CHECK_THROWS_AS(go_on(), odeint::step_adjustment_error);
  CHECK(std::isfinite(dense.current_state()[0]));
  CHECK(dense.current_time() <= 1);
}
