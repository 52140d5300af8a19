// One step of RODAS5P: measured orders, stiff problems, and side effects of a step.
#include "limcycle/analysis/motion/steppers/rodas5p.hpp"

#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

using limcycle::DenseSegment;
using limcycle::Rodas5p;
using limcycle::State;

namespace odeint = boost::numeric::odeint;

namespace {

/// Non-linear, coupled, and dependent on time: x = 1/(1+t^2), y = sin t solve it exactly.
struct Smooth {
  static State exact(double t) { return {1 / (1 + t * t), std::sin(t)}; }
  static void rhs(const State& x, State& rate, double t) {
    rate[0] = -2 * t * x[0] * x[0];
    rate[1] = std::cos(t) + x[0] * x[1] * x[1] - std::sin(t) * std::sin(t) / (1 + t * t);
  }
  static void jacobian(const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
    J(0, 0) = -4 * t * x[0];
    J(1, 0) = x[1] * x[1];
    J(1, 1) = 2 * x[0] * x[1];
    const double q = 1 + t * t;
    dfdt[0] = -2 * x[0] * x[0];
    dfdt[1] = -std::sin(t) - std::sin(2 * t) / q + 2 * t * std::sin(t) * std::sin(t) / (q * q);
  }
  static auto system() { return std::make_pair(&rhs, &jacobian); }
};

double distance(const State& a, const State& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

/// Error at t = 2 (from t = 0, or back from there to 0) after `steps` equal steps of the solution or of the embedded
/// one.
double global_error(int steps, bool embedded, bool backwards = false) {
  Rodas5p stepper;
  const double h = (backwards ? -2.0 : 2.0) / steps;
  const double begin = backwards ? 2.0 : 0.0;
  State x = Smooth::exact(begin);
  State error;
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    stepper.do_step(Smooth::system(), x, begin + i * h, h, error);
    if (embedded)
      for (std::size_t k = 0; k < x.size(); ++k) x[k] -= error[k];
    worst = std::max(worst, distance(x, Smooth::exact(begin + (i + 1) * h)));
  }
  return worst;
}

/// Largest error inside one step of length h.
double error_inside(double h) {
  Rodas5p stepper;
  State x;
  stepper.do_step(Smooth::system(), Smooth::exact(0.4), 0.4, x, h);
  DenseSegment segment;
  stepper.interpolant(segment);
  double worst = 0;
  for (int i = 1; i < 40; ++i) {
    const double t = 0.4 + h * i / 40;
    segment.at(t, x);
    worst = std::max(worst, distance(x, Smooth::exact(t)));
  }
  return worst;
}

double order_between(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("RODAS5P converges at order 5, its embedded solution at order 4", "[rodas5p]") {
  for (const int steps : {20, 40, 80}) {
    CAPTURE(steps);
    CHECK(order_between(global_error(steps, false), global_error(2 * steps, false)) == Approx(5).margin(0.3));
    CHECK(order_between(global_error(steps, false, true), global_error(2 * steps, false, true)) ==
          Approx(5).margin(0.3));
  }
  // The error of the embedded solution is small for its order here, so its own order shows at short steps only.
  for (const int steps : {160, 320})
    CHECK(order_between(global_error(steps, true), global_error(2 * steps, true)) == Approx(4).margin(0.3));
}

TEST_CASE("RODAS5P's interpolant has local order 5 and meets both ends", "[rodas5p]") {
  for (const double h : {0.04, 0.02, 0.01})
    CHECK(order_between(error_inside(h), error_inside(h / 2)) == Approx(5).margin(0.3));

  Rodas5p stepper;
  const State x0 = Smooth::exact(1);
  State x1;
  State x;
  stepper.do_step(Smooth::system(), x0, 1.0, x1, 0.25);
  DenseSegment segment;
  stepper.interpolant(segment);
  CHECK(segment.start() == 1.0);
  CHECK(segment.end() == 1.25);
  segment.at(1.0, x);
  CHECK(x == x0);
  segment.at(1.25, x);
  CHECK(x == x1);
  CHECK(segment.at(1.1, 1) == Approx(std::sin(1.1)).epsilon(1e-5));
  CHECK_THROWS_AS(segment.at(1.2501, x), std::invalid_argument);
  CHECK_THROWS_AS(segment.at(0.9999, x), std::invalid_argument);
  CHECK_THROWS_AS(segment.at(std::numeric_limits<double>::quiet_NaN(), x), std::invalid_argument);
  CHECK_THROWS_AS(segment.at(1.1, 2), std::invalid_argument);

  // A later step leaves a segment alone.
  const double before = segment.at(1.1, 1);
  State other;
  stepper.do_step(Smooth::system(), x1, 1.25, other, 0.1);
  CHECK(segment.at(1.1, 1) == before);
}

namespace {

/// Prothero & Robinson (1974): x' = lambda (x - phi(t)) + phi'(t), solved by phi at any stiffness.
double prothero_robinson_error(double lambda, int steps) {
  const auto phi = [](double t) { return std::sin(t + 0.7); };
  const auto rate = [](double t) { return std::cos(t + 0.7); };
  const auto system =
      std::make_pair([=](const State& x, State& dxdt, double t) { dxdt[0] = lambda * (x[0] - phi(t)) + rate(t); },
                     [=](const State&, Eigen::MatrixXd& J, double t, State& dfdt) {
                       J(0, 0) = lambda;
                       dfdt[0] = -lambda * rate(t) - phi(t);
                     });
  Rodas5p stepper;
  State x{phi(0)};
  const double h = 2.0 / steps;
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    stepper.do_step(system, x, i * h, h);
    worst = std::max(worst, std::abs(x[0] - phi((i + 1) * h)));
  }
  return worst;
}

}  // namespace

TEST_CASE("RODAS5P follows a stiff forced problem however stiff it is", "[rodas5p]") {
  // Steinebach built the method so that the order does not fall below 4 for this problem: the bound is uniform in
  // lambda (h^4/(lambda h) in the stiff limit, so at one large lambda order 3 is seen, of a far smaller error).
  double before = 0;
  for (const int steps : {10, 20, 40}) {
    double worst = 0;
    for (double exponent = 0; exponent <= 9; exponent += 0.1)
      worst = std::max(worst, prothero_robinson_error(-std::pow(10.0, exponent), steps));
    CAPTURE(steps, worst);
    if (before == 0) {
      CHECK(worst < 1e-6);
    } else {
      CHECK(order_between(before, worst) > 3.7);
    }
    before = worst;
  }
}

TEST_CASE("RODAS5P kills a stiff transient in one step", "[rodas5p]") {
  // R(z) -> 0 as z -> -infinity. A method with R = O(1/z) leaves 3/z.
  const double lambda = -1e8;
  const auto system = std::make_pair([=](const State& x, State& dxdt, double) { dxdt[0] = lambda * x[0]; },
                                     [=](const State&, Eigen::MatrixXd& J, double, State&) { J(0, 0) = lambda; });
  Rodas5p stepper;
  State x{1.0};
  stepper.do_step(system, x, 0.0, 1.0);
  CHECK(std::abs(x[0]) < 1e-5);
}

TEST_CASE("RODAS5P gives the same answer for a system solved at fixed size and as a part of a larger one",
          "[rodas5p]") {
  // Copies of one oscillator: sizes 2 to 8 run at fixed size, 10 and 24 at dynamic size.
  const auto oscillators = std::make_pair(
      [](const State& x, State& dxdt, double) {
        for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
          dxdt[i] = x[i + 1];
          dxdt[i + 1] = 5 * (1 - x[i] * x[i]) * x[i + 1] - x[i];
        }
      },
      [](const State& x, Eigen::MatrixXd& J, double, State&) {
        for (Eigen::Index i = 0; i + 1 < J.rows(); i += 2) {
          const double p = x[static_cast<std::size_t>(i)];
          const double v = x[static_cast<std::size_t>(i) + 1];
          J(i, i + 1) = 1;
          J(i + 1, i) = -10 * p * v - 1;
          J(i + 1, i + 1) = 5 * (1 - p * p);
        }
      });
  Rodas5p small;
  State reference{1.5, -0.5};
  for (int i = 0; i < 10; ++i) small.do_step(oscillators, reference, 0.05 * i, 0.05);
  Rodas5p stepper;  // one object through all sizes: it resizes
  for (const std::size_t copies : {2u, 3u, 4u, 5u, 12u, 1u}) {
    State x;
    for (std::size_t i = 0; i < copies; ++i) x.insert(x.end(), {1.5, -0.5});
    for (int i = 0; i < 10; ++i) stepper.do_step(oscillators, x, 0.05 * i, 0.05);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == Approx(reference[i % 2]).epsilon(1e-12));
  }
}

