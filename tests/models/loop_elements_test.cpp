#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"
#include "limcycle/models/element/of_controllers/output_rate.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/valve_stiction.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;
using Eigen::Index;

namespace {

std::vector<std::string> paths(const Loop& loop) {
  std::vector<std::string> all;
  for (const auto& port : loop.ports) all.push_back(port.path);
  return all;
}

DeadZone<double> dead_zone(double half_width) {
  DeadZone<double> element;
  element.half_width = half_width;
  return element;
}

Quantizer<double> quantizer(double step) {
  Quantizer<double> element;
  element.step = step;
  return element;
}

LoopParts compensated(Element friction, double level) {
  auto parts = servo_parts(std::move(friction));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.friction_compensation = level;
  parts.controller = controller;
  return parts;
}

/// Checks that the elements can be evaluated in order: none reads its own output or a later one.
void check_order(const Loop& loop) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    CHECK(loop.ports[i].D.tail(loop.ports[i].D.size() - static_cast<Index>(i)).isZero(0.0));
}

std::string rule(const LoopParts& parts) {
  const auto broken = validate(parts);
  return broken ? broken->key + ": " + broken->rule : "";
}

}  // namespace

TEST_CASE("friction compensation: added to the command, reads what rubs, shares the selection of a law that sticks") {
  const Loop loop = build_loop(compensated(coulomb(1.5, 1.0), 1.2));
  REQUIRE(paths(loop) == std::vector<std::string>{"loop.controller.friction_compensation", "loop.friction"});
  CHECK(law_of<Compensation<double>>(loop.elements[0]).level == 1.2);
  CHECK(loop.ports[0].selection_of == 1U);
  CHECK_FALSE(loop.ports[1].selection_of);
  CHECK(loop.ports[0].rubs);
  CHECK(loop.ports[1].rubs);
  CHECK(loop.ports[0].C == loop.ports[1].C);
  CHECK(loop.ports[0].C_v == loop.ports[1].C_v);
  for (const double w : {0.1, 2.0, 30.0}) {
    const Complex s(0.0, w), G = s / (s * s * s + 6.0 * s * s + 3.0 * s + 4.0);
    Eigen::Matrix2cd H;
    H << G, -G, G, -G;
    CHECK((loop.element_response(w) - H).norm() < 1e-13);
  }
  CHECK_FALSE(build_loop(compensated(lugre(), 1.2)).ports[0].selection_of);
  CHECK(build_loop(compensated(stribeck(1.5, 1.0, 1e-3), 1.2)).ports[0].selection_of == 1U);
  CHECK(build_loop(compensated(lugre(), 0.0)).elements.size() == 1);
}

TEST_CASE("friction compensation stands before saturation and lag") {
  auto parts = compensated(coulomb(1.5, 1.0), 1.2);
  auto& controller = std::get<Pid>(parts.controller);
  controller.lag = 0.05;
  const Complex s(0.0, 4.0), G = 1.0 / (s * s), C = 3.0 + 4.0 / s + 6.0 * s, lag = 1.0 / (0.05 * s + 1.0);
  Eigen::Matrix2cd H;  // y = G (lag (w0 - C y) - F)
  const Complex closed = G / (1.0 + G * lag * C);
  H << closed * lag, -closed, closed * lag, -closed;
  CHECK((build_loop(parts).element_response(4.0) - H).norm() < 1e-13);
  controller.saturation = 3.0;
  const Loop saturated = build_loop(parts);
  CHECK(paths(saturated) == std::vector<std::string>{"loop.controller.friction_compensation",
                                                     "loop.controller.saturation", "loop.friction"});
  CHECK(saturated.ports[0].selection_of == 2U);
  check_order(saturated);
  Eigen::Matrix3cd K;  // y = G (lag w1 - F), saturation: w0 - C y
  K << 0.0, G * lag, -G, 1.0, -C * G * lag, C * G, 0.0, G * lag, -G;
  CHECK((saturated.element_response(4.0) - K).norm() < 1e-13);
}

TEST_CASE("friction compensation of a mass on a belt reads the velocity against the belt") {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = coulomb(1.5, 1.0);
  NoController controller;
  controller.friction_compensation = 0.5;
  parts.controller = controller;
  const Loop loop = build_loop(parts);
  REQUIRE(loop.elements.size() == 2);
  CHECK(loop.ports[0].c_v(constant_one) == -0.1);
  CHECK(loop.ports[0].C_v == Eigen::RowVector2d(0.0, 1.0));
  CHECK(loop.B == (Eigen::Matrix2d() << 0.0, 0.0, 1.0, -1.0).finished());
}

TEST_CASE("pid: a leak bounds the integral, and without one it is the plain integral") {
  for (const double leak : {0.0, 0.5, 20.0}) {
    Pid controller = pid(3.0, 4.0, 6.0);
    controller.tf = 0.01;
    controller.leak = leak;
    const ControllerModel model = controller.model();
    for (const Complex s : {Complex(0.0, 0.3), Complex(0.2, 7.0)}) {
      const Complex C = 3.0 + 4.0 / (s + leak) + 6.0 * s / (0.01 * s + 1.0);
      CHECK(std::abs(model.ss.at(s)(0, 0) + model.D_rate * s - C) < 1e-12 * std::abs(C));
    }
  }
}

