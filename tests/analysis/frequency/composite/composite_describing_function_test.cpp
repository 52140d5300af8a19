#include "limcycle/analysis/frequency/composite/composite_describing_function.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

CompositeOptions to(double accuracy, int harmonics = 1) {
  CompositeOptions options;
  options.accuracy = accuracy;
  options.harmonics = harmonics;
  return options;
}

/// x1/u1 of the forced pair by the general march from rest, after many periods: position is a state there, and its
/// harmonics are sums over uniform samples.
Complex by_simulation(const Element& law, double mass, double U, double w, int settle) {
  LoopParts parts;
  parts.plant = Mass{mass, 0.0, 0.0};
  parts.friction = law;
  const Loop loop = build_loop(parts);
  LoopField field(loop);
  field.set_external([=](double t, External& value, External& rate) {
    value << 1.0, 0.0, 0.0, U * std::sin(w * t);
    rate << 0.0, 0.0, 0.0, U * w * std::cos(w * t);
  });
  State x(field.size(), 0.0);
  field.start(x, 0.0);
  ErrorWeights weights = loop_weights(loop, 1e-9);
  March march(field, StepperKind::rodas5p, weights);
  march.begin(x, 0.0);
  const double T = 2.0 * pi / w;
  const int samples = 4000;
  march.limit_step(T / 100);
  while (march.t() < settle * T) REQUIRE(march.step(settle * T) == Status::converged);
  Complex sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double t = settle * T + i * T / samples;
    while (march.t() < t) REQUIRE(march.step(t) == Status::converged);
    sum += march.x()[0] * Complex(std::sin(w * t), std::cos(w * t));
  }
  return 2.0 / samples * sum / U;
}

}  // namespace

TEST_CASE("composite describing function: the mass alone where friction is negligible") {
  CompositeDescribingFunction N(test::coulomb(1e-9, 1e-9), 2.5);
  const auto r = N({3.0, 7.0}, to(1e-8));
  REQUIRE(r.status == Status::converged);
  CHECK(r.gain.real() == Approx(-1.0 / (2.5 * 49.0)).epsilon(1e-7));
  CHECK(std::abs(r.gain.imag()) < 1e-7 * std::abs(r.gain));
}

TEST_CASE("composite describing function: a viscous law in closed form") {
  // Dry part made negligible: x1/u1 = 1/(-m w^2 + j sigma2 w).
  CompositeDescribingFunction N(test::coulomb(1e-10, 1e-10, 3.0), 0.5);
  for (const double w : {0.2, 2.0, 40.0}) {
    const auto r = N({2.0, w}, to(1e-8));
    INFO("w = " << w);
    REQUIRE(r.status == Status::converged);
    const Complex exact = 1.0 / Complex(-0.5 * w * w, 3.0 * w);
    CHECK(std::abs(r.gain - exact) < 1e-7 * std::abs(exact));
  }
}

TEST_CASE("composite describing function: stuck for ever below break-away") {
  CompositeDescribingFunction N(test::coulomb(1.5, 1.0), 1.0);
  const auto r = N({1.499999, 0.3});
  CHECK(r.status == Status::converged);
  CHECK(r.gain == Complex(0.0, 0.0));
  CHECK(r.sticking_fraction == Approx(1.0));
  CHECK(N.break_away(0.3, 1e-12) == Approx(1.5).epsilon(1e-11));
  CHECK(std::abs(N({1.500001, 0.3}, to(1e-3)).gain) > 0.5);
}

TEST_CASE("composite describing function: bristles far below break-away are a spring and a damper") {
  const auto law = test::lugre();
  CompositeDescribingFunction N(law, 1.0);
  for (const double w : {1.0, 30.0, 300.0, 1000.0}) {
    const auto r = N({1e-6, w}, to(1e-7));
    INFO("w = " << w);
    REQUIRE(r.status == Status::converged);
    const Complex exact = 1.0 / Complex(law.sigma0 - w * w, (law.sigma1 + law.sigma2) * w);
    CHECK(std::abs(r.gain - exact) < 3e-6 * std::abs(exact));  // the bristles yield by U/Fs
  }
}

