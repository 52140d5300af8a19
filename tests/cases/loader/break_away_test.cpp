/// A loop as slots and as a diagram, whose states stand in another order: roundings must not decide how it ends.
#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/models/loop.hpp"

using namespace limcycle;

namespace {

// Loop 1 of seed 424242 of tests/random_loops.
constexpr const char* slots = R"(
[loop]
load = -0.0153034
[loop.plant]
kind = "mass"
mass = 0.169843
[loop.controller]
kind = "pid"
kp = 0.362482
ki = 0.0607073
kd = 0.523559
lag = 0.00987823
[loop.friction]
kind = "stribeck"
Fc = 0.026002
Fs = 0.0575914
sigma2 = 0.00595003
vs = 0.000670647
delta = 0.7
)";

constexpr const char* diagram = R"(
[diagram]
output = "axis.y"
[[diagram.block]]
name = "control"
input = "r - axis.y"
kind = "pid"
kp = 0.362482
ki = 0.0607073
kd = 0.523559
lag = 0.00987823
[[diagram.block]]
name = "axis"
input = "control + weight"
kind = "mass"
mass = 0.169843
[[diagram.block]]
name = "weight"
kind = "constant"
value = -0.0153034
[[diagram.block]]
name = "rub"
on = "axis"
kind = "stribeck"
Fc = 0.026002
Fs = 0.0575914
sigma2 = 0.00595003
vs = 0.000670647
delta = 0.7
)";

Settled settled(const char* text, double start) {
  const Loop loop = build_loop(need_loop(read_case(text, "a.toml")));
  SettleOptions options;
  options.amplitude_floor = 4e-7;
  options.amplitude_ceiling = 4e3;
  return settle(loop, displaced(loop, start), options);
}

}  // namespace

TEST_CASE("break-away: a body leaves rest with no velocity, to the last bit, wherever its velocity stands") {
  for (const double start : {0.4588, 0.04588, 0.0004588}) {
    INFO("from " << start);
    const Settled one = settled(slots, start), other = settled(diagram, start);
    REQUIRE(one.outcome == Outcome::cycle);
    REQUIRE(other.outcome == Outcome::cycle);
    CHECK(other.shot->cycle.period == Approx(one.shot->cycle.period).epsilon(1e-8));
    CHECK(other.shot->cycle.amplitude == Approx(one.shot->cycle.amplitude).epsilon(1e-8));
    CHECK(one.shot->cycle.period == Approx(74.323863).epsilon(1e-6));
  }
}
