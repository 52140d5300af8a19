// Laws with return points under prescribed motion: iwan against the closed forms of claim A11, non-drift against closed
// forms below slip and the one-element Xiong law, two-state against an integral of its loop.
#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/bristle/two_state.hpp"
#include "limcycle/models/friction/sliders/iwan.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

template <template <class> class Kind>
DescribingFunction fft(const Kind<double>& law, double A, double w, double bias, const DescribingFunction& other) {
  const PrescribedMotion motion(A, w, bias, true);
  return FftRoute(law, motion, bias == 0.0, bias, {.harmonics = 5, .accuracy = 1e-5}).refine(other);
}

Iwan<double> iwan(int curve, double elements = 0.0) {
  Iwan<double> law;
  law.curve.index = curve;
  law.elements = elements;
  law.Fs = 1.5;
  law.Zb = 1e-3;
  return law;
}

template <class Law>
Law with_levels(double Fc = 1.0) {
  Law law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = Fc;
  law.vs = 1e-3;
  return law;
}

const double sigma = 316.22776601683796;

NonDrift<double> non_drift(int branch, int memory, double tau = 2e-3) {
  auto law = with_levels<NonDrift<double>>();
  law.Zb = 1e-3;
  law.sigma = sigma;
  law.tau = tau;
  law.branch.index = branch;
  law.memory.index = memory;
  return law;
}

double phi(double xi) { return xi < 1.0 ? xi > 0.0 ? xi * (1.0 - std::log(xi)) : 0.0 : 1.0; }

/// Integral over [0, 1] of a function with weak singularities at its ends (tanh-sinh).
std::complex<double> integral(const auto& f) {
  std::complex<double> sum = 0.0;
  const double h = 1.0 / 64.0;
  for (int k = -64 * 4; k <= 64 * 4; ++k) {
    const double s = 0.5 * pi * std::sinh(k * h), part = 1.0 / (1.0 + std::exp(-2.0 * s));
    const double weight = 0.25 * pi * std::cosh(k * h) / (std::cosh(s) * std::cosh(s));
    sum += h * weight * f(part);
  }
  return sum;
}

}  // namespace

TEST_CASE("iwan: the march meets the closed forms", "[iwan][df]") {
  for (int curve = 0; curve < 4; ++curve) {
    for (const double elements : {0.0, 7.0}) {
      const auto law = iwan(curve, elements);
      for (const double A : {2e-6, 3e-4, 1e-3, 2e-3, 0.05}) {
        const auto df = quadrature(law, A, 1.0, 0.0, 1e-9, 5);
        const auto exact = *law.exact_describing_function(A, 1.0, 0.0);
        INFO("curve " << curve << " elements " << elements << " A " << A);
        REQUIRE(df.status == Status::converged);
        CHECK(apart(df.gain, exact) < 1e-11);
        CHECK(df.error < 2e-9);
        CHECK(df.symmetric);
      }
    }
    const auto law = iwan(curve);
    const auto df = quadrature(law, 1.7e-3, 1.0, 0.0, 1e-9, 5);
    const auto other = fft(law, 1.7e-3, 1.0, 0.0, df);
    REQUIRE(other.status == Status::converged);
    CHECK(apart(other.gain, df.gain) < 1e-5);
    const auto fast = quadrature(law, 1.7e-3, 1e4, 0.0, 1e-9, 5);  // rate-independent
    CHECK(apart(fast.gain, df.gain) < 1e-14);
  }
}

TEST_CASE("iwan: with a drift the loops hang on saturation", "[iwan][df]") {
  // Forwards on Fs except for the displacement after the reversal, F = Fs - 2 f_v(xi/2) on the way back, then the same
  // branch up.
  const auto law = iwan(2);
  const double A = 2e-3, w = 1.0, V = 1.6e-3;
  const auto df = quadrature(law, A, w, V, 1e-9, 5);
  REQUIRE(df.status == Status::converged);
  const double r = std::acos(-V / (A * w));
  const auto x = [&](double theta) { return V * theta / w + A * std::sin(theta); };
  const double back = x(r) - x(2.0 * pi - r), bottom = 1.5 - 3.0 * phi(0.5 * back / 1e-3);
  double low = 2.0 * pi - r, high = 2.0 * pi + r;
  for (int k = 0; k < 100; ++k) (x(0.5 * (low + high)) < x(r) ? low : high) = 0.5 * (low + high);
  const auto over = [&](double from, double to, const auto& force) {
    return (to - from) * integral([&](double part) {
             const double theta = from + part * (to - from);
             return force(x(theta)) * std::complex<double>(std::sin(theta), std::cos(theta));
           });
  };
  const double end = 2.0 * pi - r;
  const auto sum = over(r, end, [&](double at) { return 1.5 - 3.0 * phi(0.5 * (x(r) - at) / 1e-3); }) +
                   over(end, low, [&](double at) { return bottom + 3.0 * phi(0.5 * (at - x(end)) / 1e-3); }) +
                   over(low, 2.0 * pi + r, [](double) { return 1.5; });
  CHECK(apart(df.gain, sum / (pi * A)) < 1e-9);
}

