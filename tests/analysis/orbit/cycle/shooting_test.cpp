#include "limcycle/analysis/orbit/cycle/shooting.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Cycle cycle_of(const Loop& loop, double displacement = 1.0) {
  SettleOptions options;
  options.amplitude_floor = 1e-7;
  const auto settled = settle(loop, displaced(loop, displacement), options);
  INFO(settled.why);
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

/// exp(A h) and the integral of exp(A s) B over 0..h.
std::pair<Eigen::MatrixXd, Eigen::VectorXd> discretised(const Loop& loop, double h) {
  const Eigen::Index n = loop.states();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 1, n + 1);
  M.topLeftCorner(n, n) = loop.A * h;
  M.topRightCorner(n, 1) = loop.B.col(0) * h;
  const Eigen::MatrixXd E = M.exp();
  return {E.topLeftCorner(n, n), E.topRightCorner(n, 1)};
}

/// C (I + Phi)^-1 Gamma - eps of claim B1, y where a relay of level 1 switches if the half period is h.
double switching_excess(const Loop& loop, double h, double hysteresis) {
  const auto [Phi, Gamma] = discretised(loop, h);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(Phi.rows(), Phi.cols());
  return (loop.C_y * (I + Phi).partialPivLu().solve(Gamma)).value() - hysteresis;
}

/// Half period by bisection of that equation within 1 % of a guess.
double half_period(const Loop& loop, double guess, double hysteresis) {
  double low = 0.99 * guess, high = 1.01 * guess;
  const double sign = switching_excess(loop, low, hysteresis);
  REQUIRE(sign * switching_excess(loop, high, hysteresis) < 0.0);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sign * switching_excess(loop, middle, hysteresis) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Floquet multipliers of a relay loop, largest first: squares of the eigenvalues of W = (I - w C/(C w)) Phi, w = dx/dt
/// just before a switch, without the zero that belongs to the direction of w.
std::vector<double> relay_multipliers(const Loop& loop, double h) {
  const auto [Phi, Gamma] = discretised(loop, h);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(Phi.rows(), Phi.cols());
  const Eigen::VectorXd x = (I + Phi).partialPivLu().solve(Gamma);
  const Eigen::VectorXd w = loop.A * x + loop.B.col(0);
  const Eigen::MatrixXd W = (I - w * loop.C_y / (loop.C_y * w).value()) * Phi;
  std::vector<double> squares;
  for (const auto& value : W.eigenvalues()) squares.push_back(std::norm(value));
  std::ranges::sort(squares, std::greater{});
  CHECK(squares.back() < 1e-28);
  squares.pop_back();
  return squares;
}

struct Reference {
  double period = 0.0, amplitude = 0.0, multiplier = 0.0;
};

/// Period, amplitude and non-trivial multiplier exp(integral of mu (1 - x^2)) of van der Pol, by the Runge-Kutta method
/// of order 4.
Reference van_der_pol_reference(double mu, int steps_per_second, int crossings) {
  const double h = 1.0 / steps_per_second;
  struct V {
    double x, v, integral;
  };
  const auto f = [mu](const V& z) {
    const double damping = mu * (1.0 - z.x * z.x);
    return V{z.v, damping * z.v - z.x, damping};
  };
  const auto beside = [](const V& z, double step, const V& k) {
    return V{z.x + step * k.x, z.v + step * k.v, z.integral + step * k.integral};
  };
  const auto advanced = [&](const V& z, double step) {
    const V k1 = f(z), k2 = f(beside(z, 0.5 * step, k1)), k3 = f(beside(z, 0.5 * step, k2)),
            k4 = f(beside(z, step, k3));
    return beside(beside(beside(beside(z, step / 6.0, k1), step / 3.0, k2), step / 3.0, k3), step / 6.0, k4);
  };
  // Time of the step within [0, h] at which a component is zero.
  const auto zero_of = [&](const V& z, double V::*component) {
    double low = 0.0, high = h;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      (advanced(z, middle).*component * (z.*component) > 0.0 ? low : high) = middle;
    }
    return high;
  };
  V z{2.0, 0.0, 0.0};
  double time = 0.0, last_time = 0.0, last_integral = 0.0, top = 0.0;
  for (;; time += h) {
    const V next = advanced(z, h);
    if (z.v > 0.0 && next.v <= 0.0) top = advanced(z, zero_of(z, &V::v)).x;
    if (z.x < 0.0 && next.x >= 0.0) {
      const double part = zero_of(z, &V::x), integral = advanced(z, part).integral;
      if (--crossings == 0) return {time + part - last_time, top, std::exp(integral - last_integral)};
      last_time = time + part;
      last_integral = integral;
    }
    z = next;
  }
}

}  // namespace

