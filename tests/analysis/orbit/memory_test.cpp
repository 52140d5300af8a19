#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/loops.hpp"

// Cycles of laws whose memory lasts more than one period: kept states are not dynamics, and several unequal swings may
// make one period.
using namespace limcycle;
using namespace limcycle::test;

namespace {

NonDrift<double> non_drift() {
  return made<NonDrift<double>>({{"Fs", 1.5},
                                 {"Fc", 1.0},
                                 {"vs", 1e-3},
                                 {"Zb", 1e-3},
                                 {"sigma", std::sqrt(1e5)},
                                 {"tau", 2e-3},
                                 {"sigma2", 0.4}});
}

Settled hunting(const Loop& loop, double displacement) {
  SettleOptions options;
  options.amplitude_floor = 1e-6;
  options.amplitude_ceiling = 1e4;
  return settle(loop, displaced(loop, displacement), options);
}

/// Time from one passage of `level`, upwards, to the next, after `wait` of plain simulation.
double plain_period(const Loop& loop, double displacement, double wait, double level, int returns) {
  LoopField field(loop);
  const LoopState start = displaced(loop, displacement);
  field.modes() = start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-10));
  march.begin(start.x, 0.0);
  while (march.t() < wait) REQUIRE(march.step(wait) == Status::converged);
  const LoopState then{march.x(), field.modes()};
  ReturnMap map(loop, Section{loop.C_y, level, 1}, std::nullopt, {1e-10, 200000, {}});
  auto at = map.approach(then);
  double time = 0.0;
  for (int k = 0; k < returns; ++k) {
    at = map(at.state);
    REQUIRE(at.status == Status::converged);
    time += at.time;
  }
  return time;
}

}  // namespace

TEST_CASE("a servo with the non-drift law hunts: one cycle of each history, stable for that history") {
  const Loop loop = servo(non_drift());
  const auto settled = hunting(loop, 0.1);
  REQUIRE(settled.outcome == Outcome::cycle);
  const Cycle& cycle = settled.shot->cycle;
  CHECK(cycle.stable == true);
  CHECK(cycle.remembered > 0);
  for (const auto& value : cycle.multipliers) CHECK(std::abs(value) < 0.01);
  // Plain simulation, without any shooting, gives the same period.
  CHECK(plain_period(loop, 0.1, 300.0, 0.02, 1) == Approx(cycle.period).epsilon(1e-6));

  // Another history, with outer return points moved apart: another cycle close to it, and the map keeps the change.
  LoopState other = cycle.start;
  const auto outer = static_cast<std::size_t>(loop.states()) + 1;
  REQUIRE(other.x[outer] > 0.0);
  other.x[outer] *= 1.001;
  auto shot = shoot(loop, other, choose_section(loop, cycle.trace), false);
  REQUIRE(shot.status == Status::converged);
  CHECK(shot.cycle.start.x[outer] == Approx(other.x[outer]).epsilon(1e-12));
  CHECK(shot.cycle.period == Approx(cycle.period).epsilon(1e-2));
}

TEST_CASE("laws that forget keep all their multipliers") {
  const auto settled = hunting(servo(lugre()), 0.1);
  REQUIRE(settled.outcome == Outcome::cycle);
  CHECK(settled.shot->cycle.remembered == 0);
  CHECK(settled.shot->cycle.multipliers.size() == 3);
}

TEST_CASE("a servo with Xiong's law repeats after three unequal swings each way") {
  // Ten elements, as printed in the source thesis.
  std::vector<double> K, sigma, lambda;
  for (int i = 0; i < 10; ++i) {
    K.push_back(1000.0 + 800.0 * i);
    sigma.push_back(5.0 + 2.5 * i);
    lambda.push_back(0.0955 + 0.001 * i);
  }
  const auto xiong = made<Xiong<double>>({{"K", K},
                                          {"sigma", sigma},
                                          {"lambda", lambda},
                                          {"tau", 0.002},
                                          {"Fs", 1.5},
                                          {"Fc", 1.0},
                                          {"vs", 1e-3},
                                          {"sigma2", 0.4}});
  const Loop loop = servo(xiong);
  const auto settled = hunting(loop, 0.1);
  REQUIRE(settled.outcome == Outcome::cycle);
  const Cycle& cycle = settled.shot->cycle;
  CHECK(cycle.stable == true);
  CHECK(cycle.half_wave_symmetric);
  const int returns = returns_of(choose_section(loop, cycle.trace), cycle.trace);
  CHECK(returns == 3);
  CHECK(plain_period(loop, 0.1, 400.0, choose_section(loop, cycle.trace).level, returns) ==
        Approx(cycle.period).epsilon(1e-6));
}

TEST_CASE("a map of several returns is that many maps, and so are its derivatives") {
  const Loop loop = servo(lugre());
  const auto settled = hunting(loop, 0.1);
  REQUIRE(settled.outcome == Outcome::cycle);
  const Cycle& cycle = settled.shot->cycle;
  const Section section = choose_section(loop, cycle.trace);
  ReturnMap one(loop, section, std::nullopt, {1e-10, 200000, {}, true});
  ReturnMap two(loop, section, std::nullopt, {1e-10, 200000, {}, true, infinite, 2});
  LoopState from = cycle.start;
  from.x[1] *= 1.01;  // off the cycle, on the section
  const auto first = one(from), second = one(first.state), both = two(from);
  REQUIRE(both.status == Status::converged);
  CHECK(both.time == Approx(first.time + second.time).epsilon(1e-12));
  CHECK(both.state.x == second.state.x);
  CHECK((both.derivative - second.derivative * first.derivative).norm() <= 1e-12 * first.derivative.norm());
  LoopState moved = from;
  moved.x[1] *= 1.0 + 1e-5;
  const double change = (two(moved).time - both.time) / (moved.x[1] - from.x[1]);
  CHECK(both.time_gradient(1) == Approx(change).epsilon(1e-3));
}
