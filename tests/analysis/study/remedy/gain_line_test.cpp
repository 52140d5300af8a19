#include "limcycle/analysis/study/remedy/gain_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using Keeps = GainLine::Keeps;

namespace {

LoopParts servo_of(double mass, double kp, double ki, double kd) {
  LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
  parts.plant = Mass{mass, 0.0, 0.0};
  parts.controller = test::pid(kp, ki, kd);
  return parts;
}

}  // namespace

TEST_CASE("gain line: of a mass under PID control, in closed form") {
  // With C = kp + j (kd w - ki/w) and P = -1/(m w^2): |C| = m wc^2, or C = m w^2 exp(j phi).
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < test::samples(60); ++i) {
    const double mass = std::pow(10.0, 2.0 * u(random)), kp = std::pow(10.0, 1.0 + 2.0 * u(random));
    const double kd = std::sqrt(kp * mass) * std::pow(10.0, 0.2 + 0.5 * u(random));
    const double ki = 0.3 * (1.0 + u(random)) * kp * kd / mass;
    const LoopParts parts = servo_of(mass, kp, ki, kd);
    CAPTURE(mass, kp, ki, kd);
    const double wc = highest_crossover(parts).value();
    CHECK(std::hypot(kp, kd * wc - ki / wc) == Approx(mass * wc * wc).epsilon(1e-9));
    const auto bandwidth = GainLine::of(parts, Keeps::bandwidth), margin = GainLine::of(parts, Keeps::phase_margin);
    REQUIRE(bandwidth);
    REQUIRE(margin);
    const double phi = std::atan2(kd * wc - ki / wc, kp);
    CHECK(margin->phase_margin() == Approx(phi).epsilon(1e-9));
    for (const double factor : {0.5, 1.0, 1.3, 4.0, 30.0}) {
      const double other = factor * kp, level = mass * wc * wc;
      const double w = std::sqrt(other / (mass * std::cos(phi)));
      CAPTURE(factor);
      CHECK(margin->kd(other).value() == Approx((mass * w * w * std::sin(phi) + ki / w) / w).epsilon(1e-8));
      const auto kept = bandwidth->kd(other);
      if (other > level) CHECK_FALSE(kept);
      if (other < level && kd * wc > ki / wc)
        CHECK(kept.value() == Approx((std::sqrt(level * level - other * other) + ki / wc) / wc).epsilon(1e-8));
    }
  }
}

TEST_CASE("gain line: with a filter, a lag and a dead time it keeps what it says") {
  LoopParts parts = servo_of(1.0, 30.0, 20.0, 12.0);
  auto& controller = std::get<Pid>(parts.controller);
  controller.tf = 0.01;
  controller.lag = 0.005;
  const double wc = highest_crossover(parts).value();
  const auto costs_with = [&](double kp, double kd) {
    LoopParts other = parts;
    std::get<Pid>(other.controller).kp = kp;
    std::get<Pid>(other.controller).kd = kd;
    return other;
  };
  const auto bandwidth = GainLine::of(parts, Keeps::bandwidth), margin = GainLine::of(parts, Keeps::phase_margin);
  REQUIRE(bandwidth);
  REQUIRE(margin);
  for (const double kp : {15.0, 20.0, 33.0}) {
    CHECK(highest_crossover(costs_with(kp, bandwidth->kd(kp).value())).value() == Approx(wc).epsilon(1e-6));
    const LoopParts other = costs_with(kp, margin->kd(kp).value());
    std::string why;
    const auto open = open_loop(other, why);
    const double at = highest_crossover(other).value();
    CHECK(std::arg(-open->L(std::complex<double>(0.0, at))) == Approx(margin->phase_margin()).epsilon(1e-6));
  }
}

TEST_CASE("gain line: loops that have none") {
  CHECK_FALSE(GainLine::of(servo_of(1.0, 3.0, 4.0, 0.0), Keeps::bandwidth));
  CHECK_FALSE(GainLine::of(servo_of(1.0, 0.0, 4.0, 6.0), Keeps::phase_margin));
  LoopParts none = servo_of(1.0, 3.0, 4.0, 6.0);
  none.controller = NoController{};
  CHECK_FALSE(GainLine::of(none, Keeps::bandwidth));
}
