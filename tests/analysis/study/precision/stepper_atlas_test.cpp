#include "limcycle/analysis/study/precision/stepper_atlas.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::vector<AtlasLoop> family(const std::string& law, std::vector<double> stiffnesses) {
  std::vector<AtlasLoop> loops = law_families(servo_parts(lugre()));
  std::erase_if(loops, [&](const AtlasLoop& loop) {
    return loop.law != law ||
           (!stiffnesses.empty() && std::ranges::find(stiffnesses, loop.stiffness) == stiffnesses.end());
  });
  return loops;
}

AtlasOptions only(std::vector<std::string> steppers, std::vector<double> settings) {
  AtlasOptions options;
  options.steppers = std::move(steppers);
  options.tolerances = options.steps = std::move(settings);
  options.evaluations = 1e6;
  options.check_steps = 100000;
  return options;
}

const AtlasPoint& find(const StepperAtlas& atlas, double stiffness, const std::string& stepper, double setting) {
  const auto at = std::ranges::find_if(atlas.points, [&](const AtlasPoint& point) {
    return point.stiffness == stiffness && point.stepper == stepper && point.setting == setting;
  });
  REQUIRE(at != atlas.points.end());
  return *at;
}

bool bad(RunClass kind) { return kind != RunClass::right && kind != RunClass::rough && kind != RunClass::too_slow; }

}  // namespace

TEST_CASE("stepper atlas: loose tolerances break stiction early, the more so the stiffer the bristles") {
  const std::vector<double> stiffnesses{1e5, 1e7, 1e8}, tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
  const auto loops = family("lugre", stiffnesses);
  REQUIRE(loops.size() == 3);
  const auto atlas = stepper_atlas(loops, only({"rodas5p", "rodas5p, one atol"}, tolerances));
  CHECK(atlas.status == Status::converged);
  REQUIRE(atlas.references.size() == 3);
  for (const auto& reference : atlas.references) {
    CHECK(reference.verified);
    CHECK(reference.hunts);
    CHECK(reference.agreement < 1e-6);
  }
  CHECK(atlas.references[0].period == Approx(24.436786456).epsilon(1e-8));
  CHECK(atlas.references[2].period == Approx(23.73296).epsilon(1e-5));
  REQUIRE(atlas.points.size() == 30);
  CHECK(find(atlas, 1e8, "rodas5p", 1e-4).kind == RunClass::creeps);
  CHECK(find(atlas, 1e5, "rodas5p", 1e-3).kind == RunClass::right);
  CHECK(find(atlas, 1e5, "rodas5p, one atol", 1e-5).kind == RunClass::creeps);
  CHECK(loosest_right(atlas, "rodas5p", infinite) == 1e-6);
  CHECK(loosest_right(atlas, "rodas5p", 1e5) == 1e-3);
  CHECK(std::isnan(loosest_right(atlas, "euler", infinite)));

  // The notes of the program agree with the results here.
  for (const auto& point : atlas.points) {
    if (point.stepper != "rodas5p") continue;
    INFO(point.stiffness << " N/m, rtol " << point.setting << ": " << to_string(point.kind));
    const auto at = std::ranges::find(loops, point.stiffness, &AtlasLoop::stiffness);
    const bool warned = !stepper_notes(at->loop, StepperKind::rodas5p, point.setting).empty();
    if (bad(point.kind)) CHECK(warned);
    if (point.setting <= 0.1 * loosest_stiff_tolerance(at->loop)) CHECK(point.kind == RunClass::right);
    if (point.setting <= 1e-7) CHECK_FALSE(warned);  // the default
  }
}

TEST_CASE("stepper atlas: explicit steppers become too slow, fixed steps diverge or chatter") {
  auto options = only({"dopri5", "euler", "semi-implicit"}, {1e-3, 1e-4});
  options.steps = {1e-2, 1e-3};
  options.evaluations = 6e5;
  const auto loops = family("lugre", {1e5, 1e7});
  const auto atlas = stepper_atlas(loops, options);
  CHECK(find(atlas, 1e7, "dopri5", 1e-4).kind == RunClass::too_slow);
  CHECK_FALSE(stepper_notes(loops[1].loop, StepperKind::dopri5, 1e-4).empty());
  CHECK(find(atlas, 1e7, "euler", 1e-2).kind == RunClass::diverges);
  CHECK(find(atlas, 1e5, "semi-implicit", 1e-2).kind == RunClass::chatters);
  CHECK(find(atlas, 1e5, "semi-implicit", 1e-3).error < 3e-3);
  // Runs that were too slow do not count.
  CHECK(find(atlas, 1e5, "dopri5", 1e-3).kind == RunClass::right);
  CHECK(loosest_right(atlas, "dopri5", infinite) == 1e-3);
}

