#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::string_view servo =
    "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.controller]\nkind = \"pid\"\nkp = 3.0\nki = 4.0\nkd = 6.0\n"
    "[loop.friction]\nkind = \"coulomb\"\nFs = 1.5\nFc = 1.0\nsigma2 = 0.4\n[search]\namplitude = [1e-3, 1.0]\n"
    "frequency = [0.05, 50.0]\n";

}  // namespace

TEST_CASE("adequate: text, documents and page of a servo with stiction") {
  const Scratch scratch;
  const auto ran = run({"adequate", scratch.put("servo.toml", servo), "--json", scratch.file("r.json"), "--csv",
                        scratch.file("r.csv"), "-o", scratch.file("r.html")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, Contains("Simplest adequate model: the law coulomb + stiction") && Contains("no law"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);
  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "adequate");
  CHECK(document["law"] == "coulomb + stiction");
  CHECK(document["best"]["verdict"] == "cycle");
  CHECK(document["laws"].size() == 8);
  CHECK(document["points"].size() == 10);  // two laws are possible
  CHECK(document["status"] == "converged");
  CHECK_THAT(scratch.get("r.csv"), StartsWith("law,method,verdict,period"));
  CHECK_THAT(scratch.get("r.html"), Contains("data-figure=\"work-ladder\""));
}

TEST_CASE("adequate: a tighter tolerance asks for more") {
  const Scratch scratch;
  std::string text(servo);
  text.replace(text.find("kind = \"coulomb\""), 16, "kind = \"stribeck\"\nvs = 1e-3");
  const auto path = scratch.put("servo.toml", text);
  const auto ran = run({"adequate", path, "--tolerance", "0.001", "--spread", "0", "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  CHECK(document["law"] == "stribeck");
  for (const auto& point : document["points"])  // adequate with a tolerance of 5 %
    if (point["law"] == "coulomb + stiction" && point["method"] == "shooting") CHECK(point["error"] < 0.05);
}

TEST_CASE("adequate: without friction it is refused, and says why, and wrong usage too") {
  const Scratch scratch;
  const auto ran = run({"adequate", shipped("relay-integrator.toml")});
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains("loop.friction is missing") || Contains("compares friction laws and needs one"));
  CHECK(run({"adequate", shipped("df-lugre.toml")}).code == 2);
  CHECK(run({"adequate", shipped("pid-lugre.toml"), "--tolerance", "-1"}).code == 2);
}

TEST_CASE("adequate: [sensitivity] of the case is its spread, unless --spread is given") {
  const Scratch scratch;
  const std::string spread =
      "[sensitivity]\nparameters = [{path = \"loop.friction.Fs\", from = 0.8, to = 1.6}, "
      "{path = \"loop.controller.kd\", factor = 1.1}]\n";
  const auto path = scratch.put("servo.toml", std::string(servo) + spread);
  const auto ran = run({"adequate", path, "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  CHECK(document["spread_rule"] == "the middle and 4 corners of [sensitivity]");
  REQUIRE(document["spread"].size() == 3);  // Fs = 0.8 is below Fc, in two corners
  CHECK(document["spread"][0] == "friction.Fs = 1.200, controller.kd = 6.027");
  CHECK(document["notes"].dump().find("friction.Fs = 0.8000") != std::string::npos);
  const auto own = Json::parse(run({"adequate", path, "--spread", "0.05", "--json", "-"}).out);
  CHECK(own["spread_rule"] == "each number of the law up and down, one at a time");
  CHECK(own["spread"][0].get<std::string>().find("5 %") != std::string::npos);
}
