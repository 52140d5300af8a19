#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/of_controllers/impulses.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/tests/analysis/motion/one_step.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

namespace {

struct Switch {
  LoopState at;  ///< on the guard, before the switch
  std::size_t guard = 0;
  MatrixXd saltation;   ///< by the field
  MatrixXd difference;  ///< by moving neighbours to the guard, over it, and back for as long
  std::vector<Mode> after;
  RowVectorXd gradient;  ///< of the guard, by differences
};

/// Saltation of a switch of `from`, a state close to the guard, by the field and by differences. `sizes` are those of
/// the deviations.
Switch switched(const Loop& loop, const LoopState& from, std::size_t guard, const State& sizes, double step = 1e-4) {
  LoopField field(loop);
  Switch out;
  out.guard = guard;
  field.modes() = from.modes;
  out.at = {moved(field, from.x, time_to(field, from.x, guard, step)), from.modes};
  const auto n = std::ssize(from.x);
  State x = out.at.x;
  REQUIRE(field.fire(x, 0.0, guard, out.saltation));
  out.after = field.modes();
  const auto over = [&](const State& start) {
    field.modes() = out.at.modes;
    const double t = time_to(field, start, guard, step);
    State y = moved(field, start, t);
    field.fire(y, 0.0, guard);
    CHECK(field.modes() == out.after);
    return moved(field, y, -t);
  };
  out.difference = MatrixXd(n, n);
  out.gradient = RowVectorXd(n);
  std::vector<double> g;
  for (Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    State plus = out.at.x, minus = out.at.x;
    plus[i] += sizes[i];
    minus[i] -= sizes[i];
    const State a = over(plus), b = over(minus);
    for (std::size_t j = 0; j < a.size(); ++j)
      out.difference(static_cast<Index>(j), k) = (a[j] - b[j]) / (plus[i] - minus[i]);
    field.modes() = out.at.modes;
    field.guards(plus, 0.0, g);
    const double up = g[guard];
    field.guards(minus, 0.0, g);
    out.gradient(k) = (up - g[guard]) / (plus[i] - minus[i]);
  }
  return out;
}

/// The two saltation matrices agree, column by column of the deviations' sizes.
void check_agreement(const Switch& one, double accuracy = 1e-6) {
  CAPTURE(one.saltation, one.difference);
  CHECK((one.saltation - one.difference).cwiseAbs().maxCoeff() <
        accuracy * (1.0 + one.difference.cwiseAbs().maxCoeff()));
}

State same(std::size_t n, double size) { return State(n, size); }

}  // namespace

