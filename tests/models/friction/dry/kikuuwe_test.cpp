#include "limcycle/models/friction/dry/kikuuwe.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/dual.hpp"

using namespace limcycle;

namespace {

static_assert(LawOn<Kikuuwe<double>, double> && HasModes<Kikuuwe<double>, double>);
static_assert(LawOn<Kikuuwe<Dual<4>>, Dual<4>> && HasModes<Kikuuwe<Dual<4>>, Dual<4>>);

Kikuuwe<double> law_of(double Fs_minus = 1.5, double Fc_minus = 1.0) {
  Kikuuwe<double> law;
  law.Fs = 1.5;
  law.Fc = 1.0;
  law.Fs_minus = Fs_minus;
  law.Fc_minus = Fc_minus;
  law.vs = 1e-3;
  law.K = 1e5;
  law.B = 316.0;
  law.sigma2 = 0.4;
  return law;
}

struct At {
  const Kikuuwe<double>& law;
  double v, e;
  Mode mode() const {
    double state = e;
    return law.start({0.0, v, 0.0}, std::span<double>(&state, 1));
  }
  double rate(Mode mode) const {
    double de[1];
    law.rate({0.0, v, 0.0}, mode, std::span<const double>(&e, 1), de);
    return de[0];
  }
  double output(Mode mode) const { return law.output({0.0, v, 0.0}, mode, std::span<const double>(&e, 1)); }
};

}  // namespace

TEST_CASE("Kikuuwe: f = K e + B de/dt in g Sgn(v - de/dt), odd, bounded, passive", "[kikuuwe]") {
  CHECK(Kikuuwe<double>{}.states() == 1);
  const auto law = law_of();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int seen[3] = {};
  for (int i = 0; i < 500; ++i) {
    const At at{law, 5e-3 * u(random), 1.5e-5 * u(random)};
    const Mode mode = at.mode();
    ++seen[mode.value + 1];
    const double de = at.rate(mode), f = at.output(mode) - law.sigma2 * at.v, slip = at.v - de, g = law.level(at.v);
    CHECK(f == Approx(law.K * at.e + law.B * de).epsilon(1e-12).margin(1e-14));
    CHECK(std::abs(f) <= g * (1.0 + 1e-14));
    if (mode.value == 0) CHECK(slip == 0.0);
    if (mode.value != 0) {
      CHECK(f == g * static_cast<double>(mode.value));
      CHECK(slip * f >= 0.0);
    }
    CHECK(at.output(mode) * at.v - law.K * at.e * de >= -1e-16);
    const At mirrored{law, -at.v, -at.e};
    CHECK(mirrored.mode() == law.mirror(mode));
    CHECK(mirrored.rate(law.mirror(mode)) == -de);
    CHECK(mirrored.output(law.mirror(mode)) == -at.output(mode));
  }
  for (const int times : seen) CHECK(times > 20);
}

TEST_CASE("Kikuuwe: steady sliding, continuity at the cap, uneven levels", "[kikuuwe]") {
  const auto law = law_of(1.2, 0.7);
  CHECK_FALSE(law.odd());
  for (const double v : {1e-5, 1e-3, 0.1, -0.02, -1e-4}) {
    const double g = law.level(v) * (v > 0.0 ? 1.0 : -1.0);
    const At steady{law, v, g / law.K};
    CHECK(steady.mode().value == (v > 0.0 ? 1 : -1));
    CHECK(std::abs(steady.rate(steady.mode())) < 1e-17);
    CHECK(steady.output(steady.mode()) == Approx(g + law.sigma2 * v));
    const At edge{law, v, (g - law.B * v) / law.K};  // transition from stick to the cap
    const Mode cap{v > 0.0 ? 1 : -1};
    CHECK(edge.rate({0}) == Approx(edge.rate(cap)));
    CHECK(edge.output({0}) == Approx(edge.output(cap)));
  }
  CHECK_FALSE(law.validate());
  CHECK(law_of(0.5, 0.7).validate()->key == "Fs_minus");
}

TEST_CASE("Kikuuwe: a switch leads into a mode that lasts", "[kikuuwe]") {
  const auto law = law_of();
  for (const double v : {2e-5, 1e-3, -3e-4}) {
    for (const double side : {1.0, -1.0}) {
      double e = (side * law.level(v) * (1.0 + 2e-14) - law.B * v) / law.K, g[2];
      law.guard({0.0, v, 0.0}, {0}, std::span<const double>(&e, 1), g);
      const int fired = side > 0.0 ? 0 : 1;
      REQUIRE(g[fired] < 0.0);
      const Mode next = law.next({0.0, v, 0.0}, {0}, std::span<double>(&e, 1), fired);
      CHECK(next.value == static_cast<int>(side));
      law.guard({0.0, v, 0.0}, next, std::span<const double>(&e, 1), g);
      CHECK(g[0] > 0.0);
    }
  }
}
