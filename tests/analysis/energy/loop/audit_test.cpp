#include "limcycle/analysis/energy/loop/audit.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

struct Audited {
  Simulation run;
  EnergyBalance energy;
};

Audited audited(const LoopParts& parts, SimulateOptions options) {
  const Loop loop = build_loop(parts);
  EnergyAudit audit(parts, loop, options.rtol);
  options.watch = [&](LoopField& field, March& march, const std::vector<Mode>& modes) {
    audit.step(field, march, modes);
  };
  auto run = simulate(loop, options);
  REQUIRE(run.status == Status::converged);
  return {std::move(run), audit.balance()};
}

SimulateOptions from(std::map<std::string, double> initial, double duration, double rtol,
                     const std::string& stepper = "auto") {
  SimulateOptions options;
  options.initial = std::move(initial);
  options.duration = duration;
  options.rtol = rtol;
  options.sample = duration;  // otherwise every sample would end a step
  options.stepper = stepper;
  return options;
}

LoopParts braked_mass(double Fc, double sigma2) {
  LoopParts parts;
  parts.plant = Mass{2.0, 0.0, 0.0};
  parts.friction = coulomb(Fc, Fc, sigma2);
  return parts;
}

double column(const Audited& result, const std::string& name) {
  const auto at = std::ranges::find(result.run.columns, name);
  REQUIRE(at != result.run.columns.end());
  return result.run.rows.back()[static_cast<std::size_t>(at - result.run.columns.begin())];
}

LoopParts two_mass(bool friction_on_load) {
  LoopParts parts;
  TwoMass plant;
  plant.motor_mass = 1.0;
  plant.load_mass = 2.0;
  plant.stiffness = 50.0;
  plant.damping = 0.3;
  plant.friction_on.index = friction_on_load ? 1 : 0;
  plant.measured.index = 0;
  parts.plant = plant;
  parts.controller = pid(3.0, 0.5, 6.0);
  parts.friction = lugre();
  return parts;
}

LoopParts on_belt(Element law) {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.05, 0.1};
  parts.load = 0.3;
  parts.friction = std::move(law);
  return parts;
}

LoopParts servo_drive(double current_lag) {
  LoopParts parts;
  ServoDrive plant;
  plant.motor_inertia = 2e-5;
  plant.load = 1.0;
  plant.ratio = 300.0;
  plant.efficiency = 0.9;
  plant.torque_constant = 0.02;
  plant.damping = 0.7;
  plant.current_lag = current_lag;
  parts.plant = plant;
  parts.controller = pid(3.0, 1.0, 2.0);
  parts.load = 0.1;
  parts.friction = coulomb(1.5, 1.0);
  return parts;
}

Karnopp<double> karnopp() {
  auto law = with_levels<Karnopp<double>>(1.5, 1.0);
  law.vs = 0.1;
  law.dv = 0.01;
  return law;
}

void check_sum(const EnergyBalance& energy) {
  CHECK(energy.checks());
  CHECK(energy.balanced());
  CHECK(energy.turnover > 0.0);
  CHECK(energy.supplied() - energy.stored() - energy.dissipated() == Approx(energy.error()).margin(1e-300));
}

}  // namespace

TEST_CASE("audit: a mass that dry friction brings to rest loses what it had") {
  const auto [run, energy] = audited(braked_mass(1.5, 0.0), from({{"v", 0.6}}, 2.0, 1e-8));
  check_sum(energy);
  CHECK(energy.kinetic == Approx(-0.36).epsilon(1e-12));  // m v^2/2
  CHECK(energy.friction == Approx(0.36).epsilon(1e-10));  // Fc times m v^2/(2 Fc)
  CHECK(energy.turnover == Approx(0.36).epsilon(1e-12));
  CHECK(energy.command == 0.0);
  CHECK(energy.of_storage);  // dry friction stores nothing
  CHECK(energy.in_friction == 0.0);
}

