#include "limcycle/analysis/study/adequacy/adequate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>

#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/kikuuwe.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

const SimplifiedLaw& rung(const std::vector<SimplifiedLaw>& ladder, std::string_view name) {
  const auto found = std::ranges::find(ladder, name, &SimplifiedLaw::name);
  REQUIRE(found != ladder.end());
  return *found;
}

const AdequatePoint& point(const AdequateReport& report, std::string_view law, std::string_view method) {
  const auto found = std::ranges::find_if(
      report.points, [&](const AdequatePoint& one) { return one.law == law && one.method == method; });
  REQUIRE(found != report.points.end());
  return *found;
}

AdequateOptions quick() {
  AdequateOptions options;
  options.predict.starts = 1;
  options.predict.search = SearchBox{1e-4, 1.0, 0.05, 50.0};
  options.spread = 0.0;
  options.patience = 60.0;  // verdicts must not depend on the machine
  return options;
}

}  // namespace

TEST_CASE("adequate: each law of the ladder takes over what it can carry, and is valid") {
  const auto own = lugre();
  const auto ladder = simplified_laws(own);
  CHECK(ladder.size() == 8);
  for (const auto& one : ladder) {
    INFO(one.name);
    REQUIRE(one.law);
    CHECK_FALSE(one.rule.empty());
    CHECK_FALSE(one.law->validate());
  }
  CHECK(rung(ladder, "lugre").own);
  CHECK(law_of<Coulomb<double>>(*rung(ladder, "coulomb").law).Fs == 1.0);
  CHECK(law_of<Coulomb<double>>(*rung(ladder, "coulomb + stiction").law).Fs == 1.5);
  CHECK(law_of<Stribeck<double>>(*rung(ladder, "stribeck").law).sigma2 == 0.4);
  CHECK(law_of<Dahl<double>>(*rung(ladder, "dahl").law).Fc == 1.0);
  const auto& gms = law_of<Gms<double>>(*rung(ladder, "multi-state").law);
  double k = 0.0, sigma1 = 0.0;
  for (std::size_t i = 0; i < gms.k.size(); ++i) {
    k += gms.k[i];
    sigma1 += gms.sigma1[i];
  }
  CHECK(k == Approx(own.sigma0));
  CHECK(sigma1 == Approx(own.sigma1));
  // The virgin curve of the non-drift law begins with the stiffness of the bristles.
  const auto& non_drift = law_of<NonDrift<double>>(*rung(ladder, "non-drift").law);
  CHECK(non_drift.Fs * non_drift.shape / -std::expm1(-non_drift.shape) / non_drift.Zb == Approx(own.sigma0));
}

TEST_CASE("adequate: a law that the case's own cannot give is not possible, and says why") {
  const auto from_coulomb = simplified_laws(coulomb(1.5, 1.0, 0.4));
  CHECK(rung(from_coulomb, "coulomb + stiction").own);
  CHECK_FALSE(rung(from_coulomb, "coulomb").own);
  CHECK_FALSE(rung(from_coulomb, "stribeck").law);
  CHECK(rung(from_coulomb, "stribeck").rule == "not possible: the case's law has no Stribeck velocity");
  CHECK(rung(from_coulomb, "dahl").rule == "not possible: the case's law has no bristle stiffness");
  Dahl<double> dahl;
  dahl.Fc = 1.0;
  dahl.sigma0 = 1e4;
  const auto from_dahl = simplified_laws(dahl);
  CHECK(rung(from_dahl, "multi-state").law->kind() == "maxwell-slip");
  Kikuuwe<double> kikuuwe = with_levels<Kikuuwe<double>>(1.5, 1.0);
  kikuuwe.vs = 1e-3;
  kikuuwe.K = 1e4;
  kikuuwe.B = 10.0;
  CHECK(simplified_laws(kikuuwe).back().name == "kikuuwe");
  CHECK(simplified_laws(kikuuwe).back().own);
}

