#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/golden.hpp"
#include "limcycle/tests/cli/program.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

TEST_CASE("simulate: golden documents") {
  for (const auto& golden : goldens_of("simulate")) {
    auto arguments = golden.arguments;
    arguments.insert(arguments.end(), {"--json", "-"});
    const auto ran = run(arguments);
    INFO(golden.name);
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK(difference(golden.document, Json::parse(ran.out)) == "");
  }
}

TEST_CASE("simulate: -o takes the samples, the summary stays on stdout") {
  const Scratch scratch;
  const std::vector<std::string> run_of_10_s = {
      "simulate", shipped("pid-lugre.toml"), "--set", "simulate.duration=10.0", "--set", "simulate.sample=0.5"};
  auto arguments = run_of_10_s;
  arguments.insert(arguments.end(), {"-o", scratch.file("run.csv")});
  const auto ran = run(arguments);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("21 samples") && Contains("loop.friction.output"));
  const auto csv = scratch.get("run.csv");
  CHECK_THAT(csv, StartsWith("t,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 22);

  arguments = run_of_10_s;
  arguments.insert(arguments.end(), {"--csv", "-"});
  CHECK(run(arguments).out == csv);
}
