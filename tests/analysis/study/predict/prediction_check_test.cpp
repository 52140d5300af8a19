#include "limcycle/analysis/study/predict/prediction_check.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

TEST_CASE(
    "prediction check: a stable cycle at the place of a prediction that is called unstable is what it predicted") {
  LoopParts parts;
  parts.plant = TransferFunction{{2.0}, {1.0, 3.0, 3.0, 1.0}};
  parts.element = test::relay(1.0, 0.1);
  const Loop loop = build_loop(parts);
  PredictOptions options;
  PredictReport found = predict(loop, options);
  REQUIRE(found.predictions.size() >= 1);
  Prediction p = found.predictions.front();
  REQUIRE(p.verdict == Verdict::confirmed);
  REQUIRE(p.stable == true);
  p.stable = false;
  p.verdict = Verdict::undecided;
  p.cycle.reset();
  CycleHunt hunt(loop, options, found.search);
  PredictionCheck check(loop, hunt, 1'000'000, options.stop);
  check.check(p, FirstHarmonicBalance(loop).state(p.input_amplitude, p.frequency), "prediction 0");
  CHECK(p.verdict == Verdict::biased);
  CHECK(p.cycle == 0U);
  CHECK_THAT(p.why, Catch::Matchers::Contains("its stability is wrong"));
}
