#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle::test;
using Json = nlohmann::ordered_json;

namespace {

const std::string lugre_case = LIMCYCLE_SOURCE_DIR "/cases/pid-lugre.toml";

const char* const spread_section = R"(
[sensitivity]
samples = 64
parameters = [
  {path = "loop.friction.Fs", from = 0.9, to = 1.8},
  {path = "loop.controller.kd", factor = 1.5},
  {path = "loop.friction.vs", distribution = "log-uniform", from = 1e-4, to = 1e-2},
]
)";

std::string with_spread(const Scratch& scratch) {
  std::ifstream in(lugre_case, std::ios::binary);
  return scratch.put("spread.toml", std::string(std::istreambuf_iterator<char>(in), {}) + spread_section);
}

Json parameter(const Json& document, const std::string& name) {
  for (const auto& one : document["parameters"])
    if (one["name"] == name) return one;
  return nullptr;
}

}  // namespace

TEST_CASE("sensitivity: derivatives, changes, indices and the share of loops without a case") {
  const Scratch scratch;
  const Ran ran = run({"sensitivity", with_spread(scratch), "--json", "-", "--quiet", "--html", scratch.file("s.html"),
                       "--csv", scratch.file("s.csv")});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  const Json kp = parameter(document, "loop.controller.kp"), Fs = parameter(document, "loop.friction.Fs");
  // From differences of cycles of `predict`, with Fs and kp changed by a relative 1e-4.
  CHECK(kp["derivative"]["period"].get<double>() == Approx(4.749126).epsilon(1e-5));
  CHECK(Fs["derivative"]["amplitude"].get<double>() == Approx(0.1234977).epsilon(1e-5));
  CHECK(kp["elasticity"]["period"].get<double>() ==
        Approx(kp["derivative"]["period"].get<double>() * 3.0 / document["cycle"]["period"].get<double>()));
  CHECK(parameter(document, "loop.controller.tf")["derivative"]["period"].is_null());

  bool twice = false;
  for (const auto& change : document["one_at_a_time"])
    twice = twice || (change["name"] == "loop.controller.kd" && change["factor"] == 2.0 && change["hunts"] == true);
  CHECK(twice);
  CHECK(document["morris"].size() == 9);  // three parameters, three outputs
  CHECK(document["sobol"].size() == 9);
  for (const auto& one : document["sobol"]) CHECK(one.contains("total_interval"));
  // A ninth of the range of Fs is below Fc: there is no valid case, and so no answer.
  CHECK(document["robustness"]["not_valid"].get<int>() > 5);
  CHECK(document["robustness"]["undecided"] == 0);
  CHECK(document["share_without_answer"].get<double>() == Approx(1.0 / 9.0).margin(0.04));
  CHECK(document["robustness"]["probability_of_hunting"].get<double>() > 0.5);
  CHECK(scratch.get("s.html").find("Elasticities") != std::string::npos);
  CHECK_FALSE(std::regex_search(scratch.get("s.html"), std::regex("\\bnan\\b")));
  CHECK(scratch.get("s.csv").starts_with("kind,name,output,value"));
}

TEST_CASE("sensitivity: correlated numbers have bands and a probability, but no shares of the variance") {
  const Scratch scratch;
  const auto asked = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"sensitivity",
                                   with_spread(scratch),
                                   "--json",
                                   "-",
                                   "--quiet",
                                   "--samples",
                                   "128",
                                   "--html",
                                   scratch.file("c.html"),
                                   "--csv",
                                   scratch.file("c.csv"),
                                   "--set",
                                   "sensitivity.parameters=[{path=\"loop.friction.Fs\",from=1.3,to=1.7},"
                                   "{path=\"loop.controller.kp\",factor=1.5}]"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = run(words);
    REQUIRE(ran.code == 0);
    return Json::parse(ran.out);
  };
  const Json alone = asked({});
  CHECK(alone["correlations"].empty());
  CHECK(alone["bands"].size() == 2);
  const Json joint =
      asked({"--set", "sensitivity.correlation=[{between=[\"loop.friction.Fs\",\"loop.controller.kp\"],value=0.9}]"});
  CHECK(joint["morris"].empty());
  CHECK(joint["sobol"].empty());
  CHECK(joint["correlations"][0]["value"] == 0.9);
  REQUIRE(joint["bands"].size() == 2);
  for (const auto& band : joint["bands"]) CHECK((band["low"] < band["median"] && band["median"] < band["high"]));
  CHECK(joint["robustness"]["matters_most"].is_null());
  // A stiffer loop with more stiction: amplitude rises with Fs and falls with kp, so that the band becomes narrower.
  const auto width = [](const Json& document) {
    for (const auto& band : document["bands"])
      if (band["output"] == "amplitude") return band["high"].get<double>() - band["low"].get<double>();
    return 0.0;
  };
  CHECK(width(joint) < 0.8 * width(alone));
  CHECK(scratch.get("c.csv").find("\nband,,period,") != std::string::npos);
  CHECK(scratch.get("c.html").find("95 % of the loops lie between") != std::string::npos);
}

