#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

TEST_CASE("claims: listed without being tested, each with its expected verdict") {
  const auto ran = run({"claims", "--list"});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Contains("\nthesis-rate "));
  const auto document = Json::parse(run({"claims", "--list", "--json", "-", "thesis"}).out);
  CHECK(document["claims"].size() >= 25);
  for (const auto& claim : document["claims"]) {
    CHECK(claim["id"].get<std::string>().starts_with("thesis"));
    CHECK_FALSE(claim.contains("verdict"));
  }
}

TEST_CASE("claims: the thesis's contradictory claim fails as expected, which is no failure of the program") {
  const Scratch scratch;
  const auto ran = run({"claims", "thesis-rate", "pendulum-rate", "--json", scratch.file("r.json"), "--csv",
                        scratch.file("r.csv"), "--html", scratch.file("r.html")});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, StartsWith("2 claims tested: 1 holds, 1 fails; all as expected.") &&
                          Contains("thesis-rate: fails, as expected") && Contains("rate*Zb"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);
  const auto document = Json::parse(scratch.get("r.json"));
  REQUIRE(document["claims"].size() == 2);
  CHECK(document["claims"][0]["verdict"] == "fails");
  CHECK(document["claims"][0]["as_expected"] == true);
  CHECK(document["claims"][1]["checks"].size() == 9);
  CHECK_THAT(scratch.get("r.csv"), Contains("\npendulum-rate,holds,holds,"));
  CHECK_THAT(scratch.get("r.html"), Contains("limcycle claims thesis-rate pendulum-rate") && Contains("<details"));
}

TEST_CASE("claims: the same bytes whatever the threads, other random points with another seed") {
  const auto with = [](std::vector<std::string> more) {
    std::vector<std::string> words{"claims", "thesis-boundedness", "thesis-break-zb", "--random", "4", "--csv", "-"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words).out;
  };
  const auto one = with({"--threads", "1"});
  CHECK(one == with({"--threads", "2"}));
  CHECK(one != with({"--seed", "1"}));
  CHECK_THAT(one, StartsWith("id,verdict,expected,"));
}

TEST_CASE("claims: those of a case file, and exit code 1 where a verdict is not the expected one") {
  const Scratch scratch;
  const auto shipped_case = run({"claims", shipped("relay-claims.toml")});
  CHECK(shipped_case.code == 0);
  CHECK_THAT(shipped_case.out, Contains("4 claims tested: 3 hold, 1 fails; all as expected."));
  const auto one =
      run({"claims", shipped("relay-claims.toml"), "period", "--set", "loop.element.level=2.0", "--json", "-"});
  CHECK(one.code == 0);
  const auto document = Json::parse(one.out);
  CHECK(document["case"]["sha256"].is_string());
  REQUIRE(document["claims"].size() == 1);
  CHECK(document["claims"][0]["checks"][0]["computed"].get<double>() == Approx(0.1));
  const std::string wrong =
      "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n[[claim]]\nid = \"a\"\nquantity = \"gain.imag\"\nformula = "
      "\"Fc/A\"\nat = {amplitude = 1, frequency = 1}\n";
  const auto failed = run({"claims", scratch.put("a.toml", wrong)});
  CHECK(failed.code == 1);
  CHECK_THAT(failed.out, Contains("not as expected: a") && Contains("counter-example"));
  CHECK(run({"claims", scratch.put("a.toml", wrong + "expected = \"fails\"\n")}).code == 0);
  CHECK_THAT(run({"check", scratch.file("a.toml")}).out, Contains("claims: 1"));
}

TEST_CASE("claims: what is refused") {
  CHECK_THAT(run({"claims", "thesis-rat3"}).err, Contains("unknown claim 'thesis-rat3'; did you mean thesis-rate?"));
  CHECK(run({"claims", "thesis-rat3"}).code == 2);
  CHECK(run({"claims", shipped("relay-claims.toml"), "perod"}).code == 2);
  CHECK_THAT(run({"claims", shipped("relay-claims.toml"), "perod"}).err, Contains("did you mean period?"));
  CHECK_THAT(run({"claims", shipped("pid-lugre.toml")}).err, Contains("claim: is required by this command"));
  CHECK_THAT(run({"claims", shipped("relay-claims.toml"), shipped("pid-lugre.toml")}).err,
             Contains("takes one case file"));
  CHECK(run({"claims", "no-such-file.toml"}).code == 2);
  CHECK(run({"claims", "thesis-rate", "--set", "a=1"}).code == 2);
  CHECK(run({"claims", "thesis-rate", "--random", "-1"}).code == 2);
  const Scratch scratch;
  const auto bad = scratch.put("a.toml",
                               "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n[[claim]]\nid = \"a\"\nquantity = "
                               "\"mean\"\nformula = \"2*(Fc\"\nat = {amplitude = 1, frequency = 1}\n");
  CHECK_THAT(run({"claims", bad}).err, Contains(bad + ":7: claim[0].formula = \"2*(Fc\": is not a formula"));
  CHECK(run({"claims", bad}).code == 2);
}
