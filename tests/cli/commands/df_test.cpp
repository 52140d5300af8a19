#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "limcycle/tests/cli/golden.hpp"
#include "limcycle/tests/cli/started.hpp"
#include "limcycle/tests/setting.hpp"

using namespace limcycle::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using Json = nlohmann::ordered_json;

TEST_CASE("df: golden documents") { check_goldens("df"); }

TEST_CASE("df: table, document and columns tell the same") {
  const Scratch scratch;
  const auto ran = run({"df", shipped("relay-third-order.toml"), "--set", "df.amplitude=[2.0]", "--json",
                        scratch.file("r.json"), "--csv", scratch.file("r.csv")});
  REQUIRE(ran.code == 0);
  const auto point = Json::parse(scratch.get("r.json"))["points"][0];
  const double gain = point["gain"][0];
  CHECK(gain == Approx(2.0 / std::numbers::pi).epsilon(1e-6));  // 4 M/(pi A) with M = 1, A = 2
  CHECK_THAT(ran.out, Contains("0.6366198") || Contains("0.636620"));
  std::istringstream csv(scratch.get("r.csv"));
  std::string names, row, cell;
  std::getline(csv, names);
  std::getline(csv, row);
  CHECK_THAT(names, StartsWith("amplitude,frequency,bias,gain_re,gain_im,mean,harmonic_1_sine,harmonic_1_cosine,"));
  std::istringstream cells(row);
  for (int i = 0; i < 4; ++i) std::getline(cells, cell, ',');
  CHECK(std::stod(cell) == gain);
}

TEST_CASE("df: a long table is summarised, its CSV is whole") {
  const Scratch scratch;
  const auto ran = run({"df", shipped("relay-third-order.toml"), "--set", "df.amplitude={from=0.1, to=10.0, points=21}",
                        "--set", "df.frequency={from=0.1, to=10.0, points=10}", "--csv", scratch.file("r.csv")});
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("210 of 210 points") && Contains("--csv"));
  const auto csv = scratch.get("r.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 211);
}

TEST_CASE("df: an interrupt keeps what was computed") {
  const Scratch scratch;
  const auto ran =
      run_interrupted({"df", shipped("df-lugre.toml"), "--set", "df.amplitude={from=1e-6, to=0.1, points=900}", "--set",
                       "df.frequency={from=0.1, to=1000.0, points=900}", "--set", "df.accuracy=1e-10", "--set",
                       "df.method=\"quadrature\"", "--json", scratch.file("r.json")},
                      1.0);  // instead of hours
  CHECK(ran.code == 3);
  const auto document = Json::parse(scratch.get("r.json"));
  CHECK(document["status"] == "interrupted");
  CHECK(document["points"].size() > 0);
  CHECK(document["points"].size() < 900 * 900);
  CHECK_THAT(ran.err, Contains("interrupted"));
  CHECK_THAT(ran.out, Contains("of 810000 points"));
}

TEST_CASE("df: the same numbers for any number of threads, and from a store that was interrupted and gone on with") {
  const Scratch scratch;
  const auto table = [](const std::vector<std::string>& flags) {
    std::vector<std::string> all{"df",    shipped("df-lugre.toml"),
                                 "--set", "df.amplitude={from=1e-6, to=0.1, points=40}",
                                 "--set", "df.frequency={from=0.1, to=1000.0, points=40}",
                                 "--set", "df.method=\"quadrature\"",
                                 "--set", "df.accuracy=1e-10",
                                 "--csv", "-"};
    all.insert(all.end(), flags.begin(), flags.end());
    return all;
  };
  const auto one = run(table({"--threads", "1"}));
  REQUIRE(one.code == 0);
  CHECK(run(table({"--threads", "2"})).out == one.out);
  const std::string store = scratch.file("df.store");
  std::string command = "timeout -s KILL 0.3 " + quoted(tested_program);
  for (const auto& word : table({"--store", store})) command += " " + quoted(word);
  // Usually it is killed in progress; a machine that is too fast for this tests the store of a finished run.
  static_cast<void>(std::system((command + " > " + quoted(scratch.file("cut"))).c_str()));
  const auto rest = run(table({"--store", store, "--resume"}));
  CHECK(rest.code == 0);
  CHECK(rest.out == one.out);
  CHECK_THAT(run({"status", store}).out, Contains("1600 of 1600 points"));
}
