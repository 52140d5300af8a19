#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "limcycle/models/delay.hpp"
#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;
using Eigen::Index;

namespace {

const std::vector<Complex> places{{0.3, 0.7}, {0.0, 2.0}, {-0.2, 11.0}, {4.0, 0.1}};

SignalSum sum(std::initializer_list<Term> terms) { return terms; }
Term from(const std::string& block, const std::string& output = {}, double factor = 1.0) {
  return {factor, block, output};
}

Block block(const std::string& name, BlockKind what, std::vector<SignalSum> inputs = {}) {
  return {name, "diagram." + name, std::move(what), std::move(inputs)};
}
Block friction_on(const std::string& body, const Element& law) {
  return {"friction", "diagram.friction", law, {}, Contact::opposes, body};
}

Mass mass_of(double mass, double damping = 0.0, double stiffness = 0.0) { return {mass, damping, stiffness}; }

LoopParts drawn(Diagram diagram) {
  LoopParts parts;
  diagram.load_on = diagram.output.block;
  parts.diagram = std::move(diagram);
  return parts;
}

/// A mass with friction under a controller of the error r - y.
Diagram servo_diagram(const Controller& controller, const Element& law) {
  return {{block("axis", Plant(mass_of(1.0)), {sum({from("pid")})}),
           block("pid", controller, {sum({from("r"), from("axis", "y", -1.0)})}), friction_on("axis", law)},
          from("axis", "y")};
}

std::string rule(const Diagram& diagram) {
  const auto broken = validate(drawn(diagram));
  return broken ? broken->key + ": " + broken->rule : "";
}

/// Response of a linear block from its input to its output, by a loop whose relay looks at it.
Complex response(const LinearBlock& what, Complex s) {
  const Diagram diagram{
      {block("relay", Element(relay(1.0)), {sum({from("what")})}), block("what", what, {sum({from("lag")})}),
       block("lag", LinearBlock(LowPass{.time_constant = 1.0}), {sum({from("relay")})})},
      from("lag")};
  return assemble(diagram, 0.0, 0.0).element_response(s)(0, 0) * (s + 1.0);
}

bool is_near(Complex a, Complex b) { return std::abs(a - b) <= 1e-13 * (std::abs(a) + std::abs(b)); }

}  // namespace

TEST_CASE("diagram: the servo as blocks is the servo of the slots, number by number") {
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 8.0;
  controller.lag = 0.02;
  controller.tf = 0.01;
  auto slots = servo_parts(coulomb(1.5, 1.0));
  slots.controller = controller;
  slots.reference = 0.3;
  auto blocks = drawn(servo_diagram(controller, coulomb(1.5, 1.0)));
  blocks.reference = 0.3;
  const Loop a = build_loop(slots), b = build_loop(blocks);
  CHECK(a.A == b.A);
  CHECK(a.B == b.B);
  CHECK(a.E == b.E);
  CHECK(a.C_y == b.C_y);
  CHECK(a.origin == b.origin);
  REQUIRE(a.ports.size() == b.ports.size());
  for (std::size_t i = 0; i < a.ports.size(); ++i) {
    CHECK(a.ports[i].C == b.ports[i].C);
    CHECK(a.ports[i].D == b.ports[i].D);
    CHECK(a.ports[i].C_v == b.ports[i].C_v);
    CHECK(a.ports[i].opposes == b.ports[i].opposes);
  }
  CHECK(b.ports.front().path == "diagram.pid.saturation");
  CHECK(b.state_names == std::vector<std::string>{"axis.y", "axis.v", "pid.I", "pid.e_filtered", "pid.lag.u_lag"});
}

TEST_CASE("diagram: linear blocks have the transfer functions that their equations say") {
  for (const Complex s : places) {
    CHECK(is_near(response(Gain{2.5}, s), 2.5));
    CHECK(is_near(response(SumBlock{}, s), 1.0));
    CHECK(is_near(response(Integrator{.gain = 3.0, .leak = 0.4}, s), 3.0 / (s + 0.4)));
    CHECK(is_near(response(LowPass{.time_constant = 0.2, .gain = 1.7}, s), 1.7 / (0.2 * s + 1.0)));
    CHECK(
        is_near(response(LeadLag{.lead = 0.5, .lag = 0.05, .gain = 2.0}, s), 2.0 * (0.5 * s + 1.0) / (0.05 * s + 1.0)));
    const double w = 3.0, zeta = 0.2, depth = 0.1;
    const Complex over = s * s + 2.0 * depth * zeta * w * s + w * w, under = s * s + 2.0 * zeta * w * s + w * w;
    CHECK(is_near(response(Notch{.frequency = w, .damping = zeta, .depth = depth}, s), over / under));
    CHECK(is_near(response(ProperTransferFunction{{1.0, 2.0}, {1.0, 5.0}}, s), (s + 2.0) / (s + 5.0)));
  }
}

