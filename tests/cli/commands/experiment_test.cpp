#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

TEST_CASE("experiment: without a name they are listed") {
  const auto ran = run({"experiment"});
  CHECK(ran.code == 0);
  for (const char* name :
       {"non-drift", "non-local-memory", "stick-slip-transition", "steady-velocity", "breakaway-rate",
        "breakaway-parameters", "sensitivity", "drift-against-zba", "same-servo", "robustness", "efficiency",
        "pre-sliding", "breakaway-force", "frictional-lag", "stick-slip", "asymmetric-stick-slip"})
    CHECK_THAT(ran.out, Contains("\n" + std::string(name) + " "));
  const auto document = Json::parse(run({"experiment", "--json", "-"}).out);
  CHECK(document["experiments"].size() >= 16);
}

TEST_CASE("experiment: text, documents, page and figures of one with two laws") {
  const Scratch scratch;
  const auto ran =
      run({"experiment", "breakaway-rate", "--law", "lugre", "--law", "coulomb", "--json", scratch.file("r.json"),
           "--csv", scratch.file("r.csv"), "--html", scratch.file("r.html"), "--svg", scratch.file("r.svg")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, StartsWith("breakaway-rate: ") && Contains("peak falls with the rate"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);
  const auto document = Json::parse(scratch.get("r.json"));
  const auto& one = document["experiments"][0];
  CHECK(one["name"] == "breakaway-rate");
  CHECK(one["rows"].size() == 6);
  CHECK(one["findings"].size() == 2);
  CHECK(one["figures"][0]["panels"].size() == 2);
  CHECK_THAT(scratch.get("r.csv"), StartsWith("kind,experiment,law") && Contains("\ntrace,breakaway-rate,lugre,"));
  CHECK_THAT(scratch.get("r.html"), Contains("limcycle experiment breakaway-rate --law lugre --law coulomb"));
  CHECK_THAT(scratch.get("r.svg"), StartsWith("<svg"));
}

TEST_CASE("experiment: the same run gives the same bytes, whatever the threads") {
  const auto one =
      run({"experiment", "pre-sliding", "--threads", "1", "--law", "lugre", "--law", "dahl", "--csv", "-"});
  const auto two =
      run({"experiment", "pre-sliding", "--threads", "2", "--law", "lugre", "--law", "dahl", "--csv", "-"});
  CHECK(one.code == 0);
  CHECK(one.out == two.out);
}

TEST_CASE("experiment: what a law has no number for is said in words") {
  const std::vector<std::string> commands[] = {
      {"breakaway-force", "gms"}, {"breakaway-parameters", "elasto-plastic"}, {"stick-slip-transition", "karnopp"}};
  for (const auto& words : commands) {
    const auto ran = run({"experiment", words[0], "--law", words[1]});
    INFO(ran.out);
    CHECK(ran.code == 0);
    CHECK(ran.out.find("nan ") == std::string::npos);
    CHECK(ran.out.find("not") != std::string::npos);
  }
}

TEST_CASE("experiment: a claim that is refuted, or not tested, is no failure") {
  const auto ran = run({"experiment", "breakaway-rate", "--law", "coulomb"});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Contains("not tested"));
}

TEST_CASE("experiment: wrong names and flags are refused") {
  CHECK_THAT(run({"experiment", "non-drfit"}).err, Contains("unknown experiment 'non-drfit'") && Contains("non-drift"));
  CHECK(run({"experiment", "non-drfit"}).code == 2);
  CHECK_THAT(run({"experiment", "pre-sliding", "--law", "lugr"}).err, Contains("unknown friction law 'lugr'"));
  CHECK(run({"experiment", "pre-sliding", "--law", "lugr"}).code == 2);
  CHECK(run({"experiment", "pre-sliding", "--set", "a=1"}).code == 2);
}
