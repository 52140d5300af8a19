// Describing functions of the elasto-plastic law against a plain integration of its equations, and against its closed
// form where one exists.
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"
#include "limcycle/tests/analysis/frequency/one_state_reference.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

ElastoPlastic<double> seeds(bool of_coulomb = false) {
  ElastoPlastic<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 316.22776601683796;
  law.zba_of.index = of_coulomb ? 1 : 0;
  return law;
}

/// The equations as printed, with the sign test.
OneStateReference plain(const ElastoPlastic<double>& law, double A, double w, double bias, int steps) {
  const auto g = [&](double v) {
    const double Fs = v < 0.0 ? law.Fs_minus : law.Fs, Fc = v < 0.0 ? law.Fc_minus : law.Fc;
    return Fc + (Fs - Fc) * std::exp(-(v / law.vs) * (v / law.vs));
  };
  const auto rate = [&](double v, double z) {
    const double z_ss = g(v) / law.sigma0;
    const double z_ba = law.zba_ratio * (law.zba_of.index == 0 ? z_ss : (v < 0.0 ? law.Fc_minus : law.Fc) / law.sigma0);
    double alpha = 0.0;
    if (z * v > 0.0 && std::abs(z) > z_ba)
      alpha = std::abs(z) >= z_ss
                  ? 1.0
                  : 0.5 + 0.5 * std::sin(std::numbers::pi * (std::abs(z) - 0.5 * (z_ss + z_ba)) / (z_ss - z_ba));
    return v - alpha * law.sigma0 * std::abs(v) * z / g(v);
  };
  const auto force = [&](double, double v, double z) {
    return law.sigma0 * z + law.sigma1 * rate(v, z) + law.sigma2 * v;
  };
  return one_state_reference(A, w, bias, rate, force, law.odd() && bias == 0.0, steps, -0.5 * law.Fs / law.sigma0);
}

}  // namespace

TEST_CASE("elasto-plastic describing functions are those of a plain integration", "[df][elasto-plastic]") {
  auto uneven = seeds();
  uneven.Fs_minus = 1.2;
  uneven.Fc_minus = 0.7;
  auto slow = seeds();
  slow.sigma1 = 0.0;
  slow.zba_ratio = 0.95;
  const struct {
    ElastoPlastic<double> law;
    double A, w, bias;
  } cases[] = {{seeds(), 1.1e-5, 1.0, 0.0},     {seeds(), 1.3e-5, 10.0, 0.0},  {seeds(), 1e-4, 10.0, 0.0},
               {seeds(), 1e-3, 1.0, 0.0},       {seeds(), 1e-2, 1.0, 0.0},     {seeds(), 5e-5, 10.0, 2e-4},
               {seeds(), 1e-4, 1.0, 3e-4},      {seeds(true), 1e-5, 2.0, 0.0}, {seeds(true), 1e-3, 10.0, 0.0},
               {seeds(true), 1e-4, 10.0, 5e-4}, {uneven, 1e-4, 10.0, 0.0},     {slow, 2e-5, 1.0, 0.0},
               {seeds(), 4e-6, 1.0, 1e-7}};
  for (const auto& c : cases) {
    CAPTURE(c.A, c.w, c.bias, c.law.zba_of.index, c.law.zba_ratio);
    const auto coarse = plain(c.law, c.A, c.w, c.bias, 8000), fine = plain(c.law, c.A, c.w, c.bias, 16000);
    const double doubt = apart(coarse.gain, fine.gain);
    CHECK(doubt < 1e-7);
    for (const double accuracy : {1e-6, 1e-9}) {
      const auto df = quadrature(c.law, c.A, c.w, c.bias, accuracy);
      CHECK(df.status == Status::converged);
      CHECK(df.error <= accuracy);
      CHECK(apart(df.gain, fine.gain) <= df.error + 2.0 * doubt + 1e-12);
      CHECK(df.mean == Approx(fine.mean).epsilon(accuracy).margin(1e-7));
      CHECK(df.dissipation == Approx(fine.work).epsilon(accuracy + 1e-7));
    }
  }
}

TEST_CASE("elasto-plastic: both routes agree", "[df][elasto-plastic]") {
  for (const double A : {1.2e-5, 1e-4}) {
    CAPTURE(A);
    const PrescribedMotion motion(A, 10.0, 0.0, true);
    const auto smooth = quadrature(seeds(), A, 10.0, 0.0, 1e-8);
    const auto fft = FftRoute(seeds(), motion, true, 0.0, with(DfMethod::fft, 1e-5)).refine(smooth);
    CHECK(fft.status == Status::converged);
    CHECK(fft.error <= 1e-5);
    CHECK(apart(fft.gain, smooth.gain) <= fft.error + smooth.error);
  }
}

TEST_CASE("elasto-plastic: in the elastic range a spring and a damper, without loss to friction",
          "[df][elasto-plastic]") {
  // Many states are periodic there; the half-wave symmetric one is required. Claim D9: up to 0.69 Fs, or 0.69 Fc.
  for (const bool of_coulomb : {false, true})
    for (const double share : {1e-3, 0.5, 0.999}) {
      auto law = seeds(of_coulomb);
      law.sigma2 = 0.4;
      const double A = share * (of_coulomb ? 0.69e-5 : 1.03e-5);
      const auto df = quadrature(law, A, 3.0, 0.0, 1e-10);
      CHECK(df.status == Status::converged);
      CHECK(df.symmetric);
      CHECK(apart(df.gain, {law.sigma0, 3.0 * (law.sigma1 + law.sigma2)}) < 1e-12);
    }
}
