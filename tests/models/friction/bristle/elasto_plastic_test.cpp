#include "limcycle/models/friction/bristle/elasto_plastic.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

using namespace limcycle;

namespace {

static_assert(LawOn<ElastoPlastic<double>, double> && HasModes<ElastoPlastic<double>, double>);
static_assert(LawOn<ElastoPlastic<Dual<4>>, Dual<4>> && HasModes<ElastoPlastic<Dual<4>>, Dual<4>>);

ElastoPlastic<double> elasto_plastic(int zba_of = 0) {
  ElastoPlastic<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = 316.0;
  law.sigma2 = 0.4;
  law.zba_of.index = zba_of;
  return law;
}

double rate(const ElastoPlastic<double>& law, double v, double z, Mode mode) {
  double dz[1];
  law.rate({0.0, v, 0.0}, mode, std::span<const double>(&z, 1), dz);
  return dz[0];
}
double output(const ElastoPlastic<double>& law, double v, double z, Mode mode) {
  return law.output({0.0, v, 0.0}, mode, std::span<const double>(&z, 1));
}
Mode mode_of(const ElastoPlastic<double>& law, double v, double z) {
  return law.start({0.0, v, 0.0}, std::span<double>(&z, 1));
}

/// The equation as published, for symmetric levels.
double printed(const ElastoPlastic<double>& law, double v, double z) {
  const double z_ss = law.level(v) / law.sigma0,
               z_ba = law.zba_ratio * (law.zba_of.index == 0 ? z_ss : law.Fc / law.sigma0);
  double alpha = 0.0;
  if (z * v > 0.0 && std::abs(z) >= z_ss)
    alpha = 1.0;
  else if (z * v > 0.0 && std::abs(z) > z_ba)
    alpha = 0.5 + 0.5 * std::sin(std::numbers::pi * (std::abs(z) - 0.5 * (z_ss + z_ba)) / (z_ss - z_ba));
  return v * (1.0 - alpha * law.sigma0 / law.level(v) * (v < 0.0 ? -1.0 : 1.0) * z);
}

}  // namespace

TEST_CASE("elasto-plastic: the printed equation in every mode, odd", "[elasto-plastic]") {
  CHECK(ElastoPlastic<double>{}.states() == 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const int kind : {0, 1}) {
    const auto law = elasto_plastic(kind);
    int seen[5] = {};
    for (int i = 0; i < 500; ++i) {
      const double v = 3e-3 * u(random), z = 1.5e-5 * u(random);
      const Mode mode = mode_of(law, v, z);
      ++seen[mode.value + 2];
      CHECK(rate(law, v, z, mode) == Approx(printed(law, v, z)).epsilon(1e-12).margin(1e-17));
      CHECK(rate(law, -v, -z, law.mirror(mode)) == -rate(law, v, z, mode));
      CHECK(output(law, -v, -z, law.mirror(mode)) == -output(law, v, z, mode));
      if (mode.value != 0) CHECK(mode_of(law, -v, -z) == law.mirror(mode));
    }
    for (const int times : seen) CHECK(times > 10);
    CHECK(law.odd());
  }
  auto uneven = elasto_plastic();
  uneven.Fc_minus = 0.8;
  CHECK_FALSE(uneven.odd());
  CHECK(uneven.steady_deflection(1.0, false) == Approx(0.8e-5));
}

TEST_CASE("elasto-plastic: steady sliding is the Stribeck curve, elastic range exact", "[elasto-plastic]") {
  for (const int kind : {0, 1}) {
    const auto law = elasto_plastic(kind);
    for (const double v : {1e-5, 1e-3, 0.1, -0.02}) {
      const double z = law.level(v) * (v > 0 ? 1 : -1) / law.sigma0;
      for (const int mode : {1, 2}) {  // z_ss belongs to both, to rounding
        CHECK(std::abs(rate(law, v, z, {v > 0 ? mode : -mode})) < 1e-15 * std::abs(v));
        CHECK(output(law, v, z, {v > 0 ? mode : -mode}) ==
              Approx((v > 0 ? 1 : -1) * law.level(v) + law.sigma2 * v).epsilon(1e-14));
      }
    }
    const double limit = kind == 0 ? 1.035e-5 : 0.69e-5;  // claim D9
    CHECK(law.elastic_deflection(0.0, true) == Approx(limit).epsilon(1e-15));
    for (const double z : {-0.999 * limit, 0.0, 0.999 * limit})
      CHECK(rate(law, 1e-9, z, mode_of(law, 1e-9, z)) == 1e-9);
    for (double v = 1e-6; v < 1.0; v *= 1.5) CHECK(law.elastic_deflection(v, true) < law.steady_deflection(v, true));
  }
}

