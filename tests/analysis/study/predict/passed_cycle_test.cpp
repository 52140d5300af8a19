#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A light axis on soft bristles. Above ki = 802.27 it has a stable symmetric cycle between two unstable ones, each the
/// mirror image of the other, whose range of attraction is a few per cent of the swing wide: no start falls into it.
Loop soft_axis(double ki) {
  ElastoPlastic<double> law;
  law.Fs = law.Fs_minus = 17147.4;
  law.Fc = law.Fc_minus = 7370.63;
  law.vs = 85.2147;
  law.sigma0 = 13971.7;
  law.sigma1 = 10.585;
  LoopParts parts;
  parts.plant = Mass{0.188844, 0.791302, 0.0};
  parts.controller = pid(330.328, ki, 19.0411);
  parts.friction = law;
  return build_loop(parts);
}

}  // namespace

TEST_CASE("predict: an unstable cycle that a motion passes on its way to rest leads to the stable one beside it") {
  const double ki = GENERATE(806.0, 810.3, 814.0);
  INFO("ki = " << ki);
  const Loop loop = soft_axis(ki);
  PredictOptions motions_only;
  motions_only.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
  const PredictReport report = predict(loop, motions_only);
  const auto stable = std::ranges::find(report.cycles, std::optional(true), &Cycle::stable);
  REQUIRE(stable != report.cycles.end());
  CHECK(std::ranges::count(report.cycles, std::optional(false), &Cycle::stable) >= 1);
  CHECK(stable->amplitude == Approx(14.4).epsilon(0.01));
  CHECK(std::abs(stable->multipliers.front()) < 1.0);

  // A motion that begins a thousandth of its swing away comes back to it.
  SettleOptions options = cycle_search(loop, report.search, 1e-8);
  options.known = report.cycles;
  LoopState near = stable->start;
  for (double& x : near.x) x *= 1.001;
  const Settled back = settle(loop, near, options);
  CHECK(back.outcome == Outcome::cycle);
  CHECK(back.known == std::size_t(stable - report.cycles.begin()));
}