TEST_CASE("saltation: an ideal relay, as claim B1 has it") {
  // 1/(s + 1)^3: S = I + (f+ - f-) C/(C f-).
  const Loop loop = forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  LoopState from{{0.0, 0.2, -0.1}, {Mode{1}}};
  from.x = [&] {  // on y = 0
    Eigen::Vector3d x(0.3, 0.2, -0.1);
    x -= loop.C_y.transpose() * (loop.C_y * x).value() / loop.C_y.squaredNorm();
    return State(x.begin(), x.end());
  }();
  LoopField field(loop);
  State rate;
  field.modes() = from.modes;
  field.rate(from.x, rate, 0.0);
  // The relay switches where -y falls through 0 from above; set its mode accordingly.
  if (field.y_rate(rate) < 0.0) from.modes[0] = Mode{-1};
  const auto one = switched(loop, from, 0, same(3, 1e-5));
  CHECK(one.after[0] == Mode{-from.modes[0].value});
  check_agreement(one);
  field.modes() = one.at.modes;
  field.rate(one.at.x, rate, 0.0);
  const Eigen::Map<const Eigen::Vector3d> before(rate.data());
  const Eigen::Vector3d jump = -2.0 * static_cast<double>(one.at.modes[0].value) * loop.B.col(0);
  const Eigen::Matrix3d expected = Eigen::Matrix3d::Identity() + jump * loop.C_y / (loop.C_y * before).value();
  CHECK((one.saltation - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("saltation: a relay with hysteresis and one with dead zone") {
  const Loop hysteresis = forward(relay(1.0, 0.1), {1.0}, {1.0, 1.0, 0.0});
  const Eigen::RowVectorXd C = hysteresis.C_y;
  REQUIRE(C.cwiseAbs().sum() > 0.0);
  for (const Loop& loop : {hysteresis, forward(relay(1.0, 0.02, 0.05), {1.0}, {1.0, 1.0, 0.0})}) {
    // Every switch that some state just before a guard can make.
    LoopField field(loop);
    for (const std::int64_t mode : {-1, 0, 1}) {
      field.modes() = {Mode{mode}};
      std::vector<double> g;
      State x{0.0, 0.0};
      if (mode == 0 && law_of<Relay<double>>(loop.elements[0]).dead_zone == 0.0) continue;
      for (std::size_t guard = 0; guard < field.guard_count(); ++guard) {
        // Put y on the guard, which is affine in it, with a rate of y.
        field.modes() = {Mode{mode}};
        State at = x;
        const double d = 1e-3;
        field.guards(at, 0.0, g);
        const double g0 = g[guard];
        State along = at;
        for (std::size_t i = 0; i < 2; ++i) along[i] += d * C(static_cast<Index>(i));
        field.guards(along, 0.0, g);
        const double slope = (g[guard] - g0) / d;
        REQUIRE(slope != 0.0);
        for (std::size_t i = 0; i < 2; ++i) at[i] -= g0 / slope * C(static_cast<Index>(i));
        State rate;
        at[C(0) == 0.0 ? 0 : 1] += 0.7;
        field.rate(at, rate, 0.0);
        if (std::abs(field.y_rate(rate)) < 0.1) at[C(0) == 0.0 ? 0 : 1] += 0.7;
        const auto one = switched(loop, {at, {Mode{mode}}}, guard, same(2, 1e-5));
        CHECK_FALSE(one.after[0] == Mode{mode});
        check_agreement(one);
      }
    }
  }
}

TEST_CASE("saltation: Coulomb friction that comes to rest loses the direction of the velocity") {
  const Loop loop = servo(coulomb(1.5, 1.0, 0.4));
  // v falls to 0 at a small drive: it sticks.
  const auto one = switched(loop, {{0.1, 1e-6, 0.05}, {Mode{1}}}, 0, same(3, 1e-5));
  REQUIRE(one.after[0] == Mode{0});
  check_agreement(one);
  CHECK((one.gradient * one.saltation).cwiseAbs().maxCoeff() < 1e-15);  // n S = 0, to the last bit
  CHECK(one.saltation.row(1).cwiseAbs().maxCoeff() < 1e-15);
  Eigen::FullPivLU<MatrixXd> lu(one.saltation);
  lu.setThreshold(1e-10);
  CHECK(lu.rank() == 2);
  // Here nothing else changes: the other states go on at the same rates.
  CHECK(one.saltation(0, 0) == 1.0);
  CHECK(one.saltation(2, 2) == 1.0);
}

TEST_CASE("saltation: Coulomb friction that turns without sticking") {
  const Loop loop = servo(coulomb(1.5, 1.0, 0.4));
  const auto one = switched(loop, {{1.0, 1e-6, 0.0}, {Mode{1}}}, 0, same(3, 1e-5));
  REQUIRE(one.after[0] == Mode{-1});
  check_agreement(one);
  // f jumps by +2 Fc/m (friction turns round) over an acceleration of -3 y - Fc = -4 before: 1 + 2/(-4).
  CHECK(one.saltation(1, 1) == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("saltation: break-away from stiction with Fs > Fc") {
  // Stuck at y = -0.1 with I growing at 0.1/s; guard Fs - drive, drive = 0.3 + 4 I.
  const Loop loop = servo(coulomb(1.5, 1.0));
  const auto one = switched(loop, {{-0.1, 0.0, 0.3 - 1e-7}, {Mode{0}}}, 0, same(3, 1e-5));
  REQUIRE(one.after[0] == Mode{1});
  check_agreement(one);
  // f+ - f- = (0, 0.5, 0); n = -(d drive) = (3, 6, -4), n f- = -0.4.
  CHECK(one.at.x[2] == Approx(0.3).epsilon(1e-12));
  const Eigen::Matrix3d expected =
      Eigen::Matrix3d::Identity() + Eigen::Vector3d(0.0, 0.5, 0.0) * Eigen::RowVector3d(3.0, 6.0, -4.0) / -0.4;
  CHECK((one.saltation - expected).norm() < 1e-12 * expected.norm());
  const auto back = switched(loop, {{0.1, 0.0, -0.3 + 1e-7}, {Mode{0}}}, 1, same(3, 1e-5));
  REQUIRE(back.after[0] == Mode{-1});
  CHECK((back.saltation - one.saltation).norm() < 1e-12 * expected.norm());
  // With Fs = Fc the force does not jump and neither do deviations.
  const auto smooth = switched(servo(coulomb(1.0, 1.0)), {{-0.1, 0.0, 0.175 - 1e-7}, {Mode{0}}}, 0, same(3, 1e-5));
  CHECK((smooth.saltation - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("saltation: saturation and dead zone, whose output is continuous, leave deviations as they are") {
  DeadZone<double> zone;
  zone.half_width = 0.2;
  for (const Element& element : {Element(saturation(0.2)), Element(zone)}) {
    const Loop loop = forward(element, {1.0}, {1.0, 2.0, 1.0});
    LoopField field(loop);
    const Eigen::RowVectorXd C = loop.C_y;
    for (const std::int64_t mode : {-1, 0, 1}) {
      field.modes() = {Mode{mode}};
      for (std::size_t guard = 0; guard < field.guard_count(); ++guard) {
        const double side = mode != 0 ? static_cast<double>(mode) : guard == 0 ? 1.0 : -1.0;
        State at(2, 0.0);
        for (std::size_t i = 0; i < 2; ++i)
          at[i] = -0.2 * side * C(static_cast<Index>(i)) / C.squaredNorm();  // element input -y on a break
        at[C(0) == 0.0 ? 0 : 1] += 0.9;
        const auto one = switched(loop, {at, {Mode{mode}}}, guard, same(2, 1e-5));
        CHECK_FALSE(one.after[0] == Mode{mode});
        check_agreement(one);
        CHECK((one.saltation - MatrixXd::Identity(2, 2)).cwiseAbs().maxCoeff() < 1e-12);
      }
    }
  }
}

TEST_CASE("saltation: backlash that stops driving resets what it holds, one that takes up again does not") {
  Backlash<double> backlash;
  backlash.half_gap = 0.1;
  const Loop loop = forward(backlash, {1.0}, {1.0, 2.0, 1.0});
  const auto n = static_cast<std::size_t>(loop.states());
  LoopField field(loop);
  // A state at which y turns: y' = 0. The input -y stops rising; the backlash, driven upwards, stands from then on.
  Eigen::VectorXd X(2);
  const Eigen::RowVectorXd velocity = loop.ports[0].C_v;
  REQUIRE(velocity.squaredNorm() > 0.0);
  X = Eigen::Vector2d(velocity(1), -velocity(0)).normalized() * 0.6;
  State x{X(0), X(1), 0.123};
  const auto reset = switched(loop, {x, {Mode{1}}}, 0, same(n + 1, 1e-5));
  REQUIRE(reset.after[0] == Mode{0});
  check_agreement(reset);
  CHECK(reset.saltation.col(2).cwiseAbs().maxCoeff() == 0.0);  // what it held before is forgotten
  CHECK((reset.saltation.row(2).head(2) - loop.ports[0].C).cwiseAbs().maxCoeff() < 1e-12);
  // Standing at an output that the input reaches: driven from then on, the output being continuous.
  x = {0.0, 0.0, 0.0};
  const Eigen::RowVectorXd C = loop.ports[0].C;
  X = C.transpose() * 0.5 / C.squaredNorm();
  x[0] = X(0);
  x[1] = X(1);
  x[C(0) == 0.0 ? 0 : 1] += 0.8;
  const double input = C(0) * x[0] + C(1) * x[1];
  x[2] = input - 0.1;
  const auto driven = switched(loop, {x, {Mode{0}}}, 0, same(n + 1, 1e-5));
  REQUIRE(driven.after[0] == Mode{1});
  check_agreement(driven);
}

TEST_CASE("saltation: a reset integrator, ready and waiting, with and without an interval") {
  // 1/(s + 1)^2 on a state with y = 0 that moves. At the reset z shrinks, and a clock begins at the same value whenever
  // that is; while it waits the switch changes nothing.
  for (const double interval : {0.0, 0.3}) {
    ResetIntegrator<double> element;
    element.gain = 2.0;
    element.share = 0.7;
    element.interval = interval;
    const Loop loop = forward(element, {1.0}, {1.0, 2.0, 1.0});
    const Eigen::RowVectorXd C = loop.C_y;
    const Eigen::Vector2d X = Eigen::Vector2d(C(1), -C(0)).normalized() * 0.6;
    State x{X(0), X(1), 0.4};
    if (interval > 0.0) x.push_back(0.0);
    LoopField field(loop);
    State rate;
    field.modes() = {Mode{1}};
    field.rate(x, rate, 0.0);
    const std::int64_t sign = field.y_rate(rate) > 0.0 ? 1 : -1;  // of e = -y before it passes zero
    const auto reset = switched(loop, {x, {Mode{sign}}}, 0, same(x.size(), 1e-5));
    CHECK(reset.after[0] == Mode{interval > 0.0 ? -2 * sign : -sign});
    check_agreement(reset);
    // z+ = 0.3 z-, but a neighbour that is later by dt had 0.7 z- for as long: its rates differ by -B 0.7 z-.
    CHECK(reset.saltation(2, 2) == Approx(0.3).epsilon(1e-12));
    CHECK(reset.saltation(2, 0) == Approx(0.0).margin(1e-12));
    if (interval == 0.0) continue;
    // A neighbour that is ahead passes earlier, and has that much less of the clock left.
    const Eigen::RowVectorXd clock = -static_cast<double>(sign) / std::abs(field.y_rate(rate)) * C;
    CHECK((reset.saltation.row(3).head(2) - clock).cwiseAbs().maxCoeff() < 1e-12);
    x[3] = 0.2;
    const auto passed = switched(loop, {x, {Mode{2 * sign}}}, 0, same(x.size(), 1e-5));
    CHECK(passed.after[0] == Mode{-2 * sign});
    CHECK((passed.saltation - MatrixXd::Identity(4, 4)).cwiseAbs().maxCoeff() < 1e-12);
    const auto ready = switched(loop, {{0.3, 0.2, 0.4, 0.0}, {Mode{2}}}, 1, same(x.size(), 1e-5));
    CHECK(ready.after[0] == Mode{1});
    check_agreement(ready);
    CHECK(ready.saltation.row(3).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("saltation: an impulse begins and ends, and an integral is reset at a stop") {
  // 1/(s + 1)^2 with e = -y; the states are put where the guard is zero.
  const auto on_surface = [](const Loop& loop, double y, double rate) {
    Eigen::Matrix2d rows;
    rows << loop.C_y, loop.C_y * loop.A.topLeftCorner(2, 2);
    return Eigen::Vector2d(rows.partialPivLu().solve(Eigen::Vector2d(y, rate)));
  };
  Impulses<double> impulses;
  impulses.force = 2.0;
  impulses.width = 0.1;
  impulses.pause = 0.5;
  impulses.band = 0.02;
  impulses.speed = 0.3;
  const Loop pulsed = forward(impulses, {1.0}, {1.0, 2.0, 1.0});
  const Eigen::Vector2d leaves = on_surface(pulsed, -0.02, -0.2), stops = on_surface(pulsed, -0.5, -0.3);
  const auto begun = switched(pulsed, {{leaves(0), leaves(1), 0.0}, {Mode{0}}}, 2, same(3, 1e-5));
  CHECK(begun.after[0] == Mode{2});
  check_agreement(begun);
  // A neighbour that begins later by dt has that much more of the impulse left.
  CHECK((begun.saltation.row(2).head(2) - pulsed.C_y / 0.2).cwiseAbs().maxCoeff() < 1e-12);
  const auto stopped = switched(pulsed, {{stops(0), stops(1), 0.0}, {Mode{1}}}, 0, same(3, 1e-5));
  CHECK(stopped.after[0] == Mode{2});
  check_agreement(stopped);
  const auto ended = switched(pulsed, {{0.3, 0.2, 0.0}, {Mode{-2}}}, 0, same(3, 1e-5));
  CHECK(ended.after[0] == Mode{3});
  check_agreement(ended);

  StopResetIntegrator<double> integral;
  integral.gain = 2.0;
  integral.share = 0.7;
  integral.speed = 0.3;
  const Loop reset_loop = forward(integral, {1.0}, {1.0, 2.0, 1.0});
  const Eigen::Vector2d at = on_surface(reset_loop, -0.5, -0.3);
  const auto reset = switched(reset_loop, {{at(0), at(1), -0.4}, {Mode{1}}}, 0, same(3, 1e-5));
  CHECK(reset.after[0] == Mode{0});
  check_agreement(reset);
  CHECK(reset.saltation(2, 2) == Approx(0.3).epsilon(1e-12));
  const auto kept = switched(reset_loop, {{at(0), at(1), 0.4}, {Mode{1}}}, 0, same(3, 1e-5));
  CHECK((kept.saltation - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("saltation: a delayed relay keeps when it was told") {
  DelayedRelay<double> element;
  element.level = 1.0;
  element.delay = 0.5;
  const Loop loop = forward(element, {1.0}, {1.0, 1.0});
  LoopField field(loop);
  State x(field.size(), 0.0);
  x[0] = 0.3;
  field.start(x, 0.0);
  const auto timer = field.first_state(0);
  const State sizes = same(x.size(), 1e-5);
  // The input passes 0: a decision is pending, and a shift of its start shifts its end by as much.
  for (auto& value : x) value = 0.0;
  x[0] = 0.0;
  LoopState from{x, field.modes()};
  const auto told = switched(loop, from, 0, sizes);
  check_agreement(told);
  CHECK(told.saltation.row(static_cast<Index>(timer)).cwiseAbs().maxCoeff() > 0.1);
  // The oldest timer runs out: the output turns, and the other timers move up.
  State later = told.at.x;
  field.modes() = told.at.modes;
  field.fire(later, 0.0, 0);
  later[timer] = 1e-6;
  const std::size_t last = field.guard_count() - 1;
  const auto out = switched(loop, {later, field.modes()}, last, sizes);
  check_agreement(out);
  CHECK(out.saltation(0, static_cast<Index>(timer)) != 0.0);
  CHECK(out.saltation.row(static_cast<Index>(timer)).cwiseAbs().maxCoeff() == 0.0);
}

TEST_CASE("saltation: a compensation that follows friction into rest and out of it") {
  for (const double lag : {0.0, 0.05}) {
    auto parts = servo_parts(coulomb(1.5, 1.0));
    auto controller = pid(3.0, 4.0, 6.0);
    controller.friction_compensation = 0.6;
    controller.lag = lag;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    const std::size_t n = LoopField(loop).size(), friction = loop.elements.size() - 1;
    const auto v =
        static_cast<std::size_t>(std::ranges::find(loop.state_names, std::string("v")) - loop.state_names.begin());
    REQUIRE(v < n);
    for (const double speed : {1e-6, -1e-6}) {  // to rest from both sides
      State x(n, 0.0);
      x[0] = 0.05 * speed / 1e-6;
      x[v] = speed;
      LoopField field(loop);
      field.start(x, 0.0);
      REQUIRE(field.modes()[friction] == Mode{speed > 0.0 ? 1 : -1});
      std::vector<double> g;
      field.guards(x, 0.0, g);
      REQUIRE(g.size() == 1);
      const auto rest = switched(loop, {x, field.modes()}, 0, same(n, 1e-6));
      REQUIRE(rest.after[friction] == Mode{0});
      check_agreement(rest);
      CHECK(rest.saltation.row(static_cast<Index>(v)).cwiseAbs().maxCoeff() < 1e-15);
    }
    // Stuck, the integrator (and the actuator) winding up to a little below break-away.
    LoopField field(loop);
    State x(n, 0.0);
    x[0] = -0.1;
    x[2] = 0.0;
    field.start(x, 0.0);
    REQUIRE(field.modes()[friction] == Mode{0});
    std::vector<double> g;
    field.guards(x, 0.0, g);
    for (long i = 0; i < 2000000 && g[0] > 1e-5; ++i) {
      x = moved(field, x, std::min(1e-2, 0.3 * g[0]));
      field.guards(x, 0.0, g);
    }
    REQUIRE(g[0] <= 1e-5);
    const auto away = switched(loop, {x, field.modes()}, 0, same(n, 1e-6));
    REQUIRE(away.after[friction] == Mode{1});
    check_agreement(away);
    CHECK((away.saltation - MatrixXd::Identity(std::ssize(x), std::ssize(x))).norm() > 0.1);
  }
}

TEST_CASE("saltation: a switch that is grazed has none") {
  const Loop loop = forward(relay(1.0, 0.1), {1.0}, {1.0, 1.0, 0.0});
  LoopField field(loop);
  const Eigen::RowVectorXd C = loop.C_y, velocity = loop.ports[0].C_v;
  REQUIRE(velocity.squaredNorm() > 0.0);
  Eigen::Matrix2d both;
  both << C, velocity;
  const Eigen::Vector2d X = both.inverse() * Eigen::Vector2d(0.1, 0.0);  // y = 0.1 and y' = 0
  State x{X(0), X(1)};
  field.modes() = {Mode{1}};
  MatrixXd saltation;
  CHECK_FALSE(field.fire(x, 0.0, 0, saltation));
}