TEST_CASE("non-drift below slip: hysteresis plus j sigma w", "[non-drift][df]") {
  const auto law = non_drift(0, 0);
  for (const double A : {1e-6, 3e-4}) {
    const auto df = quadrature(law, A, 1.0, 0.0, 1e-8, 5);
    const auto exact = *iwan(2).exact_describing_function(A, 1.0, 0.0) + std::complex<double>(0.0, sigma);
    REQUIRE(df.status == Status::converged);
    CHECK(apart(df.gain, exact) < 1e-9);
  }
}

TEST_CASE("non-drift in sliding with a linear branch: Xiong with one element", "[non-drift][df]") {
  auto one = with_levels<Xiong<double>>();
  one.K = {1500.0};
  one.sigma = {sigma};
  one.lambda = {1.0};
  one.tau = 2e-3;
  for (const int memory : {0, 1}) {
    const struct { double A, w, bias; } points[] = {{1e-3, 1.0, 0.0}, {1e-3, 1.0, 2e-4}, {1e-2, 1.0, 2e-4}};
    for (const auto& p : points) {
      const auto df = quadrature(non_drift(3, memory), p.A, p.w, p.bias, 1e-8, 5);
      const auto other = quadrature(one, p.A, p.w, p.bias, 1e-8, 5);
      INFO("memory " << memory << " A " << p.A << " w " << p.w << " bias " << p.bias);
      REQUIRE(df.status == Status::converged);
      CHECK(apart(df.gain, other.gain) < 2e-8);
    }
  }
}

TEST_CASE("non-drift in sliding: both routes, dissipation, no mean", "[non-drift][df]") {
  const auto law = non_drift(0, 0);
  const double A = 1e-3;
  const PrescribedMotion motion(A, 1.0, 0.0, true);
  const DfOptions options{.harmonics = 5, .accuracy = 1e-7};
  const auto df = QuadratureRoute(law, motion, false, options).refine();
  REQUIRE(df.status == Status::converged);
  CHECK(df.dissipation == Approx(pi * A * A * df.gain.imag()).epsilon(1e-6));
  CHECK(std::abs(df.mean) < 1e-6);
  CHECK(df.gain.imag() > 0.0);
  FftRoute route(law, motion, false, 0.0, options);
  const auto coarse = route.on_samples(512), fine = route.on_samples(1024);
  REQUIRE(fine.status == Status::converged);
  CHECK(apart(fine.gain, df.gain) < 2e-5);
  CHECK(apart(fine.gain, df.gain) < 0.5 * apart(coarse.gain, df.gain));
}

TEST_CASE("two-state in sliding without lag: the integral of its loop", "[two-state][df]") {
  auto law = with_levels<TwoState<double>>();
  law.s = 1e-3;
  law.tau = 0.0;
  for (const double A : {1e-3, 2.5e-3, 2e-2}) {
    const auto df = quadrature(law, A, 1.0, 0.0, 1e-9, 5);
    // From x = A, F = Fs back over 2 s to -Fs, then -g(v) until x = -A.
    const double way = std::min(2e-3, 2.0 * A), broke = std::acos(1.0 - way / A);
    const auto turn = [](double theta) { return std::complex<double>(std::cos(theta), -std::sin(theta)); };
    const auto before = broke * integral([&](double part) {
                          const double half = std::sin(0.5 * part * broke);
                          return (1.5 - 3.0 * phi(A * half * half / 1e-3)) * turn(part * broke);
                        });
    const auto after = (pi - broke) * integral([&](double part) {
                         const double theta = broke + part * (pi - broke), v = A * std::sin(theta);
                         return -(1.0 + 0.5 * std::exp(-v * v / 1e-6)) * turn(theta);
                       });
    INFO("A " << A);
    REQUIRE(df.status == Status::converged);
    CHECK(apart(df.gain, 2.0 / (pi * A) * (before + after)) < 1e-9);
    CHECK(df.symmetric);
  }
  law.tau = 2e-3;
  const auto df = quadrature(law, 2.5e-3, 1.0, 0.0, 1e-8, 5);
  REQUIRE(df.status == Status::converged);
  CHECK(apart(fft(law, 2.5e-3, 1.0, 0.0, df).gain, df.gain) < 1e-5);
}
