#include "limcycle/analysis/orbit/derivatives/threshold_derivatives.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/tests/cycle_knobs.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

struct Lost {
  BranchEvent event;
  Cycle cycle;
};

/// Value of a knob at which the stable cycle is lost.
Lost lost(const LoopParts& parts, const Knob& knob, double to) {
  const double at = value(parts, knob);
  ContinuationOptions options;
  options.from = std::min(at, to);
  options.to = std::max(at, to);
  (to > at ? options.downwards : options.upwards) = false;
  options.until_event = true;
  options.accuracy = 1e-9;
  const Cycle first = the_cycle(build_loop(parts), 1.0);
  const Branch branch =
      continue_cycle([&](double p) -> std::optional<Loop> { return with(parts, knob, p); }, first, at, options);
  INFO(branch.why);
  REQUIRE(branch.events.size() >= 1);
  const auto event = std::ranges::find(branch.events, BranchEvent::Type::fold, &BranchEvent::type);
  REQUIRE(event != branch.events.end());
  return {*event, branch.points.at(event->point).cycle};
}

struct Moved {
  double threshold;
  std::vector<ThresholdDerivative> by;
};
Moved moved(const LoopParts& parts, const Knob& knob, double to, const std::vector<Knob>& others) {
  const Lost at = lost(parts, knob, to);
  LoopParts there = parts;
  knob.of(there) = at.event.parameter;
  const auto found = threshold_derivatives(with(there, knob, at.event.parameter), at.cycle, at.event.type,
                                           neighbours(there, {knob})[0], neighbours(there, others));
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  REQUIRE(found.by.size() == others.size());
  return {at.event.parameter, found.by};
}

/// sum_j w_j p_j dp_k/dp_j, and the sum of its errors.
std::pair<double, double> scaled(const Moved& found, const LoopParts& parts, const std::vector<Knob>& others,
                                 const std::vector<double>& weights) {
  double sum = 0.0, error = 0.0;
  for (std::size_t k = 0; k < others.size(); ++k) {
    sum += weights[k] * value(parts, others[k]) * found.by[k].value;
    error += std::abs(weights[k] * value(parts, others[k])) * found.by[k].error;
  }
  return {sum, error};
}

}  // namespace

TEST_CASE("derivatives of a fold: relay with a dead zone, where only the ratio to the level counts") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  parts.element = relay(1.0, 0.0, 0.05);
  const Knob zone = of_relay("dead_zone", &Relay<double>::dead_zone);
  const std::vector<Knob> others{
      of_relay("level", &Relay<double>::level),
      {"gain", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).numerator[0]; }},
      {"lag", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).denominator[1]; }}};
  const auto found = moved(parts, zone, 0.1, others);
  CHECK(found.threshold == Approx(0.08187508078).epsilon(1e-8));
  for (const std::size_t k : {0U, 1U}) {
    CHECK(found.by[k].value == Approx(found.threshold).epsilon(1e-6));
    CHECK(std::abs(found.by[k].value - found.threshold) <= found.by[k].error + 1e-8);
    CHECK(found.by[k].error < 1e-5);
  }
  // By the lag: a difference of two folds found by continuation.
  const auto fold = [&](double lag) {
    LoopParts there = parts;
    others[2].of(there) = lag;
    return lost(there, zone, 0.1).event.parameter;
  };
  const double h = 0.01;
  const double expected =
      (8.0 * (fold(3.0 + h) - fold(3.0 - h)) - (fold(3.0 + 2 * h) - fold(3.0 - 2 * h))) / (12.0 * h);
  CAPTURE(found.by[2].value, expected, found.by[2].error);
  CHECK(found.by[2].value == Approx(expected).epsilon(1e-5));
  CHECK(std::abs(found.by[2].value - expected) <= found.by[2].error + 1e-5 * std::abs(expected));
}

