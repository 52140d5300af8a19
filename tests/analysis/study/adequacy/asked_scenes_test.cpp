#include "limcycle/analysis/study/adequacy/asked_scenes.hpp"

#include <catch2/catch.hpp>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

PredictOptions quick_predict() {
  PredictOptions options;
  options.starts = 1;
  options.search = SearchBox{1e-4, 1.0, 0.05, 50.0};
  return options;
}

}  // namespace

TEST_CASE("asked scenes: laws are the same if kind and all parameters are") {
  CHECK(same_law(coulomb(1.5, 1.0, 0.4), coulomb(1.5, 1.0, 0.4)));
  CHECK_FALSE(same_law(coulomb(1.5, 1.0, 0.4), coulomb(1.5, 1.0, 0.5)));
  CHECK_FALSE(same_law(coulomb(1.5, 1.0), stribeck(1.5, 1.0, 1e-3)));
  auto other = stribeck(1.5, 1.0, 1e-3);
  other.curve = {1};
  CHECK_FALSE(same_law(stribeck(1.5, 1.0, 1e-3), other));
  auto one_sided = coulomb(1.5, 1.0);
  one_sided.Fc_minus = 0.9;
  CHECK_FALSE(same_law(coulomb(1.5, 1.0), one_sided));
}

TEST_CASE("asked scenes: a law is asked once at each place") {
  const LoopParts parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  LoopParts heavier = parts;
  heavier.plant = Mass{1.2, 0.0, 0.0};
  AskedScenes asked(quick_predict(), infinite);
  const MethodAnswer& first = asked.ask("simulation", 0, parts, coulomb(1.5, 1.0, 0.4));
  REQUIRE(first.verdict == "cycle");
  CHECK(&asked.ask("simulation", 0, parts, coulomb(1.5, 1.0, 0.4)) == &first);
  const MethodAnswer& elsewhere = asked.ask("simulation", 1, heavier, coulomb(1.5, 1.0, 0.4));
  CHECK(&elsewhere != &first);
  CHECK(elsewhere.period != first.period);
  CHECK(asked.ask("simulation", 0, parts, coulomb(1.4, 1.0, 0.4)).period != first.period);
}

TEST_CASE("asked scenes: harmonic balance takes over roots, and their cost") {
  const Loop loop = build_loop(servo_parts(coulomb(1.5, 1.0, 0.4)));
  MethodQuestions together(loop, quick_predict());
  const MethodAnswer df = together.ask("describing-function"),
                     composite = together.ask("composite-describing-function");
  REQUIRE(composite.verdict == "cycle");
  const MethodAnswer balance = together.ask("harmonic-balance"),
                     alone = ask_scene("harmonic-balance", loop, quick_predict());
  CHECK(balance.seconds >= df.seconds + composite.seconds);
  CHECK(balance.answered == alone.answered);
  CHECK(balance.verdict == alone.verdict);
  CHECK(balance.period == alone.period);
  CHECK(balance.amplitude == alone.amplitude);
}

TEST_CASE("asked scenes: who runs out of patience has no answer") {
  MethodQuestions questions(build_loop(servo_parts(lugre())), quick_predict());
  const MethodAnswer answer = questions.ask("shooting", 1e-3);
  CHECK_FALSE(answer.answered);
  CHECK(answer.why == "stopped after 0.001 s of CPU time");
  CHECK(questions.ask("shooting").answered);
}
