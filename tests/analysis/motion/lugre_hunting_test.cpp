// The reference problem: a PID position servo that hunts on LuGre friction, marched by RODAS5P into its cycle.
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"
#include "limcycle/analysis/motion/steppers/explicit_steppers.hpp"

using limcycle::ControlledRodas5p;
using limcycle::ErrorWeights;
using limcycle::Rodas5p;
using limcycle::State;

namespace odeint = boost::numeric::odeint;

namespace {

/// m v' = -kp x - ki I - kd v - F with LuGre friction of bristle force f = sigma0 z; state (I, x, v, f).
struct HuntingMass {
  double kp = 3, ki = 4, kd = 6, m = 1;
  double Fs = 1.5, Fc = 1, vs = 1e-3, sigma0 = 1e5, sigma1 = std::sqrt(1e5), sigma2 = 0.4;

  double stribeck(double v) const { return Fc + (Fs - Fc) * std::exp(-(v / vs) * (v / vs)); }

  void rhs(const State& x, State& rate) const {
    const double v = x[2];
    const double bristle_rate = v - std::abs(v) * x[3] / stribeck(v);
    rate[0] = x[1];
    rate[1] = v;
    rate[2] = (-kp * x[1] - ki * x[0] - kd * v - (x[3] + sigma1 * bristle_rate + sigma2 * v)) / m;
    rate[3] = sigma0 * bristle_rate;
  }

  void jacobian(const State& x, Eigen::MatrixXd& J) const {
    const double v = x[2];
    const double g = stribeck(v);
    const double g_slope = -2 * v / (vs * vs) * (g - Fc);
    const double side = static_cast<double>(v > 0) - static_cast<double>(v < 0);
    const double by_v = 1 - x[3] * (side / g - std::abs(v) * g_slope / (g * g));
    const double by_f = -std::abs(v) / g;
    J(0, 1) = 1;
    J(1, 2) = 1;
    J(2, 0) = -ki / m;
    J(2, 1) = -kp / m;
    J(2, 2) = -(kd + sigma2 + sigma1 * by_v) / m;
    J(2, 3) = -(1 + sigma1 * by_f) / m;
    J(3, 2) = sigma0 * by_v;
    J(3, 3) = sigma0 * by_f;
  }

  auto system() const {
    return std::make_pair([this](const State& x, State& rate, double) { rhs(x, rate); },
                          [this](const State& x, Eigen::MatrixXd& J, double, State&) { jacobian(x, J); });
  }

  ErrorWeights weights(double tolerance) const {
    return {tolerance, {tolerance, tolerance, tolerance * vs, tolerance}};
  }
};

/// Time of the zero of x between (x0, t0) and t1, by repeating the step with shorter lengths (regula falsi).
template <class System>
double crossing(const System& system, const State& x0, double t0, double t1, double x_end) {
  Rodas5p stepper;
  State x;
  double low = 0;
  double high = t1 - t0;
  double at_low = x0[1];
  double at_high = x_end;
  for (int i = 0; i < 60 && high - low > 1e-14; ++i) {
    double h = low + (high - low) * at_low / (at_low - at_high);
    if (!(h > low && h < high)) h = (low + high) / 2;
    stepper.do_step(system, x0, t0, x, h);
    if (std::abs(x[1]) < 1e-16) return t0 + h;
    if (x[1] < 0) {
      low = h;
      at_low = x[1];
      at_high /= 2;  // Illinois: else one end stays where it is
    } else {
      high = h;
      at_high = x[1];
      at_low /= 2;
    }
  }
  return t0 + (low + high) / 2;
}

/// Times between successive rising zeros of x, from x(0) = 1 at rest.
std::vector<double> intervals(const HuntingMass& loop, double tolerance, std::size_t count) {
  const auto system = loop.system();
  ControlledRodas5p stepper(loop.weights(tolerance));
  State x{0, 1, 0, 0};
  State before;
  double t = 0;
  double dt = 1e-4;
  std::vector<double> zeros;
  while (zeros.size() <= count && t < 1000) {
    before = x;
    const double start = t;
    if (stepper.try_step(system, x, t, dt) != odeint::success) continue;
    if (before[1] < 0 && x[1] >= 0) zeros.push_back(crossing(system, before, start, t, x[1]));
  }
  REQUIRE(zeros.size() == count + 1);
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(zeros[i + 1] - zeros[i]);
  return result;
}

}  // namespace

