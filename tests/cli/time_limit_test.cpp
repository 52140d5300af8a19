#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/started.hpp"

// The time limit, and the results of an interrupted command. Times are checked loosely: the machine may be busy.

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;
using namespace limcycle::test;

namespace {

/// Runs with a limit of two seconds, and checks that it ends in time.
Ran limited(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--time-limit", "2"});
  const auto begin = std::chrono::steady_clock::now();
  Ran ran = run(arguments);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
  return ran;
}

}  // namespace

TEST_CASE("time limit: loops whose march gets nowhere end in time") {
  const std::vector<std::vector<std::string>> endless{
      {"predict", shipped("dead-zone.toml"), "--set", "loop.plant.numerator=[1e28]"},
      {"predict", shipped("relay-integrator.toml"), "--set", "loop.plant.poles=[0.0,-1.0,1e16]"},
      {"predict", shipped("valve-stiction.toml"), "--set", "loop.controller.kp=1e50"},
      {"predict", shipped("two-mass-drive.toml"), "--set", "loop.controller.kp=1e50"},
      {"predict", shipped("belt-lugre.toml"), "--set", "loop.friction.sigma1=1e12"},
      {"simulate", shipped("froude-pendulum.toml"), "--set", "loop.plant.inertia=1e-12"}};
  for (const auto& arguments : endless) {
    INFO(arguments[1] << ' ' << arguments[3]);
    const Ran ran = limited(arguments);
    CHECK((ran.code == 0 || ran.code == 3));
    CHECK(ran.err.find("the computation did not stop") == std::string::npos);
  }
}

TEST_CASE("time limit: what is known is written, and text, JSON and exit code say that it is not all") {
  const Scratch scratch;
  const Ran ran =
      limited({"map", shipped("pid-lugre.toml"), "--x", "loop.controller.kp=1:5:200", "--y",
               "loop.controller.kd=1:9:200", "--json", scratch.file("m.json"), "--store", scratch.file("m.db")});
  CHECK(ran.code == 3);
  CHECK_THAT(ran.out, StartsWith("Time limit of 2 s reached: this result is incomplete.\n"));
  CHECK_THAT(ran.err,
             Contains("time limit of 2 s reached; the results computed so far are in") && Contains("--resume"));
  CHECK(Json::parse(scratch.get("m.json"))["status"] == "time-limit");
}

TEST_CASE("time limit: a command that ends before does not mention it, and what is no duration is refused") {
  const Scratch scratch;
  const Ran ran = run({"predict", shipped("saturation.toml"), "--time-limit", "600", "--json", scratch.file("r.json")});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.out, !Contains("imit of"));
  CHECK(Json::parse(scratch.get("r.json"))["status"] == "converged");
  for (const char* wrong : {"nan", "inf", "-1", "soon", ""})
    CHECK(run({"predict", shipped("saturation.toml"), "--time-limit", wrong}).code == 2);
}

TEST_CASE("interrupted: exit code 3 and a status in the document, whatever the command") {
  const std::vector<std::vector<std::string>> commands{
      {"claims"},
      {"map", shipped("pid-lugre.toml"), "--x", "loop.controller.kp=1:5:200", "--y", "loop.controller.kd=1:9:200"},
      {"sensitivity", shipped("pid-lugre.toml"), "--samples", "65536"},
      {"margin", shipped("two-mass-drive.toml")},
      {"remedy", shipped("two-mass-drive.toml")},
      {"tune", shipped("pid-lugre.toml"), "--vary", "kp=1:20,ki=0:5,kd=1:20", "--minimise", "settling"},
      {"continue", shipped("pid-lugre.toml"), "--parameter", "loop.controller.kd=1:50"},
      {"identify", shipped("records/carriage.toml")},
      {"experiment", "all"}};
  for (const auto& command : commands) {
    INFO(command.front());
    const Scratch scratch;
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--json", scratch.file("r.json")});
    const Ran ran = run_interrupted(arguments, 0.3);
    CHECK(ran.code == 3);
    CHECK_THAT(ran.out, StartsWith("Interrupted: this result is incomplete.\n"));
    CHECK_THAT(ran.err, Contains("limcycle: interrupted; "));
    CHECK(Json::parse(scratch.get("r.json"))["status"] == "interrupted");
  }
}

TEST_CASE("predict: exit code 3 where no start was decided") {
  // One step is not enough for any of them, and no cycle is known.
  const Ran ran =
      limited({"predict", shipped("dead-zone.toml"), "--set", "loop.plant.numerator=[1e28]", "--json", "-"});
  const auto document = Json::parse(ran.out);
  bool decided = !document["cycles"].empty();
  for (const auto& one : document["outcomes"]) {
    decided = decided || one["outcome"] != "undecided";
    if (one["outcome"] == "undecided") CHECK(!one["why"].get<std::string>().empty());
  }
  CHECK(ran.code == (decided ? 0 : 3));
}
