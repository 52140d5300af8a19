#include "limcycle/analysis/orbit/settle/settle.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Settled run(const Loop& loop, double displacement, double floor = 1e-7) {
  SettleOptions options;
  options.amplitude_floor = floor;
  options.amplitude_ceiling = 1e4;
  return settle(loop, displaced(loop, displacement), options);
}

}  // namespace

TEST_CASE("stick-slip that decays for ever (Fs = Fc under integral action) is never a cycle") {
  for (const double start : {1.0, 0.01, 1e-4}) {
    CHECK(run(servo(coulomb(1.0, 1.0, 0.4)), start).outcome != Outcome::cycle);
    CHECK(run(servo(lugre(1.0, 1.0)), start).outcome != Outcome::cycle);
    CHECK(run(servo(stribeck(1.0, 1.0, 1e-3)), start).outcome != Outcome::cycle);
  }
}

TEST_CASE("step limit: a motion that has hardly turned is followed four times as long") {
  const Loop loop = servo(lugre());
  const auto followed = [&](std::size_t fewest_turns) {
    SettleOptions options;
    options.max_steps = 300;
    options.fewest_turns = fewest_turns;
    return settle(loop, displaced(loop, 1.0), options);
  };
  const Settled briefly = followed(0), longer = followed(1000);
  CHECK(briefly.outcome == Outcome::undecided);
  CHECK(briefly.steps == 301);
  CHECK((longer.outcome == Outcome::cycle || longer.steps == 1201));
  CHECK(longer.steps > briefly.steps);
}

TEST_CASE("slow hunting is never rest: Fs 1 % and 0.1 % above Fc") {
  // Ideal stiction: amplitude is proportional to Fs - Fc, the waiting time to its inverse (claim B7).
  for (const double excess : {1e-2, 1e-3}) {
    const auto settled = run(servo(coulomb(1.0 + excess, 1.0, 0.4)), 1.0);
    REQUIRE(settled.outcome == Outcome::cycle);
    CHECK(settled.shot->cycle.amplitude == Approx(0.01313061 * excess / 0.1).epsilon(1e-5));
    CHECK(settled.shot->cycle.period * excess == Approx(7.65).epsilon(0.02));
  }
  const auto bristle = run(servo(lugre(1.01, 1.0)), 1.0);
  REQUIRE(bristle.outcome == Outcome::cycle);
  CHECK(bristle.shot->cycle.period > 700.0);
}

TEST_CASE("a cycle whose halves are as large but differ in form is found by the whole map") {
  // Two masses on a stiff spring, Fs twice Fc, in N, m, s: the half map of the settled motion has no fixed point.
  LoopParts parts;
  parts.plant = TwoMass{143.094, 36.8537, 1.41105e8, 9531.94, {1}, {1}};
  parts.controller = pid(1.33191e7, 6.05072e8, 85820.3);
  parts.friction = coulomb(3972.33, 1934.09);
  const Loop loop = build_loop(parts);
  SettleOptions options;
  options.amplitude_floor = 1e-9;
  options.amplitude_ceiling = 10.0;
  const Settled settled = settle(loop, displaced(loop, 8.856e-5), options);
  REQUIRE(settled.outcome == Outcome::cycle);
  CHECK_FALSE(settled.shot->cycle.half_wave_symmetric);
  CHECK(settled.shot->cycle.period == Approx(0.25354608).epsilon(1e-6));
  CHECK(settled.shot->cycle.amplitude == Approx(8.28099e-5).epsilon(1e-5));
}

TEST_CASE("growth like a power of time: shooting in vain takes no more than the motion itself") {
  // A saturated servo just outside its unstable cycle, in N, m, s.
  LoopParts parts;
  parts.plant = Mass{0.0562901, 0.0031086, 0.0};
  Pid controller = pid(1.4743, 1.4051, 0.494994);
  controller.saturation = 1.29358;
  parts.controller = controller;
  auto law = lugre(0.196459, 0.0874896, 0.00662003);
  law.vs = 0.0484253;
  law.sigma0 = 622.469;
  law.sigma1 = 0.0;
  parts.friction = law;
  const Loop loop = build_loop(parts);
  const Settled settled = run(loop, 47.85, 0.01);
  CHECK(settled.outcome == Outcome::divergence);
  CHECK(settled.work < 2 * settled.steps);
}

TEST_CASE("a servo without integral action comes to rest with an error") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(3.0, 0.0, 1.0);
  CHECK(run(build_loop(parts), 2.0).outcome == Outcome::rest);
  parts.friction = lugre();
  CHECK(run(build_loop(parts), 2.0).outcome == Outcome::rest);
}

TEST_CASE("a fast belt slides") {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.5, 2.0};
  parts.friction = lugre();
  CHECK(run(build_loop(parts), 0.0).outcome == Outcome::sliding);
  parts.friction = coulomb(1.5, 1.0);
  CHECK(run(build_loop(parts), 0.0).outcome == Outcome::sliding);
}

TEST_CASE("an unstable loop diverges") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(-3.0, 0.0, 0.0);
  CHECK(run(build_loop(parts), 1.0).outcome == Outcome::divergence);
}

TEST_CASE("a linear-looking decay slower than any patience is not called a cycle") {
  // Undamped-looking oscillator: damping ratio 1e-5, no effective nonlinearity.
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 2e-5, 1.0}, 0.0};
  parts.controller = pid(0.0, 0.0, 0.0);
  parts.element = saturation(1.0);
  CHECK(run(build_loop(parts), 0.5, 1e-3).outcome != Outcome::cycle);
}