TEST_CASE("audit: free decay of a damped oscillator, split between damper and friction") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.2, 4.0};
  parts.friction = coulomb(0.0, 0.0, 0.3);  // only viscous: both dampers have the same speed
  const auto result = audited(parts, from({{"y", 1.0}}, 7.0, 1e-10));
  check_sum(result.energy);
  const double y = column(result, "y"), v = column(result, "dy_dt"), left = 0.5 * v * v + 2.0 * y * y;
  // Closed form of y'' + 2 d y' + 4 y = 0, d = 1/4.
  const double d = 0.25, w = std::sqrt(4.0 - d * d), t = 7.0;
  CHECK(y == Approx(std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t))).epsilon(1e-8));
  CHECK(result.energy.viscous == Approx(0.4 * (2.0 - left)).epsilon(1e-8));
  CHECK(result.energy.friction == Approx(0.6 * (2.0 - left)).epsilon(1e-8));
  CHECK(result.energy.potential == Approx(2.0 * y * y - 2.0).epsilon(1e-9));
}

TEST_CASE("audit: a constant load that creeps against viscous friction") {
  LoopParts parts = braked_mass(0.0, 4.0);
  parts.load = 2.0;
  Audited result = audited(parts, from({{"v", 0.5}}, 10.0, 1e-8));  // at the speed at which both balance
  check_sum(result.energy);
  CHECK(result.energy.load == Approx(2.0 * 0.5 * 10.0).epsilon(1e-10));
  CHECK(result.energy.friction == Approx(10.0).epsilon(1e-10));
  // The same force as a signal that begins halfway: the break is a step's end.
  parts.load = 0.0;
  SimulateOptions options = from({}, 10.0, 1e-8);
  options.force.emplace();
  options.force->kind = Signal::Kind::step;
  options.force->value = 2.0;
  options.force->start = 5.0;
  result = audited(parts, options);
  check_sum(result.energy);
  const double tau = 0.5, distance = 0.5 * (5.0 - tau * (1.0 - std::exp(-10.0)));
  CHECK(result.energy.load == Approx(2.0 * distance).epsilon(1e-7));
}

TEST_CASE("audit: every mechanical plant balances, whatever drives it") {
  const struct {
    const char* name;
    LoopParts parts;
    std::map<std::string, double> initial;
  } cases[] = {{"servo", servo_parts(lugre()), {{"y", 0.1}}},
               {"servo, dry", servo_parts(coulomb(1.5, 1.0, 0.4)), {{"y", 0.1}}},
               {"two masses", two_mass(false), {{"y_motor", 0.1}, {"y_load", 0.1}}},
               {"two masses, load", two_mass(true), {{"y_motor", 0.1}, {"y_load", 0.1}}},
               {"servo drive", servo_drive(0.0), {{"y", 1.0}}},
               {"servo drive, lag of the current", servo_drive(0.05), {{"y", 1.0}}},
               {"belt", on_belt(lugre()), {{"y", 0.5}}},
               {"belt, stick-slip", on_belt(stribeck(1.5, 1.0, 0.1)), {{"y", 0.5}}},
               {"pendulum", parts_of(froude_pendulum(5.0)), {{"y", 0.5}}}};
  for (const auto& one : cases) {
    INFO(one.name);
    const auto [run, energy] = audited(one.parts, from(one.initial, 5.0, 1e-8));
    check_sum(energy);
    CHECK(energy.of_plant);
    CHECK(std::abs(energy.relative_error()) < 1e-6);
    CHECK(energy.friction > 0.0);
  }
}

TEST_CASE("audit: a ramp moves the origin of the states, not the energy") {
  LoopParts parts = servo_parts(lugre());
  parts.plant = Mass{1.0, 0.1, 0.0};
  parts.reference_rate = 0.02;
  const auto result = audited(parts, from({}, 30.0, 1e-8));
  check_sum(result.energy);
  const double v = column(result, "loop.friction.rate");
  CHECK(result.energy.kinetic == Approx(0.5 * v * v).margin(1e-15));
  CHECK(result.energy.command > 0.5);  // at least Fc times most of 0.6 m
  CHECK(result.energy.viscous > 0.0);
}

TEST_CASE("audit: the impulse of an arrest is dissipated") {
  const LoopParts parts = servo_parts(karnopp());
  const auto [run, energy] = audited(parts, from({{"y", 1.0}}, 20.0, 1e-8));
  check_sum(energy);
  // Each stop dissipates m dv^2/2 at dv, or a little of it.
  CHECK(energy.impulses >= 0.5 * 0.01 * 0.01);
  const double stops = energy.impulses / (0.5 * 0.01 * 0.01);
  CHECK(stops == Approx(std::round(stops)).epsilon(1e-6));
  CHECK(std::abs(energy.relative_error()) < 1e-7);
}