TEST_CASE("element on the error: the controller reads its output") {
  const Complex s(0.0, 3.0), G = 1.0 / (s * s);
  auto parts = servo_parts(coulomb(1.5, 1.0));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.tf = 0.01;
  parts.controller = controller;
  parts.error = quantizer(0.01);
  const Loop filtered = build_loop(parts);
  CHECK(paths(filtered) == std::vector<std::string>{"loop.error", "loop.friction"});
  const Complex C = 3.0 + 4.0 / s + 6.0 * s / (0.01 * s + 1.0);
  Eigen::Matrix2cd H;
  H << -G * C, G, G * C, -G;
  CHECK((filtered.element_response(3.0) - H).norm() < 1e-12 * H.norm());
  CHECK(filtered.ports[0].c(reference_value) == 1.0);
  CHECK(filtered.ports[0].c_v(reference_slope) == 1.0);
  CHECK(filtered.ports[0].C_v.head(2) == Eigen::RowVector2d(0.0, -1.0));
}

TEST_CASE("element on the error: the unfiltered derivative takes the rate of its output") {
  const Complex s(0.0, 3.0), G = 1.0 / (s * s), C = 3.0 + 4.0 / s;
  auto parts = servo_parts(coulomb(1.5, 1.0));
  for (const bool limited : {false, true}) {
    if (limited)
      parts.error = saturation(0.3);
    else
      parts.error = dead_zone(0.02);
    const Loop loop = build_loop(parts);
    REQUIRE(paths(loop) == std::vector<std::string>{"loop.error", "loop.error.rate", "loop.friction"});
    Eigen::Matrix3cd H;
    H << -G * C, -G * 6.0, G, -G * C, -G * 6.0, G, G * C, G * 6.0, -G;
    CHECK((loop.element_response(3.0) - H).norm() < 1e-13 * H.norm());
    const auto& rate = law_of<OutputRate<double>>(loop.elements[1]);
    CHECK(rate.half_width == (limited ? 0.3 : 0.02));
    CHECK(rate.inside == (limited ? 1.0 : 0.0));
    CHECK(rate.outside == (limited ? 0.0 : 1.0));
    CHECK(loop.ports[1].C_v.head(2) == Eigen::RowVector2d(0.0, -1.0));
    CHECK(loop.ports[1].C == loop.ports[0].C);
    // Closing the element with gain 1, and so its rate with s, gives the loop without it: x_F = H_ww w + H_wF F.
    const Complex open = 1.0 / (1.0 - H(0, 0) - s * H(0, 1));
    const Complex closed = H(2, 2) + (H(2, 0) + s * H(2, 1)) * open * H(0, 2);
    CHECK(std::abs(closed - servo(coulomb(1.5, 1.0)).element_response(3.0)(0, 0)) < 1e-13);
  }
}

TEST_CASE("error, compensation, saturation, element and friction stand in one loop, in this order") {
  auto parts = compensated(coulomb(1.5, 1.0), 1.2);
  auto& controller = std::get<Pid>(parts.controller);
  controller.saturation = 3.0;
  parts.error = dead_zone(0.02);
  parts.element = dead_zone(0.1);
  const Loop loop = build_loop(parts);
  CHECK(paths(loop) == std::vector<std::string>{"loop.error", "loop.error.rate",
                                                "loop.controller.friction_compensation", "loop.controller.saturation",
                                                "loop.element", "loop.friction"});
  check_order(loop);
  CHECK(loop.ports[2].selection_of == 5U);
  const Complex s(0.0, 5.0), G = 1.0 / (s * s);
  Eigen::MatrixXcd H = Eigen::MatrixXcd::Zero(6, 6);
  for (const int row : {0, 1}) H(row, 4) = -G, H(row, 5) = G;
  for (const int row : {2, 5}) H(row, 4) = G, H(row, 5) = -G;
  H(3, 0) = 3.0 + 4.0 / s;
  H(3, 1) = 6.0;
  H(3, 2) = 1.0;
  H(4, 3) = 1.0;
  CHECK((loop.element_response(5.0) - H).norm() < 1e-13 * H.norm());
}

TEST_CASE("an element on the error alone makes a loop and without a controller puts out the command") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0, 1.0}, 0.0};
  parts.error = quantizer(0.1);
  const Loop loop = build_loop(parts);
  REQUIRE(loop.elements.size() == 1);
  const Complex s(0.0, 2.0);
  CHECK(std::abs(loop.element_response(2.0)(0, 0) + 1.0 / (s * s + s + 1.0)) < 1e-14);
}

