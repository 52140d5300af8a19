#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/tests/gantry.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

/// A loop is measured from its rest point: the same equations, with digits left for a small motion far away.

namespace {

std::vector<LoopParts> far_away() {
  std::vector<LoopParts> all;
  auto servo = servo_parts(lugre());
  servo.reference = 7.0;
  servo.load = -2.5;
  all.push_back(servo);
  auto controller = pid(3.0, 4.0, 6.0);
  controller.tf = 0.01;
  servo.controller = controller;
  servo.reference_rate = 0.02;
  all.push_back(servo);
  controller.saturation = 8.0;
  servo.controller = controller;
  all.push_back(servo);
  TwoMass drive;
  drive.motor_mass = 1.3;
  drive.load_mass = 0.7;
  drive.stiffness = 40.0;
  drive.damping = 0.3;
  servo.plant = drive;
  servo.controller = pid(3.0, 4.0, 6.0);
  all.push_back(servo);
  DeadZone<double> zone;
  zone.half_width = 0.1;
  servo.error = zone;
  servo.controller = pid(3.0, 4.0, 0.0);
  all.push_back(servo);
  all.push_back(parts_of(froude_pendulum(1.0)));
  all.back().load = 0.4;
  return all;
}

Eigen::VectorXd some(Eigen::Index n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

}  // namespace

TEST_CASE("origin: a loop measured from its rest point obeys the equations of the loop") {
  std::mt19937_64 random(3);
  int measured = 0;
  for (const LoopParts& parts : far_away()) {
    const Loop raw = assemble(parts), loop = build_loop(parts);
    CAPTURE(loop.state_names);
    measured += loop.origin.size() > 0;
    const double t = 1.7;
    External outside = raw.external;
    outside(reference_value) += parts.reference_rate * t;
    outside(reference_slope) = parts.reference_rate;
    const auto n = loop.states();
    const Eigen::VectorXd X = some(n, random), w = some(std::ssize(loop.elements), random);
    const Eigen::VectorXd moving = loop.origin_rate.size() > 0 ? loop.origin_rate : Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd own = in_the_case(loop, X) + moving * t;
    const Eigen::VectorXd rate = loop.A * X + loop.B * w + loop.E * loop.external + moving;
    CHECK((raw.A * own + raw.B * w + raw.E * outside - rate).norm() < 1e-12 * (raw.A * own).norm());
    const double y = loop.output_origin + loop.ramp_output_rate * t + (loop.C_y * X).value();
    CHECK((raw.C_y * own).value() == Approx(y).epsilon(1e-12));
    for (std::size_t i = 0; i < loop.ports.size(); ++i) {
      const Port &a = raw.ports[i], &b = loop.ports[i];
      CHECK((a.C_v * own + a.c_v * outside).value() ==
            Approx((b.C_v * X + b.c_v * loop.external).value()).margin(1e-12));
      const double moved = b.rubs ? (b.C * moving).value() * t : 0.0;  // a rubbing displacement moves along with a ramp
      CHECK((a.C * own + a.c * outside).value() ==
            Approx((b.C * X + b.c * loop.external).value() + moved).margin(1e-11));
    }
  }
  CHECK(measured >= 5);
}

TEST_CASE("origin: what rubs at rest stands still, whatever the place and the load") {
  for (const double reference : {0.3, 10.0, -1e6})
    for (const double load : {0.0, 1e5}) {
      const Loop loop = gantry(0.7, reference, load), home = gantry(0.7);
      REQUIRE(loop.origin.size() > 0);
      CHECK(loop.output_origin == Approx(reference).epsilon(1e-15));
      const Port& port = loop.ports.back();
      CHECK(port.rubs);
      CHECK((port.c_v * loop.external).value() == 0.0);
      CHECK((loop.E * loop.external).isZero(0.0));
      CHECK(loop.A == home.A);
      CHECK(loop.B == home.B);
    }
}

TEST_CASE("origin: a loop that rests at zero is left as it is") {
  const Loop loop = build_loop(servo_parts(lugre()));
  CHECK(loop.origin.size() == 0);
  CHECK(loop.output_origin == 0.0);
}

TEST_CASE("origin: a relay that holds a body on a soft spring is not left for where the spring alone would hold it") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.3, 1e-9};
  parts.element = relay(2.0, 0.01);
  auto controller = pid(1.0, 0.0, 1.0);
  controller.tf = 0.1;
  parts.controller = controller;
  parts.load = 1.0;
  const Loop loop = build_loop(parts);
  CHECK(loop.origin.size() == 0);
  CHECK(loop.external(external_force) == 1.0);
}