TEST_CASE("elasto-plastic: modes overlap without a trace and do not chatter", "[elasto-plastic]") {
  const auto law = elasto_plastic();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const double v = 2e-3 * (2.0 * u(random) - 1.0);
    for (const double z0 : {law.elastic_deflection(std::abs(v), true), law.steady_deflection(std::abs(v), true)}) {
      for (const int from : {0, 1, 2}) {  // each mode is left just beyond its own end, into one that lasts
        double g[2], z = z0;
        for (const double shift : {-1.2e-8, 1.2e-8}) {
          z = z0 * (1.0 + shift);
          law.guard({0.0, v, 0.0}, {from}, std::span<const double>(&z, 1), g);
          for (int k = 0; k < law.guards({from}); ++k) {
            if (g[k] >= 0.0 || std::abs(g[k]) > 1e-12) continue;
            const Mode next = law.next({0.0, v, 0.0}, {from}, std::span<double>(&z, 1), k);
            CHECK(rate(law, v, z, next) == Approx(rate(law, v, z, {from})).epsilon(1e-13).margin(1e-14 * std::abs(v)));
            double after[2];
            law.guard({0.0, v, 0.0}, next, std::span<const double>(&z, 1), after);
            for (int j = 0; j < law.guards(next); ++j) CHECK(after[j] > 0.0);
          }
        }
      }
    }
  }
}

TEST_CASE("elasto-plastic: bounded, and passive where it says so", "[elasto-plastic]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const int kind : {0, 1}) {
    auto law = elasto_plastic(kind);
    for (int i = 0; i < 500; ++i) {
      const double v = 5e-3 * u(random), z = 1.5e-5 * u(random);
      const Mode mode = mode_of(law, v, z);
      CHECK(rate(law, std::abs(v), 1.5e-5, mode_of(law, std::abs(v), 1.5e-5)) <= 1e-15 * std::abs(v));
      // Storage sigma0 z^2/2: without sigma1 at any sigma2, with it for sigma2/sigma1 >= (Fs - Fc)/Fc.
      for (const double damping : {0.0, 316.0}) {
        law.sigma1 = damping;
        law.sigma2 = 0.5 * damping;
        const double supplied = output(law, v, z, mode) * v, stored = law.sigma0 * z * rate(law, v, z, mode);
        CHECK(supplied - stored >= -1e-14 * std::abs(supplied));
      }
    }
  }
}

TEST_CASE("elasto-plastic: z_ba to zero makes sliding that of LuGre", "[elasto-plastic]") {
  auto law = elasto_plastic();
  law.zba_ratio = 1e-9;
  LuGre<double> lugre;
  lugre.Fs = lugre.Fs_minus = 1.5;
  lugre.Fc = lugre.Fc_minus = 1.0;
  lugre.vs = 1e-3;
  lugre.sigma0 = 1e5;
  const double z = 1.45e-5, v = 1e-3;  // beyond z_ss: a = 1 as in LuGre
  double dz[1];
  lugre.rate({0.0, v, 0.0}, {}, std::span<const double>(&z, 1), dz);
  CHECK(rate(law, v, z, mode_of(law, v, z)) == Approx(dz[0]).epsilon(1e-14));
  CHECK_FALSE(law.validate());
  law.Fs = 0.5;
  CHECK(law.validate()->key == "Fs");
  for (const auto& row : ElastoPlastic<double>::parameters())
    if (row.key == "zba_ratio") {
      CHECK_FALSE(row.range.contains(0.0));
      CHECK_FALSE(row.range.contains(1.0));
    }
}
