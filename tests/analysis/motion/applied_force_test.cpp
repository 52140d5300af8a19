// Laws that need the applied force, in a loop: gradients and saltations against differences, the order of the stiff
// stepper, rest without creep, and the hunting servo as the band shrinks.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/friction/dry/awrejcewicz.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/quinn.hpp"
#include "limcycle/models/friction/dry/wojewoda.hpp"
#include "limcycle/tests/analysis/motion/one_step.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

template <class Law>
Law banded(double dv, double Fs = 1.5, double Fc = 1.0, double vs = 1e-3, double sigma2 = 0.0) {
  auto law = with_levels<Law>(Fs, Fc);
  law.vs = vs;
  law.dv = dv;
  law.sigma2 = sigma2;
  return law;
}

Wojewoda<double> wojewoda(double Fs = 1.5, double Fc = 1.0, double vs = 1e-2, double ks = 1e3) {
  auto law = with_levels<Wojewoda<double>>(Fs, Fc);
  law.vs = vs;
  law.ks = ks;
  law.sigma2 = 0.4;
  return law;
}

State shifted(State x, std::size_t i, double by) {
  x[i] += by;
  return x;
}

/// Largest difference of the field's Jacobian, by state and time, and central differences, relative to the largest.
double jacobian_defect(LoopField& field, const State& x, double t = 0.0, double h = 1e-6) {
  Eigen::MatrixXd J;
  State dfdt, plus, minus;
  field.jacobian(x, J, t, dfdt);
  double worst = 0.0, size = J.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k <= x.size(); ++k) {
    const bool time = k == x.size();
    if (time && !field.driven()) break;
    field.rate(time ? x : shifted(x, k, h), plus, time ? t + h : t);
    field.rate(time ? x : shifted(x, k, -h), minus, time ? t - h : t);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double here = time ? dfdt[i] : J(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      worst = std::max(worst, std::abs((plus[i] - minus[i]) / (2.0 * h) - here));
    }
  }
  return worst / size;
}

/// Saltation matrix of the switch of a guard near x, against neighbours carried over it and back.
void check_saltation(const Loop& loop, const State& near, std::vector<Mode> modes, std::size_t guard,
                     std::vector<Mode> after, double size, double accuracy = 1e-5) {
  LoopField field(loop);
  field.modes() = modes;
  const State at = moved(field, near, time_to(field, near, guard, 1e-5));
  State x = at;
  Eigen::MatrixXd saltation;
  REQUIRE(field.fire(x, 0.0, guard, saltation));
  CHECK(field.modes() == after);
  const auto over = [&](const State& start) {
    field.modes() = modes;
    const double t = time_to(field, start, guard, 1e-5);
    State y = moved(field, start, t);
    field.fire(y, 0.0, guard);
    CHECK(field.modes() == after);
    return moved(field, y, -t);
  };
  for (std::size_t k = 0; k < at.size(); ++k) {
    const State a = over(shifted(at, k, size)), b = over(shifted(at, k, -size));
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double here = saltation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      CAPTURE(i, k);
      CHECK((a[i] - b[i]) / (2.0 * size) == Approx(here).margin(accuracy * saltation.cwiseAbs().maxCoeff()));
    }
  }
}

/// Period and swing of y of a motion that hunts, between its last two upward crossings of y = 0.02.
struct Hunting {
  double period = 0.0, high = 0.0, low = 0.0;
  Status status = Status::converged;
  long steps = 0;
};

Hunting hunt(const Loop& loop, double duration, double rtol = 1e-9) {
  LoopField field(loop);
  State x(field.size(), 0.0);
  x[0] = 1.0;
  field.start(x, 0.0);
  March march(field, StepperKind::automatic, loop_weights(loop, rtol));
  march.begin(x, 0.0, Section{loop.C_y, 0.02, 1});
  std::vector<double> crossings;
  Hunting result;
  double high = 0.0, low = 0.0;
  while (march.t() < duration && result.status == Status::converged) {
    result.status = march.step(duration);
    const double y = field.y(march.x());
    high = std::max(high, y);
    low = std::min(low, y);
    if (!march.last().on_section) continue;
    crossings.push_back(march.t());
    result.high = high;
    result.low = low;
    high = low = 0.0;
  }
  if (crossings.size() > 1) result.period = crossings.back() - crossings[crossings.size() - 2];
  result.steps = march.steps();
  return result;
}

}  // namespace