TEST_CASE("hunting servo with LuGre friction: period to 1e-10, amplitude, stability") {
  const Loop loop = servo(lugre());
  const Cycle cycle = cycle_of(loop);
  CHECK(cycle.period == Approx(24.436786455993).epsilon(1e-10));
  CHECK(cycle.amplitude == Approx(0.063903).epsilon(1e-5));
  CHECK(std::abs(cycle.offset) < 1e-9);
  CHECK(cycle.half_wave_symmetric);
  REQUIRE(cycle.stable);
  CHECK(*cycle.stable);
  REQUIRE(cycle.multipliers.size() == 3);
  CHECK(std::abs(cycle.multipliers[0]) == Approx(0.0061457).epsilon(1e-3));  // 0.0784^2
  CHECK(std::abs(cycle.multipliers[2]) < 1e-8);
  CHECK(std::abs(cycle.period / 24.436786455993 - 1.0) <= cycle.error);
  CHECK(cycle.error < 1e-8);

  // Substitute back: after one period the state is that of the start.
  Trace trace;
  REQUIRE(record(loop, cycle.start, cycle.period, 1e-11, 100, trace) == Status::converged);
  CHECK(trace.y.back() == Approx(trace.y.front()).margin(1e-9));
}

TEST_CASE("PID with Coulomb friction and stiction: the exact cycles of claim B7") {
  struct Row {
    double Fs, sigma2, amplitude, period, stick, multiplier;
  };
  for (const Row& row : {Row{1.5, 0.0, 0.06724015, 23.36927229, 9.11619722, 0.0886262},
                         Row{1.5, 0.4, 0.06565304, 24.01303872, 9.35339812, 0.0975085},
                         Row{1.1, 0.4, 0.01313061, 84.93938497, 39.81657125, 0.0975085}}) {
    const Cycle cycle = cycle_of(servo(coulomb(row.Fs, 1.0, row.sigma2)));
    CHECK(cycle.amplitude == Approx(row.amplitude).epsilon(2e-7));
    CHECK(cycle.period == Approx(row.period).epsilon(1e-9));
    CHECK(cycle.sticking_fraction == Approx(2.0 * row.stick / row.period).epsilon(1e-6));
    REQUIRE(cycle.multipliers.size() == 2);
    CHECK(cycle.multipliers[0].real() == Approx(row.multiplier * row.multiplier).epsilon(2e-6));  // of the half map
    CHECK(cycle.multipliers[1] == 0.0);  // the exact zero of sticking
  }
}

TEST_CASE("relay loops: period, peak and multipliers of claim B1, exact by its own equation") {
  struct Row {
    Loop loop;
    double hysteresis, half_period, frequency, peak, radius;
  };
  for (const Row& row :
       {Row{forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0}), 0.0, 1.83987534, 1.70750300, 0.16306148, 0.383990575},
        Row{forward(relay(1.0), {1.0}, {1.0, 2.0, 1.0, 0.0}), 0.0, 3.21223060, 0.97800969, 0.65831341, 0.353748014},
        Row{forward(relay(1.0, 0.1), {1.0}, {1.0, 1.0, 0.0}), 0.1, 1.42362311, 2.20675868, 0.23445282, 0.240839845}}) {
    const Cycle cycle = cycle_of(row.loop);
    CAPTURE(row.half_period);
    // To the digits that the table prints.
    CHECK(std::abs(0.5 * cycle.period - row.half_period) < 0.6e-8);
    CHECK(std::abs(cycle.frequency() - row.frequency) < 0.6e-8);
    CHECK(std::abs(cycle.amplitude - row.peak) < 0.6e-8);
    CHECK(std::abs(std::sqrt(cycle.multipliers[0].real()) - row.radius) < 3e-9);
    CHECK(cycle.sticking_fraction == 0.0);
    // And to rounding.
    const double h = half_period(row.loop, row.half_period, row.hysteresis);
    CHECK(std::abs(switching_excess(row.loop, 0.5 * cycle.period, row.hysteresis)) < 1e-12);
    CHECK(cycle.period == Approx(2.0 * h).epsilon(1e-12));
    const auto multipliers = relay_multipliers(row.loop, h);
    REQUIRE(cycle.multipliers.size() == multipliers.size());
    for (std::size_t i = 0; i < multipliers.size(); ++i)
      CHECK(cycle.multipliers[i].real() == Approx(multipliers[i]).epsilon(1e-9));
    CHECK(cycle.stable == true);
    CHECK(cycle.error < 1e-11);
  }
  const Cycle triangle = cycle_of(forward(relay(1.0, 0.1), {1.0}, {1.0, 0.0}));
  CHECK(triangle.period == Approx(0.4).epsilon(1e-11));
  CHECK(triangle.amplitude == Approx(0.1).epsilon(1e-11));
  CHECK(triangle.first_harmonic == Approx(0.8 / (std::acos(-1.0) * std::acos(-1.0))).epsilon(1e-9));
  const Cycle lag = cycle_of(forward(relay(1.0, 0.2), {1.0}, {1.0, 1.0}));
  CHECK(lag.period == Approx(2.0 * std::log(1.2 / 0.8)).epsilon(1e-10));
}

