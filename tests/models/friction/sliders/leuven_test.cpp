// The equations of the modified Leuven law: limits, steady sliding, switches, symmetry.
#include "limcycle/models/friction/sliders/leuven.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/friction/bristle/lugre.hpp"

using namespace limcycle;

namespace {

template <class Law>
Law stribeck_set() {
  Law law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  return law;
}

Leuven<double> three_elements(double n) {
  auto law = stribeck_set<Leuven<double>>();
  law.k = {2e4, 1e4, 5e3};
  law.W = {0.3, 0.5, 0.9};
  law.n = n;
  law.sigma1 = 10.0;
  return law;
}

constexpr Input<double> sliding(double v) { return {0.0, v, v < 0.0 ? -infinite : infinite}; }

}  // namespace

TEST_CASE("leuven: one element that never slips is LuGre", "[friction]") {
  auto law = stribeck_set<Leuven<double>>();
  law.k = {1e5};
  law.W = {3.0};
  law.sigma1 = 300.0;
  law.sigma2 = 0.4;
  auto lugre = stribeck_set<LuGre<double>>();
  lugre.sigma0 = 1e5;
  lugre.sigma1 = 300.0;
  lugre.sigma2 = 0.4;
  for (const double v : {-1e-2, -1e-4, 1e-5, 3e-3})
    for (const double z : {-1.4e-5, -2e-6, 1e-6, 1.2e-5}) {
      const double s[] = {z};
      double ds[1], dz[1];
      law.rate(sliding(v), {}, s, ds);
      lugre.rate(sliding(v), {}, s, dz);
      CHECK(ds[0] == Approx(dz[0]).epsilon(1e-13));
      CHECK(law.output(sliding(v), {}, s) == Approx(lugre.output(sliding(v), {}, s)).epsilon(1e-13));
    }
}

TEST_CASE("leuven: steady sliding is the Stribeck curve for any n", "[friction]") {
  for (const double n : {0.7, 1.0, 2.0, 5.0}) {
    const auto law = three_elements(n);
    for (const double v : {1e-4, 1e-3, -0.1}) {
      // The first two elements are on their limits, the third carries the rest.
      const double direction = v < 0.0 ? -1.0 : 1.0, rest = law.level(v) - 0.8;
      const std::vector<double> s{direction * 0.3 / 2e4, direction * 0.5 / 1e4, direction * rest / 5e3};
      double ds[3];
      law.rate(sliding(v), {}, s, ds);
      for (const double rate : ds) CHECK(std::abs(rate) < 1e-14 * std::abs(v));
      CHECK(law.output(sliding(v), {}, s) == Approx(direction * law.level(v)).epsilon(1e-13));
    }
  }
}

TEST_CASE("leuven: elements turn back with dz/dt, not with v", "[friction]") {
  const auto law = three_elements(1.0);
  const Mode slips = with_slider({}, 0, Slider::slips_forward);
  std::vector<double> s{0.3 / 2e4, 0.5 / 1e4, 0.4 / 5e3}, g(8);  // F_h = 1.2 N
  law.guard(sliding(1e-4), slips, s, g);
  CHECK(g[6] > 0.0);
  law.guard(sliding(0.1), slips, s, g);  // g has fallen to Fc < F_h
  CHECK(g[6] < 0.0);
  CHECK(law.next(sliding(0.1), slips, s, 6) == Mode{0});
  law.guard(sliding(-1e-4), slips, s, g);
  CHECK(g[6] < 0.0);
  s[2] = (1.0 - 0.8) / 5e3 * (1.0 + 1e-15);  // steady sliding to rounding
  law.guard(sliding(0.1), slips, s, g);
  CHECK(g[6] >= 0.0);
  // A slipping element is exactly on its limit and does not move while it slips.
  s[0] *= 1.0 - 1e-9;
  CHECK(law.next(sliding(1e-4), {}, s, 0) == slips);
  CHECK(s[0] == 0.3 / 2e4);
  double ds[3];
  law.rate(sliding(1e-4), slips, s, ds);
  CHECK(ds[0] == 0.0);
  CHECK(ds[1] > 0.0);
}

TEST_CASE("leuven: the kink of |F_h|^n is a switch, where there is one", "[friction]") {
  std::vector<double> s(3, 1e-6), g(8);
  for (const double n : {1.0, 3.0}) {
    const auto law = three_elements(n);
    law.guard(sliding(-1e-3), {}, s, g);
    CHECK(g[7] == 1.0);
    CHECK(law.start(sliding(-1e-3), s) == Mode{0});
  }
  const auto law = three_elements(2.0);
  law.guard(sliding(-1e-3), {}, s, g);
  CHECK(g[7] == Approx(0.035));
  const Mode turned = law.next(sliding(-1e-3), {}, s, 7);
  law.guard(sliding(-1e-3), turned, s, g);
  CHECK(g[7] == Approx(-0.035));
  CHECK(law.mirror({}) == turned);
  std::vector<double> none(3, 0.0);
  CHECK(law.start(sliding(-1e-3), none) == turned);
  CHECK(law.start(sliding(1e-3), none) == Mode{0});
}

TEST_CASE("leuven is odd, modes included", "[friction]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const double n : {1.0, 2.0}) {
    const auto law = three_elements(n);
    for (int trial = 0; trial < 100; ++trial) {
      std::vector<double> s(3), minus(3), ds(3), minus_ds(3), g(8), minus_g(8);
      Mode mode;
      const Slider way = u(random) < 0.0 ? Slider::slips_backward : Slider::slips_forward;
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        minus[at] = -(s[at] = u(random) * law.state_scale(i));
        if (u(random) < 0.0) mode = with_slider(mode, i, way);
      }
      const double v = 3e-3 * u(random);
      const Mode turned = law.mirror(mode);
      CHECK(law.mirror(turned) == mode);
      CHECK(law.output(sliding(v), mode, s) == -law.output(sliding(-v), turned, minus));
      law.rate(sliding(v), mode, s, ds);
      law.rate(sliding(-v), turned, minus, minus_ds);
      law.guard(sliding(v), mode, s, g);
      law.guard(sliding(-v), turned, minus, minus_g);
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(ds[i] == -minus_ds[i]);
        CHECK(g[2 * i] == minus_g[2 * i + 1]);
      }
      CHECK(g[6] == minus_g[6]);
      CHECK(g[7] == minus_g[7]);
    }
  }
}

TEST_CASE("leuven: elements too weak for the level are refused", "[friction]") {
  auto law = three_elements(1.0);
  CHECK_FALSE(law.validate());
  law.W[2] = 0.6;
  CHECK(law.validate()->key == "W");
  CHECK(law.validate()->rule == "must sum to Fs or more; it sums to 1.400000");
  law.W[2] = 0.7 * (1.0 - 1e-13);  // equal to rounding
  CHECK_FALSE(law.validate());
  law.Fs_minus = 1.6;
  CHECK(law.validate()->rule == "must sum to Fs_minus or more; it sums to 1.500000");
}
