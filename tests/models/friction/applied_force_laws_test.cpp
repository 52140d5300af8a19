// Karnopp, Quinn, Awrejcewicz, Wojewoda: their equations, mode by mode.
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/friction/dry/awrejcewicz.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/quinn.hpp"
#include "limcycle/models/friction/dry/wojewoda.hpp"

using namespace limcycle;

namespace {

template <class Law>
Law levels(double sigma2 = 0.4) {
  Law law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-2;
  law.sigma2 = sigma2;
  if constexpr (requires { law.dv; }) law.dv = 1e-3;
  if constexpr (requires { law.ks; }) law.ks = 1e4;
  return law;
}

/// Output of the law without history at this velocity and drive.
template <class Law>
double fresh(const Law& law, double v, double drive) {
  const Input<double> in{0.0, v, drive};
  return law.output(in, law.start(in, {}), {});
}

template <class Law>
std::vector<double> guards_at(const Law& law, double v, double drive, Mode mode, std::vector<double> z = {}) {
  std::vector<double> g(static_cast<std::size_t>(law.guards(mode)));
  law.guard(Input<double>{0.0, v, drive}, mode, std::span<const double>(z), g);
  return g;
}

template <class Law>
void check_mirror(const Law& law, const std::vector<std::int64_t>& modes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  CHECK(law.odd());
  for (int i = 0; i < 50; ++i)
    for (const auto value : modes) {
      const Mode mode{value}, mirrored = law.mirror(mode);
      CHECK(law.mirror(mirrored) == mode);
      const double v = 2e-3 * u(random), drive = 3.0 * u(random), q = 1e-4 * u(random);
      const Input<double> in{0.0, v, drive}, back{0.0, -v, -drive};
      const std::vector<double> z(static_cast<std::size_t>(law.states()), q), minus(z.size(), -q);
      CHECK(law.output(in, mode, z) == Approx(-law.output(back, mirrored, minus)).margin(1e-15));
      auto g = guards_at(law, v, drive, mode, z), h = guards_at(law, -v, -drive, mirrored, minus);
      std::ranges::sort(g);
      std::ranges::sort(h);
      CHECK(g == h);
    }
}

}  // namespace

TEST_CASE("laws with a band: outside it the Stribeck curve, at rest the applied force up to Fs") {
  const auto check = []<class Law>(const Law& law) {
    for (const double v : {1.001e-3, 5e-3, 0.3}) {
      CHECK(fresh(law, v, 7.0) == Approx(law.level(v) + law.sigma2 * v));
      CHECK(fresh(law, -v, 7.0) == Approx(-law.level(v) - law.sigma2 * v));
    }
    for (const double drive : {-1.4, 0.0, 0.2, 1.49}) CHECK(fresh(law, 0.0, drive) == drive);
    CHECK(fresh(law, 0.0, 1.7) == 1.5);
    CHECK(fresh(law, 0.0, -9.0) == -1.5);
    CHECK(drive_band(law) == 1e-3);
    CHECK(drive_is_of_rate(law));
    CHECK_FALSE(law.validate());
    auto uneven = law;
    uneven.Fs_minus = 2.0;
    CHECK_FALSE(uneven.odd());
    CHECK(fresh(uneven, 0.0, -9.0) == -2.0);
    uneven.Fs = 0.5;
    CHECK(uneven.validate());
  };
  check(levels<Karnopp<double>>());
  check(levels<Quinn<double>>());
  check(levels<Awrejcewicz<double>>());
  check_mirror(levels<Karnopp<double>>(), {0, 1, 2, -1, -2});
  check_mirror(levels<Quinn<double>>(), {0, 1, 2, 3, -1, -2, -3});
  check_mirror(levels<Awrejcewicz<double>>(), {0, 1, 2, 3, -1, -2, -3});
  check_mirror(levels<Wojewoda<double>>(), {0, 1, 2, 3, -1, -2, -3});
}

