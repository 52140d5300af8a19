#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <stdexcept>

#include "limcycle/analysis/study/claims/run_claims.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

Claim made(const std::string& id, std::function<ClaimResult(const ClaimOptions&)> run,
           ClaimVerdict expected = ClaimVerdict::holds) {
  Claim claim;
  claim.id = id;
  claim.statement = "statement of " + id;
  claim.expected = expected;
  claim.run = std::move(run);
  return claim;
}

ClaimVerdict verdict(const ClaimChecks& checks) { return checks.result().verdict; }

}  // namespace

TEST_CASE("claim checks: equality is held to the claimed number, or to a size") {
  const auto equal = [](double claimed, double computed, double allowed, double size) {
    ClaimChecks checks;
    checks.equal("here", "N", "N/m", claimed, computed, allowed, size);
    return checks.result();
  };
  CHECK(equal(2.0, 2.0 * (1.0 + 0.9e-6), 1e-6, 0.0).verdict == ClaimVerdict::holds);
  CHECK(equal(2.0, 2.0 * (1.0 + 1.1e-6), 1e-6, 0.0).verdict == ClaimVerdict::fails);
  CHECK(equal(-2.0, 2.0, 1e-6, 0.0).verdict == ClaimVerdict::fails);
  CHECK(equal(0.0, 1e-9, 1e-6, 1e-2).verdict == ClaimVerdict::holds);
  CHECK(equal(0.0, 1e-7, 1e-6, 1e-2).verdict == ClaimVerdict::fails);
  CHECK(equal(0.0, 0.0, 0.0, 0.0).verdict == ClaimVerdict::holds);
  const auto failed = equal(2.0, 3.0, 1e-6, 0.0);
  CHECK(failed.checks[0].error == Approx(0.5));
  CHECK_THAT(failed.counterexample, Contains("N at here: claimed 2 N/m, computed 3 N/m"));
  CHECK(equal(2.0, HUGE_VAL, 1e-6, 0.0).verdict == ClaimVerdict::fails);
}

TEST_CASE("claim checks: bounds, and statements that are true or not") {
  ClaimChecks checks;
  checks.at_most("", "F", "N", 1.5, 1.5 + 1e-9, 1e-8);
  checks.at_least("", "F", "N", 1.5, 1.5 - 1e-9, 1e-8);
  checks.at_least("", "F", "N", 1.5, 7.0, 0.0);
  checks.is_true("", "it rests", true);
  CHECK(verdict(checks) == ClaimVerdict::holds);
  auto more = checks;
  more.at_most("", "F", "N", 1.5, 1.5 + 1e-9, 1e-10);
  CHECK(verdict(more) == ClaimVerdict::fails);
  more = checks;
  more.at_least("", "F", "N", 0.0, -1e-9, 0.0);
  CHECK(verdict(more) == ClaimVerdict::fails);
  checks.is_true("", "it rests", false);
  CHECK(verdict(checks) == ClaimVerdict::fails);
}

TEST_CASE("claim checks: what was not computed neither holds nor refutes") {
  CHECK(verdict({}) == ClaimVerdict::undecided);
  ClaimChecks checks;
  checks.equal("", "N", "", 1.0, 1.0, 1e-6);
  checks.equal("", "N", "", 1.0, NAN, 1e-6);
  CHECK(verdict(checks) == ClaimVerdict::undecided);
  CHECK_FALSE(checks.result().checks[1].holds);
  CHECK_THAT(checks.result().finding, Contains("could not be computed"));
  checks.equal("", "N", "", 1.0, 2.0, 1e-6);  // one that refutes the claim
  CHECK(verdict(checks) == ClaimVerdict::fails);
  CHECK_THAT(checks.result().counterexample, Contains("computed 2"));
  checks.stop(Status::interrupted);
  CHECK(verdict(checks) == ClaimVerdict::undecided);
  CHECK_THAT(checks.result("first"), Catch::Predicate<ClaimResult>([](const ClaimResult& result) {
               return result.finding.starts_with("first; ") && result.status == Status::interrupted;
             }));
}

TEST_CASE("claim checks: the counter-example is the worst one, random checks are counted") {
  ClaimChecks checks;
  checks.equal("a", "N", "", 1.0, 1.1, 1e-2);
  checks.random(true);
  checks.equal("b", "N", "", 1.0, 1.5, 1e-2);
  checks.random(false);
  checks.equal("c", "N", "", 1.0, 1.2, 1e-2);
  const auto result = checks.result();
  CHECK_THAT(result.counterexample, Contains("at b:"));
  CHECK_THAT(result.finding, Contains("3 of 3 comparisons (1 at random parameters) fail"));
  CHECK(result.checks[1].random);
  CHECK_FALSE(result.checks[2].random);
}