TEST_CASE("derivatives of a fold: where hunting of the LuGre servo ends obeys its scalings, and differences") {
  auto law = lugre();
  law.vs = 0.01;
  auto parts = servo_parts(law);
  parts.controller = pid(3.0, 4.0, 33.0);
  auto knobs = lugre_knobs();  // mass, kp, ki, kd, Fs, Fc, vs, sigma0, sigma1, sigma2
  const Knob kd = knobs[3];
  knobs.erase(knobs.begin() + 3);
  const auto found = moved(parts, kd, 45.0, knobs);
  CHECK(found.threshold == Approx(36.01377176).epsilon(1e-7));
  const double p = found.threshold;
  const auto expect = [&](const std::vector<double>& weights, double whole) {
    const auto [sum, error] = scaled(found, parts, knobs, weights);
    CAPTURE(sum, whole * p, error);
    CHECK(std::abs(sum - whole * p) < 1e-5 * p);
    CHECK(std::abs(sum - whole * p) <= error);
    CHECK(error < 1e-3 * p);
  };
  expect({1, 1, 1, 1, 1, 0, 1, 1, 1}, 1.0);    // all forces
  expect({0, 0, 0, 1, 1, 1, 0, 0, 0}, 0.0);    // all lengths
  expect({2, 0, -1, 0, 0, -1, 0, 1, 1}, 1.0);  // time: kd is a force times a time over a length
  // kd and sigma2 act at one place.
  CHECK(found.by[8].value == Approx(-1.0).epsilon(1e-6));
  CHECK(std::abs(found.by[1].value * 3.0) > 0.1 * p);

  if (one_in() > 1) return;  // four folds more
  const auto fold = [&](double kp) {
    auto there = parts;
    there.controller = pid(kp, 4.0, 33.0);
    return lost(there, kd, 45.0).event.parameter;
  };
  const double h = 0.01;
  const double expected =
      (8.0 * (fold(3.0 + h) - fold(3.0 - h)) - (fold(3.0 + 2 * h) - fold(3.0 - 2 * h))) / (12.0 * h);
  CAPTURE(found.by[1].value, expected, found.by[1].error);
  CHECK(found.by[1].value == Approx(expected).epsilon(1e-4));
}

TEST_CASE("derivatives of a change of stability: a mode beside the cycle, in closed form") {
  // The relay's cycle drives a mode with poles -c +- j 1.1, c = a + 2 b, and is not affected by it: |m| = e^{-cT}.
  const auto loop_at = [](double a, double b) {
    StateSpacePlant plant;
    const double c = a + 2.0 * b;
    plant.A.resize(5, 5);
    plant.A << -3.0, -3.0, -1.0, 0.0, 0.0,  //
        1.0, 0.0, 0.0, 0.0, 0.0,            //
        0.0, 1.0, 0.0, 0.0, 0.0,            //
        0.0, 0.0, 0.0, -c, 1.1,             //
        1.0, 0.0, 0.0, -1.1, -c;
    plant.B = Eigen::VectorXd::Unit(5, 0);
    plant.C = Eigen::RowVectorXd::Unit(5, 2);
    LoopParts parts;
    parts.plant = plant;
    parts.element = relay(1.0, 0.02);
    return build_loop(parts);
  };
  const Cycle damped = the_cycle(loop_at(0.3, 0.1), 1.0);
  const Loop there = loop_at(-0.2, 0.1);
  const auto shot = shoot(there, damped.start, choose_section(there, damped.trace), damped.half_wave_symmetric, {});
  REQUIRE(shot.status == Status::converged);
  REQUIRE(std::abs(std::abs(shot.cycle.multipliers.at(0)) - 1.0) < 1e-8);
  const double step = 1e-6;
  const ParameterNeighbours own{loop_at(-0.2 - step, 0.1), loop_at(-0.2 + step, 0.1), step, -0.2};
  const std::vector<ParameterNeighbours> others{{loop_at(-0.2, 0.1 - step), loop_at(-0.2, 0.1 + step), step, 0.1}};
  const auto found = threshold_derivatives(there, shot.cycle, BranchEvent::Type::stability, own, others);
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  CHECK(found.by.at(0).value == Approx(-2.0).epsilon(1e-6));
  CHECK(std::abs(found.by[0].value + 2.0) <= found.by[0].error);
  CHECK(found.by[0].error < 1e-2);

  // The cycle before the change has no derivative, neither for a change of stability nor for a fold.
  CHECK(threshold_derivatives(there, damped, BranchEvent::Type::stability, own, others).status == Status::stalled);
  CHECK(threshold_derivatives(loop_at(0.3, 0.1), damped, BranchEvent::Type::fold, own, others).status ==
        Status::stalled);
  CHECK(threshold_derivatives(there, damped, BranchEvent::Type::end, own, others).status == Status::undefined);
}
