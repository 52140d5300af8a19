#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/sampled_response.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;

namespace {

constexpr double tick = 0.02;

Block named_block(const std::string& name, BlockKind what, SignalSum input) {
  return {name, "diagram." + name, std::move(what), {std::move(input)}};
}

/// A mass with friction, the command of which is this block's.
LoopParts axis_under(std::vector<Block> controllers) {
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  diagram.output = {1.0, "axis", "y"};
  diagram.load_on = "axis";
  diagram.blocks.push_back(named_block("axis", Plant(Mass{2.0, 0.5, 0.0}), {{1.0, controllers.back().name, ""}}));
  diagram.blocks.push_back({"friction", "diagram.friction", coulomb(1.5, 1.0), {}, Contact::opposes, "axis"});
  diagram.blocks.insert(diagram.blocks.end(), controllers.begin(), controllers.end());
  return parts;
}

const SignalSum error{{1.0, "r", ""}, {-1.0, "axis", "y"}};

Pid on_computer(Pid controller, double sample_time = tick) {
  controller.sample_time = sample_time;
  return controller;
}

Cascade axis_cascade() {
  Cascade law;
  law.position_kp = 3.0;
  law.velocity_kp = 20.0;
  law.velocity_ki = 50.0;
  law.sample_time = tick;
  return law;
}

/// The same controller in the slots.
LoopParts slots_under(const Controller& controller) {
  LoopParts parts;
  parts.plant = Mass{2.0, 0.5, 0.0};
  parts.controller = controller;
  parts.friction = coulomb(1.5, 1.0);
  return parts;
}

Complex friction_response(const LoopParts& parts, Complex s) { return build_loop(parts).element_response(s)(0, 0); }

Complex hold(Complex s, double T) { return (1.0 - std::exp(-s * T)) / (s * T); }

const std::vector<Complex> at_places{{0.0, 0.3}, {0.0, 2.0}, {0.0, 40.0}, {-0.2, 5.0}, {1.0, 0.0}};

}  // namespace

TEST_CASE("sampled response: a PID at its ticks is its pulse transfer function behind a hold") {
  Pid controller = on_computer(pid(30.0, 40.0, 6.0));
  controller.computation_delay = 0.3 * tick;
  for (const Complex s : at_places) {
    const Complex z = std::exp(s * tick), K = 30.0 + 40.0 * tick * z / (z - 1.0) + 6.0 * (1.0 - 1.0 / z) / tick;
    const Complex C = hold(s, tick) * std::exp(-s * 0.3 * tick) * K;
    CAPTURE(s);
    CHECK(std::abs(friction_response(slots_under(controller), s) * (2.0 * s * s + 0.5 * s + C) + 1.0) < 1e-10);
  }
}

TEST_CASE("sampled response: a cascade of two rates, its velocity differenced") {
  Cascade law = axis_cascade();
  law.position_every = 4.0;
  law.velocity_window = 2.0;
  for (const Complex s : at_places) {
    const Complex z = std::exp(s * tick), PI = 20.0 + 50.0 * tick * z / (z - 1.0);
    const Complex older = 0.25 * (1.0 + 1.0 / z + std::pow(z, -2.0) + std::pow(z, -3.0));
    const Complex speed = (1.0 - 1.0 / (z * z)) / (2.0 * tick);
    const Complex C = hold(s, tick) * PI * (3.0 * older + speed);
    CAPTURE(s);
    CHECK(std::abs(friction_response(slots_under(law), s) * (2.0 * s * s + 0.5 * s + C) + 1.0) < 1e-10);
  }
}

TEST_CASE("sampled response: a limit that holds the integral back is an element between command and hold") {
  Cascade law = axis_cascade();
  law.limit = 5.0;
  law.anti_windup.index = Cascade::back_calculation;
  const Loop loop = build_loop(slots_under(law));
  REQUIRE(loop.elements.size() == 2);  // the limit, friction
  REQUIRE(loop.ports[0].path == "loop.controller.limit");
  for (const Complex s : at_places) {
    // u = (kp + ki T) e + ki I, z I = I + T e + (T/kp) (v - u); e = -(3 + s) y; u is limited to v, which is held.
    const Complex z = std::exp(s * tick), h = hold(s, tick), P = 1.0 / (2.0 * s * s + 0.5 * s);
    const double a = 50.0 * tick / 20.0;
    const Eigen::MatrixXcd H = loop.element_response(s);
    for (int k = 0; k < 2; ++k) {
      const Complex v = k == 0 ? 1.0 : 0.0, F = k == 0 ? 0.0 : 1.0;
      const Complex y = P * (h * v - F), e = -(3.0 + s) * y;
      const Complex u = ((20.0 * (z - 1.0) + 50.0 * tick * z) * e + a * v) / (z - 1.0 + a);
      CAPTURE(s, k);
      CHECK(std::abs(H(1, k) - y) < 1e-10 * std::abs(y));
      CHECK(std::abs(H(0, k) - u) < 1e-10 * std::abs(u));
    }
  }
}

