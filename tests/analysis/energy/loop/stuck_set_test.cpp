#include "limcycle/analysis/energy/loop/stuck_set.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Loop under(Controller controller, Element friction, double load = 0.0, double reference = 0.0) {
  LoopParts parts = servo_parts(std::move(friction));
  parts.controller = std::move(controller);
  parts.load = load;
  parts.reference = reference;
  return build_loop(parts);
}

}  // namespace

TEST_CASE("holding forces: break-away of every law, from its own switches or its slowest sliding") {
  for (const Element& law : {Element(coulomb(1.5, 1.0)), Element(stribeck(1.5, 1.0, 1e-3)), Element(lugre())}) {
    CHECK(holding_forces(law).high == Approx(1.5).epsilon(1e-8));
    CHECK(holding_forces(law).low == Approx(-1.5).epsilon(1e-8));
  }
  Coulomb<double> one_sided = coulomb(1.5, 1.0);
  one_sided.Fs_minus = 1.2;
  CHECK(holding_forces(one_sided).low == Approx(-1.2).epsilon(1e-12));
  CHECK(stopping_forces(coulomb(1.5, 1.0)).high == Approx(1.0).epsilon(1e-12));
  CHECK(stopping_forces(stribeck(1.5, 1.0, 1e-3)).high == Approx(1.5).epsilon(1e-8));
  for (const std::string_view kind : {"karnopp", "quinn", "awrejcewicz", "xiong", "gms", "elasto-plastic", "leuven"})
    FrictionLaws::for_each([&]<template <class> class Kind>() {
      if (Kind<double>::kind != kind) return;
      const auto law = made<Kind<double>>(samples_of_kind(kind).front().settings);
      INFO(kind);
      CHECK(holding_forces(law).high == Approx(1.5).epsilon(1e-6));
    });
}

TEST_CASE("stuck states: position control holds a band of positions, integral action one position") {
  const StuckSet pd = stuck_set(under(pid(3.0, 0.0, 6.0), coulomb(1.5, 1.0), 0.3, 0.7));
  REQUIRE(pd.answer.decision == Decision::yes);
  CHECK(pd.dimension == 1);
  CHECK(pd.output.low == Approx(0.7 + (0.3 - 1.5) / 3.0).epsilon(1e-9));  // kp (r - y) + load = F
  CHECK(pd.output.high == Approx(0.7 + (0.3 + 1.5) / 3.0).epsilon(1e-9));
  CHECK(pd.attracts.decision == Decision::yes);
  CHECK(pd.attracts.why.find("between -1 and 1 N") != std::string::npos);  // only there the law stops a sliding body
  CHECK(pd.tried == 4);
  CHECK(pd.returned == 4);

  const StuckSet pid_coulomb = stuck_set(under(pid(3.0, 4.0, 6.0), coulomb(1.5, 1.0), 0.3, 0.7));
  CHECK(pid_coulomb.dimension == 1);
  CHECK(pid_coulomb.output.low == Approx(0.7).epsilon(1e-9));
  CHECK(pid_coulomb.fixed_output());
  CHECK(pid_coulomb.winding == 1);
  CHECK(pid_coulomb.attracts.decision == Decision::no);
  CHECK(pid_coulomb.returned == 0);
}

TEST_CASE("stuck states: on bristles integral action lets go of a small error, slowly") {
  const StuckSet set = stuck_set(servo(lugre()));
  CHECK(set.dimension == 1);
  CHECK(std::abs(set.output.high) < 1e-12);
  CHECK(set.attracts.decision == Decision::yes);
  CHECK(set.returned == set.tried);
  // A spring sigma0 in parallel to kp: ki y = -(kp + sigma0) y'
  REQUIRE(set.eigenvalues.size() == 4);
  CHECK(set.eigenvalues(1).real() == Approx(-4.0 / (1e5 + 3.0)).epsilon(1e-3));
}

TEST_CASE(
    "stuck states: a negative spring throws out what a small push sets moving, and a free mass may stop anywhere") {
  const StuckSet thrown = stuck_set(under(pid(-3.0, 0.0, 1.0), lugre()));
  CHECK(thrown.answer.decision == Decision::yes);  // bristles hold it while the deflection is small
  CHECK(thrown.output.high == Approx(0.5).epsilon(1e-9));
  const StuckSet free = stuck_set(under(NoController{}, coulomb(1.5, 1.0), 0.5));
  CHECK(free.force.low == Approx(0.5).epsilon(1e-12));
  CHECK(free.force.high == free.force.low);
  CHECK(free.output.low == -infinite);
  CHECK(free.output.high == infinite);
  CHECK(free.attracts.decision == Decision::yes);
  CHECK(stuck_set(under(NoController{}, coulomb(1.5, 1.0), 2.0)).answer.decision == Decision::no);  // it slides off
}

TEST_CASE("stuck states: beside a stuck motor the load's own motion decides") {
  TwoMass plant;
  plant.motor_mass = 1.0;
  plant.load_mass = 0.5;
  plant.stiffness = 100.0;
  plant.measured.index = 0;
  for (const double damping : {0.1, 0.0, -0.1}) {
    plant.damping = damping;
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    parts.plant = plant;
    parts.controller = pid(3.0, 0.0, 6.0);
    const StuckSet set = stuck_set(build_loop(parts));
    INFO("damping " << damping);
    CHECK(set.attracts.decision == (damping > 0.0   ? Decision::yes
                                    : damping < 0.0 ? Decision::no
                                                    : Decision::undecided));
    CHECK(set.eigenvalues(damping > 0.0 ? 1 : 0).real() == Approx(-damping).margin(1e-12));  // c/(2 m)
    if (damping > 0.0) CHECK(set.returned == set.tried);
    if (damping < 0.0) CHECK(set.returned == 0);
  }
}

TEST_CASE("stuck states: what is not asked is said") {
  CHECK(stuck_set(forward(relay(1.0), {1.0}, {1.0, 1.0})).answer.decision == Decision::not_applicable);
  CHECK(stuck_set(belt(coulomb(1.5, 1.0))).answer.decision == Decision::no);
  CHECK(stuck_set(build_loop(parts_of(froude_pendulum(4.0)))).answer.decision == Decision::not_applicable);
}