TEST_CASE("Quinn and Awrejcewicz: the band, case by case, and continuity across it") {
  const auto quinn = levels<Quinn<double>>();
  const auto smooth = levels<Awrejcewicz<double>>();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const double v = 1e-3 * u(random), Fe = 3.0 * u(random), s = std::abs(v) / 1e-3, sgn = v < 0.0 ? -1.0 : 1.0;
    const double sat = std::clamp(Fe, -1.5, 1.5), A3 = s * s * (3.0 - 2.0 * s), viscous = 0.4 * v;
    CHECK(fresh(quinn, v, Fe) == Approx((1.0 - s) * sat + s * quinn.level(v) * sgn + viscous));
    // The published cases, one by one.
    const double published = std::abs(Fe) <= 1.5 ? A3 * (-Fe + 1.5 * sgn) + Fe
                             : Fe * sgn > 0.0    ? 1.5 * sgn
                                                 : (2.0 * A3 - 1.0) * 1.5 * sgn;
    CHECK(fresh(smooth, v, Fe) == Approx(published + viscous));
  }
  // At the edge of the band: continuous, or a fall from Fs to g(dv).
  const double in = 1e-3 * (1.0 - 1e-12), out = 1e-3 * (1.0 + 1e-12);
  for (const double Fe : {-2.0, 0.7, 2.0}) {
    CHECK(fresh(quinn, in, Fe) == Approx(fresh(quinn, out, Fe)).epsilon(1e-10));
    CHECK(fresh(smooth, in, Fe) - fresh(smooth, out, Fe) == Approx(1.5 - smooth.level(1e-3)).epsilon(1e-6));
  }
}

TEST_CASE("laws with a band: switches lead to the mode that a fresh start would have") {
  const auto check = []<class Law>(const Law& law, const std::vector<std::int64_t>& modes) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (int i = 0; i < 400; ++i)
      for (const auto value : modes) {
        // A point on one guard only: the switch of that guard, and a point just beyond it.
        const double v = std::array{1e-3, -1e-3, 0.0, 0.7e-3 * u(random)}[static_cast<std::size_t>(i % 4)];
        const double drive = i % 8 < 4 ? 3.0 * u(random) : std::array{1.5, -1.5}[static_cast<std::size_t>(i % 2)];
        const auto g = guards_at(law, v, drive, {value});
        for (std::size_t k = 0; k < g.size(); ++k) {
          if (g[k] != 0.0) continue;
          bool inside = true;
          for (std::size_t j = 0; j < g.size(); ++j) inside = inside && (j == k || g[j] > 0.0);
          if (!inside) continue;
          const Mode after = law.next(Input<double>{0.0, v, drive}, {value}, {}, static_cast<int>(k));
          CHECK_FALSE(after == Mode{value});
          CHECK(law.output(Input<double>{0.0, v, drive}, after, {}) ==
                Approx(law.output(Input<double>{0.0, v, drive}, {value}, {})).margin(1e-12));
          for (const double here : guards_at(law, v, drive, after)) CHECK(here >= 0.0);
        }
      }
  };
  check(levels<Quinn<double>>(), {0, 1, 2, 3, -1, -2, -3});
  const auto law = levels<Awrejcewicz<double>>();
  CHECK(law.next(Input<double>{0.0, 1e-3, 0.3}, {1}, {}, 0) == Mode{0});
  CHECK(law.next(Input<double>{0.0, 1e-3, -2.0}, {1}, {}, 0) == Mode{-3});
  CHECK(law.next(Input<double>{0.0, -1e-3, -2.0}, {-1}, {}, 0) == Mode{-2});
  // A drive that jumps between infinities, as under prescribed motion.
  CHECK(law.next(Input<double>{0.0, 1e-4, -infinite}, {2}, {}, 2) == Mode{-3});
  CHECK(law.next(Input<double>{0.0, 1e-4, 0.0}, {2}, {}, 2) == Mode{0});
}

