#include "limcycle/models/linear/rubbing.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Eigen::MatrixXd;

namespace {

/// A mass with damping, seen through a sensor with a lag of 0.5 s; states y, v, measured y. Friction is on the mass.
StateSpacePlant behind_a_sensor() {
  StateSpacePlant plant;
  plant.A.resize(3, 3);
  plant.A << 0.0, 1.0, 0.0, 0.0, -0.1, 0.0, 2.0, 0.0, -2.0;
  plant.B = plant.B_friction = Eigen::Vector3d(0.0, 1.0, 0.0);
  plant.C = Eigen::RowVector3d(0.0, 0.0, 1.0);
  return plant;
}

Pid filtered_pid() {
  Pid controller = pid(4.0, 0.0, 1.0);
  controller.tf = 0.01;
  return controller;
}

LoopParts parts_with(Plant plant, Controller controller) {
  LoopParts parts;
  parts.plant = std::move(plant);
  parts.controller = std::move(controller);
  parts.friction = coulomb(1.0, 1.0);
  return parts;
}

/// The same with the lag in the actuator: the friction sees the same loop.
Loop behind_an_actuator() {
  Pid controller = filtered_pid();
  controller.lag = 0.5;
  return build_loop(parts_with(Mass{1.0, 0.1, 0.0}, controller));
}

double difference(const Loop& one, const Loop& other) {
  double largest = 0.0;
  for (const double w : {0.1, 1.0, 1.7, 20.0}) {
    const auto a = one.element_response(w)(0, 0), b = other.element_response(w)(0, 0);
    largest = std::max(largest, std::abs(a / b - 1.0));
  }
  return largest;
}

std::string refused_key(const StateSpacePlant& plant) {
  const auto broken = plant.validate();
  return broken ? broken->key : "";
}

}  // namespace

TEST_CASE("state space: friction rubs where its velocity port says, not at y") {
  const Loop wanted = behind_an_actuator();
  StateSpacePlant plant = behind_a_sensor();
  plant.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0);
  CHECK(difference(build_loop(parts_with(plant, filtered_pid())), wanted) < 1e-13);
  plant.C_friction = Eigen::RowVector3d(1.0, 0.0, 0.0);
  CHECK(difference(build_loop(parts_with(plant, filtered_pid())), wanted) < 1e-13);
  plant.C_velocity.resize(0, 0);
  CHECK(difference(build_loop(parts_with(plant, filtered_pid())), wanted) < 1e-13);
}

TEST_CASE("state space: the rubbing displacement is found in any coordinates of the states") {
  std::mt19937_64 random(20261123);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  const Loop wanted = behind_an_actuator();
  for (int i = 0; i < 20; ++i) {
    MatrixXd T(3, 3);
    for (auto& value : T.reshaped()) value = entry(random);
    for (Eigen::Index k = 0; k < 3; ++k) T.col(k) *= std::pow(10.0, 3.0 * entry(random));
    if (std::abs(T.colwise().normalized().determinant()) < 0.1) continue;
    StateSpacePlant plant = behind_a_sensor();
    const MatrixXd back = T.inverse();
    plant.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0) * T;
    plant.A = back * plant.A * T;
    plant.B = back * plant.B;
    plant.B_friction = plant.B;
    plant.C = plant.C * T;
    CHECK(difference(build_loop(parts_with(plant, filtered_pid())), wanted) < 1e-9);
  }
}

TEST_CASE("state space: a velocity that is the rate of y keeps y, and one in other units is scaled") {
  StateSpacePlant plant;
  plant.A.resize(2, 2);
  plant.A << 0.0, 1.0, 0.0, -0.4;
  plant.B = Eigen::Vector2d(0.0, 1.0);
  plant.C = Eigen::RowVector2d(1.0, 0.0);
  plant.C_velocity = Eigen::RowVector2d(0.0, 1.0);
  CHECK(plant.model().C_x == plant.C);
  plant.C_velocity = Eigen::RowVector2d(0.0, 0.02);  // a radius
  CHECK((plant.model().C_x - 0.02 * plant.C).norm() < 1e-15);
}

TEST_CASE("state space: where no state holds the rubbing displacement, the frequency domain takes v/(jw)") {
  // A motor that drives a load on a spring through a fluid coupling: its angle affects nothing.
  const double d = 0.7, k = 3.0;
  StateSpacePlant without, with;
  without.A.resize(3, 3);
  without.A << -d, 0.0, d, 0.0, 0.0, 1.0, d, -k, -d;
  without.B = Eigen::Vector3d(1.0, 0.0, 0.0);
  without.C = Eigen::RowVector3d(0.0, 1.0, 0.0);
  without.C_velocity = Eigen::RowVector3d(1.0, 0.0, 0.0);
  with.A = MatrixXd::Zero(4, 4);
  with.A.topLeftCorner(3, 3) = without.A;
  with.A(3, 0) = 1.0;
  with.B = Eigen::Vector4d(1.0, 0.0, 0.0, 0.0);
  with.C = Eigen::RowVector4d(0.0, 1.0, 0.0, 0.0);
  with.C_friction = Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  CHECK(without.model().C_x.isZero(0.0));
  const Loop loop = build_loop(parts_with(without, filtered_pid()));
  const Loop wanted = build_loop(parts_with(with, filtered_pid()));
  CHECK(loop.states() + 1 == wanted.states());  // no integrator is added, which would drift
  CHECK(difference(loop, wanted) < 1e-12);
}

TEST_CASE("state space: a rubbing displacement whose rate is not the rubbing velocity is refused") {
  StateSpacePlant plant = behind_a_sensor();
  plant.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0);
  plant.C_friction = Eigen::RowVector3d(1.0, 0.0, 0.0);
  CHECK(refused_key(plant).empty());
  plant.C_friction = Eigen::RowVector3d(2.0, 0.0, 0.0);
  CHECK(refused_key(plant) == "C_friction");
  plant.C_friction = plant.C;
  CHECK(refused_key(plant) == "C_friction");
  plant.C_velocity.resize(0, 0);
  CHECK(refused_key(plant).empty());
  plant.C_friction = Eigen::RowVector3d(0.0, 1.0, 0.0);  // a force moves it at once
  CHECK(refused_key(plant) == "C_friction");
  plant.C_friction = MatrixXd::Zero(1, 2);
  CHECK(refused_key(plant) == "C_friction");
}