TEST_CASE("sampled response: it tends to that of the continuous controller, and the average is right to first order") {
  double last = 0.0, last_average = 0.0;
  for (const double h : {0.02, 0.01, 0.005}) {
    const Complex s{0.0, 3.0};
    const LoopParts continuous = slots_under(pid(30.0, 40.0, 6.0));
    const Loop loop = build_loop(slots_under(on_computer(pid(30.0, 40.0, 6.0), h)));
    Loop averaged = loop;
    averaged.sampled.reset();
    const Complex exact = loop.element_response(s)(0, 0);
    const double change = std::abs(exact - friction_response(continuous, s));
    const double left = std::abs(exact - averaged.element_response(s)(0, 0));
    if (last > 0.0) {
      CHECK(last / change == Approx(2.0).epsilon(0.05));
      CHECK(last_average / left > 3.5);
    }
    last = change;
    last_average = left;
  }
}

TEST_CASE("sampled diagram: one PID at its ticks is the loop of the slots") {
  Pid controller = on_computer(pid(30.0, 40.0, 6.0));
  controller.input_step = 1e-3;
  controller.output_step = 1e-2;
  controller.computation_delay = 0.3 * tick;
  controller.velocity_window = 3.0;
  const Loop slots = build_loop(slots_under(controller));
  const Loop diagram = build_loop(axis_under({named_block("pid", Controller(controller), error)}));
  REQUIRE(diagram.sampled);
  REQUIRE(diagram.sampled->elements.size() == slots.sampled->elements.size());
  CHECK(diagram.delay == slots.delay);
  CHECK(diagram.A.isApprox(slots.A, 1e-14));
  CHECK(diagram.A_delayed.isApprox(slots.A_delayed, 1e-14));
  for (const Complex s : at_places) {
    const Complex H = slots.element_response(s)(0, 0);
    CHECK(std::abs(diagram.element_response(s)(0, 0) - H) < 1e-12 * std::abs(H));
  }
}

TEST_CASE("sampled diagram: two PIDs of two rates are the cascade") {
  Cascade law = axis_cascade();
  law.position_every = 4.0;
  law.input_step = 1e-4;
  law.computation_delay = 0.5 * tick;
  Pid position = on_computer(pid(3.0, 0.0, 0.0), 4.0 * tick), velocity = on_computer(pid(20.0, 50.0, 0.0));
  position.input_step = 1e-4;
  velocity.computation_delay = 0.5 * tick;
  const Loop slots = build_loop(slots_under(law));
  for (const bool turned : {false, true}) {  // whichever stands first
    std::vector<Block> blocks{
        named_block("position", Controller(position), error),
        named_block("velocity", Controller(velocity), {{1.0, "position", ""}, {-1.0, "axis", "v"}})};
    LoopParts parts = axis_under(blocks);
    if (turned) std::swap(parts.diagram->blocks[2], parts.diagram->blocks[3]);
    const Loop diagram = build_loop(parts);
    CHECK(diagram.delay == slots.delay);
    for (const Complex s : at_places) {
      const Complex H = slots.element_response(s)(0, 0);
      CHECK(std::abs(diagram.element_response(s)(0, 0) - H) < 1e-11 * std::abs(H));
    }
  }
}