TEST_CASE("diagram: a state space of two inputs and two outputs joins by their numbers") {
  StateSpaceBlock two;
  two.A = Eigen::Matrix2d{{-1.0, 0.3}, {0.0, -2.0}};
  two.B = Eigen::Matrix2d{{1.0, 0.5}, {0.0, 1.0}};
  two.C = Eigen::Matrix2d{{1.0, 0.0}, {0.4, 1.0}};
  const Diagram diagram{
      {block("relay", Element(relay(1.0)), {sum({from("two", "1", -1.0), from("two", "2", 0.5)})}),
       block("two", LinearBlock(two), {sum({from("relay")}), sum({from("two", "x1"), from("relay", "", 3.0)})})},
      from("two", "2")};
  const Loop loop = assemble(diagram, 0.0, 0.0);
  for (const Complex s : places) {
    Eigen::Matrix2cd M = s * Eigen::Matrix2cd::Identity() - two.A.cast<Complex>();
    M.col(0) -= two.B.col(1).cast<Complex>();  // the second input reads x1
    const Eigen::Vector2cd x = M.inverse() * (two.B.col(0) + 3.0 * two.B.col(1)).cast<Complex>();
    const Eigen::Vector2cd y = two.C.cast<Complex>() * x;
    CHECK(is_near(loop.element_response(s)(0, 0), -y(0) + 0.5 * y(1)));
  }
}

TEST_CASE("diagram: a P-PI cascade is the same loop written as a transfer function") {
  // u = (kv + ki/s)(kp e - v), v = s y: from e = -y to u (kv + ki/s)(kp + s)
  const double kp = 30.0, kv = 40.0, ki = 200.0;
  const Diagram cascade{
      {block("position", LinearBlock(Gain{kp}), {sum({from("r"), from("axis", "y", -1.0)})}),
       block("velocity", Controller(pid(kv, ki, 0.0)), {sum({from("position"), from("axis", "v", -1.0)})}),
       block("axis", Plant(mass_of(2.0, 3.0)), {sum({from("velocity")})}), friction_on("axis", coulomb(1.5, 1.0))},
      from("axis", "y")};
  const Loop loop = build_loop(drawn(cascade));
  for (const Complex s : places) {
    const Complex closed = 2.0 * s * s + 3.0 * s + (kv + ki / s) * (kp + s);
    CHECK(is_near(loop.element_response(s)(0, 0), -1.0 / closed));
  }
}

TEST_CASE("cascade: the slot is the P-PI loop of its equation, and back-calculation adds its path") {
  Cascade controller;
  controller.position_kp = 30.0;
  controller.velocity_kp = 40.0;
  controller.velocity_ki = 200.0;
  LoopParts parts;
  parts.plant = mass_of(2.0, 3.0);
  parts.controller = controller;
  parts.friction = coulomb(1.5, 1.0);
  const Loop plain = build_loop(parts);
  CHECK(plain.state_names == std::vector<std::string>{"y", "v", "I_velocity"});
  controller.limit = 50.0;
  controller.anti_windup.index = Cascade::back_calculation;
  parts.controller = controller;
  const Loop limited = build_loop(parts);
  REQUIRE(limited.elements.size() == 2);
  CHECK(limited.ports.front().path == "loop.controller.limit");
  for (const Complex s : places) {
    const Complex pi = 40.0 + 200.0 / s, plant = 1.0 / (2.0 * s * s + 3.0 * s);
    CHECK(is_near(plain.element_response(s)(0, 0), -plant / (1.0 + pi * (30.0 + s) * plant)));
    CHECK(is_near(limited.element_response(s)(0, 0), -40.0 * (30.0 + s) * plant + 200.0 / (40.0 * s + 200.0)));
  }
  parts.reference_rate = 0.1;
  controller.anti_windup.index = 0;
  controller.velocity_feedforward = 1.0;
  parts.controller = controller;
  CHECK_FALSE(validate(parts));
  controller.anti_windup.index = Cascade::clamp;
  parts.controller = controller;
  CHECK_FALSE(validate(parts));
  const Loop clamped = build_loop(parts);
  CHECK(clamped.elements.front().kind() == "clamped-pi");
  CHECK(clamped.elements.front().number("kp") == 40.0);
}

TEST_CASE("diagram: friction between two bodies acts on both, against their relative velocity") {
  const Diagram diagram{{block("a", Plant(mass_of(2.0, 0.0, 5.0)), {sum({from("r")})}),
                         block("b", Plant(mass_of(3.0, 0.1, 7.0)), {sum({from("a", "y")})}),
                         {"f", "diagram.f", Element(coulomb(1.0, 1.0)), {}, Contact::opposes, "a", "b"}},
                        from("b", "y")};
  const Loop loop = assemble(diagram, 0.0, 0.0);
  for (const Complex s : places) {
    const Complex a = -1.0 / (2.0 * s * s + 5.0), b = (a + 1.0) / (3.0 * s * s + 0.1 * s + 7.0);
    CHECK(is_near(loop.element_response(s)(0, 0), a - b));
  }
  CHECK(loop.ports[0].rubs);
}