TEST_CASE("sensitivity: the same for any number of threads, and from a store") {
  const Scratch scratch;
  const std::string from = with_spread(scratch), count = std::to_string(8 * limcycle::test::samples(8));
  const auto document = [&](std::vector<std::string> flags) {
    std::vector<std::string> all{"sensitivity", from, "--json", "-", "--quiet", "--samples", count};
    all.insert(all.end(), flags.begin(), flags.end());
    const Ran ran = run(all);
    REQUIRE(ran.code == 0);
    Json made = Json::parse(ran.out);
    made.erase("provenance");
    return made.dump();
  };
  const std::string one = document({"--threads", "1"});
  CHECK(document({"--threads", "2", "--store", scratch.file("s.store")}) == one);
  CHECK(document({"--store", scratch.file("s.store"), "--resume"}) == one);
  const Ran other = run({"sensitivity", from, "--seed", "7", "--store", scratch.file("s.store"), "--resume"});
  CHECK(other.code == 2);
}

TEST_CASE("sensitivity: without a cycle there is nothing to differentiate, and that is said") {
  const Ran ran =
      run({"sensitivity", lugre_case, "--set", "loop.friction.Fs=1.0", "--local", "--json", "-", "--quiet"});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  CHECK(document["cycle"].is_null());
  CHECK(document["parameters"].empty());
  CHECK(document["share_without_answer"].is_null());
  CHECK(document["answer"].get<std::string>().find("no stable limit cycle") != std::string::npos);
  CHECK(run({"sensitivity", lugre_case, "--factors", "0,2"}).code == 2);
}

TEST_CASE("sensitivity: harmonics, predictions and thresholds") {
  const Scratch scratch;
  const std::string relay_case = LIMCYCLE_SOURCE_DIR "/cases/relay-third-order.toml";
  const Ran ran = run({"sensitivity", relay_case, "--set", "loop.element.dead_zone=0.05", "--local", "--factors", "1.1",
                       "--threshold", "loop.element.dead_zone", "--threshold", "loop.element.level", "--json", "-",
                       "--quiet", "--html", scratch.file("s.html"), "--csv", scratch.file("s.csv")});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  // For small constants the relay is a gain k: y = k/(1 + k) r + 1/(1 + k) load.
  const auto of = [](const Json& one) { return one["derivative"]["offset"].get<double>(); };
  CHECK(of(parameter(document, "loop.reference")) + of(parameter(document, "loop.load")) == Approx(1.0).epsilon(1e-6));
  CHECK(parameter(document, "loop.element.level")["elasticity"]["first_harmonic"].get<double>() > 1.0);

  REQUIRE(document["predicted"].size() == 2);
  CHECK(document["predicted"][0]["gain"][0].get<double>() == Approx(8.0).epsilon(1e-6));
  const Json by_level = parameter(document["predicted"][0], "loop.element.level");
  REQUIRE_FALSE(by_level.is_null());
  CHECK(by_level["derivative"]["gain"][0].get<double>() == Approx(8.0).epsilon(1e-6));

  REQUIRE(document["thresholds"].size() == 2);
  const Json& zone = document["thresholds"][0];
  CHECK(zone["what"] == "ends");
  CHECK(zone["at"].get<double>() == Approx(0.08187508).epsilon(1e-6));
  bool by_the_level = false;
  for (const auto& one : zone["parameters"]) {
    CHECK(one["name"] != "loop.element.dead_zone");
    if (one["name"] != "loop.element.level") continue;
    by_the_level = true;  // only the ratio of both counts
    CHECK(one["elasticity"].get<double>() == Approx(1.0).epsilon(1e-5));
  }
  CHECK(by_the_level);
  CHECK(scratch.get("s.html").find("Elasticities of the threshold of element.dead_zone") != std::string::npos);
  CHECK_FALSE(std::regex_search(scratch.get("s.html"), std::regex("\\bnan\\b")));
  CHECK(scratch.get("s.csv").find("threshold,loop.element.level,loop.element.dead_zone,0.0818") != std::string::npos);
  CHECK(scratch.get("s.csv").find("predicted,loop.element.level,amplitude of prediction 0,") != std::string::npos);

  CHECK(run({"sensitivity", relay_case, "--local", "--threshold", "loop.element.dead_zone"}).code == 2);  // it is 0
  CHECK(run({"sensitivity", relay_case, "--local", "--threshold", "loop.element.nothing"}).code == 2);
}

TEST_CASE("sensitivity: without a cycle, where hunting begins") {
  const std::string relay_case = LIMCYCLE_SOURCE_DIR "/cases/relay-third-order.toml";
  const Ran ran = run({"sensitivity", relay_case, "--set", "loop.element.dead_zone=0.1", "--local", "--factors", "1.1",
                       "--threshold", "loop.element.level", "--json", "-", "--quiet"});
  REQUIRE(ran.code == 0);
  const Json document = Json::parse(ran.out);
  CHECK(document["cycle"].is_null());
  REQUIRE(document["thresholds"].size() == 1);
  const Json& level = document["thresholds"][0];
  CHECK(level["what"] == "begins");
  CHECK(level["at"].get<double>() == Approx(0.1 / 0.08187508).epsilon(1e-6));
  for (const auto& one : level["parameters"]) {
    if (one["name"] == "loop.element.dead_zone")
      CHECK(one["derivative"].get<double>() == Approx(1.0 / 0.08187508).epsilon(1e-5));
  }
}
