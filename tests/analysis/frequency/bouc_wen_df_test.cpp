// Describing functions of Bouc-Wen hysteresis against a plain integration of its equations, and against the closed form
// of its special case, Dahl's law.
#include "limcycle/models/friction/bristle/bouc_wen.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"
#include "limcycle/tests/analysis/frequency/one_state_reference.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

BoucWen<double> bouc_wen(double beta, double gamma, double n = 1.0, double alpha = 0.0) {
  BoucWen<double> law;
  law.alpha = alpha;
  law.k = 1e5;
  law.D = 1e-5;
  law.beta = beta;
  law.gamma = gamma;
  law.n = n;
  return law;
}

OneStateReference plain(const BoucWen<double>& law, double A, double w, double bias, int steps) {
  const auto rate = [&](double v, double z) {
    return (law.A * v - law.beta * std::abs(v) * std::pow(std::abs(z), law.n - 1.0) * z -
            law.gamma * v * std::pow(std::abs(z), law.n)) /
           law.D;
  };
  const auto force = [&](double x, double, double z) {
    return law.alpha * law.k * x + (1.0 - law.alpha) * law.k * law.D * z;
  };
  return one_state_reference(A, w, bias, rate, force, bias == 0.0, steps, -0.5 * law.largest());
}

}  // namespace

TEST_CASE("Bouc-Wen describing functions are those of a plain integration", "[df][bouc-wen]") {
  auto other_A = bouc_wen(0.7, 0.1, 2.0);
  other_A.A = 1.7;
  const struct {
    BoucWen<double> law;
    double A, w, bias;
  } cases[] = {{bouc_wen(0.5, 0.5), 2e-7, 1.0, 0.0},       {bouc_wen(0.5, 0.5), 1e-5, 1.0, 0.0},
               {bouc_wen(0.5, 0.5), 1e-3, 10.0, 0.0},      {bouc_wen(0.5, 0.5), 5e-5, 1.0, 2e-5},
               {bouc_wen(0.3, 0.7, 2.0), 2e-5, 1.0, 0.0},  {bouc_wen(0.9, -0.4, 3.0), 2e-5, 1.0, 0.0},
               {bouc_wen(0.2, 1.3), 3e-5, 1.0, 0.0},       {bouc_wen(0.0, 1.0, 2.0), 2e-5, 1.0, 0.0},
               {bouc_wen(0.5, 0.5, 1.5), 2e-5, 1.0, 0.0},  {bouc_wen(0.6, 0.2, 2.6, 0.3), 1e-4, 1.0, 0.0},
               {bouc_wen(0.5, 0.5, 1.2), 2e-5, 1.0, 1e-5}, {other_A, 4e-5, 2.0, 0.0},
               {bouc_wen(0.5, 0.5, 10.0), 5e-5, 1.0, 0.0}};
  for (const auto& c : cases) {
    CAPTURE(c.A, c.w, c.bias, c.law.beta, c.law.gamma, c.law.n);
    const auto coarse = plain(c.law, c.A, c.w, c.bias, 4000), fine = plain(c.law, c.A, c.w, c.bias, 8000);
    const double doubt = apart(coarse.gain, fine.gain);
    CHECK(doubt < 1e-7);
    for (const double accuracy : {1e-6, 1e-9}) {
      const auto df = quadrature(c.law, c.A, c.w, c.bias, accuracy);
      CHECK(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, fine.gain) <= df.error + 2.0 * doubt + 1e-12);
      CHECK(df.mean == Approx(fine.mean).epsilon(accuracy + 1e-7).margin(1e-9));
      CHECK(df.dissipation == Approx(fine.work).epsilon(accuracy + 1e-7).margin(1e-10));
    }
  }
}

TEST_CASE("Bouc-Wen with n = 1 and gamma = 0 has the closed form of Dahl's law", "[df][bouc-wen][claims]") {
  // Claim A12.
  const auto law = bouc_wen(1.0, 0.0);
  for (const double A : {5e-6, 1e-5, 5e-5}) {
    CAPTURE(A);
    const double a = A / law.D, F = law.k * law.D;
    const std::complex<double> dahl(2.0 * F * std::cyl_bessel_i(1.0, a) / (A * std::cosh(a)),
                                    4.0 * F / (pi * A) * (1.0 - std::tanh(a) / a));
    CHECK(apart(quadrature(law, A, 1.0, 0.0, 1e-10).gain, dahl) < 1e-10);
  }
}

TEST_CASE("Bouc-Wen depends on the path only, and both routes agree", "[df][bouc-wen]") {
  for (const double n : {1.0, 2.0, 1.5}) {
    const auto law = bouc_wen(0.4, 0.6, n);
    const auto slow = quadrature(law, 3e-5, 1.0, 0.0, 1e-8), fast = quadrature(law, 3e-5, 977.0, 0.0, 1e-8);
    CHECK(apart(slow.gain, fast.gain) < 1e-12);
    const PrescribedMotion motion(3e-5, 1.0, 0.0, true);
    const auto fft = FftRoute(law, motion, true, 0.0, with(DfMethod::fft, 1e-6)).refine(slow);
    CHECK(fft.status == Status::converged);
    CHECK(apart(fft.gain, slow.gain) <= fft.error + slow.error);
    CHECK(fft.error <= 1e-6);
  }
}
