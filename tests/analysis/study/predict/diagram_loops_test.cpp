#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Block block(const std::string& name, BlockKind what, std::vector<SignalSum> inputs) {
  return {name, "diagram." + name, std::move(what), std::move(inputs)};
}
Block friction(const std::string& name, const std::string& body, const Element& law) {
  return {name, "diagram." + name, law, {}, Contact::opposes, body};
}

Block servo_pid(const SignalSum& measured) {
  SignalSum error = measured;
  for (Term& term : error) term.factor *= -1.0;
  error.push_back({1.0, "r", ""});
  return block("pid", Controller(pid(3.0, 4.0, 6.0)), {error});
}

PredictReport predicted(const Diagram& diagram) {
  LoopParts parts;
  parts.diagram = diagram;
  return predict(build_loop(parts), {});
}

/// The servo with ideal stiction (claim B7, first row).
void check_servo(const PredictReport& report) {
  const auto stable = std::ranges::find(report.cycles, std::optional(true), &Cycle::stable);
  REQUIRE(stable != report.cycles.end());
  CHECK(stable->period == Approx(23.36927229).epsilon(1e-8));
  CHECK(stable->amplitude == Approx(0.06724015).epsilon(1e-6));
}

}  // namespace

TEST_CASE("diagram: a second body that is joined to nothing does not change the cycle of the first") {
  Diagram diagram;
  diagram.blocks = {block("a", Plant(Mass{1.0, 0.0, 0.0}), {{{1.0, "pid", ""}}}), servo_pid({{1.0, "a", "y"}}),
                    block("b", Plant(Mass{2.0, 0.3, 5.0}), {{{1.0, "a", "y"}, {-1.0, "a", "y"}}}),
                    friction("fa", "a", coulomb(1.5, 1.0)), friction("fb", "b", coulomb(0.7, 0.7, 0.2))};
  diagram.output = {1.0, "a", "y"};
  diagram.load_on = "a";
  check_servo(predicted(diagram));
}

TEST_CASE("diagram: two equal bodies with equal friction, joined by a spring, move as one") {
  Diagram diagram;
  const auto push = [](const std::string& from, const std::string& to) {
    return SignalSum{{1.0, "pid", ""}, {50.0, to, "y"}, {-50.0, from, "y"}, {20.0, to, "v"}, {-20.0, from, "v"}};
  };
  diagram.blocks = {block("a", Plant(Mass{1.0, 0.0, 0.0}), {push("a", "b")}),
                    block("b", Plant(Mass{1.0, 0.0, 0.0}), {push("b", "a")}),
                    servo_pid({{0.5, "a", "y"}, {0.5, "b", "y"}}), friction("fa", "a", coulomb(1.5, 1.0)),
                    friction("fb", "b", coulomb(1.5, 1.0))};
  diagram.output = {1.0, "b", "y"};
  diagram.load_on = "b";
  check_servo(predicted(diagram));
}

namespace {

/// A servo whose body bears these friction laws.
Diagram servo_under(const std::vector<Element>& laws) {
  Diagram diagram;
  diagram.blocks = {block("a", Plant(Mass{1.0, 0.0, 0.0}), {{{1.0, "pid", ""}}}), servo_pid({{1.0, "a", "y"}})};
  for (std::size_t i = 0; i < laws.size(); ++i)
    diagram.blocks.push_back(friction("f" + std::to_string(i), "a", laws[i]));
  diagram.output = {1.0, "a", "y"};
  diagram.load_on = "a";
  return diagram;
}

Loop loop_of_diagram(const Diagram& diagram) {
  LoopParts parts;
  parts.diagram = diagram;
  return build_loop(parts);
}

}  // namespace

TEST_CASE("diagram: friction laws at one body are their sum, however it is shared out") {
  for (const auto& laws :
       std::vector<std::vector<Element>>{{coulomb(0.9, 0.6), coulomb(0.6, 0.4)},
                                         {coulomb(0.8, 0.3), coulomb(0.7, 0.7)},
                                         {coulomb(1.5 - 1e-3, 1.0 - 1e-3), coulomb(1e-3, 1e-3)},
                                         {coulomb(0.5, 0.4), coulomb(0.6, 0.3), coulomb(0.4, 0.3)}}) {
    CAPTURE(laws.size());
    check_servo(predicted(servo_under(laws)));
  }
}