TEST_CASE("stick-slip on a belt: claim B4, ideal stiction and LuGre") {
  const Cycle dry = cycle_of(belt(coulomb(1.5, 1.0)), 0.0);
  const double w0 = std::sqrt(2.0), delta = 0.25, speed = 0.1;
  const double slip = 2.0 / w0 * (std::acos(-1.0) - std::atan(w0 * delta / speed)), stick = 2.0 * delta / speed;
  CHECK(dry.period == Approx(slip + stick).epsilon(1e-10));
  CHECK(dry.amplitude == Approx(std::hypot(delta, speed / w0)).epsilon(1e-9));
  CHECK(slip == Approx(2.611259).epsilon(1e-6));
  REQUIRE(dry.multipliers.size() == 1);
  CHECK(dry.multipliers[0] == 0.0);  // each stick forgets everything
  CHECK(dry.sticking_fraction == Approx(stick / (slip + stick)).epsilon(1e-9));
  CHECK_FALSE(dry.half_wave_symmetric);
  CHECK(cycle_of(belt(coulomb(1.5, 1.0, 0.4)), 0.0).period == Approx(6.453933).epsilon(1e-7));
  CHECK(cycle_of(belt(lugre()), 0.0).period == Approx(6.36272).epsilon(1e-6));
  CHECK(cycle_of(belt(lugre(1.5, 1.0, 0.0)), 0.0).period == Approx(7.49381).epsilon(1e-6));
}

TEST_CASE("van der Pol: periods, amplitudes and multipliers of claim B3, however small") {
  struct Row {
    double mu, period, amplitude, multiplier, printed;  // printed: relative accuracy of the table's multiplier
    double amplitude_accuracy = 1e-9, multiplier_accuracy = 1e-7;
  };
  // The stiff ones: a cubic finds the peak between steps, and the step errors of 300 e-folds add up in the multiplier.
  for (const Row& row :
       {Row{0.1, 6.28711127, 2.00010398, 0.5330693, 1e-7}, Row{0.5, 6.38067580, 2.00248793, 3.917692e-2, 2e-7},
        Row{1.0, 6.66328686, 2.00861986, 8.596951e-4, 2e-7}, Row{2.0, 7.62987448, 2.01989138, 1.273849e-8, 5e-7},
        Row{5.0, 11.61223066, 2.02150806, 7.7e-38, 0.01, 1e-9, 1e-4},
        Row{10.0, 19.07836956, 2.01428536, 3.7e-136, 0.01, 5e-8, 0.015}}) {
    const Cycle cycle = cycle_of(van_der_pol(row.mu));
    CAPTURE(row.mu);
    CHECK(std::abs(cycle.period - row.period) < 1e-8);
    CHECK(cycle.amplitude == Approx(row.amplitude).epsilon(3e-9 + row.amplitude_accuracy));
    REQUIRE(cycle.multipliers.size() == 1);
    CHECK(cycle.multipliers[0].imag() == 0.0);
    CHECK(cycle.multipliers[0].real() == Approx(row.multiplier).epsilon(row.printed));
    CHECK(cycle.stable == true);
    // Digits beyond the table, by the trace formula along an independent run.
    const Reference reference = van_der_pol_reference(row.mu, row.mu < 2.0 ? 4096 : 16384, row.mu < 0.5 ? 40 : 8);
    CHECK(std::abs(cycle.period / reference.period - 1.0) <= cycle.error);
    CHECK(cycle.period == Approx(reference.period).epsilon(3e-11));
    CHECK(cycle.amplitude == Approx(reference.amplitude).epsilon(row.amplitude_accuracy));
    CHECK(cycle.multipliers[0].real() == Approx(reference.multiplier).epsilon(row.multiplier_accuracy));
  }
}