TEST_CASE("sampled diagram: linear blocks on a computer are their difference equations by backward Euler") {
  const LeadLag lead{.lead = 0.4, .lag = 0.05, .gain = 2.0};
  const Notch notch{.frequency = 30.0, .damping = 0.5, .depth = 0.1};
  const Integrator integrator{.gain = 7.0, .leak = 0.3};
  std::vector<Block> blocks{named_block("gain", LinearBlock(Gain{30.0}), error),
                            named_block("lead", LinearBlock(lead), {{1.0, "gain", ""}}),
                            named_block("integrator", LinearBlock(integrator), {{1.0, "lead", ""}}),
                            named_block("notch", LinearBlock(notch), {{1.0, "integrator", ""}, {1.0, "lead", ""}})};
  for (Block& block : blocks) block.sampling.sample_time = tick;
  blocks.back().sampling.computation_delay = 0.4 * tick;
  const LoopParts parts = axis_under(blocks);
  REQUIRE_FALSE(validate(parts));
  for (const Complex s : at_places) {
    const Complex z = std::exp(s * tick), d = (1.0 - 1.0 / z) / tick;  // of the differences
    const Complex lead_lag = 2.0 * (0.4 * d + 1.0) / (0.05 * d + 1.0), sum = 7.0 / (d + 0.3) + 1.0;
    const Complex dip = (d * d + 3.0 * d + 900.0) / (d * d + 30.0 * d + 900.0);
    const Complex C = hold(s, tick) * std::exp(-s * 0.4 * tick) * 30.0 * lead_lag * sum * dip;
    CAPTURE(s);
    const Complex H = friction_response(parts, s);
    CHECK(std::abs(H * (2.0 * s * s + 0.5 * s + C) + 1.0) < 1e-9);
  }
}

TEST_CASE("sampled diagram: where the dead time cannot stand in the plant, a low-pass stands for it to first order") {
  double last = 0.0;
  for (const double h : {0.02, 0.01, 0.005}) {
    // A spring of the continuous part reads the plant too.
    std::vector<Block> blocks{named_block("spring", LinearBlock(LowPass{.time_constant = 0.1}), {{-4.0, "axis", "y"}}),
                              named_block("pid", Controller(on_computer(pid(30.0, 0.0, 6.0), h)), error)};
    LoopParts parts = axis_under(blocks);
    parts.diagram->blocks[0].inputs = {{{1.0, "pid", ""}, {1.0, "spring", ""}}};
    const Loop loop = build_loop(parts);
    CHECK(loop.delay == 0.0);
    Loop averaged = loop;
    averaged.sampled.reset();
    const Complex s{0.0, 3.0};
    const double left = std::abs(loop.element_response(s)(0, 0) - averaged.element_response(s)(0, 0));
    if (last > 0.0) CHECK(last / left > 3.5);
    last = left;
  }
}

TEST_CASE("sampled diagram: rules") {
  const auto rule = [](Pid first, Pid second) {
    const LoopParts parts =
        axis_under({named_block("position", Controller(first), error),
                    named_block("velocity", Controller(second), {{1.0, "position", ""}, {-1.0, "axis", "v"}})});
    const auto broken = validate(parts);
    return broken ? broken->key + ": " + broken->rule : "";
  };
  const Pid slow = on_computer(pid(3.0, 0.0, 0.0), 0.05), fast = on_computer(pid(20.0, 0.0, 0.0), 0.02);
  CHECK(rule(on_computer(slow, 0.06), fast).empty());
  CHECK(rule(slow, fast) ==
        "diagram.position.sample_time: must be a whole multiple of the shortest sample_time in the diagram");
  Pid late = on_computer(slow, 0.06);
  late.computation_delay = 0.03;
  CHECK(rule(late, fast) ==
        "diagram.position.computation_delay: must be less than the shortest sample_time in the diagram where a sampled "
        "block reads position: it reads it one sample late for any delay above 0");
  Pid behind = fast;
  behind.computation_delay = 0.05;
  CHECK(rule(on_computer(slow, 0.06), behind).empty());
  Pid counted = pid(1.0, 0.0, 0.0);
  counted.input_step = 0.1;
  CHECK(rule(counted, fast) == "diagram.position.input_step: needs sample_time: a continuous controller has none");
  LoopParts late_plant = axis_under({named_block("pid", Controller(fast), error)});
  late_plant.diagram->blocks.push_back(named_block("wait", LinearBlock(DelayBlock{0.1}), {{1.0, "axis", "y"}}));
  late_plant.diagram->blocks[2].inputs = {{{-1.0, "wait", ""}}};
  CHECK_FALSE(validate(late_plant));
}