TEST_CASE("turning points: confirmed by a return of 3 % of the last swing, small tremble ignored") {
  TurningPoints turning;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 0.01 * i;
    turning.feed(t, std::sin(t) + 2e-3 * std::sin(40.0 * t));
  }
  // After the start (where any reversal counts) one for each half period of the slow sine.
  std::size_t late = 0;
  for (const auto& point : turning.points()) late += point.t > 8.0 ? 1 : 0;
  CHECK(late == 10);
  CHECK(turning.swing(0) == Approx(2.0).epsilon(2e-3));
}

TEST_CASE("a body pushed harder than friction can hold slides away, it does not diverge or stay undecided") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  parts.friction = coulomb(1.0, 1.0, 1.0);
  parts.load = 2.0;
  CHECK(run(build_loop(parts), 0.0).outcome == Outcome::sliding);
  parts.load = 0.5;
  CHECK(run(build_loop(parts), 0.0).outcome == Outcome::rest);
}

TEST_CASE(
    "the tremble of a stiff bristle at the first stop is not rest: hunting at sigma0 = 1e7 is seen from any start") {
  auto law = lugre();
  law.sigma0 = 1e7;
  law.sigma1 = std::sqrt(1e7);
  for (const double start : {1.0, 0.1, 1e-3}) {
    const auto settled = run(servo(law), start, 1e-6);
    REQUIRE(settled.outcome == Outcome::cycle);
    CHECK(settled.shot->cycle.period == Approx(23.748197).epsilon(3e-8));  // measured by another program
  }
}

TEST_CASE("turning points: a ringing that does not die while the body waits is not taken for swings") {
  TurningPoints turning;
  for (int i = 0; i <= 40000; ++i) {
    const double t = 0.001 * i, place = std::clamp(3.0 * std::sin(t), -1.0, 1.0);  // waits at both ends
    turning.feed(t, place + 4e-3 * std::sin(300.0 * t));
  }
  std::size_t late = 0;
  for (const auto& point : turning.points()) late += point.t > 8.0 ? 1 : 0;
  CHECK(late == 9);
}

TEST_CASE("a body that waits for its integrator takes few steps, whatever filter is in the loop") {
  // Slow sliding on a Stribeck curve that is flat at rest creeps to the set-point; 1 micrometre off, the integrator
  // winds up for 1500 s first. The filter of the derivative has 1 ms.
  LoopParts parts;
  parts.plant = Mass{5.0, 2.0, 0.0};
  parts.friction = stribeck(12.0, 8.0, 0.01);
  Pid controller = pid(2000.0, 8000.0, 150.0);
  controller.tf = 1e-3;
  parts.controller = controller;
  for (const double start : {0.1, 1e-4, 1e-6}) {
    const auto settled = run(build_loop(parts), start);
    INFO("start " << start << ": " << settled.why);
    CHECK(settled.outcome == Outcome::rest);
    CHECK(settled.steps < 2000);
    if (start == 1e-6) CHECK(settled.time > 1500.0);
  }
}

TEST_CASE("slow hunting is one swing each way a period, not three") {
  for (const Element& friction : {Element(coulomb(1.5, 1.0, 0.4)), Element(lugre())}) {
    LoopParts parts = servo_parts(friction);
    parts.controller = pid(3.0, 0.04, 1.0);
    const Loop loop = build_loop(parts);
    const auto settled = run(loop, 1.0);
    INFO(settled.why);
    REQUIRE(settled.outcome == Outcome::cycle);
    const Cycle& cycle = settled.shot->cycle;
    CHECK(cycle.period == Approx(1140.0).epsilon(2e-3));  // by simulation
    CHECK(returns_of(choose_section(loop, cycle.trace), cycle.trace) == 1);
  }
}

TEST_CASE("a dead time is not left out silently") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.5};
  parts.element = saturation(1.0);
  const Loop loop = build_loop(parts);
  LoopState start;
  start.x.assign(static_cast<std::size_t>(loop.states()), 0.0);
  start.modes.resize(loop.elements.size());
  CHECK_THROWS_AS(settle(loop, start, {}), std::invalid_argument);
}

TEST_CASE("a thermostat of first order: y turns at corners, by its closed form wherever its set-point is", "[relay]") {
  // Between r - h and r + h at the rate D - y and back at -D - y, for a lag 1/p and a swing D = gain level / p.
  for (const double set : {0.0, 0.005, 0.00989178, -0.0155}) {
    LoopParts parts;
    const double pole = 248.092, gain = 0.0956446, level = 53.5981, h = 0.000881625;
    parts.plant = TransferFunction{{gain}, {1.0, pole}, 0.0};
    parts.element = relay(level, h);
    parts.reference = set;
    const Settled settled = run(build_loop(parts), 1.0, 1e-9);
    CAPTURE(set, settled.why);
    REQUIRE(settled.outcome == Outcome::cycle);
    const double D = gain * level / pole;
    const double period = (std::log((D - set + h) / (D - set - h)) + std::log((D + set + h) / (D + set - h))) / pole;
    CHECK(settled.shot->cycle.period == Approx(period).epsilon(1e-11));
    CHECK(settled.shot->cycle.amplitude == Approx(h).epsilon(1e-11));
    CHECK(settled.shot->cycle.stable == true);
  }
}

TEST_CASE("settle: a body that the command cannot break away rests, however two integrals wind up") {
  Cascade law;
  law.position_kp = 20.0;
  law.position_ki = 3.0;
  law.velocity_kp = 300.0;
  law.velocity_ki = 6000.0;
  law.limit = 30.0;
  LoopParts parts = servo_parts(coulomb(35.0, 20.0));
  parts.plant = Mass{12.0, 5.0, 0.0};
  parts.controller = law;
  const Loop loop = build_loop(parts);
  for (const double start : {1e-3, 1e-5}) CHECK(settle(loop, displaced(loop, start), {}).outcome == Outcome::rest);
}
