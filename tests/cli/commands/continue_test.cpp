#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

namespace {

const std::vector<std::string> dead_zone = {"continue",    shipped("relay-third-order.toml"),
                                            "--set",       "loop.element.dead_zone=0.05",
                                            "--parameter", "loop.element.dead_zone=0.02:0.2"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

}  // namespace

TEST_CASE("continue: text, documents, page and diagram of a branch with a fold") {
  const Scratch scratch;
  const auto ran = run(with(dead_zone, {"--json", scratch.file("r.json"), "--csv", scratch.file("r.csv"), "--html",
                                        scratch.file("r.html"), "--svg", scratch.file("r.svg")}));
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(ran.out, Contains("There is one fold, where the branch") && Contains("0.0818750"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);

  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "continue");
  CHECK(document["status"] == "converged");
  CHECK(document["parameter"]["path"] == "loop.element.dead_zone");
  REQUIRE(document["events"].size() == 3);
  CHECK(document["events"][1]["type"] == "fold");
  CHECK(document["events"][1]["parameter"].get<double>() == Approx(0.08187508078).epsilon(1e-8));
  CHECK(document["events"][0]["type"] == "end");
  CHECK(document["events"][2]["type"] == "end");
  const auto& branch = document["branch"];
  REQUIRE(branch.size() > 20);
  for (const char* key : {"parameter", "amplitude", "period", "stable", "multipliers"}) CHECK(branch[0].contains(key));
  CHECK(branch.front()["stable"] == true);
  CHECK(branch.back()["stable"] == false);
  const std::size_t fold = document["events"][1]["point"];
  CHECK(branch[fold]["parameter"] == document["events"][1]["parameter"]);
  CHECK(branch[fold]["stable"].is_null());

  const auto csv = scratch.get("r.csv");
  CHECK_THAT(csv, StartsWith("kind,part,parameter,amplitude,period,stable") && Contains("\nfold,0,0.0818750"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == static_cast<long>(branch.size() + 3 + 1));
  const auto svg = scratch.get("r.svg");
  CHECK_THAT(svg, StartsWith("<svg ") && Contains("class=\"stable\"") && Contains("class=\"unstable\"") &&
                      Contains("class=\"fold\""));
  const auto page = scratch.get("r.html");
  const auto curves = svg.substr(svg.find("</style>"));  // the picture's style has a scope of its own in a page
  CHECK_THAT(page, StartsWith("<!DOCTYPE html>") && Contains(curves) && Contains("limcycle continue ") &&
                       Contains("--set loop.element.dead_zone=0.05"));
  CHECK(page.size() < 500'000);  // without the library that draws figures
}

TEST_CASE("continue: the coefficient of the cubic of van der Pol only scales its cycle") {
  const auto ran =
      run({"continue", shipped("van-der-pol.toml"), "--parameter", "loop.element.coefficient=0.1:10", "--json", "-"});
  REQUIRE(ran.code == 0);
  // x'' - x' + x + (c x^3)' = 0 is x -> x/sqrt(3 c) of mu = 1: the period does not change.
  const auto document = Json::parse(ran.out);
  for (const auto& point : document["branch"]) {
    CHECK(point["period"].get<double>() == Approx(6.66328686).epsilon(2e-8));
    const double c = point["parameter"];
    CHECK(point["amplitude"].get<double>() * std::sqrt(3.0 * c) == Approx(2.00861986).epsilon(2e-7));
  }
}

TEST_CASE("continue: a start without a cycle is looked for, and said") {
  const auto ran = run({"continue", shipped("relay-third-order.toml"), "--set", "loop.element.dead_zone=0.15",
                        "--parameter", "loop.element.dead_zone=0.05:0.2", "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  REQUIRE(document["notes"].size() == 1);
  CHECK_THAT(document["notes"][0].get<std::string>(), Contains("no limit cycle was found at 0.15"));
  CHECK(document["parameter"]["start"].get<double>() < 0.0819);
}

TEST_CASE("continue: bad input ends with 2 before anything is computed or written") {
  const Scratch scratch;
  const std::string servo = shipped("pid-lugre.toml");
  const auto refused = [&](const std::string& parameter, const std::string& why) {
    const auto ran = run({"continue", servo, "--parameter", parameter, "--json", scratch.file("r.json")});
    INFO(parameter << ": " << ran.err);
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    CHECK(ran.err.find(why) != std::string::npos);
    CHECK_FALSE(exists(scratch.file("r.json")));
  };
  refused("loop.controller.kd", "must be PATH=FROM:TO");
  refused("loop.controller.kd=1", "must be PATH=FROM:TO");
  refused("loop.controller.kd=1:1", "must differ");
  refused("loop.controller.kd=1:inf", "finite numbers");
  refused("loop.controller.kd=1:2:3", "finite numbers");
  refused("loop.controller.kdd=1:2", "did you mean loop.controller.kd?");
  refused("loop.plant.kind=1:2", "not a parameter of this loop");
  CHECK(run({"continue", servo}).code == 2);
  CHECK(run({"continue", shipped("df-lugre.toml"), "--parameter", "loop.friction.Fs=1:2"}).code == 2);
}

TEST_CASE("margin: what must be changed, in a sentence, a table and documents") {
  const Scratch scratch;
  const auto ran = run({"margin", shipped("relay-third-order.toml"), "--set", "loop.element.dead_zone=0.05", "--json",
                        scratch.file("r.json"), "--csv", scratch.file("r.csv"), "-o", scratch.file("r.html")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  std::string words = ran.out;
  std::replace(words.begin(), words.end(), '\n', ' ');
  CHECK_THAT(words,
             Contains("This loop has a stable limit cycle") && Contains("lower loop.element.level from 1.000 to 0.61"));
  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["hunts"] == true);
  REQUIRE(document["parameters"].size() == 2);
  CHECK(document["parameters"][0]["name"] == "loop.element.level");
  CHECK(document["parameters"][0]["down"]["hunting"] == "ends");
  CHECK(document["parameters"][0]["nearest"].get<double>() == Approx(0.05 / 0.08187508078).epsilon(1e-6));
  CHECK(document["parameters"][0]["distance_percent"].get<double>() == Approx(38.93).epsilon(1e-3));
  CHECK(document["parameters"][0]["up"]["value"].is_null());
  CHECK(document["describing_function"]["distance_percent"].get<double>() < 0.01);
  CHECK_THAT(scratch.get("r.csv"), StartsWith("name,unit,own_value,part,side,hunting,value") &&
                                       Contains("loop.element.dead_zone,1,0.05,plant or controller,up,ends,0.08187"));
  CHECK_THAT(scratch.get("r.html"), StartsWith("<!DOCTYPE html>") && Contains("limcycle margin "));
}

TEST_CASE("margin: along a line of several numbers, as by hand where the loop is homogeneous") {
  const std::vector<std::string> relay{
      "margin", shipped("relay-third-order.toml"), "--set", "loop.element.dead_zone=0.05", "--json", "-"};
  const auto edge = [&](const std::vector<std::string>& toward) {
    auto arguments = relay;
    for (const auto& one : toward) arguments.insert(arguments.end(), {"--toward", one});
    const auto ran = run(arguments);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto document = Json::parse(ran.out);
    REQUIRE(document["parameters"].size() == toward.size());
    CHECK(document["notes"].dump().find("loop.element.level = ") != std::string::npos);
    return document["parameters"][0];
  };
  // Hunting ends where dead_zone/level passes 0.0818750.. whatever the way there.
  constexpr double ratio = 0.08187508078;
  const auto both = edge({"level=0.5,dead_zone=0.1"});
  CHECK(both["name"] == "toward level = 0.5, dead_zone = 0.1");
  CHECK(both["nearest"].get<double>() == Approx(1.0 + (ratio - 0.05) / (0.05 + 0.5 * ratio)).epsilon(1e-6));
  CHECK(edge({"level=0.5"})["nearest"].get<double>() == Approx(1.0 + (1.0 - 0.05 / ratio) / 0.5).epsilon(1e-6));
  for (const auto* wrong : {"level", "level=x", "level=1", "levl=2", "level=2,level=3", "level=-1", ""})
    CHECK(run({"margin", relay[1], "--toward", wrong}).code == 2);
}

TEST_CASE("margin: bad input ends with 2") {
  const std::string servo = shipped("pid-lugre.toml");
  CHECK(run({"margin", servo, "--factor", "0.5"}).code == 2);
  CHECK(run({"margin", servo, "--parameter", "loop.controller.kdd"}).code == 2);
  const auto zero = run({"margin", servo, "--parameter", "loop.plant.damping"});
  CHECK(zero.code == 2);
  CHECK_THAT(zero.err, Contains("no factor changes it"));
}

TEST_CASE("continue, margin: the cycle of a relay with a dead time, against its closed form") {
  const std::string late = shipped("relay-delay.toml");
  const auto ran = run({"continue", late, "--parameter", "loop.plant.delay=0.2:2", "--json", "-"});
  REQUIRE(ran.code == 0);
  int stable = 0;
  const auto followed = Json::parse(ran.out);
  for (const auto& point : followed["branch"]) {
    if (point["stable"] != true) continue;
    ++stable;
    const double L = point["parameter"];
    CHECK(point["period"].get<double>() == Approx(2.0 * std::log(2.0 * std::exp(L) - 1.0)).epsilon(1e-8));
    CHECK(point["amplitude"].get<double>() == Approx(1.0 - std::exp(-L)).epsilon(1e-8));
  }
  CHECK(stable > 10);
  const auto margin = run({"margin", late, "--parameter", "loop.plant.delay", "--json", "-"});
  REQUIRE(margin.code == 0);
  const auto document = Json::parse(margin.out);
  CHECK(document["hunts"] == true);
  for (const char* side : {"up", "down"}) CHECK(document["parameters"][0][side]["hunting"] == "none");
}

TEST_CASE("continue, margin: a dead time that is not behind a relay is refused, the reason first") {
  const std::vector<std::string> late{shipped("saturation.toml"), "--set", "loop.plant.delay=0.2"};
  for (const auto& command : {with({"continue"}, with(late, {"--parameter", "loop.element.slope=1:2"})),
                              with({"margin"}, with(late, {"--parameter", "loop.element.slope"}))}) {
    const auto ran = run(command);
    CHECK(ran.code == 3);
    CHECK_THAT(ran.out, Contains("\nNot answered: the dead time of this loop"));
  }
  const auto local = run({"sensitivity", shipped("relay-delay.toml"), "--local"});
  CHECK(local.code == 0);
  CHECK_THAT(local.out, Contains("The derivatives of the limit cycle were not computed"));
}

TEST_CASE("continue: a cycle that shrinks to nothing ends there, and not as points without size or period") {
  const auto ran =
      run({"continue", shipped("tutorial-servo.toml"), "--parameter", "loop.friction.Fs=8:12", "--json", "-"});
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  CHECK(document["branch"].size() > 20);
  for (const auto& point : document["branch"]) {
    CHECK(point["amplitude"].get<double>() > 1e-9);
    CHECK(point["period"].get<double>() > 1.0);
  }
  const auto& events = document["events"];
  REQUIRE(events.size() == 2);
  CHECK(events[0]["type"] == "end");
  CHECK(events[0]["parameter"].get<double>() == Approx(8.0).epsilon(1e-6));  // where Fs is Fc
}