TEST_CASE("The Jacobian of the hunting loop is that of its right side", "[rodas5p][lugre]") {
  const HuntingMass loop;
  for (const State& x : {State{0.3, -0.2, 0.05, 0.9}, State{0.1, 0.2, -4e-4, -1.2}, State{0, 0, 2e-3, 1}}) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(4, 4);
    loop.jacobian(x, J);
    for (std::size_t j = 0; j < 4; ++j) {
      const double step = j == 2 ? 1e-8 : 1e-5;
      State up = x;
      State down = x;
      up[j] += step;
      down[j] -= step;
      State rate_up(4);
      State rate_down(4);
      loop.rhs(up, rate_up);
      loop.rhs(down, rate_down);
      for (std::size_t i = 0; i < 4; ++i)
        CHECK(J(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) ==
              Approx((rate_up[i] - rate_down[i]) / (2 * step)).epsilon(1e-6).margin(1e-6));
    }
  }
}

TEST_CASE("RODAS5P reaches the hunting cycle of LuGre friction with its period", "[rodas5p][lugre]") {
  // Period by an explicit method of order 8 in extended precision: 24.436786455993(1) s.
  const double exact = 24.436786455993;
  const HuntingMass loop;
  const std::vector<double> fine = intervals(loop, 1e-9, 10);
  CHECK(fine.back() == Approx(exact).epsilon(1e-9));
  // The cycle is reached (multiplier of half a period 0.078): two periods in a row agree.
  CHECK(fine[9] == Approx(fine[8]).epsilon(1e-9));
  // Two tolerances agree, all the way from the start.
  const std::vector<double> coarse = intervals(loop, 1e-7, 10);
  for (std::size_t i = 0; i < fine.size(); ++i) CHECK(coarse[i] == Approx(fine[i]).epsilon(1e-7));
  CHECK(coarse.back() == Approx(exact).epsilon(1e-7));
}

TEST_CASE("RODAS5P is not misled by a loose tolerance when velocity is weighted by vs", "[rodas5p][lugre]") {
  // With atol(v) = tol these settle on false cycles of 13 to 25 s.
  for (const double tolerance : {1e-4, 1e-5})
    CHECK(intervals(HuntingMass{}, tolerance, 10).back() == Approx(24.4368).epsilon(1e-4));
  HuntingMass stiffer;
  stiffer.sigma0 = 1e6;
  stiffer.sigma1 = 1e3;
  CHECK(intervals(stiffer, 1e-6, 10).back() == Approx(23.830519).epsilon(1e-6));
}

TEST_CASE("An explicit stepper finds the same motion as RODAS5P where both can go", "[explicit_steppers][lugre]") {
  // Two codes that share only the right-hand side, over the first slip and the first stick (2 s), state by state.
  const HuntingMass loop;
  const auto rhs = [&](const State& x, State& rate, double) { loop.rhs(x, rate); };
  const auto march = [](auto stepper, const auto& system) {
    State x{0, 1, 0, 0};
    double t = 0;
    double dt = 1e-5;
    while (t < 2) {
      dt = std::min(dt, 2 - t);
      stepper.try_step(system, x, t, dt);
    }
    return x;
  };
  const State implicit = march(ControlledRodas5p(loop.weights(1e-10)), loop.system());
  const State dopri5 = march(limcycle::make_dopri5(loop.weights(1e-10)), rhs);
  const State fehlberg = march(limcycle::make_fehlberg78(loop.weights(1e-10)), rhs);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(implicit[i] == Approx(dopri5[i]).epsilon(1e-7).margin(1e-10));
    CHECK(fehlberg[i] == Approx(dopri5[i]).epsilon(1e-7).margin(1e-10));
  }
}