TEST_CASE("run claims: the same whatever the threads and the company, other numbers for another seed") {
  const auto draw = [](const ClaimOptions& options) {
    RandomShares random(options.seed);
    ClaimChecks checks;
    for (int i = 0; i < options.random_points; ++i) checks.equal("", "share", "", 0.5, random.share(), 10.0);
    return checks.result();
  };
  std::vector<Claim> claims;
  for (const char* id : {"a", "b", "c", "d", "e"}) claims.push_back(made(id, draw));
  const auto numbers = [](const std::vector<TestedClaim>& tested, const std::string& id) {
    std::vector<double> list;
    for (const auto& one : tested)
      if (one.claim.id == id)
        for (const auto& check : one.result.checks) list.push_back(check.computed);
    return list;
  };
  ClaimRunOptions options;
  options.seed = 7;
  options.random_points = 50;
  const auto one = run_claims(claims, options);
  options.threads = 4;
  const auto two = run_claims({claims[2], claims[1]}, options);
  CHECK(numbers(one, "c").size() == 50);
  CHECK(numbers(one, "c") == numbers(two, "c"));
  CHECK(numbers(one, "b") == numbers(two, "b"));
  CHECK(numbers(one, "b") != numbers(one, "c"));
  CHECK(two[0].claim.id == "c");
  options.seed = 8;
  CHECK(numbers(run_claims(claims, options), "c") != numbers(one, "c"));
}

TEST_CASE("run claims: one that throws is undecided and says why, a stop keeps what was done") {
  int ran = 0;
  const auto holds = [&ran](const ClaimOptions&) {
    ++ran;
    ClaimChecks checks;
    checks.is_true("", "true", true);
    return checks.result();
  };
  const auto throws = [](const ClaimOptions&) -> ClaimResult { throw std::invalid_argument("no such law"); };
  ClaimRunOptions options;
  const auto tested = run_claims({made("a", throws), made("b", holds, ClaimVerdict::fails)}, options);
  REQUIRE(tested.size() == 2);
  CHECK(tested[0].result.verdict == ClaimVerdict::undecided);
  CHECK_THAT(tested[0].result.finding, Contains("no such law"));
  CHECK(tested[1].result.verdict == ClaimVerdict::holds);
  CHECK_FALSE(tested[1].as_expected());
  ran = 0;
  options.stop = [&ran] { return ran >= 2; };
  CHECK(run_claims({made("a", holds), made("b", holds), made("c", holds)}, options).size() == 2);
}

TEST_CASE("claims are found by id, else by its beginning") {
  std::vector<Claim> all;
  for (const char* id : {"A1", "A11a", "A11b", "B1", "thesis-rate"}) all.push_back(made(id, {}));
  const auto ids = [&](std::string_view word) {
    std::string out;
    for (const auto& claim : claims_named(all, word)) out += claim.id + " ";
    return out;
  };
  CHECK(ids("A1") == "A1 ");
  CHECK(ids("A11") == "A11a A11b ");
  CHECK(ids("A") == "A1 A11a A11b ");
  CHECK(ids("thesis") == "thesis-rate ");
  CHECK(ids("C").empty());
  CHECK(ids("").empty());
}

TEST_CASE("random shares lie between 0 and 1 and fill it") {
  RandomShares random(3);
  double sum = 0.0, least = 1.0, most = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double share = random.share();
    sum += share;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  CHECK(least >= 0.0);
  CHECK(most < 1.0);
  CHECK(least < 1e-3);
  CHECK(most > 1.0 - 1e-3);
  CHECK(sum / 10000.0 == Approx(0.5).margin(0.015));  // five standard deviations
  CHECK(random.log_between(1e-3, 10.0) >= 1e-3);
}

TEST_CASE("every claim of the catalogue says what it is, and has an id of its own") {
  std::set<std::string> ids;
  for (const auto& claim : claims()) {
    INFO(claim.id);
    CHECK(ids.insert(claim.id).second);
    CHECK_FALSE(claim.statement.empty());
    CHECK_FALSE(claim.source.empty());
    CHECK_FALSE(claim.range.empty());
    CHECK_FALSE(claim.test.empty());
    CHECK(claim.run);
    CHECK(claim.expected != ClaimVerdict::undecided);
  }
  CHECK(ids.size() >= 39);
}
