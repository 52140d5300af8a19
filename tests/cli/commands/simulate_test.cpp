#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/golden.hpp"
#include "limcycle/tests/cli/program.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

TEST_CASE("simulate: golden documents") { check_goldens("simulate"); }

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

TEST_CASE("simulate: states, y and inputs are those of the case, wherever the loop rests") {
  const auto document = Json::parse(
      run({"simulate", shipped("pid-lugre.toml"), "--set", "loop.reference=10.0", "--set", "loop.load=2.0", "--set",
           "simulate.initial={ y = 1.0, I = 0.25 }", "--set", "simulate.duration=400.0", "--json", "-"})
          .out);
  REQUIRE(document["columns"][1] == "state.y");
  const auto& first = document["rows"].front();
  const auto named = [&](const char* name) {
    const auto& columns = document["columns"];
    return first[static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin())];
  };
  CHECK(named("state.y") == 1.0);
  CHECK(named("state.I") == 0.25);
  CHECK(named("y") == 1.0);
  CHECK(named("loop.friction.input").get<double>() == Approx(1.0));
  double low = 1e9, high = -1e9;  // in the last period, hunting about the set-point
  for (const auto& row : document["rows"]) {
    if (row[0].get<double>() < 375.0) continue;
    low = std::min(low, row[1].get<double>());
    high = std::max(high, row[1].get<double>());
  }
  CHECK(0.5 * (low + high) == Approx(10.0).margin(1e-4));
  CHECK(0.5 * (high - low) == Approx(0.0639).epsilon(0.01));
}

TEST_CASE("simulate: a second run at tighter tolerances checks the first one") {
  const std::vector<std::string> hunting = {"simulate", shipped("pid-lugre.toml"), "--set", "simulate.duration=200.0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), hunting.begin(), hunting.end());
    return run(more);
  };
  CHECK_THAT(with({}).out, Contains("It settles on a cycle of period 24.4") && Contains("Agrees with a second run"));
  const auto good = Json::parse(with({"--json", "-"}).out);
  CHECK(good["outcome"] == "cycle");
  CHECK(good["period"].get<double>() == Approx(24.4367865).epsilon(1e-4));
  CHECK(good["agreement"]["agrees"] == true);
  CHECK(good["agreement"]["period_difference"].get<double>() < 1e-6);
  CHECK(good["agreement"]["parted"].is_null());

  const auto alone = with({"--no-check", "--json", "-"});
  CHECK(Json::parse(alone.out)["agreement"].is_null());
  CHECK(alone.err.empty());

  const std::vector<std::string> rough = {"--set", "simulate.rtol=0.1",       "--set", "loop.friction.sigma0=1e8",
                                          "--set", "loop.friction.sigma1=1e4"};
  const auto bad = with(rough);
  CHECK(bad.code == 0);
  CHECK_THAT(bad.out, Contains("Warning: a second run") && Contains("--set simulate.rtol="));
  CHECK_THAT(bad.err, Contains("Warning: a second run"));
  auto document = rough;
  document.insert(document.end(), {"--json", "-", "--quiet"});
  const auto told = with(document);
  CHECK(told.err.empty());
  CHECK(Json::parse(told.out)["agreement"]["agrees"] == false);
  CHECK(Json::parse(told.out)["agreement"]["why"].get<std::string>().size() > 10);
}

TEST_CASE("simulate: the energy balance") {
  const std::vector<std::string> servo = {"simulate", shipped("pid-lugre.toml"), "--no-check", "--json", "-"};
  const auto energy = Json::parse(run(servo).out)["energy"];
  CHECK(energy["of"] == "loop");
  CHECK(energy["balanced"] == true);
  // Only the work of the command against the friction remains.
  CHECK(energy["supplied"]["command"].get<double>() ==
        Approx(energy["dissipated"]["friction"].get<double>()).epsilon(1e-5));
  CHECK(energy["balance_difference"].get<double>() < 1e-7 * energy["turnover"].get<double>());
  auto without = servo;
  without.emplace_back("--no-audit");
  CHECK(Json::parse(run(without).out)["energy"].is_null());
  CHECK_THAT(run({"simulate", shipped("pid-lugre.toml"), "--no-check"}).out, Contains("The energy balances to"));
}

TEST_CASE("simulate: a tolerance that is too loose for the stiffness is told") {
  const std::vector<std::string> stiff = {"simulate",  shipped("pid-lugre.toml"),  "--set", "loop.friction.sigma0=1e8",
                                          "--set",     "loop.friction.sigma1=1e4", "--set", "simulate.duration=1.0",
                                          "--no-check"};
  CHECK(run(stiff).err.empty());
  auto loose = stiff;
  loose.insert(loose.end(), {"--set", "simulate.rtol=1e-4", "--json", "-"});
  const auto ran = run(loose);
  CHECK(ran.code == 0);
  CHECK_THAT(ran.err, Contains("too loose for bristles") && Contains("1e-06"));
  CHECK_THAT(Json::parse(ran.out)["notes"].dump(), Contains("too loose for bristles"));
}
