// The simple method for loops whose elements hold nothing, against the general method for the same loops.
#include "limcycle/analysis/motion/field/plain_field.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Eigen::Index;

namespace {

/// The same loop with an additional relay without effect: the general method must be used.
Loop with_idle_relay(Loop loop) {
  const Index n = loop.states();
  loop.elements.insert(loop.elements.begin(), relay(1.0, 0.5));
  Eigen::MatrixXd B(n, loop.B.cols() + 1);
  B << Eigen::VectorXd::Zero(n), loop.B;
  loop.B = B;
  for (Port& port : loop.ports)
    for (Eigen::RowVectorXd* row : {&port.D, &port.D_v}) {
      Eigen::RowVectorXd longer(row->size() + 1);
      longer << 0.0, *row;
      *row = longer;
    }
  Port idle = loop.ports.front();
  for (Eigen::RowVectorXd* row : {&idle.C, &idle.D, &idle.C_v, &idle.D_v, &idle.C_delayed}) row->setZero();
  idle.c.setZero();
  idle.c_v.setZero();
  idle.rubs = false;
  loop.ports.insert(loop.ports.begin(), idle);
  return loop;
}

/// A limited actuator with a lag, driving a body with bristle friction.
Loop limited_servo() {
  auto parts = servo_parts(lugre());
  auto controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 2.0;
  controller.lag = 0.1;
  parts.controller = controller;
  return build_loop(parts);
}

Gms<double> three_sliders() {
  auto law = with_levels<Gms<double>>(1.5, 1.0);
  law.vs = 1e-3;
  law.k = {5e4, 3e4, 2e4};
  law.alpha = {0.5, 0.3, 0.2};
  law.C = 100.0;
  return law;
}

}  // namespace

TEST_CASE("plain field: rates, Jacobian, inputs and guards are those of the general way") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const Loop& loop : {servo(lugre()), limited_servo(), build_loop(parts_of(froude_pendulum(8.0))),
                           servo(three_sliders()), belt(lugre())}) {
    REQUIRE(PlainField::applies(loop));
    const Loop longer = with_idle_relay(loop);
    REQUIRE_FALSE(PlainField::applies(longer));
    LoopField plain(loop), general(longer);
    REQUIRE(plain.size() == general.size());
    const State sizes = typical_sizes(loop);
    for (int i = 0; i < 40; ++i) {
      State x(plain.size()), other, dx, dx_general, dfdt;
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = sizes[k] * u(random);
      plain.start(x, 0.0);
      other = x;
      general.start(other, 0.0);
      REQUIRE(x == other);
      plain.rate(x, dx, 0.0);
      general.rate(x, dx_general, 0.0);
      for (std::size_t k = 0; k < x.size(); ++k) CHECK(dx[k] == Approx(dx_general[k]).epsilon(1e-13).margin(1e-13));
      Eigen::MatrixXd J, J_general;
      plain.jacobian(x, J, 0.0, dfdt);
      CHECK(dfdt == State(x.size(), 0.0));
      general.jacobian(x, J_general, 0.0, dfdt);
      CHECK((J - J_general).cwiseAbs().maxCoeff() <= 1e-12 * J_general.cwiseAbs().maxCoeff());
      std::vector<double> g, g_general;
      plain.guards(x, 0.0, g);
      general.guards(x, 0.0, g_general);
      REQUIRE(g.size() < g_general.size());
      const std::size_t own = g_general.size() - g.size();  // guards of the relay come first
      for (std::size_t k = 0; k < g.size(); ++k) CHECK(g[k] == Approx(g_general[k + own]).margin(1e-12));
      for (std::size_t e = 0; e < loop.elements.size(); ++e) {
        CHECK(plain.input(e).x == Approx(general.input(e + 1).x).margin(1e-15));
        CHECK(plain.input(e).v == Approx(general.input(e + 1).v).margin(1e-15));
        CHECK(plain.input(e).drive == Approx(general.input(e + 1).drive).epsilon(1e-9).margin(1e-9));
      }
    }
  }
}

TEST_CASE("plain field: signals from outside act as in the general way") {
  const Loop loop = servo(lugre()), longer = with_idle_relay(loop);
  LoopField plain(loop), general(longer);
  const auto signals = [](double t, External& value, External& rate) {
    value << 1.0, std::sin(t), std::cos(t), 0.3 * t;
    rate << 0.0, std::cos(t), -std::sin(t), 0.3;
  };
  plain.set_external(signals);
  general.set_external(signals);
  State x{0.02, -0.003, 0.1, 4e-6}, dx, dx_general, dfdt, dfdt_general;
  general.start(x, 0.0);
  Eigen::MatrixXd J, J_general;
  for (const double t : {0.0, 0.7, 2.9}) {
    plain.rate(x, dx, t);
    general.rate(x, dx_general, t);
    plain.jacobian(x, J, t, dfdt);
    general.jacobian(x, J_general, t, dfdt_general);
    for (std::size_t k = 0; k < x.size(); ++k) {
      CHECK(dx[k] == Approx(dx_general[k]).epsilon(1e-13));
      CHECK(dfdt[k] == Approx(dfdt_general[k]).epsilon(1e-13).margin(1e-13));
    }
    CHECK((J - J_general).cwiseAbs().maxCoeff() <= 1e-12 * J_general.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("plain field: not for loops that stick, follow a selection or ask for the drive") {
  CHECK_FALSE(PlainField::applies(servo(coulomb(1.5, 1.0))));
  CHECK_FALSE(PlainField::applies(servo(stribeck(1.5, 1.0, 1e-3))));
  auto compensated = servo_parts(coulomb(1.5, 1.0));
  auto controller = pid(3.0, 4.0, 6.0);
  controller.friction_compensation = 0.5;
  compensated.controller = controller;
  CHECK_FALSE(PlainField::applies(build_loop(compensated)));
  auto karnopp = with_levels<Karnopp<double>>(1.5, 1.0);
  karnopp.vs = karnopp.dv = 1e-3;
  CHECK_FALSE(PlainField::applies(servo(karnopp)));
}

TEST_CASE("march: a longest step that is asked for does not make steps fail") {
  const Loop loop = servo(lugre());
  LoopField field(loop);
  long calls = 0;
  field.set_external([&](double, External& value, External& rate) {
    ++calls;
    value << 1.0, 0.0, 0.0, 0.0;
    rate.setZero();
  });
  March march(field, StepperKind::rodas5p, loop_weights(loop, 1e-7));
  march.begin({0.05, 0.0, 0.1, 0.0}, 0.0);
  march.limit_step(0.05);
  while (march.t() < 25.0) REQUIRE(march.step(25.0) == Status::converged);
  // Eight rates a step (the first is that of the previous step) and one Jacobian, with a margin for failed steps.
  CHECK(double(calls) < 1.3 * 9.0 * double(march.steps()));
}
