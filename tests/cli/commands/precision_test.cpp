#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/started.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

/// The document without values that depend on the clock.
Json without_times(Json document) {
  for (const char* list : {"points", "stiffness"})
    for (auto& point : document[list]) point.erase("seconds");
  document.erase("front");
  document.erase("never_best");
  return document;
}

std::vector<std::string> relay(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"precision", shipped("relay-integrator.toml")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("precision: text, documents and page of a relay loop") {
  const Scratch scratch;
  const auto ran =
      run(relay({"--json", scratch.file("r.json"), "--csv", scratch.file("r.csv"), "-o", scratch.file("r.html")}));
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, Contains("Reference: shooting at rtol 3e-12 (exact)") && Contains("fehlberg78"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);

  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "precision");
  for (const char* key : {"points", "reference", "front", "stiffness", "status"}) CHECK(document.contains(key));
  CHECK(document["reference"][0]["verified"] == true);
  CHECK(document["reference"][0]["period"].get<double>() == Approx(2.0 * 3.2122306).epsilon(1e-8));
  CHECK(document["points"].size() > 40);
  CHECK_FALSE(document["front"].empty());
  CHECK_THAT(scratch.get("r.csv"), StartsWith("question,sigma0,method,setting,error"));
  CHECK_THAT(scratch.get("r.html"), Contains("data-figure=\"work-cycle\""));

  // The same bytes again, except for the times.
  REQUIRE(run(relay({"--json", scratch.file("again.json")})).code == 0);
  CHECK(without_times(Json::parse(scratch.get("again.json"))) == without_times(document));
}

TEST_CASE("precision: a describing function alone") {
  const Scratch scratch;
  const auto path = scratch.put("df.toml",
                                "[loop.element]\nkind = \"saturation\"\nlimit = 1.0\n[df]\namplitude = [2.0, 5.0]\n"
                                "frequency = [1.0]\n");
  const auto ran = run({"precision", path, "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  CHECK(document["df_points"].size() == 2);
  for (const auto& point : document["points"]) CHECK(point["question"] == "describing-function");
}

TEST_CASE("precision: a loop without cycle and without friction cannot be answered, wrong usage is refused") {
  const Scratch scratch;
  const auto rests = scratch.put("rests.toml",
                                 "[loop.plant]\nkind = \"transfer-function\"\nnumerator = [1.0]\ndenominator = [1.0, "
                                 "1.0]\n[loop.element]\nkind = \"saturation\"\nlimit = 1.0\n");
  const auto ran = run({"precision", rests});
  CHECK(ran.code == 3);
  CHECK_THAT(ran.out, Contains("no verified reference: no stable limit"));
  CHECK(run({"precision"}).code == 2);
  CHECK(run({"precision", scratch.file("none.toml")}).code == 2);
  CHECK(run(relay({"--csv", "/nonexistent/r.csv"})).code == 2);
}

TEST_CASE("precision: Ctrl-C ends it soon and keeps what was computed") {
  const Scratch scratch;
  const std::string json = scratch.file("r.json");
  const auto ran = run_interrupted({"precision", shipped("pid-lugre.toml"), "--json", json}, 0.5);
  CHECK(ran.code == 3);
  const auto document = Json::parse(scratch.get("r.json"));
  CHECK_THAT(ran.err, Contains("interrupted"));
  CHECK(document["status"] == "interrupted");
}

TEST_CASE("precision: where steppers fail") {
  const Scratch scratch;
  const auto ran = run({"precision", shipped("belt-coulomb.toml"), "--stability", "--json", scratch.file("a.json"),
                        "--csv", scratch.file("a.csv"), "--html", scratch.file("a.html"), "-o", scratch.file("a.svg")});
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("Right everywhere") && Contains("coulomb"));
  const auto document = Json::parse(scratch.get("a.json"));
  CHECK(document["reference"][0]["verified"] == true);
  CHECK(document["points"].size() > 60);
  CHECK(document["points"][0]["stepper"] == "exact");
  CHECK(document["points"][0]["result"] == "right");
  CHECK_THAT(scratch.get("a.svg"), StartsWith("<svg"));
  CHECK_THAT(scratch.get("a.html"), Contains("<svg"));
  CHECK_THAT(scratch.get("a.csv"), StartsWith("law,stiffness"));

  CHECK(run({"precision", shipped("relay-integrator.toml"), "--stability"}).code == 2);
  CHECK(run(relay({"--svg", scratch.file("b.svg")})).code == 2);
}
