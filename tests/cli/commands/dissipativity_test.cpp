#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/lines.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Json = nlohmann::ordered_json;

namespace {

Json document(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "dissipativity");
  arguments.insert(arguments.end(), {"--json", "-", "--quiet"});
  const auto ran = run(arguments);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(ran.out);
}

std::string preset(const std::string& name) { return shipped("presets/" + name + ".toml"); }

}  // namespace

TEST_CASE("dissipativity: LuGre as published is not passive, and from sigma1 (Fs - Fc)/Fc on it is") {
  const Json found = document({preset("lugre")});
  CHECK(found["passive"] == false);
  CHECK(found["deficit"].get<double>() > 0.0);
  CHECK(found["threshold"]["parameter"] == "loop.friction.sigma2");
  CHECK(found["threshold"]["value"].get<double>() == Approx(158.11388300841898).epsilon(1e-5));
  CHECK(found["state_bound"][0].get<double>() == Approx(1.5e-5).epsilon(1e-6));
  CHECK(found["force_bound"]["up_to_speed"] == 1.0);
  const auto& example = found["counterexample"];
  REQUIRE(example.is_object());
  CHECK(example["confirmed_energy_per_cycle"].get<double>() ==
        Approx(example["energy_per_cycle"].get<double>()).epsilon(1e-4));
  const auto taken = example["taken_from_rest"].get<std::vector<double>>();
  REQUIRE(taken.size() > 2);
  CHECK(taken.back() > taken[taken.size() / 2]);

  CHECK(document({preset("lugre"), "--set", "loop.friction.sigma2=157.95"})["passive"] == false);
  const Json enough = document({preset("lugre"), "--set", "loop.friction.sigma2=158.28"});
  CHECK(enough["passive"] == true);
  CHECK(enough["deficit"] == 0.0);
  CHECK(enough["counterexample"].is_null());
}

TEST_CASE("dissipativity: laws that are passive, and one that creeps its energy out") {
  for (const char* law : {"dahl", "coulomb", "stribeck", "jenkins", "maxwell-slip", "iwan", "kikuuwe"}) {
    CAPTURE(law);
    const Json found = document({preset(law)});
    CHECK(found["passive"] == true);
    CHECK(found["deficit"] == 0.0);
  }
  const Json gms = document({preset("gms")});
  CHECK(gms["passive"] == false);
  CHECK(gms["counterexample"]["energy_per_cycle"].get<double>() > 0.0);
}

TEST_CASE("dissipativity: over a number that another one follows by default, the other one follows") {
  const std::string damped = "loop.friction.sigma2=100.0";
  // Passive for sigma2/sigma1 >= (Fs - Fc)/Fc, on either side.
  const auto edge = [&](const std::string& range) {
    const auto report = document({preset("lugre"), "--set", damped, "--parameter", range});
    REQUIRE(report["changes"]["changes"].size() == 1);
    return report["changes"]["changes"][0]["value"].get<double>();
  };
  CHECK(edge("loop.friction.Fs=1:3") == Approx(1.0 + 100.0 / std::sqrt(1e5)).epsilon(1e-5));
  CHECK(edge("loop.friction.Fc=0.5:1.5") == Approx(1.5 / (1.0 + 100.0 / std::sqrt(1e5))).epsilon(1e-5));
}

TEST_CASE("dissipativity of a loop: where no question applies it says why") {
  const auto ran =
      run({"dissipativity", shipped("pid-lugre.toml"), "--set", "loop.controller.friction_compensation=0.5"});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, Contains("No question applies: The rest of the loop is not linear"));
}

TEST_CASE("dissipativity of a loop: a proof that nothing can hunt, and none for the servo that does") {
  const std::vector<std::string> no_integral = {shipped("pid-lugre-no-stiction.toml"), "--set",
                                                "loop.controller.ki=0.0"};
  const Json proved = document(no_integral);
  CHECK(proved["loop"]["no_cycle"]["answer"] == true);
  CHECK(proved["loop"]["agrees_with_predict"] == true);
  const Json servo = document({shipped("pid-lugre.toml")});
  CHECK(servo["loop"]["no_cycle"]["answer"] != true);
  CHECK(servo["loop"]["stuck_states"]["exists"]["answer"] == true);
  CHECK(servo["loop"]["stuck_states"]["dimension"] == 1);
  CHECK(servo["loop"]["sliding"]["velocity"].is_null());
}

TEST_CASE("dissipativity of a loop: what does not exist has no number") {
  const Json belt = document({shipped("belt-lugre.toml")});  // it cannot stand still, and slides
  CHECK(belt["loop"]["stuck_states"]["exists"]["answer"] == false);
  for (const auto* key : {"dimension", "force", "output"}) CHECK(belt["loop"]["stuck_states"][key].is_null());
  CHECK(belt["loop"]["sliding"]["velocity"] == -0.1);
}

TEST_CASE("dissipativity: text, page and points over the state") {
  const Scratch scratch;
  const auto ran = run({"dissipativity", shipped("belt-lugre.toml"), "--html", scratch.file("r.html"), "--csv",
                        scratch.file("r.csv"), "--parameter", "loop.friction.sigma2=0:400"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("not passive") && Contains("Counter-example") && Contains("Steady sliding"));
  for (const auto& line : lines_of(ran.out.substr(0, ran.out.find("report: ")))) CHECK(line.size() <= 80);
  CHECK_THAT(scratch.get("r.html"), Contains("<svg") && Contains("--parameter loop.friction.sigma2=0:400"));
  CHECK_THAT(scratch.get("r.csv"), Contains("storage,") && Contains("taken,"));
}

TEST_CASE("dissipativity: what is refused") {
  CHECK(run({"dissipativity", preset("lugre"), "--parameter", "loop.friction.sigma9=0:1"}).code == 2);
  CHECK(run({"dissipativity", preset("lugre"), "--parameter", "loop.plant.mass=1:2"}).code == 2);
  CHECK(run({"dissipativity", preset("lugre"), "--speed", "-1"}).code == 2);
  CHECK(run({"dissipativity", shipped("van-der-pol.toml"), "--set", "dissipativity.sped=1.0"}).code == 2);
}
