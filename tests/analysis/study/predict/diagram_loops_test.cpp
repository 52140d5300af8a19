#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/study/predict/predict.hpp"
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

/// Blocks of a mass under PID control; `push`: what else acts on it.
void add_servo(Diagram& diagram, const std::string& name, const SignalSum& measured, const SignalSum& push) {
  SignalSum error = measured, force = push;
  for (Term& term : error) term.factor *= -1.0;
  error.push_back({1.0, "r", ""});
  force.push_back({1.0, name + "_pid", ""});
  diagram.blocks.push_back(block(name, Plant(Mass{1.0, 0.0, 0.0}), {force}));
  diagram.blocks.push_back(block(name + "_pid", Controller(pid(3.0, 4.0, 6.0)), {error}));
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

TEST_CASE("diagram: a second servo that is joined to nothing does not change the cycle of the first") {
  Diagram diagram;
  add_servo(diagram, "a", {{1.0, "a", "y"}}, {});
  add_servo(diagram, "b", {{1.0, "b", "y"}, {1.0, "a", "y"}, {-1.0, "a", "y"}}, {});
  diagram.blocks.push_back(friction("fa", "a", coulomb(1.5, 1.0)));
  diagram.blocks.push_back(friction("fb", "b", coulomb(1.5, 1.5, 0.2)));
  diagram.output = {1.0, "a", "y"};
  diagram.load_on = "a";
  check_servo(predicted(diagram));
}

TEST_CASE("diagram: two equal bodies with equal friction, joined by a spring, move as one") {
  Diagram diagram;
  const auto spring = [](const std::string& from, const std::string& to) {
    return SignalSum{{50.0, to, "y"}, {-50.0, from, "y"}, {2.0, to, "v"}, {-2.0, from, "v"}};
  };
  const SignalSum middle{{0.5, "a", "y"}, {0.5, "b", "y"}};
  add_servo(diagram, "a", middle, spring("a", "b"));
  add_servo(diagram, "b", middle, spring("b", "a"));
  diagram.blocks.push_back(friction("fa", "a", coulomb(1.5, 1.0)));
  diagram.blocks.push_back(friction("fb", "b", coulomb(1.5, 1.0)));
  diagram.output = {1.0, "b", "y"};
  diagram.load_on = "b";
  check_servo(predicted(diagram));
}