TEST_CASE("adequate: variations move one number and those that follow it") {
  const auto list = law_variations(lugre(), 0.1);
  CHECK(list.size() == 14);  // Fs, Fc, vs, delta, sigma0, sigma1, sigma2
  const auto up = std::ranges::find(list, "Fs +10 %", &LawVariation::name);
  REQUIRE(up != list.end());
  const auto& law = law_of<LuGre<double>>(up->law);
  CHECK(law.Fs == Approx(1.65));
  CHECK(law.Fs_minus == law.Fs);
  CHECK(law.Fc == 1.0);
  // Fs = Fc: neither may cross the other.
  for (const auto& one : law_variations(coulomb(1.0, 1.0), 0.1)) {
    const auto& changed = law_of<Coulomb<double>>(one.law);
    CHECK(changed.Fs >= changed.Fc);
  }
}

TEST_CASE("adequate: hunting on a Stribeck law needs stiction and no more, and the describing function sees no cycle") {
  // vs is so small that the curve is a step: stiction alone is the same law.
  const auto report = adequate(servo_parts(stribeck(1.5, 1.0, 1e-6)), quick());
  REQUIRE(report.status == Status::converged);
  CHECK(report.best.verdict == "cycle");
  CHECK_FALSE(report.verified.empty());
  REQUIRE(report.least);
  CHECK(report.laws[*report.least].name == "coulomb + stiction");
  CHECK(point(report, "coulomb + stiction", "shooting").error < 1e-3);
  CHECK(point(report, "coulomb", "shooting").answer.verdict == "rest");
  CHECK(std::isinf(point(report, "coulomb", "shooting").error));
  CHECK(point(report, "stribeck", "shooting").error == 0.0);
  CHECK(point(report, "stribeck", "simulation").within);
  const auto& df = point(report, "coulomb + stiction", "describing-function");
  CHECK(df.answer.verdict == "no cycle");
  CHECK_FALSE(df.within);
  CHECK(df.why == "finds no cycle, although a cycle exists");
  REQUIRE(report.cheapest);
  const auto& cheapest = report.points[*report.cheapest];
  CHECK(cheapest.within);
  for (const auto& one : report.points)
    if (one.law == cheapest.law && one.within) CHECK(one.answer.seconds >= cheapest.answer.seconds);
}

TEST_CASE("adequate: the spread decides where the own values do not") {
  AdequateOptions options = quick();
  options.spread = 0.4;  // Fs -33 % is refused by the law; Fc -40 % and the rest are not
  options.tolerance = 0.02;
  const auto report = adequate(servo_parts(stribeck(1.5, 1.0, 1e-3)), options);
  REQUIRE(report.status == Status::converged);
  const auto& simple = point(report, "coulomb + stiction", "shooting");
  CHECK(simple.error < options.tolerance);  // at the own values
  CHECK(simple.worst > simple.error);       // elsewhere
  CHECK(point(report, "stribeck", "shooting").worst == 0.0);
}

TEST_CASE("adequate: variations that are given, of anything in the loop, take the place of the default spread") {
  AdequateOptions options = quick();
  options.spread = 0.4;
  options.tolerance = 0.05;
  options.spread_rule = "two plants";
  const auto own = servo_parts(stribeck(1.5, 1.0, 1e-3));
  CHECK(adequate(own, options).spread.size() > 2);
  auto slow = own, rough = own;
  slow.plant = Mass{1.2, 0.0, 0.0};
  options.variations = {{"heavier", slow}};
  const auto near = adequate(own, options);
  CHECK(near.spread == std::vector<std::string>{"heavier"});
  CHECK(near.spread_rule == "two plants");
  CHECK(point(near, "coulomb + stiction", "shooting").within);
  // A wide Stribeck curve is not the same as stiction: in that corner the simple law fails.
  rough.friction = stribeck(1.5, 1.0, 0.1);
  options.variations.push_back({"wide curve", rough});
  const auto far = adequate(own, options);
  const auto& simple = point(far, "coulomb + stiction", "shooting");
  CHECK(simple.error < options.tolerance);
  CHECK_FALSE(simple.within);
  CHECK(simple.worst_at == "wide curve");
  CHECK(far.laws[*far.least].name == "stribeck");
}