TEST_CASE("composite describing function: Coulomb friction that is passed without stopping") {
  // Den Hartog (1931) without a spring: v = 0 at phase a with cos a = pi Fc/(2 U), force Fc sgn v. The first harmonic
  // of the square wave gives x1 exactly: -m w^2 x1 = U - F1, F1 = (4 Fc/pi) in phase with v, whose zero is at the phase
  // a.
  const double U = 4.0, Fc = 1.0, w = 3.0, m = 1.3;
  CompositeDescribingFunction N(test::coulomb(Fc, Fc), m);
  const auto r = N({U, w}, to(1e-9, 5));
  REQUIRE(r.status == Status::converged);
  CHECK(r.sticking_fraction == 0.0);
  // v goes from negative to positive at phase a: m w v = -U cos - Fc (phase - a) + const, zero mean of v over the half
  // period from a to a + pi fixes cos a.
  const double a = std::acos(pi * Fc / (2.0 * U));
  const Complex F1 = 4.0 * Fc / pi * Complex(std::cos(a), -std::sin(a));
  const Complex x1 = -(U - F1) / (m * w * w);
  CHECK(std::abs(r.harmonics[0] - x1) < 1e-8 * std::abs(x1));
  const Complex F3 = 4.0 * Fc / (3.0 * pi) * Complex(std::cos(3.0 * a), -std::sin(3.0 * a));
  CHECK(std::abs(r.harmonics[2] - F3 / (9.0 * m * w * w)) < 1e-8 * std::abs(x1));
  CHECK(std::abs(r.harmonics[1]) == 0.0);
  // Work per period: 2 Fc times twice the peak-to-peak travel / 2, and pi U x1 sin(lag) from outside.
  CHECK(r.dissipation == Approx(-pi * U * r.harmonics[0].imag()).epsilon(1e-8));
}

TEST_CASE("composite describing function: one slip from break-away to stop in closed form") {
  // Fs > Fc at U = 1.6: release at sin p = Fs/U, stop where U (cos p - cos q) = Fc (q - p).
  const double U = 1.6, Fs = 1.5, Fc = 1.0, w = 0.7;
  CompositeDescribingFunction N(test::coulomb(Fs, Fc), 1.0);
  const auto r = N({U, w}, to(1e-8));
  REQUIRE(r.status == Status::converged);
  const double p = std::asin(Fs / U);
  double low = p + 0.5, high = p + pi;
  for (int i = 0; i < 200; ++i) {
    const double q = 0.5 * (low + high);
    (U * (std::cos(p) - std::cos(q)) - Fc * (q - p) > 0.0 ? low : high) = q;
  }
  CHECK(r.sticking_fraction == Approx(1.0 - (low - p) / pi).epsilon(1e-8));
  // First harmonic of v by the midpoint rule over the slip, twice for its mirror image.
  Complex sum = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double phase = p + (low - p) * (i + 0.5) / n;
    const double v = (U * (std::cos(p) - std::cos(phase)) - Fc * (phase - p)) / w;
    sum += v * Complex(std::cos(phase), -std::sin(phase)) * (low - p) / double(n);
  }
  const Complex x1 = 2.0 / (pi * w) * sum;
  CHECK(std::abs(r.gain * U - x1) < 1e-7 * std::abs(x1));
}

TEST_CASE("composite describing function: a slip with viscous friction by small steps of Runge and Kutta") {
  const double U = 1.8, Fs = 1.5, Fc = 1.0, sigma2 = 0.4, w = 1.0;
  CompositeDescribingFunction N(test::coulomb(Fs, Fc, sigma2), 1.0);
  const auto r = N({U, w}, to(1e-7));
  REQUIRE(r.status == Status::converged);
  const auto a = [&](double t, double v) { return U * std::sin(t) - Fc - sigma2 * v; };
  const auto g = [](double t, double v) { return v * Complex(std::cos(t), -std::sin(t)); };
  const double h = 1e-4;
  double t = std::asin(Fs / U), v = 0.0;
  Complex sum = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double k1 = a(t, v), k2 = a(t + h / 2, v + h / 2 * k1), k3 = a(t + h / 2, v + h / 2 * k2),
                 k4 = a(t + h, v + h * k3), next = v + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (next < 0.0) break;
    sum += h / 6 * (g(t, v) + 4.0 * g(t + h / 2, v + h / 24 * (5 * k1 + 4 * k2 + 4 * k3 - k4)) + g(t + h, next));
    t += h;
    v = next;
  }
  const Complex exact = 2.0 / (pi * w * U) * sum;  // the remainder of the last step is of order h^2
  CHECK(std::abs(r.gain - exact) < 1e-7 * std::abs(exact));
}

TEST_CASE("composite describing function: what goes in is dissipated") {
  const std::vector<Element> laws{test::lugre(), test::coulomb(1.5, 1.0, 0.4), test::stribeck(1.5, 1.0, 0.01)};
  for (const auto& law : laws)
    for (const double U : {1.2, 1.7, 6.0})
      for (const double w : {0.5, 20.0}) {
        CompositeDescribingFunction N(law, 1.0);
        const auto r = N({U, w}, to(1e-7));
        INFO("law " << law.kind() << ", U = " << U << ", w = " << w);
        REQUIRE((r.status == Status::converged || r.status == Status::incomplete));
        const double put_in = -pi * U * U * r.gain.imag();
        CHECK(std::abs(r.dissipation - put_in) <= 1e-5 * std::abs(put_in) + 1e-300);
      }
}