TEST_CASE("Karnopp: stopped on entering the band, breaking away against Fs") {
  const auto law = levels<Karnopp<double>>();
  CHECK(arrests(law, law.forward, 0));
  CHECK(arrests(law, law.backward, 0));
  CHECK_FALSE(arrests(law, law.leaving_forward, 0));
  CHECK_FALSE(arrests(law, law.stuck, 0));
  const auto next = [&](double drive, Mode mode, int fired) {
    return law.next(Input<double>{0.0, 0.0, drive}, mode, {}, fired);
  };
  CHECK(next(1.2, law.forward, 0) == law.stuck);
  CHECK(next(-1.6, law.forward, 0) == law.leaving_backward);
  CHECK(next(1.6, law.forward, 0) == law.leaving_forward);
  CHECK(next(1.5, law.stuck, 0) == law.leaving_forward);
  CHECK(next(-1.5, law.stuck, 1) == law.leaving_backward);
  CHECK(next(1.6, law.leaving_forward, 0) == law.forward);
  CHECK(next(0.3, law.leaving_forward, 1) == law.stuck);
  CHECK(law.output(Input<double>{0.0, 5e-4, 2.0}, law.leaving_forward, {}) == Approx(1.5 + 2e-4));
  CHECK(law.start(Input<double>{0.0, 5e-4, 0.0}, {}) == law.leaving_forward);
  CHECK(law.held(law.stuck) == Held::rate);
  CHECK(law.held(law.leaving_forward) == Held::nothing);
  CHECK(law.selection(law.stuck, 0.75) == 0.5);
  CHECK(law.selection(law.leaving_backward, -1.5) == -1.0);
}

TEST_CASE("Wojewoda: the slip force is the drive clipped between the two curves, and only that is consistent") {
  const auto law = levels<Wojewoda<double>>(0.0);
  CHECK(drive_band(law) == 0.0);
  CHECK(drive_is_of_rate(law));
  const double z[] = {0.0};
  for (const double v : {1e-3, 8e-3, 0.02, -4e-3})
    for (const double drive : {-2.0, 0.55, 0.9, 1.1, 1.45, 3.0, -0.7, -1.3}) {
      const std::int64_t d = v < 0.0 ? -1 : 1;
      const double g = law.level(v), sign = static_cast<double>(d);
      int consistent = 0;
      for (std::int64_t phase = 1; phase <= 3; ++phase) {
        const Input<double> in{0.0, v, drive};
        const Mode mode{d * phase};
        const double F = law.output(in, mode, z), acceleration = drive - F;  // per unit mass
        // In the equation: F = sgn(v) (Fc + (g - Fc) sgn(v dv/dt)), sgn(0) in [-1, 1].
        const double dry = (sign * F - 1.0) / (g - 1.0);
        const bool holds = acceleration == 0.0 ? std::abs(dry) <= 1.0
                                               : dry == Approx(acceleration * sign > 0.0 ? 1.0 : -1.0).epsilon(1e-12);
        bool stays = true;
        for (const double here : guards_at(law, v, drive, mode, {0.0})) stays = stays && here >= 0.0;
        CHECK(holds == stays);
        if (!holds) continue;
        ++consistent;
        CHECK(sign * F == Approx(std::clamp(sign * drive, 2.0 - g, g)));
      }
      CHECK(consistent == 1);
    }
}

TEST_CASE("Wojewoda: the spring, its release and re-entry with the force of slip") {
  const auto law = levels<Wojewoda<double>>();
  std::vector<double> z(1), dz(1);
  CHECK(law.start({}, z) == Mode{0});
  CHECK(z[0] == 0.0);
  z[0] = 1e-4;
  law.rate(Input<double>{0.0, 3e-3, 0.0}, {0}, z, dz);
  CHECK(dz[0] == 3e-3);
  CHECK(law.output(Input<double>{0.0, 3e-3, 0.0}, {0}, z) == Approx(1.0 + 0.4 * 3e-3));
  CHECK(guards_at(law, 0.0, 0.0, {0}, {1.5e-4})[0] == Approx(0.0).margin(1e-15));
  z[0] = 1.5e-4;
  CHECK(law.next(Input<double>{0.0, 1e-3, infinite}, {0}, z, 0) == Mode{3});
  CHECK(z[0] == 0.0);
  CHECK(law.next(Input<double>{0.0, -1e-3, infinite}, {0}, z, 1) == Mode{-1});
  CHECK(law.next(Input<double>{0.0, 1e-3, -infinite}, {3}, z, 0) == Mode{1});
  CHECK(law.next(Input<double>{0.0, 1e-3, 1.0}, {3}, z, 0) == Mode{2});
  const double before = law.output(Input<double>{0.0, 0.0, -infinite}, {1}, z);
  CHECK(law.next(Input<double>{0.0, 0.0, -infinite}, {1}, z, 1) == Mode{0});
  CHECK(law.output(Input<double>{0.0, 0.0, -infinite}, {0}, z) == Approx(before));
  CHECK(before == Approx(0.5));
}
