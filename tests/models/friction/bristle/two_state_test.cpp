// The two-state law: pre-sliding, sliding, and the transitions between them.
#include "limcycle/models/friction/bristle/two_state.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/tests/law_march.hpp"

using namespace limcycle;

namespace {

TwoState<double> law_of(double tau = 2e-3) {
  TwoState<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.s = 1e-4;
  law.tau = tau;
  return law;
}

using TwoStateMarch = test::LawMarch<TwoState<double>>;
const test::MarchSteps two_state_steps{.displacement = 2e-6, .velocity = 1e-3, .time = 2e-4};
double phi(double xi) { return xi * (1.0 - std::log(xi)); }

}  // namespace

TEST_CASE("pre-sliding between return points, at the levels of each direction", "[two-state]") {
  TwoState<double> law = law_of();
  law.Fs_minus = 1.2;
  law.Fc_minus = 0.8;
  TwoStateMarch march(law, two_state_steps);
  march.glide(4e-5, 1.0);
  const double up = 1.5 * phi(0.4);
  CHECK(march.force() == Approx(up).epsilon(1e-9));
  march.glide(-2e-5, 1.0);
  const double down = up - (up + 1.2) * phi(6e-5 / 1.4e-4);
  CHECK(march.force() == Approx(down).epsilon(1e-9));
  march.glide(1e-5, 1.0);
  CHECK(march.force() == Approx(down + (up - down) * phi(0.5)).epsilon(1e-9));
  march.glide(4e-5, 1.0);  // closes at the first return point
  CHECK(march.force() == Approx(up).epsilon(1e-9));
  march.glide(7e-5, 1.0);
  CHECK(march.force() == Approx(1.5 * phi(0.7)).epsilon(1e-9));
}

TEST_CASE("sliding begins at Fs, lags to the Stribeck level and hands its force to the next branch", "[two-state]") {
  TwoStateMarch march(law_of(), two_state_steps);
  march.slide(1e-4 + 2e-5, 1.2e-2);  // v = 0.01: break-away after 10 ms, then 2 ms of lag
  const double g = 1.0 + 0.5 * std::exp(-100.0);
  const double level = g + (1.5 - g) * std::exp(-1.0);
  CHECK(march.force() == Approx(level).epsilon(1e-6));
  march.slide(1e-4, 1e-2);
  const double part = 2e-5 / 2e-4;
  CHECK(march.force() == Approx(level - (level + 1.5) * phi(part)).epsilon(1e-6));
  march.slide(1.2e-4 + 1e-6, 2.1e-3);  // closed: sliding continues from its last level
  CHECK(march.force() == Approx(g + (level - g) * std::exp(-0.05)).epsilon(1e-6));
  march.slide(-1e-3, 1.0);  // broken away on the other side
  CHECK(march.force() == Approx(-law_of().level(1.121e-3)).epsilon(1e-6));
}

TEST_CASE("steady sliding, bounds, oddness", "[two-state]") {
  for (const double tau : {0.0, 2e-3}) {
    for (const double speed : {3e-4, 2e-3, 0.1}) {
      TwoState<double> law = law_of(tau);
      law.sigma2 = 0.4;
      TwoStateMarch march(law, {.displacement = 1e-4, .time = 1e-3});
      march.slide(-speed, 1.0);
      CHECK(march.force() == Approx(-law.level(speed) - 0.4 * speed).epsilon(1e-9));
    }
    TwoStateMarch there(law_of(tau), two_state_steps), back(law_of(tau), two_state_steps);
    double most = 0.0;
    there.watch = [&](const Input<double>& in, Mode mode, const std::vector<double>& z) {
      most = std::max(most, std::abs(there.law().output(in, mode, z)));
    };
    std::mt19937 random(2);
    for (int i = 0; i < 40; ++i) {
      const double to = std::normal_distribution<double>(0.0, i % 3 == 2 ? 4e-4 : 6e-5)(random);
      there.glide(to, 0.1);
      back.glide(-to, 0.1);
      INFO("stroke " << i);
      CHECK(back.force() == -there.force());
      CHECK(there.law().mirror(there.mode()) == back.mode());
    }
    CHECK(most <= 1.5 * (1.0 + 1e-12));
    CHECK(most > 1.4);
  }
}

TEST_CASE("closed pre-sliding loops dissipate and leave no trace", "[two-state]") {
  TwoStateMarch march(law_of(), two_state_steps);
  march.glide(6e-5, 0.1);
  march.glide(-3e-5, 0.1);
  const double force = march.force();
  for (int i = 0; i < 20; ++i) {
    const double before = march.work();
    march.glide(2e-5, 0.1);
    march.glide(-3e-5, 0.1);
    REQUIRE(march.force() == Approx(force).margin(1e-9));
    REQUIRE(march.work() > before + 1e-7);
    REQUIRE(ReturnMode::of(march.mode()).depth <= 3);
  }
}
