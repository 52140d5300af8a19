#include "limcycle/analysis/energy/loop/loop_dissipation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Loop pd(double kd, double sigma2 = 0.4) {
  LoopParts parts = servo_parts(lugre(1.5, 1.0, sigma2));
  parts.controller = pid(3.0, 0.0, kd);
  return build_loop(parts);
}

/// Viscous deficit of LuGre (claim D2): sigma1 (Fs - Fc)/Fc - sigma2.
double deficit_of_lugre(double sigma2) { return std::sqrt(1e5) * 0.5 - sigma2; }

}  // namespace

TEST_CASE("dissipation of a loop: damping in the controller makes up for what the law lacks") {
  LoopDissipationOptions options;
  options.deficit = deficit_of_lugre(0.4);
  const auto decision = [&](const Loop& loop) { return loop_dissipation(loop, options).no_cycle.decision; };
  CHECK(decision(pd(6.0)) == Decision::no);  // not proved, though it comes to rest: the condition is sufficient only
  CHECK(decision(pd(options.deficit - 1e-6)) == Decision::no);
  CHECK(decision(pd(options.deficit + 1e-6)) == Decision::yes);
  CHECK(decision(servo(lugre())) == Decision::no);
  const Loop damped = pd(160.0);
  SettleOptions run;
  run.max_steps = 5000;
  CHECK(settle(damped, displaced(damped, 0.3), run).outcome != Outcome::cycle);
  options.deficit = std::nan("");
  CHECK(decision(pd(160.0)) == Decision::undecided);
}

TEST_CASE("dissipation of a loop: every part of the answer has its reason") {
  for (const Loop& loop :
       {pd(6.0), servo(lugre()), belt(lugre()), forward(saturation(1.0), {2.0}, {1.0, 3.0, 3.0, 1.0}),
        build_loop(parts_of(froude_pendulum(4.0)))}) {
    const LoopDissipation all = loop_dissipation(loop);
    for (const Answer* answer : {&all.rest_is_passive, &all.passivity, &all.no_cycle, &all.stuck.answer,
                                 &all.stuck.attracts, &all.sliding.stable, &all.sector.circle(), &all.sector.popov()})
      CHECK_FALSE(answer->why.empty());
  }
  const LoopDissipation lags = loop_dissipation(forward(saturation(1.0), {2.0}, {1.0, 3.0, 3.0, 1.0}));
  CHECK(lags.no_cycle.decision == Decision::yes);
  CHECK(lags.no_cycle.why.find("circle") != std::string::npos);
}

TEST_CASE("dissipation of a loop: stopped, it says so") {
  LoopDissipationOptions options;
  options.stop = [] { return true; };
  const LoopDissipation all = loop_dissipation(servo(lugre()), options);
  CHECK(all.stuck.answer.decision == Decision::undecided);
  CHECK(all.sliding.stable.why == "interrupted");
}
