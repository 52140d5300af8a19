// The equations of GMS: steady sliding, switches, bounds, symmetry.
#include "limcycle/models/friction/sliders/gms.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace limcycle;

namespace {

Gms<double> two_elements() {
  Gms<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.k = {1e4, 3e3};
  law.alpha = {0.7, 0.3};
  law.C = 20.0;
  return law;
}

constexpr Input<double> moving(double v) { return {0.0, v, v < 0.0 ? -infinite : infinite}; }

Mode all(Slider slider) { return with_slider(with_slider({}, 0, slider), 1, slider); }

}  // namespace

TEST_CASE("gms: steady sliding is the Stribeck curve", "[friction]") {
  auto law = two_elements();
  law.sigma1 = {5.0, 2.0};
  law.sigma2 = 0.4;
  for (const double v : {1e-5, 1e-3, 0.1, -2e-3}) {
    const double level = std::copysign(law.level(v), v);
    const Mode mode = all(v > 0.0 ? Slider::slips_forward : Slider::slips_backward);
    const std::vector<double> F{0.7 * level, 0.3 * level};
    double dF[2];
    law.rate(moving(v), mode, F, dF);
    CHECK(std::abs(dF[0]) < 1e-14);
    CHECK(std::abs(dF[1]) < 1e-14);
    CHECK(law.output(moving(v), mode, F) == Approx(level + 0.4 * v).epsilon(1e-14));
  }
}

TEST_CASE("gms: an element sticks until alpha g(v), slips until v changes sign", "[friction]") {
  const auto law = two_elements();
  std::vector<double> F{0.7 * 1.2, 0.1}, g(5);
  law.guard(moving(1e-6), {}, F, g);
  CHECK(g[0] > 0.0);
  law.guard(moving(1e-2), {}, F, g);  // g has fallen to Fc: slips at once
  CHECK(g[0] < 0.0);
  CHECK(g[2] > 0.0);
  const Mode slips = law.next(moving(1e-2), {}, F, 0);
  CHECK(slips == with_slider({}, 0, Slider::slips_forward));
  // Stretched forwards while the motion is backwards: slips too, and relaxes to the other side.
  const Mode back = law.next(moving(-1e-2), {}, F, 0);
  CHECK(back == with_slider({}, 0, Slider::slips_backward));
  double dF[2];
  law.rate(moving(-1e-2), back, F, dF);
  CHECK(dF[0] == Approx(20.0 * (-0.7 - 0.84)));
  CHECK(dF[1] == Approx(-30.0));
  law.guard(moving(-1e-9), slips, F, g);
  CHECK(g[4] < 0.0);
  CHECK(law.next(moving(-1e-9), slips, F, 4) == Mode{0});
  // Reversal on the limit itself: rounding must not count as beyond it.
  F[0] = 0.7 * 1.5 * (1.0 + 3e-16);
  law.guard(moving(-1e-30), {}, F, g);
  CHECK(g[0] >= 0.0);
}

TEST_CASE("gms: |F_i| <= alpha_i Fs is invariant", "[friction]") {
  const auto law = two_elements();
  const std::vector<double> top{0.7 * 1.5, 0.3 * 1.5};
  for (const double v : {0.0, 1e-5, 1e-3, 1.0}) {
    double dF[2];
    law.rate(moving(v), all(Slider::slips_forward), top, dF);
    CHECK(dF[0] <= 1e-13);
    CHECK(dF[1] <= 1e-13);
    std::vector<double> g(5);
    law.guard(moving(v), {}, top, g);
    CHECK(g[0] <= 0.0);
  }
}

TEST_CASE("gms: levels that jump at v = 0 do not chatter", "[friction]") {
  auto law = two_elements();
  law.Fs_minus = law.Fc_minus = 0.8;
  std::vector<double> F{0.7, 0.3}, g(5);  // between both levels
  Mode mode = all(Slider::slips_forward);
  int events = 0;
  for (double v = 1e-15; v > -1e-6 && events<50; v -= v> - 1e-14 ? 1e-16 : 1e-9) {
    for (bool quiet = false; !quiet && events < 50;) {
      quiet = true;
      const Input<double> in{0.0, v, -5.0};  // the drive reverses the body
      law.guard(in, mode, F, g);
      for (std::size_t i = 0; i < 5 && quiet; ++i) {
        if (g[i] >= 0.0) continue;
        mode = law.next(in, mode, F, static_cast<int>(i));
        quiet = false;
        ++events;
      }
    }
  }
  CHECK(events == 3);  // the reversal, and each element
  CHECK(mode == all(Slider::slips_backward));
}

TEST_CASE("gms is odd, modes included", "[friction]") {
  auto law = two_elements();
  law.sigma1 = {5.0, 2.0};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const double v = 3e-3 * u(random);
    Mode mode;
    for (int i = 0; i < 2; ++i)
      if (u(random) < 0.0) mode = with_slider(mode, i, v > 0.0 ? Slider::slips_forward : Slider::slips_backward);
    const std::vector<double> F{u(random), u(random)}, minus{-F[0], -F[1]};
    const Mode turned = law.mirror(mode);
    CHECK(law.output(moving(v), mode, F) == -law.output(moving(-v), turned, minus));
    std::vector<double> dF(2), minus_dF(2), g(5), minus_g(5);
    law.rate(moving(v), mode, F, dF);
    law.rate(moving(-v), turned, minus, minus_dF);
    law.guard(moving(v), mode, F, g);
    law.guard(moving(-v), turned, minus, minus_g);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(dF[i] == -minus_dF[i]);
      CHECK(g[2 * i] == minus_g[2 * i + 1]);
    }
    CHECK(g[4] == minus_g[4]);
  }
  law.Fs_minus = 1.6;
  CHECK_FALSE(law.odd());
}

TEST_CASE("gms: broken lists are named", "[friction]") {
  auto law = two_elements();
  CHECK_FALSE(law.validate());
  law.alpha = {0.7, 0.2};
  CHECK(law.validate()->key == "alpha");
  CHECK(law.validate()->rule == "must sum to 1, sums to 0.900000");
  law.alpha = {1.0};
  CHECK(law.validate()->rule == "must have as many entries as k: 2, has 1");
  law = two_elements();
  law.sigma1 = {1.0};
  CHECK(law.validate()->key == "sigma1");
  CHECK(Gms<double>{}.states() == 0);
}