TEST_CASE("composite describing function: the general marcher reaches the same steady state") {
  struct Point {
    Element law;
    double U, w;
    int settle;
  };
  const std::vector<Point> points{
      {test::lugre(), 1.6, 2.0, 4}, {test::lugre(), 1.2, 10.0, 6}, {test::stribeck(1.5, 1.0, 0.05), 1.7, 1.0, 4}};
  for (const auto& point : points) {
    INFO("law " << point.law.kind() << ", U = " << point.U);
    CompositeDescribingFunction N(point.law, 1.0);
    const auto r = N({point.U, point.w}, to(1e-6));
    REQUIRE((r.status == Status::converged || r.status == Status::incomplete));
    const Complex other = by_simulation(point.law, 1.0, point.U, point.w, point.settle);
    CHECK(std::abs(r.gain - other) < 1e-5 * std::abs(other));
  }
}

TEST_CASE("composite describing function: the error falls with the accuracy asked for, and is not underestimated") {
  for (const double w : {0.8, 20.0}) {
    CompositeDescribingFunction N(test::lugre(), 1.0);
    const Complex exact = N({1.7, w}, to(1e-10)).gain;
    double last = 1.0;
    for (const double accuracy : {1e-3, 1e-5, 1e-7}) {
      const auto r = N({1.7, w}, to(accuracy));
      const double error = std::abs(r.gain - exact) / std::abs(exact);
      INFO("w = " << w << ", accuracy " << accuracy << ", error " << error << ", estimate " << r.error);
      CHECK(error <= r.error + 1e-10);
      CHECK(error <= accuracy);
      CHECK(error < last);
      last = error;
    }
  }
}

TEST_CASE("composite describing function: order of the integrator on a smooth motion") {
  // Viscous law: no kink, no switch. The tolerance controls steps of order 5: the error is proportional to the 5th
  // power of the step, so steps grow by 10^(1/5) a decade.
  CompositeDescribingFunction N(test::coulomb(1e-12, 1e-12, 1.0), 1.0);
  CompositeOptions options = to(1e-6);
  options.estimate_error = false;
  const auto coarse = N({1.0, 1.0}, options);
  options.accuracy = 1e-10;
  const auto fine = N({1.0, 1.0}, options);
  const double per_decade = std::log10(double(fine.steps) / fine.maps / (double(coarse.steps) / coarse.maps)) / 4.0;
  CHECK(per_decade == Approx(0.2).margin(0.06));
}

TEST_CASE("composite describing function: sliding on a belt without stick has the closed form of a free mass") {
  // Coulomb friction of constant sign: bias -Fc, N = -1/(m w^2).
  CompositeDescribingFunction N(test::coulomb(1.5, 1.0), 1.0);
  const auto r = N({0.1, 2.0, -0.1}, to(1e-8));
  REQUIRE(r.status == Status::converged);
  CHECK(r.bias == Approx(-1.0).epsilon(1e-8));
  CHECK(r.mean_velocity == Approx(-0.1).epsilon(1e-6));
  CHECK(std::abs(r.gain + 0.25) < 1e-7);
}

TEST_CASE("composite describing function: on a belt the power of bias and force together is dissipated") {
  for (const auto& law : std::vector<Element>{test::lugre(), test::coulomb(1.5, 1.0)}) {
    CompositeDescribingFunction N(law, 1.0);
    const double w = 3.0, V = -0.1, U = 0.9;
    const auto r = N({U, w, V}, to(1e-6));
    INFO("law " << law.kind());
    REQUIRE((r.status == Status::converged || r.status == Status::incomplete));
    CHECK(r.mean_velocity == Approx(V).epsilon(1e-4));
    const double put_in = -pi * U * U * r.gain.imag() + r.bias * r.mean_velocity * 2.0 * pi / w;
    CHECK(r.dissipation == Approx(put_in).epsilon(1e-4));
    CHECK(r.sticking_fraction > 0.0);
  }
}

TEST_CASE("composite describing function: break-away under a bias") {
  CompositeDescribingFunction N(test::coulomb(1.5, 1.0), 1.0);
  CHECK(N.break_away_bias(0.5, 1.0, +1.0, 1e-10) == Approx(1.0).epsilon(1e-8));
  CHECK(N.break_away_bias(0.5, 1.0, -1.0, 1e-10) == Approx(-1.0).epsilon(1e-8));
}

TEST_CASE("composite describing function: bad input is refused by name") {
  CHECK_THROWS_WITH(CompositeDescribingFunction(test::relay(1.0), 1.0), Catch::Contains("relay"));
  CHECK_THROWS_WITH(CompositeDescribingFunction(test::lugre(), 0.0), Catch::Contains("mass = 0"));
  CompositeDescribingFunction N(test::lugre(), 1.0);
  CHECK_THROWS_WITH(N({-1.0, 1.0}), Catch::Contains("force = -1"));
  CHECK_THROWS_WITH(N({1.0, 0.0}), Catch::Contains("frequency = 0"));
  CHECK_THROWS_WITH(N({1.0, 1.0}, to(0.5)), Catch::Contains("accuracy = 0.5"));
  CHECK_THROWS_WITH(N({1.0, 1.0}, to(1e-6, 0)), Catch::Contains("harmonics = 0"));
}
