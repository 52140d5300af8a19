#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/branch/continuation.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("branch: a corner at which sticking begins makes no unstable cycle stable") {
  // The unstable cycle does not stick, the stable one does; they merge at Fs = 0.042625 N.
  const auto belt_at = [](double Fs) {
    Stribeck<double> law;
    law.Fc = law.Fc_minus = 0.0388853;
    law.Fs = law.Fs_minus = Fs;
    law.vs = 4.71949;
    law.delta = 1.0;
    LoopParts parts;
    parts.plant = Belt{1.49285e-06, 0.100177, 2.98572e-05, 34.6957};
    parts.friction = law;
    return build_loop(parts);
  };
  const PredictReport report = predict(belt_at(0.0525499));
  const auto unstable = std::ranges::find(report.cycles, std::optional<bool>(false), &Cycle::stable);
  REQUIRE(unstable != report.cycles.end());
  ContinuationOptions options;
  options.from = 0.03;
  options.to = 0.06;
  const Branch branch =
      continue_cycle([&](double Fs) -> std::optional<Loop> { return belt_at(Fs); }, *unstable, 0.0525499, options);
  REQUIRE(branch.points.size() > 10);
  for (const BranchPoint& point : branch.points) {
    INFO("Fs = " << point.parameter);
    CHECK(point.cycle.stable == false);
  }
  for (const BranchEvent& event : branch.events) CHECK(event.type == BranchEvent::Type::end);
  const auto corner = std::ranges::min_element(branch.points, {}, &BranchPoint::parameter);
  CHECK(corner->parameter == Approx(0.0426249).epsilon(1e-5));
}
