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
