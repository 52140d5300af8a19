#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/settle/displaced.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;

namespace {

/// 12 kg on a screw of 10 mm lead.
ServoDrive axis() {
  ServoDrive drive;
  drive.motor_inertia = 8e-5;
  drive.load = 12.0;
  drive.ratio = 2.0 * std::numbers::pi / 0.01;
  drive.efficiency = 0.9;
  drive.torque_constant = 0.12;
  drive.damping = 30.0;
  return drive;
}

Complex response(const PlantModel& plant, const Eigen::VectorXd& input, Complex s) {
  return StateSpace{plant.A, input, plant.C_y, Eigen::MatrixXd::Zero(1, 1)}.at(s)(0, 0);
}

Cycle cycle_of(const Plant& plant, double gain, double force) {
  Pid controller = pid(4e3 / gain, 2e4 / gain, 600.0 / gain);
  controller.lag = 1e-4;
  const Loop loop = loop_of(plant, controller, coulomb(1.5 * force, force));
  const Settled settled = settle(loop, displaced(loop, 1e-3), {});
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

}  // namespace

TEST_CASE("servo drive: its response is that of its formula, with and without a current lag") {
  ServoDrive drive = axis();
  const double force = 0.9 * drive.ratio * 0.12, mass = 12.0 + 0.9 * drive.ratio * drive.ratio * 8e-5;
  for (const double lag : {0.0, 2e-3}) {
    drive.current_lag = lag;
    const PlantModel plant = drive.model();
    CHECK(plant.state_names.size() == (lag > 0.0 ? 3 : 2));
    for (const double w : {0.1, 20.0, 3000.0}) {
      const Complex s(0.0, w), body = 1.0 / (s * (mass * s + 30.0));
      CHECK(std::abs(response(plant, plant.B_u, s) / (force * body / (lag * s + 1.0)) - 1.0) < 1e-12);
      CHECK(std::abs(response(plant, plant.B_F, s) / body - 1.0) < 1e-12);
    }
  }
}

TEST_CASE("servo drive: it hunts as its mass does, seen from the motor too, and a fast current loop changes little") {
  const ServoDrive drive = axis();
  const double gain = 0.9 * drive.ratio * 0.12, mass = 12.0 + 0.9 * drive.ratio * drive.ratio * 8e-5;
  const Cycle as_mass = cycle_of(Mass{mass, 30.0, 0.0}, 1.0, 8.0), as_drive = cycle_of(drive, gain, 8.0);
  CHECK(as_drive.period == Approx(as_mass.period).epsilon(1e-9));
  CHECK(as_drive.amplitude == Approx(as_mass.amplitude).epsilon(1e-9));
  double before = infinite;
  for (const double lag : {1e-3, 1e-4, 1e-5}) {  // first order in the lag
    ServoDrive lagging = drive;
    lagging.current_lag = lag;
    const double apart = std::abs(cycle_of(lagging, gain, 8.0).amplitude / as_mass.amplitude - 1.0);
    CAPTURE(lag, apart);
    CHECK(apart < 0.2 * before);
    before = apart;
  }
  // In millimetres, tonnes and newtons: lengths by 1e3, masses by 1e-3, time and force kept.
  ServoDrive scaled = drive;
  scaled.ratio *= 1e-3;
  scaled.load *= 1e-3;
  scaled.motor_inertia *= 1e3;
  scaled.damping *= 1e-3;
  scaled.torque_constant *= 1e3;
  const Cycle in_millimetres = cycle_of(scaled, 1e3 * gain, 8.0);
  CHECK(in_millimetres.period == Approx(as_mass.period).epsilon(1e-7));
  CHECK(in_millimetres.amplitude == Approx(1e3 * as_mass.amplitude).epsilon(1e-7));
}