TEST_CASE("stepper atlas: dry friction is exact, and the order of Euler's method shows") {
  auto options = only({"exact", "fehlberg78", "euler"}, {1e-3, 1e-8});
  options.steps = {3e-3, 3e-4};
  const auto atlas = stepper_atlas(family("coulomb", {}), options);
  REQUIRE(atlas.points.size() == 6);
  for (const auto& point : atlas.points) {
    CHECK(std::isnan(point.stiffness));
    if (point.stepper == "exact") CHECK(point.error < 1e-13);
    if (point.stepper == "fehlberg78") CHECK(point.kind == RunClass::right);
  }
  CHECK(atlas.points[4].error / atlas.points[5].error == Approx(10.0).epsilon(0.15));
}

TEST_CASE("stepper atlas: where the truth is rest, hunting is the error") {
  const auto atlas = stepper_atlas(family("dahl", {1e5}), only({"rodas5p", "rodas5p, one atol"}, {1e-3, 1e-6}));
  REQUIRE(atlas.references.size() == 1);
  CHECK(atlas.references[0].verified);
  CHECK_FALSE(atlas.references[0].hunts);
  CHECK(find(atlas, 1e5, "rodas5p", 1e-6).kind == RunClass::right);
  CHECK(bad(find(atlas, 1e5, "rodas5p, one atol", 1e-3).kind));
}

TEST_CASE("stepper atlas: the same whatever the threads, and it can be stopped") {
  auto options = only({"rodas5p"}, {1e-3, 1e-5});
  const auto loops = family("lugre", {1e5, 1e6});
  const auto one = stepper_atlas(loops, options);
  options.threads = 2;
  const auto two = stepper_atlas(loops, options);
  REQUIRE(one.points.size() == two.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    CHECK(one.points[i].error == two.points[i].error);
    CHECK(one.points[i].steps == two.points[i].steps);
    CHECK(one.points[i].setting == two.points[i].setting);
  }
  int asked = 0;
  options.threads = 1;
  options.stop = [&] { return ++asked > 3; };
  const auto ended = stepper_atlas(loops, options);
  CHECK(ended.status == Status::interrupted);
  CHECK(ended.points.size() < one.points.size());
}

TEST_CASE("stepper atlas: families keep the levels of the case") {
  LoopParts parts = servo_parts(stribeck(2.0, 1.2, 0.01));
  for (const auto& loop : law_families(parts)) {
    const double output = loop.loop.elements.back().scales().output;
    CHECK(output == Approx(2.0));
    if (loop.law == "lugre") CHECK(law_of<LuGre<double>>(loop.loop.elements.back()).sigma0 == loop.stiffness);
  }
  CHECK(own_law(parts).size() == 1);  // has no sigma0
  CHECK(own_law(servo_parts(lugre())).size() == 6);
  LoopParts without;
  without.plant = Mass{1.0, 0.0, 0.0};
  without.element = relay(1.0);
  CHECK_THROWS_AS(own_law(without), std::invalid_argument);
}

TEST_CASE("stepper atlas: predict takes a tighter tolerance where bristles need it, and says so") {
  const auto hunt = [](double sigma0) {
    auto law = lugre();
    law.sigma0 = sigma0;
    law.sigma1 = std::sqrt(sigma0);
    PredictOptions options;
    options.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
    options.starts = 1;
    return predict(servo(law), options);
  };
  const auto told = [](const PredictReport& report) {
    return std::ranges::any_of(report.notes,
                               [](const auto& note) { return note.find("breaks stiction") != note.npos; });
  };
  const auto usual = hunt(1e7), stiff = hunt(1e9);
  CHECK_FALSE(told(usual));
  CHECK(told(stiff));
  REQUIRE(stiff.cycles.size() == 1);
  CHECK(stiff.cycles[0].period == Approx(23.73).epsilon(1e-3));  // 23.748 at 1e7, 23.733 at 1e8
}