TEST_CASE("RODAS5P gives the same answer with states beside that depend on nothing", "[rodas5p]") {
  // A stiff pair driven by w, w' = cos t; the others stand, or move with time alone. Size 3 runs at fixed size, 12 with
  // a system for the pair only.
  const auto system = std::make_pair(
      [](const State& x, State& dxdt, double t) {
        std::fill(dxdt.begin(), dxdt.end(), 0.0);
        dxdt[0] = x[1];
        dxdt[1] = -1e4 * (x[1] - x[2]) - x[0] * x[0] * x[0];
        dxdt[2] = std::cos(t);
        if (x.size() > 3) dxdt[7] = t * t;
      },
      [](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
        J(0, 1) = 1.0;
        J(1, 0) = -3.0 * x[0] * x[0];
        J(1, 1) = -1e4;
        J(1, 2) = 1e4;
        dfdt[2] = -std::sin(t);
        if (x.size() > 3) dfdt[7] = 2.0 * t;
      });
  Rodas5p alone, among;
  State small{1.0, 0.5, 0.0}, large{1.0, 0.5, 0.0, 3.0, 0.0, -2.0, 0.0, 0.0, 0.0, 7.0, 0.0, 0.0};
  for (int i = 0; i < 20; ++i) {
    alone.do_step(system, small, 0.1 * i, 0.1);
    among.do_step(system, large, 0.1 * i, 0.1);
  }
  for (std::size_t i = 0; i < 3; ++i) CHECK(large[i] == Approx(small[i]).epsilon(1e-11));
  CHECK(large[3] == 3.0);
  CHECK(large[5] == -2.0);
  CHECK(large[7] == Approx(8.0 / 3.0).epsilon(1e-12));
  CHECK(large[9] == 7.0);
}

