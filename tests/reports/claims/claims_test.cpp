#include "limcycle/reports/claims/claims.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

TestedClaim claim(const std::string& id, const ClaimChecks& checks, ClaimVerdict expected) {
  TestedClaim one;
  one.claim = {id,
               "It <is> so & stays so, whatever the parameters of the law and the words of the claim.",
               "a = b",
               "somebody, 1999",
               Evidence::knowledge,
               "a > 0",
               "by hand",
               expected,
               {}};
  one.result = checks.result("found");
  return one;
}

std::vector<TestedClaim> sample() {
  ClaimChecks good, bad, none;
  good.equal("a = 1", "period", "s", 2.0, 2.0 + 1e-9, 1e-6);
  good.random(true);
  good.equal("a = 2", "period", "s", 3.0, 3.0, 1e-6);
  bad.equal("a = \"3\", b", "force", "", 2.0, 2.5, 1e-2);
  none.equal("", "x", "m", 1.0, NAN, 1e-6);
  return {claim("A1", good, ClaimVerdict::holds), claim("A2", bad, ClaimVerdict::fails),
          claim("A3", none, ClaimVerdict::holds)};
}

}  // namespace

TEST_CASE("claims: text within 80 columns, the answer first, what does not hold in words") {
  const auto text = claims_text(sample(), false);
  CHECK_THAT(text, StartsWith("3 claims tested: 1 holds, 1 fails, 1 is undecided; not as expected: A3.\n"));
  CHECK_THAT(text, Contains("A2: fails, as expected") && Contains("A3: undecided, but holds is expected") &&
                       Contains("Counter-example: force at a = \"3\", b: claimed 2, computed 2.5"));
  CHECK(text.find("A1: ") == std::string::npos);
  const auto all = claims_text(sample(), true);
  CHECK_THAT(all, Contains("A1: ") && Contains("(from knowledge, the source was not opened)") &&
                      Contains("claimed 3.00000000 s") && Contains("(random: a = 2)"));
  CHECK_THAT(claims_text({sample()[0]}, false), Contains("all as expected") && Contains("by hand"));
  CHECK_THAT(claims_list({sample()[0].claim}), Contains("A1  It <is> so"));
  for (const auto& document : {text, all}) {
    for (const auto& line : test::lines_of(document)) CHECK(line.size() <= 80);
  }
}

TEST_CASE("claims: JSON and CSV carry every comparison, and no NaN") {
  const auto document = nlohmann::ordered_json::parse(claims_json({}, sample()));
  CHECK(document["command"] == "claims");
  const auto& list = document["claims"];
  REQUIRE(list.size() == 3);
  for (const char* key : {"id", "statement", "formula", "source", "evidence", "range", "test", "expected", "verdict",
                          "as_expected", "checks", "finding", "counterexample"})
    CHECK(list[0].contains(key));
  CHECK(list[0]["evidence"] == "knowledge");
  CHECK(list[0]["checks"][1]["random"] == true);
  CHECK(list[0]["counterexample"].is_null());
  CHECK(list[1]["verdict"] == "fails");
  CHECK(list[1]["as_expected"] == true);
  CHECK(list[2]["checks"][0]["computed"].is_null());
  CHECK(list[2]["as_expected"] == false);
  const auto csv = claims_csv(sample());
  CHECK_THAT(csv, StartsWith("id,verdict,expected,where,quantity,unit,claimed,computed,error,allowed,random,holds\n") &&
                      Contains("A1,holds,holds,a = 2,period,s,3,3,0,1e-06,true,true\n") &&
                      Contains("A2,fails,fails,\"a = \"\"3\"\", b\",force,,2,2.5,0.25,0.01,false,false\n") &&
                      Contains("A3,undecided,holds,,x,m,1,,,1e-06,false,false\n"));
  CHECK(nlohmann::ordered_json::parse(claims_list_json({}, {sample()[1].claim}))["claims"][0]["id"] == "A2");
}

TEST_CASE("claims: the page folds each claim and opens those that are not as expected") {
  const auto page = claims_page(sample(), {}, "A", "");
  CHECK_THAT(page, Contains("<details id=\"A1\"><summary>A1: holds") && Contains("<details id=\"A3\" open>") &&
                       Contains("It &lt;is&gt; so &amp; stays so") && Contains("</html>"));
  CHECK_THAT(page, Contains("limcycle claims A"));
  CHECK(page.size() < 500'000);  // without the library that draws figures
}
