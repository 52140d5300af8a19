#include <catch2/catch.hpp>

#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/analysis/study/claims/sources/source_documents.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

ClaimResult tested(const std::string& id, int random_points = 4) {
  ClaimRunOptions options;
  options.random_points = random_points;
  const auto result = run_claims(claims_named(source_document_claims(), id), options);
  REQUIRE(result.size() == 1);
  INFO(result[0].result.finding << " " << result[0].result.counterexample);
  CHECK(result[0].as_expected());
  return result[0].result;
}

}  // namespace

TEST_CASE("document claims: what the proposed law is said to be") {
  CHECK(tested("thesis-uniqueness").checks.size() == 10);
  tested("thesis-boundedness");
  tested("thesis-stability");
  tested("thesis-steady-curve");
  tested("thesis-through-zero");
}

TEST_CASE("document claims: one measure of drift says that LuGre drifts and the others do not") {
  for (const char* id : {"thesis-drift-ep", "thesis-drift-gms", "thesis-drift-zba", "thesis-non-drift"}) tested(id, 1);
  const auto lugre = tested("thesis-drift-lugre");
  CHECK(lugre.checks[0].computed == Approx(0.514).epsilon(0.01));  // 4.75 of 9.24 um, as in the experiment
}

TEST_CASE("document claims: one measure of memory tells LuGre from the laws whose loops close") {
  for (const char* id : {"thesis-memory", "thesis-memory-lugre", "thesis-memory-ep", "thesis-memory-xiong",
                         "thesis-memory-gms", "thesis-memory-gms-printed"})
    tested(id);
}

TEST_CASE("document claims: break-away over the parameters") {
  for (const char* id : {"thesis-break-zb", "thesis-break-zb-way", "thesis-break-vs", "thesis-break-vs-speed",
                         "thesis-break-sigma", "thesis-break-tau", "thesis-break-tau-slope"})
    tested(id);
  // Peaks at half, once and twice Zb: an independent program's numbers.
  const auto peaks = tested("thesis-break-zb", 0).checks;
  CHECK(peaks[0].claimed == Approx(1.4945).margin(1e-4));
  CHECK(peaks[0].computed == Approx(1.4873).margin(1e-4));
  CHECK(peaks[1].computed == Approx(1.4715).margin(1e-4));
}

TEST_CASE("document claims: that break-away rises with the force rate is refuted, with the reason") {
  const auto result = tested("thesis-rate");
  CHECK(result.verdict == ClaimVerdict::fails);
  CHECK_THAT(result.finding, Contains("rate*Zb alone"));
  CHECK(result.checks[1].computed == Approx(1.4715).margin(1e-4));  // at 0.2 N/s, that of twice Zb at 0.1 N/s
  CHECK_THAT(result.counterexample, Contains("N/s against the rate before"));
  CHECK(tested("thesis-rate-scaling", 8).verdict == ClaimVerdict::holds);
  CHECK(tested("pendulum-rate").checks.size() == 9);
}

TEST_CASE("document claims: LuGre's parameters, robustness, lag") {
  for (const char* id :
       {"thesis-lugre-sigma0", "thesis-lugre-sigma1", "thesis-lugre-crossing", "thesis-lugre-vs", "pendulum-lag"})
    CHECK(tested(id).verdict == ClaimVerdict::holds);
  CHECK(tested("thesis-robustness").verdict == ClaimVerdict::fails);
}

TEST_CASE("document claims: play of the Froude pendulum") {
  CHECK(tested("pendulum-play-velocity").verdict == ClaimVerdict::holds);
  CHECK(tested("pendulum-play-any").verdict == ClaimVerdict::fails);
}

TEST_CASE("document claims: a stop leaves them undecided") {
  ClaimRunOptions options;
  int asked = 0;
  options.stop = [&asked] { return ++asked > 100; };
  const auto result = run_claims(claims_named(source_document_claims(), "thesis-stability"), options);
  REQUIRE(result.size() == 1);
  CHECK(result[0].result.verdict == ClaimVerdict::undecided);
  CHECK(result[0].result.status == Status::interrupted);
}

TEST_CASE("prescribed motion is that of the acceleration, whatever the law") {
  const auto law = make_law(document_law("lugre"));
  ForcedOptions options;
  options.duration = 3.0;
  const ForcedRun run = run_accelerated(law, piecewise_constant({0.0, 1.0, 2.0, 3.0}, {0.01, 0.0, -0.02}), options);
  REQUIRE(run.status == Status::converged);
  CHECK(run.v.back() == Approx(-0.01).epsilon(1e-9));
  CHECK(run.x.back() == Approx(0.015).epsilon(1e-9));
  CHECK(run.F[run.at(2.0)] == Approx(1.0).epsilon(1e-9));  // long at 0.01 m/s, ten times vs
  CHECK_THROWS_AS(run_accelerated(law, piecewise_constant({0.0, 1.0}, {0.01}), options, "euler"),
                  std::invalid_argument);
}

TEST_CASE("document claims: the proposed law is passive") {
  CHECK(tested("thesis-dissipativity", 2).checks.size() == 3);
}