TEST_CASE("RODAS5P's overloads agree and repeat_step evaluates the start only once", "[rodas5p]") {
  int rhs_calls = 0;
  int jacobian_calls = 0;
  auto rhs = [&](const State& x, State& rate, double t) { ++rhs_calls, Smooth::rhs(x, rate, t); };
  auto jacobian = [&](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
    ++jacobian_calls, Smooth::jacobian(x, J, t, dfdt);
  };
  auto system = std::make_pair(std::ref(rhs), std::ref(jacobian));

  const State x0 = Smooth::exact(0.3);
  Rodas5p stepper;
  State out;
  State error;
  stepper.do_step(std::ref(system), x0, 0.3, out, 0.1, error);
  CHECK(rhs_calls == 8);
  CHECK(jacobian_calls == 1);
  CHECK(stepper.start_state() == x0);
  CHECK(stepper.start_time() == 0.3);

  State again;
  stepper.do_step(system, x0, 0.3, again, 0.2, error);  // another step between
  stepper.repeat_step(system, again, 0.1, error);
  CHECK(again == out);
  CHECK(rhs_calls == 8 + 8 + 7);
  CHECK(jacobian_calls == 2);

  State in_place = x0;
  State in_place_error;
  Rodas5p().do_step(system, in_place, 0.3, 0.1, in_place_error);
  CHECK(in_place == out);
  CHECK(in_place_error == error);
  in_place = x0;
  Rodas5p().do_step(system, in_place, 0.3, 0.1);
  CHECK(in_place == out);
  Rodas5p().do_step(system, x0, 0.3, in_place, 0.1);
  CHECK(in_place == out);
}

TEST_CASE("RODAS5P shows a NaN and a singular matrix in its results", "[rodas5p]") {
  const auto nan_rhs = std::make_pair(
      [](const State& x, State& rate, double) { rate[0] = x[0] > 0.5 ? std::sqrt(-1 - x[0] * x[0]) : 1.0; },
      [](const State&, Eigen::MatrixXd&, double, State&) {});
  Rodas5p stepper;
  State x{0.0};
  State error;
  stepper.do_step(nan_rhs, x, 0.0, 1.0, error);
  CHECK(std::isnan(error[0]));

  const double h = 0.5;
  const double lambda = 1 / (limcycle::rodas5p::gamma * h);  // I/(gamma h) - J = 0
  const auto singular = std::make_pair([=](const State& s, State& rate, double) { rate[0] = lambda * s[0]; },
                                       [=](const State&, Eigen::MatrixXd& J, double, State&) { J(0, 0) = lambda; });
  x = {1.0};
  stepper.do_step(singular, x, 0.0, h, error);
  CHECK_FALSE(std::isfinite(error[0]));
}

TEST_CASE("Odeint drives RODAS5P at fixed steps", "[rodas5p][odeint]") {
  State direct = Smooth::exact(0);
  Rodas5p stepper;
  for (int i = 0; i < 16; ++i) stepper.do_step(Smooth::system(), direct, 0.125 * i, 0.125);

  State x = Smooth::exact(0);
  CHECK(odeint::integrate_const(Rodas5p(), Smooth::system(), x, 0.0, 2.0, 0.125) == 16);
  CHECK(x == direct);
  x = Smooth::exact(0);
  CHECK(odeint::integrate_n_steps(Rodas5p(), Smooth::system(), x, 0.0, 0.125, 16) == 2.0);
  CHECK(x == direct);
  CHECK(distance(x, Smooth::exact(2)) < 1e-5);
}
