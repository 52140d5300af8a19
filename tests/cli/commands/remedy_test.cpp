#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/program.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;
using limcycle::test::squeezed;

TEST_CASE("remedy: the cause, a cure and the case that predict confirms") {
  const Scratch scratch;
  const auto ran =
      run({"remedy", shipped("over-compensated.toml"), "--apply", "gain-kp", "-o", scratch.file("fixed.toml"), "--json",
           scratch.file("r.json"), "--csv", scratch.file("r.csv"), "--html", scratch.file("r.html")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(squeezed(ran.out), Contains("This loop hunts. The friction compensation is too strong") &&
                                    Contains("One remedy ends it: lower loop.controller.kp from 100.0 N/m to 37."));
  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["cause"]["kind"] == "over-compensation");
  REQUIRE(document["remedies"].size() == 1);
  const auto& one = document["remedies"][0];
  CHECK(one["ends"] == true);
  CHECK(one["applicable"] == true);
  REQUIRE(one["edges"].size() == 1);  // however little, it then creeps to a stand
  CHECK_THAT(scratch.get("r.csv"), StartsWith("name,parameter,unit") && Contains("gain-kp,loop.controller.kp"));
  CHECK_THAT(scratch.get("r.html"), StartsWith("<!DOCTYPE html>") && Contains("with gain-kp"));
  CHECK_THAT(scratch.get("fixed.toml"), StartsWith("# ") && Contains("  # limcycle remedy: gain-kp\n"));
  const auto hunts = [&](const std::string& kp) {
    const auto predicted =
        run({"predict", scratch.file("fixed.toml"), "--set", "loop.controller.kp=" + kp, "--json", "-"});
    const auto found = Json::parse(predicted.out);
    return std::ranges::any_of(found["cycles"], [](const Json& cycle) { return cycle["stable"] == true; });
  };
  CHECK_FALSE(hunts(one["edges"][0].dump()));
  CHECK(hunts(one["beyond"][0].dump()));
  CHECK_FALSE(hunts("8.0"));
  const auto fixed = Json::parse(run({"predict", scratch.file("fixed.toml"), "--json", "-"}).out);
  for (const auto& cycle : fixed["cycles"]) CHECK(cycle["stable"] != true);
}

TEST_CASE("remedy: a loop that rests, and one without a controller") {
  const auto rests = run({"remedy", shipped("pid-lugre-no-stiction.toml")});
  CHECK(rests.code == 0);
  CHECK_THAT(rests.out, Contains("does not hunt from any start"));
  const auto belt =
      run({"remedy", shipped("belt-coulomb.toml"), "--only", "damping", "--only", "gain-kp", "--json", "-"});
  REQUIRE(belt.code == 0);
  const auto document = Json::parse(belt.out);
  CHECK(document["cause"]["kind"] == "negative-slope");
  for (const auto& one : document["remedies"]) {
    CHECK(one["applicable"] == (one["name"] == "damping"));
    if (one["name"] == "gain-kp") CHECK(one["why"] == "there is no controller");
  }
}

TEST_CASE("remedy: bad input ends with 2, before anything is computed") {
  const Scratch scratch;
  const std::string servo = shipped("pid-lugre.toml");
  const auto refused = [&](const std::vector<std::string>& flags, const std::string& why) {
    std::vector<std::string> command{"remedy", servo};
    command.insert(command.end(), flags.begin(), flags.end());
    const auto ran = run(command);
    INFO(why);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains(why));
  };
  refused({"--only", "error-dead-zon"}, "did you mean error-dead-zone?");
  refused({"--apply", "gain-ki"}, "needs -o FILE");
  refused({"--apply", "gain", "-o", "x.toml"}, "is not a remedy");
  refused({"--weight", "noise_gan=1"}, "did you mean noise_gain?");
  refused({"--weight", "noise_gain=-1"}, "must be COST=WEIGHT");
  refused({"--weight", "noise_gain"}, "must be COST=WEIGHT");
  refused({"--samples", "-1"}, "--samples");
  CHECK(run({"remedy", shipped("df-lugre.toml")}).code == 2);
  const auto elsewhere =
      run({"remedy", shipped("measured-axis.toml"), "--apply", "gain-ki", "-o", scratch.file("m.toml")});
  CHECK(elsewhere.code == 2);
  CHECK_THAT(squeezed(elsewhere.err), Contains("names files of data, which are found from its own folder"));
}

TEST_CASE("a page's command has the flags that were given, but those that say where results go") {
  const Scratch scratch;
  const std::string servo = shipped("over-compensated.toml");
  const auto command_of = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--html", scratch.file("a.html"), "--json", scratch.file("a.json"), "--threads", "2"});
    REQUIRE(run(words).code == 0);
    const std::string page = scratch.get("a.html"), begin = "<p>To reproduce it:</p>\n<pre>";
    const auto at = page.find(begin) + begin.size();
    return page.substr(at, page.find("</pre>", at) - at);
  };
  CHECK(command_of({"remedy", servo, "--only", "gain-kp", "--only", "dither", "--samples=3", "--weight", "noise_gain=1",
                    "--set", "loop.controller.kd=5.0"}) ==
        "limcycle remedy " + servo +
            " --only gain-kp --only dither --weight noise_gain=1 --samples 3 --set "
            "loop.controller.kd=5.0");
  CHECK(command_of({"margin", servo, "--parameter", "loop.friction.Fc", "--factor", "1.5"}) ==
        "limcycle margin " + servo + " --factor 1.5 --parameter loop.friction.Fc");
  CHECK(command_of({"predict", servo, "--seed", "7", "--quiet"}) == "limcycle predict " + servo + " --seed 7");
  CHECK(command_of({"predict", servo}) == "limcycle predict " + servo);
}

TEST_CASE("remedy: the schema knows the names that the program knows") {
  std::ifstream file(std::string(LIMCYCLE_SOURCE_DIR) + "/docs/schema/remedy.json");
  const auto schema = Json::parse(file);
  const auto& names = schema["properties"]["remedies"]["items"]["properties"]["name"]["enum"];
  REQUIRE(names.size() > 10);
  std::string known;
  for (const auto& name : names) known += (known.empty() ? "" : ", ") + name.get<std::string>();
  const auto ran = run({"remedy", shipped("over-compensated.toml"), "--only", "no-such-word"});
  CHECK(ran.code == 2);
  CHECK_THAT(squeezed(ran.err), Contains("known: " + known));
}
