#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/orbit/settle/load_step.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Eigen::VectorXd states(const Loop& loop, const LoopState& start) {
  return Eigen::Map<const Eigen::VectorXd>(start.x.data(), loop.states());
}

/// Two masses of 1 and 3 kg with a shaft of 4000 N/m, as a state space in the coordinates T x.
Loop drive(const Eigen::MatrixXd& T) {
  StateSpacePlant plant;
  const Eigen::MatrixXd back = T.inverse();
  plant.A =
      T *
      Eigen::MatrixXd{{0, 1, 0, 0}, {-4000, -1, 4000, 1}, {0, 0, 0, 1}, {4000.0 / 3, 1.0 / 3, -4000.0 / 3, -1.0 / 3}} *
      back;
  plant.B = T * Eigen::MatrixXd{{0}, {1}, {0}, {0}};
  plant.C = Eigen::MatrixXd{{1, 0, 0, 0}} * back;
  LoopParts parts;
  parts.plant = plant;
  parts.controller = pid(30.0, 20.0, 30.0);
  parts.friction = coulomb(1.5, 1.0);
  return build_loop(parts);
}

}  // namespace

TEST_CASE("displaced: two masses move as one, in any coordinates") {
  TwoMass plant;
  plant.motor_mass = 1.0;
  plant.load_mass = 3.0;
  plant.stiffness = 4000.0;
  plant.damping = 1.0;
  plant.measured = Choice{0};  // the motor
  LoopParts parts;
  parts.plant = plant;
  parts.controller = pid(30.0, 20.0, 30.0);
  parts.friction = coulomb(1.5, 1.0);
  const Loop loop = build_loop(parts);
  const Eigen::VectorXd x = states(loop, displaced(loop, 0.2));
  CHECK((loop.C_y * x).value() == Approx(0.2).epsilon(1e-14));
  // Rates are those of the controller alone, as for one mass of 4 kg: y'' = -kp 0.2/m at once, the shaft is not
  // stretched.
  const Eigen::VectorXd rates = loop.A * x;
  CHECK((loop.C_y * rates).value() == Approx(0.0).margin(1e-9));
  CHECK((loop.C_y * (loop.A * rates)).value() == Approx(-30.0 * 0.2).epsilon(1e-6));

  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5; ++i) {
    Eigen::MatrixXd T(4, 4);
    for (double& entry : T.reshaped()) entry = normal(random);
    const Loop other = drive(T);
    const Eigen::VectorXd z = states(other, displaced(other, 0.2));
    // y and its derivatives by the linear part.
    Eigen::VectorXd one = x, two = z;
    double size = 0.2;
    for (int k = 0; k < 5; ++k, size *= 73.0) {
      CHECK((loop.C_y * one).value() == Approx((other.C_y * two).value()).margin(1e-6 * size));
      one = loop.A * one;
      two = other.A * two;
    }
  }
}

TEST_CASE("displaced: a spring on the plant is held by the integrator, as at another set-point") {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.plant = Mass{1.0, 0.0, 8.0};
  const Loop loop = build_loop(parts);
  const Eigen::VectorXd x = states(loop, displaced(loop, 0.1));
  LoopParts moved = parts;
  moved.reference = 0.1;
  const Loop there = build_loop(moved);
  CHECK((x - there.origin).norm() == Approx(0.0).margin(1e-8));
  CHECK(x.cwiseAbs().maxCoeff() == Approx(8.0 * 0.1 / 4.0).epsilon(1e-8));  // k y / ki
}

TEST_CASE("displaced: a free mass moves without a velocity") {
  LoopParts parts;
  parts.plant = Mass{2.0, 0.0, 0.0};
  parts.friction = coulomb(1.5, 1.0);
  const Loop loop = build_loop(parts);
  const Eigen::VectorXd x = states(loop, displaced(loop, 0.3));
  CHECK((loop.C_y * x).value() == 0.3);
  CHECK((loop.C_y * loop.A * x).value() == 0.0);
}

TEST_CASE("load_step: the integrator is wound up by the load that let go") {
  const Loop loop = servo(coulomb(1.5, 1.0));
  const auto step = load_step(loop);
  REQUIRE(step);
  CHECK(step->load >= 1.5);
  const Eigen::VectorXd x = states(loop, step->start);
  CHECK((loop.C_y * x).value() == Approx(0.0).margin(1e-12));
  // The command that balanced the load accelerates the mass of 1 kg now.
  const Eigen::VectorXd rates = loop.A * x;
  CHECK((loop.C_y * rates).value() == Approx(0.0).margin(1e-12));
  CHECK((loop.C_y * (loop.A * rates)).value() == Approx(-step->load).epsilon(1e-12));
}

TEST_CASE("load_step: none where nothing holds the load, or where it only displaces") {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(3.0, 0.0, 6.0);
  CHECK_FALSE(load_step(build_loop(parts)));  // y = load/kp
  CHECK_FALSE(load_step(belt(coulomb(1.5, 1.0))));
  CHECK_FALSE(load_step(forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0})));
  LoopParts free;
  free.plant = Mass{2.0, 0.0, 0.0};
  free.friction = coulomb(1.5, 1.0);
  CHECK_FALSE(load_step(build_loop(free)));
}

TEST_CASE("load_step: a limited command holds what is within its limit") {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 10.0;
  parts.controller = controller;
  const auto within = load_step(build_loop(parts));
  REQUIRE(within);
  CHECK(within->load < 10.0);
  controller.saturation = 0.5;
  parts.controller = controller;
  CHECK_FALSE(load_step(build_loop(parts)));
}

TEST_CASE("load_step: a held body is held in coordinates that mix its position and its velocity") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10; ++i) {
    Eigen::MatrixXd T(4, 4);
    for (double& entry : T.reshaped()) entry = normal(random);
    const Loop loop = drive(T);
    const auto step = load_step(loop);
    REQUIRE(step);
    const Eigen::VectorXd x = states(loop, step->start);
    CHECK((loop.C_y * x).value() == Approx(0.0).margin(1e-9));
    CHECK((loop.C_y * (loop.A * (loop.A * x))).value() == Approx(-step->load).epsilon(1e-6));  // of 1 kg
  }
}