TEST_CASE("applied force: gradients of the field in every mode, by state and by time") {
  const State x{0.3, 0.04, 0.2};  // in a band of 0.1
  const auto check = [&](const Loop& loop, std::vector<std::int64_t> modes, State at) {
    LoopField field(loop);
    for (const bool driven : {false, true}) {
      if (driven)
        field.set_external([&](double t, External& value, External& rate) {
          value = loop.external;
          value(external_force) = 0.7 * std::sin(3.0 * t);
          rate = External::Zero();
          rate(external_force) = 2.1 * std::cos(3.0 * t);
        });
      for (const auto mode : modes) {
        CAPTURE(mode, driven);
        field.modes().assign(loop.elements.size(), Mode{mode});
        CHECK(jacobian_defect(field, at, 0.3) < 1e-8);
      }
    }
  };
  check(servo(banded<Quinn<double>>(0.1, 1.5, 1.0, 0.2, 0.4)), {0, 1, 2, 3, -1, -2, -3}, x);
  check(servo(banded<Awrejcewicz<double>>(0.1, 1.5, 1.0, 0.2, 0.4)), {0, 1, 2, 3, -1, -2, -3}, x);
  check(servo(banded<Karnopp<double>>(0.1, 1.5, 1.0, 0.2, 0.4)), {0, 1, 2, -1, -2}, x);
  check(servo(wojewoda(1.5, 1.0, 0.2, 20.0)), {0, 1, 2, 3, -1, -2, -3}, {0.3, 0.04, 0.2, 0.03});
  // Two masses: the drive of the motor holds the force of the spring.
  LoopParts parts;
  parts.plant = TwoMass{1.0, 2.0, 50.0, 0.3};
  parts.controller = pid(3.0, 4.0, 6.0);
  parts.friction = banded<Quinn<double>>(0.1, 1.5, 1.0, 0.2);
  const Loop flexible = build_loop(parts);
  State away(static_cast<std::size_t>(flexible.states()), 0.1);
  for (std::size_t i = 0; i < away.size(); ++i)
    if (flexible.ports[0].C_v(static_cast<Eigen::Index>(i)) != 0.0) away[i] = 0.04;
  check(flexible, {0}, away);
}

TEST_CASE("applied force: beside an element that holds, both are solved for together") {
  // A relay that slides on its own input, together with friction in its band: the relay's output holds the input, the
  // drive contains the relay's output, which contains the friction.
  LoopParts parts;
  parts.plant = Mass{1.0, 0.1, 0.0};
  parts.controller = pid(3.0, 0.0, 0.5);
  parts.element = relay(2.0);
  parts.friction = banded<Quinn<double>>(0.1, 1.5, 1.0, 0.2);
  const Loop loop = build_loop(parts);
  REQUIRE(loop.elements.size() == 2);
  LoopField field(loop);
  const double v = 0.06;
  const State x{-v / 6.0, v};  // 3 y + 0.5 v = 0
  field.modes() = {Mode{2}, Mode{0}};
  State dx;
  field.rate(x, dx, 0.0);
  // The input of the relay stands still: 3 dy/dt + 0.5 dv/dt = 0, so dv/dt = -6 v.
  CHECK(dx[1] == Approx(-6.0 * v));
  // F = (1 - s) (u - c v) + s g and dv/dt = u - c v - F give s (u - c v - g) = -6 v.
  const auto& law = law_of<Quinn<double>>(loop.elements[1]);
  const double s = 0.6, u = law.level(v) - 6.0 * v / s + 0.1 * v;
  CHECK(field.output(0) == Approx(u));
  CHECK(field.input(1).drive == Approx(u - 0.1 * v));
  CHECK(field.output(1) == Approx((1.0 - s) * (u - 0.1 * v) + s * law.level(v)));
  CHECK(jacobian_defect(field, x) < 1e-8);
  // An element other than friction has no applied force.
  parts.controller = pid(3.0, 0.0, 0.0);
  parts.element = banded<Quinn<double>>(1e-3);
  CHECK_THROWS_WITH(build_loop(parts), Catch::Contains("applied force"));
  parts.element = banded<Karnopp<double>>(1e-3);
  CHECK_THROWS_WITH(build_loop(parts), Catch::Contains("applied force"));
}