TEST_CASE("between a cycle and rest: what larger and smaller motions of a relay with dead zone lead to") {
  // Before 1/(s+1)^3; the unstable cycle in between is found by multiple shooting (multiple_shooting_test).
  const Loop loop = forward(relay(1.0, 0.0, 0.05), {1.0}, {1.0, 3.0, 3.0, 1.0});
  SettleOptions options;
  options.amplitude_floor = 1e-6;
  CHECK(settle(loop, displaced(loop, 1.0), options).outcome == Outcome::cycle);
  CHECK(settle(loop, displaced(loop, 0.01), options).outcome == Outcome::rest);
}

TEST_CASE("period error falls as the integration tolerance does") {
  const Loop loop = servo(lugre());
  const auto period = [&](double rtol) {
    SettleOptions options;
    options.shooting.rtol = rtol;
    options.shooting.tolerance = 30.0 * rtol;
    const auto settled = settle(loop, displaced(loop, 1.0), options);
    REQUIRE(settled.shot);
    CHECK(std::abs(settled.shot->cycle.period / 24.436786455993 - 1.0) <= settled.shot->cycle.error);
    return std::abs(settled.shot->cycle.period / 24.436786455993 - 1.0);
  };
  for (const double rtol : {1e-8, 1e-10}) CHECK(period(rtol) < 30.0 * rtol);  // the tolerance of the shooting
}

TEST_CASE("a period is had for less: loose tolerances, rough multipliers or none, each as right as it says") {
  const Loop loop = servo(lugre());
  const Cycle best = cycle_of(loop);
  const Section section{loop.C_y, 0.5 * best.amplitude, 1};
  ShootingOptions options;
  options.rtol = options.tolerance = 1e-9;
  options.resolution = 200;
  options.derivative_rtol = 0.0;
  const auto bare = shoot(loop, displaced(loop, 1.0), section, true, options);
  REQUIRE(bare.status == Status::converged);
  CHECK(std::abs(bare.cycle.period / best.period - 1.0) < bare.cycle.error);
  CHECK(std::abs(bare.cycle.amplitude / best.amplitude - 1.0) < bare.cycle.error);
  CHECK(bare.cycle.error < 2e-8);
  CHECK(bare.cycle.multipliers.empty());
  CHECK_FALSE(bare.cycle.stable.has_value());

  options.derivative_rtol = 1e-7;
  const auto rough = shoot(loop, displaced(loop, 1.0), section, true, options);
  REQUIRE(rough.status == Status::converged);
  CHECK(rough.cycle.period == bare.cycle.period);
  CHECK(rough.cycle.stable == true);
  REQUIRE(rough.cycle.multipliers.size() == best.multipliers.size());
  for (std::size_t i = 0; i < best.multipliers.size(); ++i)
    CHECK(std::abs(rough.cycle.multipliers[i] - best.multipliers[i]) < 4.0 * rough.multiplier_error);
}

TEST_CASE("the accuracy that is asked for is reached, by an estimate that holds") {
  Cubic<double> cubic;
  cubic.coefficient = 5.0 / 3.0;
  const Loop loops[] = {servo(lugre()), belt(lugre()), forward(cubic, {1.0, 0.0}, {1.0, -5.0, 1.0})};
  for (const Loop& loop : loops) {
    const Cycle best = cycle_of(loop);
    for (const double accuracy : {1e-6, 1e-8, 1e-10}) {
      ShootingOptions options;
      options.accuracy = accuracy;
      options.rtol = std::min(accuracy, 1e-8);
      options.tolerance = 0.1 * options.rtol;
      const auto shot = shoot(loop, best.start, choose_section(loop, best.trace), best.half_wave_symmetric, options);
      REQUIRE(shot.status == Status::converged);
      CAPTURE(best.period, accuracy, shot.cycle.error);
      CHECK(shot.cycle.error <= accuracy);
      CHECK(std::abs(shot.cycle.period / best.period - 1.0) <= shot.cycle.error + best.error);
      CHECK(std::abs(shot.cycle.amplitude / best.amplitude - 1.0) <= shot.cycle.error + best.error);
    }
  }
}
