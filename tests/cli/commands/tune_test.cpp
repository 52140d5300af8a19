#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/golden.hpp"
#include "limcycle/tests/cli/program.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;
using limcycle::test::check_goldens;
using limcycle::test::run;
using limcycle::test::Scratch;
using limcycle::test::shipped;
using limcycle::test::squeezed;

TEST_CASE("tune: golden documents") { check_goldens("tune"); }

TEST_CASE("tune: numbers that end hunting, in every document, and the case that predict confirms") {
  const Scratch scratch;
  const auto ran = run({"tune",
                        shipped("over-compensated.toml"),
                        "--vary",
                        "kp=10:100,loop.controller.kd=9:11",
                        "--minimise",
                        "settling",
                        "--at-most",
                        "ms=3",
                        "--samples",
                        "4",
                        "--apply",
                        "-o",
                        scratch.file("tuned.toml"),
                        "--json",
                        scratch.file("t.json"),
                        "--csv",
                        scratch.file("t.csv"),
                        "--html",
                        scratch.file("t.html"),
                        "--svg",
                        scratch.file("t.svg")});
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK_THAT(squeezed(ran.out),
             Contains("The least settling time without hunting that was found is") && Contains("with kp = "));
  const auto document = Json::parse(scratch.get("t.json"));
  CHECK(document["hunts"] == true);
  CHECK(document["status"] == "converged");
  REQUIRE(document["best"].is_number());
  const auto& best = document["points"][document["best"].get<std::size_t>()];
  CHECK(best["outcome"] == "feasible");
  CHECK(best["settling"] == document["cost"]);
  CHECK(best["ms"] <= 3.0);
  CHECK(document["numbers"][0]["parameter"] == "loop.controller.kp");
  CHECK(document["numbers"][0]["value"] == best["values"][0]);
  for (const auto& point : document["points"]) {
    CHECK((point["values"][0] >= 10.0 && point["values"][0] <= 100.0));
    CHECK((point["values"][1] >= 9.0 && point["values"][1] <= 11.0));
  }
  CHECK_THAT(scratch.get("t.csv"), StartsWith("part,search,loop.controller.kp,loop.controller.kd,outcome,ms"));
  CHECK_THAT(scratch.get("t.html"), StartsWith("<!DOCTYPE html>") && Contains("Before and after"));
  CHECK_THAT(scratch.get("t.svg"), StartsWith("<svg"));
  CHECK_THAT(scratch.get("tuned.toml"), Contains("  # limcycle tune\n"));
  const auto predicted = Json::parse(run({"predict", scratch.file("tuned.toml"), "--json", "-"}).out);
  for (const auto& cycle : predicted["cycles"]) CHECK(cycle["stable"] != true);
  for (const auto& one : predicted["outcomes"]) CHECK(one["outcome"] == "rest");
}

TEST_CASE("tune: exit code 3 where nothing is free of hunting, and no case is written") {
  const Scratch scratch;
  const auto ran = run({"tune", shipped("pid-lugre.toml"), "--vary", "ki=2:8", "--samples", "4", "--apply", "-o",
                        scratch.file("tuned.toml")});
  CHECK(ran.code == 3);
  CHECK_THAT(squeezed(ran.out), Contains("No point without hunting was found within these bounds") &&
                                    Contains("That is no proof that there is none"));
  CHECK_THAT(ran.err, Contains("there is nothing to apply"));
  CHECK_FALSE(std::filesystem::exists(scratch.file("tuned.toml")));
}

TEST_CASE("tune: bad input ends with 2, before anything is computed") {
  const std::string servo = shipped("pid-lugre.toml");
  const auto refused = [&](const std::string& file, const std::vector<std::string>& flags, const std::string& why) {
    std::vector<std::string> command{"tune", file};
    command.insert(command.end(), flags.begin(), flags.end());
    const auto ran = run(command);
    INFO(why);
    CHECK(ran.code == 2);
    CHECK_THAT(ran.err, Contains(why));
  };
  refused(servo, {}, "--vary");
  refused(servo, {"--vary", "kq=1:2"}, "did you mean kp?");
  refused(servo, {"--vary", "kp=1"}, "must be PATH=FROM:TO");
  refused(servo, {"--vary", "kp=2:1"}, "the lower bound must be below the upper one");
  refused(servo, {"--vary", "kp=1:2,kp=3:4"}, "is named twice");
  refused(servo, {"--vary", "tf=-1:1"}, "this bound is not a valid value");
  refused(servo, {"--vary", "kp=1:2", "--until", "hunts=yes"}, "must be hunts=no");
  refused(servo, {"--vary", "kp=1:2", "--minimise", "mz"}, "did you mean ms?");
  refused(servo, {"--vary", "kp=1:2", "--at-most", "ms"}, "must be COST=VALUE");
  for (const char* wrong : {"ms=-1", "ms=0x10", "ms=nan", "ms=1e400", "ms= 2", "ms="})
    refused(servo, {"--vary", "kp=1:2", "--at-most", wrong}, "must be COST=VALUE");
  refused(servo, {"--vary", "kp=1:2", "--apply"}, "needs -o FILE");
  refused(servo, {"--vary", "kp=1:2", "--samples", "0"}, "--samples");
  refused(servo, {"--vary", "kp=1:2", "--margin", "60"}, "--margin");
  refused(servo, {"--vary", "kp=1:2", "--horizon", "0"}, "--horizon");
  refused(shipped("tutorial-servo.toml"), {"--vary", "kp=1:2", "--minimise", "ise"}, "--horizon");
  refused(shipped("two-mass-drive.toml"), {"--vary", "mass=1:2"}, "is not a parameter of this loop");
  refused(shipped("belt-coulomb.toml"), {"--vary", "damping=0:2", "--minimise", "settling"}, "no set-point");
  refused(shipped("relay-third-order.toml"), {"--vary", "level=1:2"}, "has no peak sensitivity");
  refused(shipped("df-lugre.toml"), {"--vary", "Fs=1:2"}, "");
}
