// The multistate law of Xiong, Kikuuwe and Yamamoto: equations, bounds, energy, rest without drift.
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/friction/sliders/xiong.hpp"

using namespace limcycle;

namespace {

/// Ten elements as in the source thesis (K of some 1e3 N/m, sigma 5 to 27.5 N s/m, lambda 0.0955 to 0.1045).
Xiong<double> ten() {
  Xiong<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.tau = 2e-3;
  for (int i = 0; i < 10; ++i) {
    law.K.push_back(1000.0 + 800.0 * i);
    law.sigma.push_back(5.0 + 2.5 * i);
    law.lambda.push_back(0.0955 + 0.001 * i);
  }
  return law;
}

double sat(double limit, double u) { return std::clamp(u, -limit, limit); }

/// The equations as published, without modes: rates and force.
double plain(const Xiong<double>& law, double v, const std::vector<double>& z, std::vector<double>& dz) {
  const std::size_t n = law.K.size();
  double sum = law.sigma2 * v;
  dz.resize(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double f = sat(law.lambda[i] * z[n], law.K[i] * z[i] + law.sigma[i] * v);
    dz[i] = (f - law.K[i] * z[i]) / law.sigma[i];
    sum += f;
  }
  dz[n] = (law.level(v) - z[n]) / law.tau;
  return sum;
}

/// Mode in which all guards are non-negative, by firing those that are not.
Mode settled(const Xiong<double>& law, double v, std::vector<double>& z, Mode mode) {
  const Input<double> in{0.0, v, 0.0};
  std::vector<double> g;
  for (int k = 0; k < 1000; ++k) {
    g.assign(static_cast<std::size_t>(law.guards(mode)), 0.0);
    law.guard(in, mode, std::span<const double>(z), g);
    const auto fired = std::ranges::find_if(g, [](double value) { return value < 0.0; });
    if (fired == g.end()) return mode;
    mode = law.next(in, mode, z, static_cast<int>(fired - g.begin()));
  }
  FAIL("no mode");
  return mode;
}

}  // namespace

TEST_CASE("xiong: modes and guards give the equations with their caps, and are odd") {
  auto law = ten();
  law.sigma2 = 0.3;
  REQUIRE_FALSE(law.validate());
  CHECK(law.states() == 11);
  CHECK(law.even_state(10));
  CHECK_FALSE(law.even_state(9));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<double> z(11), dz(11), want(11), minus(11), minus_dz(11);
  Mode mode = law.start(Input<double>{}, z);
  CHECK(mode == Mode{});
  CHECK(z[10] == 1.5);
  for (int k = 0; k < 300; ++k) {
    const double v = 0.02 * u(random);
    for (std::size_t i = 0; i < 10; ++i) z[i] = 2e-4 * u(random);
    z[10] = 1.25 + 0.25 * u(random);
    mode = settled(law, v, z, mode);
    const Input<double> in{0.0, v, 0.0}, back{0.0, -v, 0.0};
    const double F = plain(law, v, z, want);
    CHECK(law.output(in, mode, z) == Approx(F));
    CHECK(std::abs(law.output(in, mode, z) - 0.3 * v) <= z[10] * (1.0 + 1e-12));
    law.rate(in, mode, z, dz);
    for (std::size_t i = 0; i < 11; ++i) CHECK(dz[i] == Approx(want[i]).epsilon(1e-10).margin(1e-15));
    for (std::size_t i = 0; i < 11; ++i) minus[i] = law.even_state(static_cast<int>(i)) ? z[i] : -z[i];
    CHECK(law.output(back, law.mirror(mode), minus) == Approx(-F));
    CHECK(law.mirror(law.mirror(mode)) == mode);
    law.rate(back, law.mirror(mode), minus, minus_dz);
    for (std::size_t i = 0; i < 11; ++i) CHECK(minus_dz[i] == Approx(i == 10 ? dz[i] : -dz[i]));
  }
  // A start at speed: elements with dampers only may be at their caps.
  mode = law.start(Input<double>{0.0, -5.0, 0.0}, z);
  CHECK(settled(law, -5.0, z, mode) == mode);
}

TEST_CASE("xiong: steady sliding is the Stribeck curve, a slow cycle below Fs does not drift") {
  const auto law = ten();
  std::vector<double> z(11), dz;
  law.start(Input<double>{}, z);
  const auto slide = [&](double v, double duration) {
    const double h = 2e-5;
    double F = 0.0;
    for (int k = 0; k < static_cast<int>(duration / h); ++k) {
      F = plain(law, v, z, dz);
      for (std::size_t i = 0; i < 11; ++i) z[i] += h * dz[i];
    }
    return F;
  };
  for (const double v : {0.01, 5e-4, -2e-3}) {
    const double F = slide(v, 1.0);
    CHECK(F == Approx((v < 0.0 ? -1.0 : 1.0) * law.level(v)).epsilon(1e-9));
    // According to the modes every element slips here.
    const Mode mode = settled(law, v, z, {});
    CHECK(law.output(Input<double>{0.0, v, 0.0}, mode, z) == Approx(F));
    CHECK(law.guards(mode) == 10);
  }
  // Back and forth within the smallest yield displacement, from any deflections: every a_i returns to its value.
  law.start(Input<double>{}, z);
  const std::vector<double> before = z;
  slide(1e-5, 0.5);
  slide(-1e-5, 0.5);
  for (std::size_t i = 0; i < 10; ++i) CHECK(std::abs(z[i] - before[i]) < 1e-19);
}

TEST_CASE("xiong: passive for any motion") {
  const auto law = ten();
  std::mt19937 random(13);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> z(11), dz;
  law.start(Input<double>{}, z);
  double v = 0.0, work = 0.0, worst = 0.0, size = 0.0;
  const double h = 1e-5;
  const auto stored = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < 10; ++i) sum += 0.5 * law.K[i] * z[i] * z[i];
    return sum;
  };
  for (int k = 0; k < 40000; ++k) {
    v += -v * h / 0.02 + 2e-4 * noise(random);
    const double F = plain(law, v, z, dz), kept = stored();
    for (std::size_t i = 0; i < 11; ++i) z[i] += h * dz[i];
    work += h * F * v;
    worst = std::min(worst, h * F * v - (stored() - kept));
    size = std::max(size, std::abs(h * F * v));
  }
  CHECK(work > 0.0);
  CHECK(worst > -0.02 * size);  // energy error of Euler's steps, of order h
}

TEST_CASE("xiong: what is wrong with its lists is said") {
  auto law = ten();
  law.lambda[0] += 2e-6;
  REQUIRE(law.validate());
  CHECK(law.validate()->key == "lambda");
  law = ten();
  law.sigma.pop_back();
  CHECK(law.validate()->key == "sigma");
  law = ten();
  law.K[3] = 0.0;
  CHECK(law.validate()->key == "K");
  law.K.clear();
  CHECK(law.validate()->key == "K");
  law = ten();
  law.K.assign(32, 1.0);
  CHECK(law.validate()->rule.find("31") != std::string::npos);
  CHECK(Xiong<double>{}.states() == 1);
}