TEST_CASE("applied force: saltation where Karnopp's law stops the body") {
  const Loop loop = servo(banded<Karnopp<double>>(0.1, 1.5, 1.0, 0.5, 0.4));
  REQUIRE(loop.state_names.size() == 3);
  // Falling to v = dv: stopped, and at rest; stopped and drawn back (y far out); stopped and off again (y far behind).
  check_saltation(loop, {0.1, 0.1003, -0.1}, {Mode{1}}, 0, {Mode{0}}, 1e-6);
  check_saltation(loop, {0.9, 0.1003, -0.1}, {Mode{1}}, 0, {Mode{-2}}, 1e-6);
  check_saltation(loop, {-0.1, -0.1003, 0.1}, {Mode{-1}}, 0, {Mode{0}}, 1e-6);
  // Break-away, and out of the band.
  LoopField field(loop);
  field.modes() = {Mode{2}};
  check_saltation(loop, {-0.8, 0.0998, -0.3}, {Mode{2}}, 0, {Mode{1}}, 1e-6);
  // On stopping, position and integral stay, and deviations of the velocity end.
  State x{0.1, 0.1, -0.1};
  field.modes() = {Mode{1}};
  Eigen::MatrixXd saltation;
  REQUIRE(field.fire(x, 0.0, 0, saltation));
  CHECK(x[0] == 0.1);
  CHECK(std::abs(x[1]) < 1e-17);
  CHECK(x[2] == -0.1);
  CHECK(saltation.row(1).isZero(0.0));
}

TEST_CASE("applied force: saltations of the other laws") {
  const Loop quinn = servo(banded<Quinn<double>>(0.1, 1.5, 1.0, 0.5, 0.4));
  check_saltation(quinn, {0.1, 0.1003, -0.1}, {Mode{1}}, 0, {Mode{0}}, 1e-6);
  check_saltation(quinn, {-0.5, 0.03, -0.1}, {Mode{0}}, 2, {Mode{2}}, 1e-6);
  const Loop jumping = servo(banded<Awrejcewicz<double>>(0.1, 1.5, 1.0, 0.5, 0.4));
  check_saltation(jumping, {0.1, 0.1003, -0.1}, {Mode{1}}, 0, {Mode{0}}, 1e-6);
  const Loop hysteretic = servo(wojewoda(1.5, 1.0, 0.2, 20.0));
  check_saltation(hysteretic, {-0.4, 0.1, 0.0, 0.0}, {Mode{2}}, 1, {Mode{1}}, 1e-6);
  check_saltation(hysteretic, {0.1, 1e-4, 0.0, 0.0}, {Mode{1}}, 1, {Mode{0}}, 1e-6);
  check_saltation(hysteretic, {0.1, 0.1, 0.0, 0.0749}, {Mode{0}}, 0, {Mode{1}}, 1e-6);
}

TEST_CASE("applied force: the stiff stepper keeps its order") {
  const Loop loop = servo(banded<Quinn<double>>(0.2, 1.5, 1.0, 0.5, 0.4));
  LoopField field(loop);
  field.set_external([&](double t, External& value, External& rate) {
    value = loop.external;
    rate = External::Zero();
    value(external_force) = 0.3 * std::sin(5.0 * t);
    rate(external_force) = 1.5 * std::cos(5.0 * t);
  });
  field.modes() = {Mode{0}};
  const auto run = [&](int steps) {
    Rodas5p stepper;
    State x{-0.1, 0.1, 0.05};
    const double h = 0.4 / steps;
    const auto system =
        std::pair([&](const State& at, State& dx, double t) { field.rate(at, dx, t); },
                  [&](const State& at, Eigen::MatrixXd& J, double t, State& dfdt) { field.jacobian(at, J, t, dfdt); });
    for (int i = 0; i < steps; ++i) stepper.do_step(system, x, i * h, h);
    return x;
  };
  const State exact = run(640);
  const auto error = [&](int steps) {
    const State x = run(steps);
    return std::hypot(x[0] - exact[0], x[1] - exact[1], x[2] - exact[2]);
  };
  const double coarse = error(20), fine = error(40);
  CHECK(coarse < 1e-6);
  CHECK(std::log2(coarse / fine) > 4.6);
}