TEST_CASE("diagram: a dead time behind the plant or as a block of its own is the same, and a relay takes it over") {
  TransferFunction plant;
  plant.numerator = {2.0};
  plant.denominator = {1.0, 1.2, 0.4};
  const Element hysteretic(relay(1.0, 0.1));
  const auto error = [](const std::string& name) { return sum({from("r"), from(name, "", -1.0)}); };
  TransferFunction late = plant;
  late.delay = 0.7;
  const Diagram inside{
      {block("plant", Plant(late), {sum({from("relay")})}), block("relay", hysteretic, {error("plant")})},
      from("plant")};
  const Diagram outside{
      {block("plant", Plant(plant), {sum({from("relay")})}), block("relay", hysteretic, {error("wait")}),
       block("wait", LinearBlock(DelayBlock{0.7}), {sum({from("plant")})})},
      from("plant")};
  const Loop a = build_loop(drawn(inside)), b = build_loop(drawn(outside));
  for (const Complex s : places) CHECK(is_near(a.element_response(s)(0, 0), b.element_response(s)(0, 0)));
  for (const Loop* loop : {&a, &b}) {
    const TimeDomainLoop in_time = in_time_domain(*loop, 6);
    CHECK(in_time.pade_order == 0);
    CHECK(in_time.loop.elements.front().as<DelayedRelay<double>>() != nullptr);
  }
}

TEST_CASE("diagram: a derivative without filter is that of what it reads") {
  DeadZone<double> zone;
  zone.half_width = 0.1;
  auto diagram = servo_diagram(pid(3.0, 4.0, 6.0), coulomb(1.5, 1.0));
  auto slots = servo_parts(coulomb(1.5, 1.0));
  slots.error = zone;
  diagram.blocks[1].inputs = {sum({from("zone")})};
  diagram.blocks.insert(diagram.blocks.begin() + 1,
                        block("zone", Element(zone), {sum({from("r"), from("axis", "y", -1.0)})}));
  const Loop a = build_loop(slots), b = build_loop(drawn(diagram));
  for (const Complex s : places) CHECK((a.element_response(s) - b.element_response(s)).norm() <= 1e-13);
  CHECK(b.ports[1].path == "diagram.zone.rate");
}

TEST_CASE("diagram: what cannot be computed is refused by the name of the block") {
  const Element ideal(relay(1.0));
  const Diagram round{{block("a", LinearBlock(Gain{2.0}), {sum({from("b"), from("relay")})}),
                       block("b", LinearBlock(LeadLag{.lead = 1.0, .lag = 2.0}), {sum({from("a")})}),
                       block("relay", ideal, {sum({from("b")})})},
                      from("b", "u_lag")};
  CHECK(rule(round).find("makes an algebraic loop") != std::string::npos);
  CHECK(rule(round).find("low-pass") != std::string::npos);

  auto jumps = servo_diagram(pid(3.0, 0.0, 6.0), coulomb(1.5, 1.0));
  jumps.blocks[1].inputs = {sum({from("relay")})};
  jumps.blocks.push_back(block("relay", ideal, {sum({from("axis", "y", -1.0)})}));
  CHECK(rule(jumps).starts_with("diagram.pid.tf: must be > 0: kd differentiates relay"));

  const Diagram direct{
      {block("g", Plant(TransferFunction{{1.0}, {1.0, 1.0}}), {sum({from("r")})}), friction_on("g", coulomb(1.0, 1.0))},
      from("g")};
  CHECK(rule(direct).starts_with("diagram.g: needs relative degree 2"));

  const Diagram late{{block("g", Plant(TransferFunction{{1.0}, {1.0, 1.0}, 0.3}), {sum({from("relay")})}),
                      block("wait", LinearBlock(DelayBlock{0.5}), {sum({from("lag")})}),
                      block("lag", LinearBlock(LowPass{.time_constant = 1.0}), {sum({from("g")})}),
                      block("relay", ideal, {sum({from("wait", "", -1.0)})})},
                     from("lag")};
  CHECK(rule(late).starts_with("diagram.wait.delay: must be that of the other dead time"));

  Diagram unknown = servo_diagram(pid(3.0, 4.0, 6.0), coulomb(1.5, 1.0));
  unknown.output = from("axis", "speed");
  CHECK(rule(unknown).starts_with("diagram.axis: has no output \"speed\"; it has y, v"));
}