TEST_CASE("diagram: two Stribeck curves of one velocity are one of the summed levels") {
  const auto one = predicted(servo_under({stribeck(1.5, 1.0, 0.02)}));
  const auto two = predicted(servo_under({stribeck(0.9, 0.5, 0.02), stribeck(0.6, 0.5, 0.02)}));
  REQUIRE(!one.cycles.empty());
  REQUIRE(one.cycles.size() == two.cycles.size());
  for (std::size_t i = 0; i < one.cycles.size(); ++i) {
    CHECK(two.cycles[i].period == Approx(one.cycles[i].period).epsilon(1e-7));
    CHECK(two.cycles[i].amplitude == Approx(one.cycles[i].amplitude).epsilon(1e-6));
    CHECK(two.cycles[i].stable == one.cycles[i].stable);
  }
}

TEST_CASE("diagram: laws between two bodies add up, from whichever body each is measured") {
  const auto joined = [](const std::vector<Block>& laws) {
    Diagram diagram;
    diagram.blocks = {block("a", Plant(Mass{1.0, 0.0, 0.0}), {{{1.0, "pid", ""}}}), servo_pid({{1.0, "a", "y"}}),
                      block("b", Plant(Mass{1.0, 2.0, 1.0}), {{{1.0, "a", "y"}, {-1.0, "a", "y"}}})};
    diagram.blocks.insert(diagram.blocks.end(), laws.begin(), laws.end());
    diagram.output = {1.0, "a", "y"};
    diagram.load_on = "a";
    return predicted(diagram);
  };
  const auto between = [](const std::string& name, const std::string& on, const std::string& against,
                          const Element& law) {
    Block made = friction(name, on, law);
    made.against = against;
    return made;
  };
  const auto one = joined({between("f", "a", "b", coulomb(1.5, 1.0))});
  const auto two = joined({between("f1", "a", "b", coulomb(0.9, 0.6)), between("f2", "b", "a", coulomb(0.6, 0.4))});
  REQUIRE(one.outcomes.size() == two.outcomes.size());
  for (std::size_t i = 0; i < one.outcomes.size(); ++i) CHECK(one.outcomes[i].outcome == two.outcomes[i].outcome);
  REQUIRE(one.cycles.size() == two.cycles.size());
  for (std::size_t i = 0; i < one.cycles.size(); ++i)
    CHECK(two.cycles[i].period == Approx(one.cycles[i].period).epsilon(1e-7));
}

TEST_CASE("diagram: a stuck body shares its force among its laws, and the Jacobian is that of the rates") {
  const Loop loop = loop_of_diagram(servo_under({coulomb(0.9, 0.6), stribeck(0.6, 0.4, 0.02)}));
  LoopField field(loop);
  State x(field.size(), 0.0);
  x[0] = 0.05;  // of the integral or of y: small enough to stick
  field.start(x, 0.0);
  State dx;
  field.rate(x, dx, 0.0);
  CHECK(field.holds(1));
  CHECK_FALSE(field.holds(0));
  CHECK(field.output(0) / 0.9 == Approx(field.output(1) / 0.6));
  for (const int mode : {0, 1, -1}) {
    CAPTURE(mode);
    for (auto& one : field.modes()) one = Mode{mode};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.01 * static_cast<double>(i + 1) * (mode < 0 ? -1.0 : 1.0);
    Eigen::MatrixXd J;
    State time;
    field.jacobian(x, J, 0.0, time);
    for (std::size_t k = 0; k < x.size(); ++k) {
      constexpr double h = 1e-6;
      State above = x, below = x, up, down;
      above[k] += h;
      below[k] -= h;
      field.rate(above, up, 0.0);
      field.rate(below, down, 0.0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
        CHECK(J(row, column) == Approx((up[i] - down[i]) / (2.0 * h)).margin(1e-6));
      }
    }
  }
}

TEST_CASE("diagram: a law that needs the applied force is no second one at a body") {
  auto by_force = with_levels<Karnopp<double>>(0.6, 0.4);
  by_force.dv = 1e-4;
  CHECK_THROWS_WITH(loop_of_diagram(servo_under({coulomb(0.9, 0.6), by_force})),
                    Catch::Matchers::Contains("holds the same body"));
  Diagram apart = servo_under({by_force});
  apart.blocks.push_back(block("b", Plant(Mass{2.0, 0.3, 5.0}), {{{1.0, "a", "y"}, {-1.0, "a", "y"}}}));
  apart.blocks.push_back(friction("fb", "b", coulomb(0.7, 0.7)));
  CHECK_NOTHROW(loop_of_diagram(apart));
}
