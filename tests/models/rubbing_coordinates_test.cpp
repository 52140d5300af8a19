#include "limcycle/models/rubbing_coordinates.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/linear/balance.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A flow behind a sticking valve in a mixture of its states.
StateSpacePlant mixed_valve() {
  StateSpacePlant plant;
  Eigen::Matrix3d A, mix;
  A << 0.0, 1.0, 0.0, -10000.0, -400.0, 0.0, 2500.0, 0.0, -0.5;
  mix << 0.3, -1.2, 0.7, 1.1, 0.4, -0.2, -0.5, 0.9, 1.3;
  const Eigen::Matrix3d back = mix.inverse();
  plant.A = mix * A * back;
  plant.B = mix * Eigen::Vector3d(0.0, 0.2, 0.0);
  plant.B_friction = plant.B;
  plant.C = Eigen::RowVector3d(0.0, 0.0, 1.0) * back;
  plant.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0) * back;
  return plant;
}

Loop valve_loop(const StateSpacePlant& plant) {
  LoopParts parts;
  parts.plant = plant;
  parts.controller = pid(5.0, 5.0, 0.0);
  parts.friction = coulomb(100.0, 80.0);
  return build_loop(parts);
}

}  // namespace

TEST_CASE("rubbing coordinates: friction acts on one state, and the responses are the same") {
  // Two masses seen at the motor, written as a transfer function and in mixed states.
  PlantModel plant = TransferFunction{{0.5, 1.0, 200.0}, {0.25, 1.0, 200.0, 0.0, 0.0}, 0.0}.model();
  const auto [changed, own] = rubbing_coordinates(plant);
  REQUIRE(own.rows() == 4);
  CHECK(changed.C_x == Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(4, 0)));
  CHECK(changed.C_v == Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(4, 1)));
  CHECK((changed.B_F.array() != 0.0).count() == 1);
  CHECK(changed.A.row(0) == Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(4, 1)));
  CHECK((plant.A * own - own * changed.A).norm() < 1e-11 * plant.A.norm() * own.norm());
  for (const double w : {0.1, 3.0, 40.0}) {
    const std::complex<double> s(0.0, w);
    const auto response = [&](const PlantModel& p) {
      const Eigen::MatrixXcd M = s * Eigen::MatrixXcd::Identity(4, 4) - p.A.cast<std::complex<double>>();
      return (p.C_y.cast<std::complex<double>>() * M.fullPivLu().solve(p.B_u.cast<std::complex<double>>())).value();
    };
    CHECK(std::abs(response(changed) / response(plant) - 1.0) < 1e-10);
  }
}

TEST_CASE("rubbing coordinates: what is left over is written in its modes, however the case mixes it") {
  // Two masses on a stiff spring, friction on the motor: the load on its spring, in N, m, s.
  const double motor = 1.4e-6, load = 4.7e-6, k = 60.0, d = 1.5e-3;
  Eigen::Matrix4d A, mix;
  A << 0.0, 1.0, 0.0, 0.0, -k / motor, -d / motor, k / motor, d / motor,  //
      0.0, 0.0, 0.0, 1.0, k / load, d / load, -k / load, -d / load;
  mix << 0.3, -1.2, 0.7, 0.4, 1.1, 0.4, -0.2, -0.9, -0.5, 0.9, 1.3, 0.2, 0.6, -0.3, 0.5, 1.0;
  const Eigen::Matrix4d back = mix.inverse();
  StateSpacePlant plant;
  plant.A = mix * A * back;
  plant.B = mix * Eigen::Vector4d(0.0, 1.0 / motor, 0.0, 0.0);
  plant.B_friction = plant.B;
  plant.C = Eigen::RowVector4d(1.0, 0.0, 0.0, 0.0) * back;
  plant.C_velocity = Eigen::RowVector4d(0.0, 1.0, 0.0, 0.0) * back;
  const auto [changed, own] = rubbing_coordinates(plant.model());
  const Eigen::Matrix2d left = changed.A.bottomRightCorner(2, 2);
  const double frequency = std::sqrt(k / load), decay = 0.5 * d / load;
  CHECK(left(0, 0) == Approx(-decay).epsilon(1e-5));
  CHECK(left(1, 1) == Approx(-decay).epsilon(1e-5));
  CHECK(std::abs(left(0, 1)) == Approx(std::sqrt(frequency * frequency - decay * decay)).epsilon(1e-6));
  CHECK(left(1, 0) == Approx(-left(0, 1)).epsilon(1e-6));
  CHECK((plant.A * own - own * changed.A).norm() < 1e-11 * plant.A.norm() * own.norm());
}

TEST_CASE("rubbing coordinates: plants that are of this form stay as they are") {
  CHECK(rubbing_coordinates(Mass{2.0, 0.1, 3.0}.model()).own_states.size() == 0);
  CHECK(rubbing_coordinates(TransferFunction{{1.0}, {2.0, 0.1, 3.0}, 0.0}.model()).own_states.size() == 0);
  CHECK(servo(coulomb(1.5, 1.0)).own_states.size() == 0);
}

TEST_CASE("rubbing coordinates: the states of the case are found again") {
  const StateSpacePlant plant = mixed_valve();
  const Loop loop = valve_loop(plant);
  REQUIRE(loop.own_states.rows() == loop.states());
  // The velocity as defined in the case, in terms of its own states.
  const Eigen::RowVectorXd velocity = plant.C_velocity * loop.own_states.topLeftCorner(3, 3);
  CHECK((velocity - loop.ports.back().C_v.head(3)).norm() < 1e-12);
}

TEST_CASE("balancing units: powers of two that make rows and columns alike, whatever the units of the states") {
  Eigen::Matrix3d A;
  A << -1.0, 2.0, 0.5, 1.0, -3.0, 1.0, 0.7, 1.5, -2.0;
  CHECK(balancing_units(A) == Eigen::VectorXd(Eigen::VectorXd::Ones(3)));
  const Eigen::Vector3d units(1.0, 1048576.0, 1.0 / 1024.0);
  const Eigen::MatrixXd scaled = units.asDiagonal() * A * units.cwiseInverse().asDiagonal();
  const Eigen::VectorXd found = balancing_units(scaled);
  for (Eigen::Index k = 1; k < 3; ++k) {
    const double share = (found(k) / found(0)) / (units(k) / units(0));
    CHECK(share >= 0.5);
    CHECK(share <= 2.0);
    CHECK(std::exp2(std::round(std::log2(found(k)))) == found(k));
  }
}