TEST_CASE("applied force: rest without creep") {
  // No integrator: a constant force below Fs, a body that comes to rest.
  const auto rest = [](Element friction, double duration) {
    LoopParts parts;
    parts.plant = Mass{1.0, 0.5, 0.0};
    parts.controller = pid(3.0, 0.0, 0.0);
    parts.friction = std::move(friction);
    const Loop loop = build_loop(parts);
    LoopField field(loop);
    State x{0.6, 0.0};
    field.start(x, 0.0);
    March march(field, StepperKind::automatic, loop_weights(loop, 1e-9));
    march.begin(x, 0.0);
    double half_way = 0.0;
    while (march.t() < duration) {
      REQUIRE(march.step(march.t() < 0.5 * duration ? 0.5 * duration : duration) == Status::converged);
      if (march.t() <= 0.5 * duration) half_way = march.x()[0];
    }
    CHECK(march.steps() < 20000);
    return std::pair(march.x()[1], march.x()[0] - half_way);
  };
  const auto [v_karnopp, creep_karnopp] = rest(banded<Karnopp<double>>(1e-4), 200.0);
  CHECK(std::abs(v_karnopp) < 1e-17);
  CHECK(std::abs(creep_karnopp) < 1e-12);
  const auto [v_quinn, creep_quinn] = rest(banded<Quinn<double>>(1e-4), 200.0);
  CHECK(std::abs(v_quinn) < 1e-13);
  CHECK(std::abs(creep_quinn) < 1e-12);
  // Slows down as 1/t: v = m dv^2/(3 (Fs - |Fe|) t), which moves it on by m dv^2/(3 (Fs - |Fe|)) ln 2 in twice the
  // time.
  const auto [v_slow, creep_slow] = rest(banded<Awrejcewicz<double>>(1e-4), 200.0);
  const double pace = std::abs(v_slow) * 200.0;
  CHECK(pace > 1e-8 / (3.0 * 1.5));
  CHECK(pace < 1e-8 / (3.0 * 0.5));
  CHECK(std::abs(creep_slow) == Approx(pace * std::log(2.0)).epsilon(0.05));
}

TEST_CASE("applied force: the hunting servo as the band shrinks") {
  const Hunting exact = hunt(servo(stribeck(1.5, 1.0, 1e-2)), 200.0);
  REQUIRE(exact.status == Status::converged);
  REQUIRE(exact.period > 1.0);
  const auto apart = [&](Element law) {
    const Hunting found = hunt(servo(std::move(law)), 200.0);
    CHECK(found.status == Status::converged);
    CHECK(found.steps < 40000);
    return std::max({std::abs(found.period / exact.period - 1.0), std::abs(found.high / exact.high - 1.0),
                     std::abs(found.low / exact.low - 1.0)});
  };
  const double karnopp = apart(banded<Karnopp<double>>(1e-3, 1.5, 1.0, 1e-2)),
               quinn = apart(banded<Quinn<double>>(1e-3, 1.5, 1.0, 1e-2)),
               smooth = apart(banded<Awrejcewicz<double>>(1e-3, 1.5, 1.0, 1e-2));
  CAPTURE(karnopp, quinn, smooth);
  CHECK(karnopp < 1e-2);
  CHECK(quinn < 1e-2);
  CHECK(smooth < 1e-2);
  CHECK(apart(banded<Karnopp<double>>(1e-5, 1.5, 1.0, 1e-2)) < 0.02 * karnopp);
  CHECK(apart(banded<Quinn<double>>(1e-5, 1.5, 1.0, 1e-2)) < 0.02 * quinn);
  CHECK(apart(banded<Awrejcewicz<double>>(1e-5, 1.5, 1.0, 1e-2)) < 0.02 * smooth);
}