TEST_CASE("rules of compensation and of the element on the error") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0, 0.0}, 0.0};
  Pid controller = pid(1.0, 0.0, 0.5);
  controller.friction_compensation = 1.0;
  parts.controller = controller;
  parts.element = relay(1.0);
  CHECK(rule(parts) == "loop.controller.friction_compensation: has nothing to compensate: add [loop.friction]");
  parts.friction = coulomb(1.0, 1.0);
  CHECK(rule(parts).empty());
  parts.error = quantizer(0.1);
  CHECK(rule(parts) == "loop.controller.tf: must be > 0: kd differentiates the output of the quantizer, which jumps");
  parts.error = Element(Cubic<double>{});
  CHECK(rule(parts).starts_with("loop.controller.tf: must be > 0: kd differentiates the output of the cubic on"));
  CHECK_THROWS_AS(build_loop(parts), std::invalid_argument);
  parts.error = quantizer(0.1);
  controller.tf = 0.01;
  parts.controller = controller;
  CHECK(rule(parts).empty());
  parts.element.reset();
  parts.controller = NoController{};
  CHECK(rule(parts) == "loop.error: needs a controller: with friction alone the error is not used");
  parts.element = Backlash<double>{};
  CHECK(rule(parts) ==
        "loop.element: needs the rate of its input, into which the output of loop.error passes straight: add "
        "loop.controller.lag");
  NoController lagging;
  lagging.lag = 0.1;
  parts.controller = lagging;
  CHECK(rule(parts).empty());
}

TEST_CASE(
    "an element that goes by the way its input moves stands behind none that jumps, nor a valve behind dead time") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0, 0.0}, 0.0};
  Pid controller = pid(1.0, 0.2, 0.0);
  ValveStiction<double> valve;
  valve.S = 0.2;
  valve.J = 0.1;
  Backlash<double> backlash;
  backlash.half_gap = 0.1;
  for (const Element& element : {Element(valve), Element(backlash)}) {
    parts.element = element;
    parts.controller = controller;
    CHECK(rule(parts).empty());
    controller.sample_time = 0.01;
    parts.controller = controller;
    CHECK(rule(parts).starts_with(
        "loop.element: goes by the way its input moves, and the output of loop.controller jumps"));
    controller.sample_time = 0.0;
  }
  parts.controller = controller;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0, 0.0}, 0.5};
  CHECK(rule(parts).empty());  // backlash
  parts.element = valve;
  CHECK(rule(parts).starts_with("loop.element: cannot stand in a loop with dead time"));
}

TEST_CASE("a load with friction, compensation and an element on the error: the integrator carries it at rest") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  parts.load = -9.81;
  parts.reference = 0.3;
  bool exact = false;
  const Loop plain = build_loop(parts);
  const Eigen::VectorXd rest = in_the_case(plain, plain.rest_point(exact));
  CHECK(exact);
  CHECK(rest(0) == Approx(0.3));
  CHECK(4.0 * rest(2) == Approx(9.81));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.friction_compensation = 1.0;
  parts.controller = controller;
  parts.error = dead_zone(0.01);
  const Loop loop = assemble(parts);
  const Eigen::VectorXd still = loop.A * rest + loop.E * loop.external;  // outputs of all elements are 0 there
  CHECK(still.norm() < 1e-12);
  CHECK((loop.ports[0].C * rest + loop.ports[0].c * loop.external).value() == Approx(0.0).margin(1e-14));
}

TEST_CASE("a ramp reference: an element on the error stands still while the loop moves along") {
  auto parts = servo_parts(lugre());
  parts.reference_rate = 0.02;
  parts.error = saturation(0.5);
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.friction_compensation = 0.5;
  parts.controller = controller;
  const Loop loop = build_loop(parts);
  CHECK(loop.ramp_output_rate == Approx(0.02));
  // At the moving point: v = rate, e = 0, the integrator is at zero; states are measured from that motion.
  const Eigen::VectorXd X = Eigen::VectorXd::Zero(3);
  CHECK(in_the_case(loop, X)(1) == Approx(0.02));
  CHECK((loop.A * X + loop.E * loop.external).norm() < 1e-14);
  CHECK((loop.ports[1].C_v * X + loop.ports[1].c_v * loop.external).value() == Approx(0.0).margin(1e-15));
  CHECK((loop.ports[2].C_v * X + loop.ports[2].c_v * loop.external).value() == Approx(0.02));
  parts.plant = Mass{1.0, 0.0, 5.0};  // the integrator can balance the growing force of the spring...
  CHECK(rule(parts).empty());
  CHECK(build_loop(parts).ramp_output_rate == Approx(0.02));
  parts.controller = pid(3.0, 0.0, 6.0);  // ...nothing else can
  CHECK(rule(parts).starts_with("loop.reference: "));
}

TEST_CASE("a ramp reference: a relay that drives an integrator can follow") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 0.0}, 0.0};
  parts.element = relay(1.0);
  parts.reference_rate = 0.25;
  const Loop loop = build_loop(parts);
  CHECK(loop.ramp_output_rate == Approx(0.25));
  // A constant output of the rate of the ramp over the plant's gain keeps the state constant.
  CHECK(std::abs(loop.B(0, 0) * 0.25 + (loop.E * loop.external)(0)) < 1e-15);
}