TEST_CASE("adequate: a loop that rests needs the least law there is") {
  const auto report = adequate(servo_parts(coulomb(1.0, 1.0, 0.4)), quick());
  REQUIRE(report.status == Status::converged);
  CHECK(report.best.verdict == "rest");
  REQUIRE(report.least);
  CHECK(report.laws[*report.least].name == "coulomb");
  CHECK(point(report, "coulomb", "describing-function").within);
}

TEST_CASE("adequate: answers are compared by kind first, then by their numbers") {
  MethodAnswer best, answer;
  best.answered = answer.answered = true;
  best.verdict = "cycle/rest";
  best.period = 2.0;
  best.amplitude = 1.0;
  best.first_harmonic = 1.1;
  answer.verdict = "no cycle";
  CHECK(std::isinf(scene_error("simulation", answer, best)));  // it tries every start, too
  CHECK(std::isinf(scene_error("describing-function", answer, best)));
  answer.verdict = "cycle";
  answer.period = 2.02;
  answer.amplitude = answer.first_harmonic = 1.0;
  CHECK(std::isinf(scene_error("simulation", answer, best)));
  answer.verdict = "cycle/no cycle";
  CHECK(scene_error("simulation", answer, best) == Approx(0.01));  // which does not distinguish rest from sliding
  answer.verdict = "cycle";
  CHECK(scene_error("describing-function", answer, best) == Approx(1.0 - 1.0 / 1.1));  // of the first harmonic
  CHECK(std::isinf(scene_error("shooting", answer, best)));                            // which tries every start
  answer.answered = false;
  CHECK(std::isnan(scene_error("simulation", answer, best)));
}

TEST_CASE("adequate: a plain simulation sees what every start comes to, not only the largest") {
  // A motor that gives 4 N: from 100 m and from 10 m it diverges, from nearer it hunts.
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid limited = pid(3.0, 4.0, 6.0);
  limited.saturation = 4.0;
  parts.controller = limited;
  const Loop loop = build_loop(parts);
  PredictOptions options;
  options.search = SearchBox{1e-4, 100.0, 0.01, 100.0};
  options.starts = 3;
  const auto simulated = ask_scene("simulation", loop, options), best = ask_scene("shooting", loop, options);
  INFO(simulated.why << "; " << best.why);
  REQUIRE((simulated.answered && best.answered));
  CHECK(simulated.verdict == "cycle/divergence");
  CHECK(best.verdict == "cycle/divergence");
  CHECK(scene_error("simulation", simulated, best) < 0.02);
  MethodAnswer runaway;
  runaway.answered = true;
  runaway.verdict = "divergence/no cycle";
  CHECK_FALSE(runaway.hunts());
  CHECK(std::isinf(scene_error("simulation", runaway, best)));
}

TEST_CASE("adequate: without friction there is nothing to ask") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.0};
  parts.element = relay(1.0, 0.1);
  CHECK_THROWS_AS(adequate(parts, quick()), std::invalid_argument);
}

TEST_CASE("adequate: the answers are the same on any number of threads") {
  AdequateOptions alone = quick(), together = quick();
  alone.threads = 1;
  together.threads = 4;
  alone.spread = together.spread = 0.1;
  const LoopParts parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  const auto one = adequate(parts, alone), all = adequate(parts, together);
  CHECK(one.least == all.least);
  REQUIRE(one.points.size() == all.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    const auto &p = one.points[i], &q = all.points[i];
    INFO(p.law << " " << p.method);
    CHECK((p.law == q.law && p.method == q.method && p.why == q.why && p.worst_at == q.worst_at));
    CHECK((p.error == q.error || (std::isnan(p.error) && std::isnan(q.error))));
    CHECK((p.worst == q.worst || (std::isnan(p.worst) && std::isnan(q.worst))));
  }
}

TEST_CASE("adequate: work that is stopped says so and keeps what it has") {
  AdequateOptions options = quick();
  options.threads = 1;
  bool most_laws_done = false;
  options.progress = [&](double done, std::string_view) { most_laws_done = done > 0.7; };
  options.predict.stop = [&] { return most_laws_done; };
  const auto report = adequate(servo_parts(stribeck(1.5, 1.0, 1e-6)), options);
  CHECK(report.status == Status::interrupted);
  CHECK_FALSE(report.points.empty());
  CHECK_FALSE(report.least);
}