TEST_CASE("audit: of a plant known by input and output, the friction law alone") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 0.1, 0.0}, 0.0};
  parts.controller = pid(3.0, 1.0, 6.0);
  parts.friction = lugre();
  auto energy = audited(parts, from({{"x1", 0.01}, {"x2", 0.3}}, 10.0, 1e-8)).energy;
  check_sum(energy);
  CHECK_FALSE(energy.of_plant);
  CHECK(energy.of_storage);
  CHECK(energy.in_friction > 0.0);  // the bristle is deflected at the end
  CHECK(energy.in_friction < 0.5 * 1.5 * 1.5 / 1e5);
  CHECK(energy.supplied() == energy.rubbing);
  parts.friction = stribeck(1.5, 1.0, 0.01);  // has no state: all work is dissipated
  energy = audited(parts, from({{"x1", 0.01}, {"x2", 0.3}}, 5.0, 1e-8)).energy;
  CHECK(energy.rubbing > 0.0);
  CHECK(energy.friction == Approx(energy.rubbing));
}

TEST_CASE("audit: the error of the balance follows the tolerance") {
  for (const char* stepper : {"rodas5p", "dopri5", "fehlberg78"}) {
    INFO(stepper);
    LoopParts parts = servo_parts(lugre());
    if (std::string(stepper) != "rodas5p") law_of<LuGre<double>>(*parts.friction).sigma0 = 1e3;
    double before = infinite;
    for (const double rtol : {1e-4, 1e-6, 1e-8}) {
      const auto energy = audited(parts, from({{"y", 1.0}}, 20.0, rtol, stepper)).energy;
      CHECK(energy.balanced());
      const double error = std::abs(energy.relative_error());
      CHECK(error < 100.0 * rtol);          // an explicit stepper at its limit of stability: 40 rtol
      CHECK(error < 0.1 * before + 1e-13);  // a hundredth of the tolerance, at most a tenth of the error
      before = error;
    }
  }
}

TEST_CASE("audit: it sees a step that is wrong") {
  // The same march, but with its states scaled in between: energy appears from nowhere.
  const LoopParts parts = servo_parts(lugre());
  const Loop loop = build_loop(parts);
  LoopField field(loop);
  EnergyAudit audit(parts, loop, 1e-8);
  March march(field, StepperKind::rodas5p, loop_weights(loop, 1e-8));
  State x(field.size(), 0.0);
  x[0] = 1.0;
  field.start(x, 0.0);
  march.begin(x, 0.0);
  const auto run_to = [&](double end) {
    while (march.t() < end) {
      const auto modes = field.modes();
      REQUIRE(march.step(end) == Status::converged);
      audit.step(field, march, modes);
    }
  };
  run_to(0.5);
  CHECK(audit.balance().balanced());
  State pushed = march.x();
  pushed[1] *= 1.0 + 1e-5;
  march.begin(pushed, march.t());
  run_to(1.0);
  CHECK_FALSE(audit.balance().balanced());
}

TEST_CASE("audit: it changes nothing of the run, and costs no step") {
  const LoopParts parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  for (const char* stepper : {"auto", "rodas5p", "dopri5"}) {
    const auto options = from({{"y", 1.0}}, 20.0, 1e-7, stepper);
    const auto watched = audited(parts, options);
    const auto plain = simulate(build_loop(parts), options);
    CHECK(watched.run.rows == plain.rows);
    CHECK(watched.run.steps == plain.steps);
  }
}

TEST_CASE("audit: there is something to count where there is a mass or friction") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.0};
  parts.element = relay(1.0);
  CHECK_FALSE(has_energy(parts));
  parts.plant = Mass{1.0, 0.5, 0.0};
  CHECK(has_energy(parts));
  parts.controller = pid(1.0, 0.0, 0.0);
  const auto energy = audited(parts, from({{"y", 1.0}}, 10.0, 1e-8)).energy;  // a relay drives the mass
  check_sum(energy);
  CHECK_FALSE(energy.of_friction);
  CHECK(energy.viscous > 0.0);
}
