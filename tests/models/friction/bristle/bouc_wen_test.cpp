#include "limcycle/models/friction/bristle/bouc_wen.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"

using namespace limcycle;

namespace {

static_assert(LawOn<BoucWen<double>, double> && HasModes<BoucWen<double>, double>);
static_assert(LawOn<BoucWen<Dual<4>>, Dual<4>> && HasModes<BoucWen<Dual<4>>, Dual<4>>);

BoucWen<double> bouc_wen(double beta, double gamma, double n = 1.0) {
  BoucWen<double> law;
  law.k = 1e5;
  law.D = 1e-5;
  law.beta = beta;
  law.gamma = gamma;
  law.n = n;
  return law;
}

double rate(const BoucWen<double>& law, double v, double z, Mode mode) {
  double dz[1];
  law.rate({0.0, v, 0.0}, mode, std::span<const double>(&z, 1), dz);
  return dz[0];
}

/// The equation as published.
double printed(const BoucWen<double>& law, double v, double z) {
  const double size = std::abs(z);
  return (law.A * v - law.beta * std::abs(v) * std::pow(size, law.n - 1.0) * z -
          law.gamma * v * std::pow(size, law.n)) /
         law.D;
}

Mode mode_of(const BoucWen<double>& law, double z) { return law.start({0.0, 0.0, 1.0}, std::span<double>(&z, 1)); }

}  // namespace

TEST_CASE("Bouc-Wen: the printed equation in every mode, odd, within its bound", "[bouc-wen]") {
  CHECK(BoucWen<double>{}.states() == 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const auto& law : {bouc_wen(0.5, 0.5), bouc_wen(1.0, 0.0), bouc_wen(0.7, -0.6, 2.0), bouc_wen(0.0, 1.0, 2.0),
                          bouc_wen(0.2, 1.3, 1.4), bouc_wen(0.5, 0.5, 3.0)}) {
    for (int i = 0; i < 100; ++i) {
      const double v = 1e-3 * u(random), z = law.largest() * u(random);
      const Mode mode = mode_of(law, z);
      CHECK(rate(law, v, z, mode) == Approx(printed(law, v, z)).epsilon(1e-12).margin(1e-12));
      CHECK(rate(law, -v, -z, law.mirror(mode)) == -rate(law, v, z, mode));
      const double mirrored = -z;
      CHECK(law.output({-0.1, -v, 0.0}, law.mirror(mode), std::span<const double>(&mirrored, 1)) ==
            -law.output({0.1, v, 0.0}, mode, std::span<const double>(&z, 1)));
    }
    for (const double v : {1e-3, -1e-3}) {  // at the bound z does not move outwards
      CHECK(rate(law, v, law.largest(), mode_of(law, 1.0)) <= 1e-12 * std::abs(v) / law.D);
      CHECK(std::abs(rate(law, 1e-3, law.largest(), mode_of(law, 1.0))) < 1e-12 * 1e-3 / law.D);
    }
  }
}

TEST_CASE("Bouc-Wen: modes follow z without chatter", "[bouc-wen]") {
  for (const double n : {1.0, 1.5}) {
    const auto law = bouc_wen(0.5, 0.5, n);
    double z = 0.99, g[2];
    Mode mode = mode_of(law, z);
    int switches = 0;
    for (; z > -0.99; z -= 1e-7) {
      const std::span<const double> state(&z, 1);
      law.guard({}, mode, state, g);
      for (int k = 0; k < law.guards(mode); ++k) {
        if (g[k] >= 0.0) continue;
        mode = law.next({}, mode, std::span<double>(&z, 1), k);
        ++switches;
        law.guard({}, mode, state, g);
        for (int j = 0; j < law.guards(mode); ++j) REQUIRE(g[j] >= 0.0);
        break;
      }
    }
    CHECK(switches == (n == 1.0 ? 1 : 21));
    CHECK(mode.value == -1);
  }
  CHECK(bouc_wen(1.0, 0.0).guards(mode_of(bouc_wen(1.0, 0.0), 0.3)) == 0);  // nothing requires a switch
}

TEST_CASE("Bouc-Wen: Dahl's law and linear unloading as special cases", "[bouc-wen]") {
  const Dahl<double> dahl{1.0, 1e5, 1.0};
  const auto law = bouc_wen(1.0, 0.0);
  for (const double z : {-0.9, -0.1, 0.0, 0.4, 0.99})
    for (const double v : {-1e-3, 2e-3}) {
      double dz[1], deflection = law.D * z;
      dahl.rate({0.0, v, 0.0}, {}, std::span<const double>(&deflection, 1), dz);
      CHECK(law.D * rate(law, v, z, mode_of(law, z)) == Approx(dz[0]).epsilon(1e-13));
    }
  // beta = gamma: unloading has the slope A.
  for (const double z : {0.1, 0.5, 0.9}) CHECK(rate(bouc_wen(0.5, 0.5), -1e-3, z, {1}) == Approx(-1e-3 / 1e-5));
}

TEST_CASE("Bouc-Wen: passive for beta >= 0 whatever gamma, unbounded for beta < 0", "[bouc-wen]") {
  // Storage: the energy returned in unloading, W' = k D^2 z/(A + (beta - gamma) |z|^n).
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const auto& law : {bouc_wen(0.5, 0.5), bouc_wen(0.2, 1.3), bouc_wen(0.7, -0.6, 2.0), bouc_wen(0.1, 2.0, 1.5)})
    for (int i = 0; i < 200; ++i) {
      const double v = u(random), z = law.largest() * u(random);
      const double given_back =
          law.k * law.D * law.D * z / (law.A + (law.beta - law.gamma) * std::pow(std::abs(z), law.n));
      const double F = law.output({0.0, v, 0.0}, mode_of(law, z), std::span<const double>(&z, 1));
      CHECK(F * v - given_back * rate(law, v, z, mode_of(law, z)) >= -1e-14 * std::abs(F * v));
    }
  // beta = -0.05, gamma = 1.05: z approaches 1 in loading and then grows while the motion is reversed.
  const auto law = bouc_wen(-0.05, 1.05);
  CHECK(rate(law, -1e-3, 0.95, {1}) > 0.0);
}

TEST_CASE("Bouc-Wen: what is refused", "[bouc-wen]") {
  CHECK_FALSE(bouc_wen(0.5, 0.5).validate());
  CHECK_FALSE(bouc_wen(-0.05, 1.05).validate());
  CHECK(bouc_wen(0.5, -0.5).validate()->key == "gamma");
  CHECK(bouc_wen(0.5, -0.6).validate().has_value());
}
