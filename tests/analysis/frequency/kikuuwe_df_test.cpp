// Describing functions of the compliant Coulomb law of Kikuuwe et al. against a plain integration of its equations.
#include "limcycle/models/friction/dry/kikuuwe.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"
#include "limcycle/tests/analysis/frequency/one_state_reference.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Kikuuwe<double> kikuuwe(double K = 1e5, double B = 316.0, double sigma2 = 0.0) {
  Kikuuwe<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.K = K;
  law.B = B;
  law.sigma2 = sigma2;
  return law;
}

OneStateReference plain(const Kikuuwe<double>& law, double A, double w, double bias, int steps) {
  const auto g = [&](double v, bool forward) {
    const double Fs = forward ? law.Fs : law.Fs_minus, Fc = forward ? law.Fc : law.Fc_minus;
    return Fc + (Fs - Fc) * std::exp(-(v / law.vs) * (v / law.vs));
  };
  const auto f = [&](double v, double e) { return std::clamp(law.K * e + law.B * v, -g(v, false), g(v, true)); };
  const auto rate = [&](double v, double e) { return (f(v, e) - law.K * e) / law.B; };
  const auto force = [&](double, double v, double e) { return f(v, e) + law.sigma2 * v; };
  return one_state_reference(A, w, bias, rate, force, law.odd() && bias == 0.0, steps, -0.5 * law.Fs / law.K);
}

}  // namespace

TEST_CASE("Kikuuwe describing functions are those of a plain integration", "[df][kikuuwe]") {
  auto uneven = kikuuwe();
  uneven.Fs_minus = 1.2;
  uneven.Fc_minus = 0.7;
  const struct {
    Kikuuwe<double> law;
    double A, w, bias;
  } cases[] = {
      {kikuuwe(), 5e-6, 1.0, 0.0},           {kikuuwe(), 1.6e-5, 1.0, 0.0}, {kikuuwe(), 2e-5, 100.0, 0.0},
      {kikuuwe(), 1e-4, 10.0, 0.0},          {kikuuwe(), 1e-3, 10.0, 0.0},  {kikuuwe(1e5, 316.0, 2.0), 1e-2, 1.0, 0.0},
      {kikuuwe(1e4, 30.0), 1e-3, 10.0, 0.0}, {kikuuwe(), 1e-4, 10.0, 3e-4}, {uneven, 1e-4, 10.0, 0.0},
      {kikuuwe(), 1e-4, 10.0, 2e-3}};
  for (const auto& c : cases) {
    CAPTURE(c.A, c.w, c.bias, c.law.K, c.law.B);
    const auto coarse = plain(c.law, c.A, c.w, c.bias, 16000), fine = plain(c.law, c.A, c.w, c.bias, 32000);
    const double doubt = apart(coarse.gain, fine.gain);
    CHECK(doubt < 1e-7);
    for (const double accuracy : {1e-6, 1e-9}) {
      const auto df = quadrature(c.law, c.A, c.w, c.bias, accuracy);
      CHECK(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, fine.gain) <= df.error + 2.0 * doubt + 1e-12);
      CHECK(df.mean == Approx(fine.mean).epsilon(accuracy + 1e-7).margin(1e-8));
      CHECK(df.dissipation == Approx(fine.work).epsilon(accuracy + 1e-7).margin(1e-10));
    }
  }
}

TEST_CASE("Kikuuwe: both routes agree", "[df][kikuuwe]") {
  for (const double A : {1.7e-5, 1e-4}) {
    CAPTURE(A);
    const PrescribedMotion motion(A, 10.0, 0.0, true);
    const auto smooth = quadrature(kikuuwe(), A, 10.0, 0.0, 1e-8);
    const auto fft = FftRoute(kikuuwe(), motion, true, 0.0, with(DfMethod::fft, 1e-5)).refine(smooth);
    CHECK(fft.status == Status::converged);
    CHECK(fft.error <= 1e-5);
    CHECK(apart(fft.gain, smooth.gain) <= fft.error + smooth.error);
  }
}

TEST_CASE("Kikuuwe: a spring and a damper before sliding, and a slow slider is Jenkins' element", "[df][kikuuwe]") {
  const auto law = kikuuwe(1e5, 316.0, 0.4);
  CHECK(apart(quadrature(law, 1e-5, 3.0, 0.0, 1e-10).gain, {law.K, 3.0 * (law.B + law.sigma2)}) < 1e-12);
  // Claim A8 with h = Fs/K, approached with order w.
  const double A = 4e-5, h = 1.5e-5, x = 1.0 - 2.0 * h / A;
  const double f = 2.0 / std::numbers::pi * (std::asin(x) + x * std::sqrt(1.0 - x * x));
  const std::complex<double> jenkins(0.5e5 * (1.0 - f), 6.0 / (std::numbers::pi * A) * (1.0 - h / A));
  const double near = apart(quadrature(kikuuwe(), A, 1e-3, 0.0, 1e-10).gain, jenkins);
  const double nearer = apart(quadrature(kikuuwe(), A, 1e-4, 0.0, 1e-10).gain, jenkins);
  CHECK(nearer < 1e-6);
  CHECK(nearer < 0.2 * near);
}
