#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "limcycle/tests/cli/program.hpp"

using namespace limcycle::test;
using Json = nlohmann::ordered_json;

namespace {

const std::string servo_case = LIMCYCLE_SOURCE_DIR "/cases/pid-lugre.toml";

std::vector<std::string> small_map(std::vector<std::string> more) {
  std::vector<std::string> all{
      "map", servo_case, "--x", "loop.controller.kd=6:120:3", "--y", "loop.friction.Fs=0.5:1.5:3", "--quiet"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string without_provenance(const std::string& document) {
  Json all = Json::parse(document);
  all.erase("provenance");
  return all.dump();
}

}  // namespace

TEST_CASE("map: what happens, and that the describing function misses the hunting servo") {
  const Scratch scratch;
  const Ran ran = run(small_map({"--json", "-", "--csv", scratch.file("map.csv"), "--svg", scratch.file("map.svg"),
                                 "--html", scratch.file("map.html")}));
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "map");
  CHECK(document["x"]["parameter"] == "loop.controller.kd");
  REQUIRE(document["points"].size() == 9);
  CHECK(document["points"][0]["happens"] == "not valid");  // Fs below Fc
  CHECK(document["points"][0]["amplitude"].is_null());
  const Json& hunting = document["points"][6];
  CHECK(hunting["stable_cycles"] == 1);
  CHECK(hunting["period"].get<double>() == Approx(24.4368).epsilon(1e-5));
  CHECK(hunting["methods"][0]["worth"] == "missed");
  CHECK(document["points"][3]["happens"] == "rest");  // Fs = Fc
  CHECK(document["points"][3]["methods"][0]["worth"] == "right");
  const std::string csv = scratch.get("map.csv"), svg = scratch.get("map.svg");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 10);
  CHECK(svg.starts_with("<svg"));
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(scratch.get("map.html").find("<svg") != std::string::npos);
}

TEST_CASE("map: outcomes alone are those of the whole map, without a method, and say what may be missing") {
  const Scratch scratch;
  const Ran whole = run(small_map({"--json", "-"})), ran = run(small_map({"--outcomes", "--json", "-"}));
  REQUIRE(ran.code == 0);
  const Json full = Json::parse(whole.out), document = Json::parse(ran.out);
  REQUIRE(document["points"].size() == 9);
  for (std::size_t k = 0; k < 9; ++k) {
    CHECK(document["points"][k]["happens"] == full["points"][k]["happens"]);
    CHECK(document["points"][k]["methods"].empty());
  }
  CHECK(document["points"][6]["period"].get<double>() == Approx(24.4368).epsilon(1e-4));
  const Ran text = run(small_map({"--outcomes", "--threads", "1", "--html", scratch.file("map.html")}));
  CHECK(text.out.find("No method was judged") != std::string::npos);
  CHECK(text.out.find("Reliability") == std::string::npos);
  CHECK(scratch.get("map.html").find("--outcomes") != std::string::npos);
  const Ran both = run(small_map({"--outcomes", "--methods", "describing-function"}));
  CHECK(both.code == 2);
  CHECK(both.err.find("--methods excludes --outcomes") != std::string::npos);
}

TEST_CASE("map: the same bytes for any number of threads, and from a store that was begun and finished") {
  const Scratch scratch;
  const Ran one = run(small_map({"--threads", "1", "--json", "-"}));
  const Ran two = run(small_map({"--threads", "2", "--json", "-", "--store", scratch.file("map.store")}));
  REQUIRE(two.code == 0);
  CHECK(without_provenance(two.out) == without_provenance(one.out));
  const Ran again = run(small_map({"--json", "-", "--store", scratch.file("map.store"), "--resume"}));
  REQUIRE(again.code == 0);
  CHECK(without_provenance(again.out) == without_provenance(one.out));
  const Ran status = run({"status", scratch.file("map.store")});
  CHECK(status.code == 0);
  CHECK(status.out.find("9 of 9") != std::string::npos);

  const Ran refused = run(small_map({"--store", scratch.file("map.store")}));
  CHECK(refused.code == 2);
  CHECK(refused.err.find("--resume") != std::string::npos);
  const Ran other = run({"map", servo_case, "--set", "loop.plant.mass=2.0", "--x", "loop.controller.kd=6:120:3", "--y",
                         "loop.friction.Fs=0.5:1.5:3", "--store", scratch.file("map.store"), "--resume"});
  CHECK(other.code == 2);
}

TEST_CASE("map: what cannot be a map is refused") {
  const auto refused = [](std::vector<std::string> flags, const std::string& words) {
    std::vector<std::string> all{"map", servo_case};
    all.insert(all.end(), flags.begin(), flags.end());
    const Ran ran = run(all);
    CHECK(ran.code == 2);
    INFO(ran.err);
    CHECK(ran.err.find(words) != std::string::npos);
  };
  const std::string y = "loop.controller.ki=1:2:3";
  refused({"--x", "loop.controller.kd=1:50", "--y", y}, "PATH=FROM:TO:N");
  refused({"--x", "loop.controller.kd=1:50:1", "--y", y}, "whole number");
  refused({"--x", "loop.controller.kd=1:50:2.5", "--y", y}, "whole number");
  refused({"--x", "loop.controller.kd=0:50:5:log", "--y", y}, "one sign");
  refused({"--x", "loop.controller.kdd=1:50:5", "--y", y}, "kd");
  refused({"--x", y, "--y", y}, "must be another parameter than --x");
  refused({"--x", "loop.controller.kd=1:50:5", "--y", y, "--methods", "describing-functoin"}, "describing-function");
  refused({"--x", "loop.controller.kd=1:50:5", "--y", y, "--resume"}, "--store");
}
