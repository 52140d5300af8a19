#include "limcycle/reports/json.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using OrderedJson = nlohmann::ordered_json;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();

Provenance provenance() {
  Provenance from;
  from.version = "1.2.3";
  from.commit = "abc";
  from.seed = 18446744073709551615U;
  from.title = "a title";
  from.file = "case.toml";
  from.sha256 = std::string(64, '0');
  return from;
}

std::vector<std::string> keys(const OrderedJson& object) {
  std::vector<std::string> out;
  for (const auto& [key, value] : object.items()) out.push_back(key);
  return out;
}

using Keys = std::vector<std::string>;

}  // namespace

TEST_CASE("every document says what it is and where it comes from") {
  const auto document = OrderedJson::parse(predict_json(provenance(), {}));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "predict");
  CHECK(document["case"] == OrderedJson({{"title", "a title"},
                                         {"file", "case.toml"},
                                         {"sha256", std::string(64, '0')},
                                         {"measured", OrderedJson::array()},
                                         {"curves", OrderedJson::array()},
                                         {"matrices", OrderedJson::array()}}));
  CHECK(document["provenance"]["version"] == "1.2.3");
  CHECK(document["provenance"]["seed"] == 18446744073709551615U);
  for (const char* key : {"commit", "isa", "threads"}) CHECK(document["provenance"].contains(key));
  CHECK(OrderedJson::parse(df_json(provenance(), {}, {}))["command"] == "df");
  CHECK(OrderedJson::parse(simulate_json(provenance(), {}))["command"] == "simulate");
}

TEST_CASE("predict: a sampled loop tells of each cycle if it is locked, and of a motion that is not its spread") {
  PredictReport report = sample::relay();
  CHECK(OrderedJson::parse(predict_json(provenance(), report))["cycles"][0]["locked"].is_null());
  report.sample_time = report.cycles.front().period / 40.0;
  OutcomeOfStart one;
  one.outcome = Outcome::irregular;
  one.irregular = {0.11, 5.0, 4.9, 5.2, 200.0, 0.1, 0.09, 0.105};
  report.outcomes = {one, one};
  report.outcomes.back().irregular.mean_period = 5.01;  // the same motion, from another start
  one.irregular.mean_period = 9.0;
  one.irregular.beat_frequency = 0.25;
  report.outcomes.push_back(one);
  report.predictions.front().motion = one.irregular;
  report.predictions.front().sampling = RootSpread{0.02, 0.01};
  const auto document = OrderedJson::parse(predict_json(provenance(), report));
  const auto& cycles = document["cycles"];
  REQUIRE(cycles.size() == report.cycles.size() + 2);
  CHECK(cycles[0]["locked"] == true);
  CHECK(cycles[0]["samples"] == 40);
  const std::size_t first = report.cycles.size();
  const auto& mean = cycles[first];
  CHECK(mean["locked"] == false);
  CHECK(mean["samples"].is_null());
  CHECK(mean["period"] == 5.0);
  CHECK(mean["amplitude"] == 0.1);
  CHECK(mean["first_harmonic"].is_null());
  CHECK(mean["spread"]["period"].get<double>() == Approx(0.15));
  CHECK(mean["spread"]["amplitude"].get<double>() == Approx(0.0075));
  CHECK(document["outcomes"][0]["cycle"] == first);
  CHECK(document["outcomes"][1]["cycle"] == first);
  CHECK(document["outcomes"][2]["cycle"] == first + 1);
  CHECK(document["outcomes"][2]["beat_frequency"] == 0.25);
  CHECK_FALSE(document["outcomes"][0].contains("beat_frequency"));
  CHECK(document["predictions"][0]["cycle"] == first + 1);
  CHECK(document["predictions"][0]["sampling"] == OrderedJson({{"amplitude", 0.02}, {"frequency", 0.01}}));
}

TEST_CASE("predict: keys and values") {
  const auto document = OrderedJson::parse(predict_json(provenance(), sample::relay()));
  CHECK(keys(document) == Keys{"schema", "command", "case", "provenance", "cycles", "predictions", "missed", "outcomes",
                               "search", "absence", "cause", "notes", "status"});
  const auto& cycle = document["cycles"][0];
  CHECK(keys(cycle) == Keys{"amplitude", "first_harmonic", "period", "frequency", "offset", "stable", "multipliers",
                            "multiplier_error", "sticking_fraction", "method", "error", "residual",
                            "half_wave_symmetric", "remembered", "locked", "samples"});
  CHECK(cycle["amplitude"] == 0.65831343);
  CHECK(cycle["frequency"].get<double>() == Approx(1.0).epsilon(1e-15));
  CHECK(cycle["stable"] == true);
  CHECK(cycle["multipliers"] == OrderedJson({{0.0095, -0.001}, {0.0, 0.0}}));
  CHECK(cycle["method"] == "exact");
  const auto& predictions = document["predictions"];
  REQUIRE(predictions.size() == 2);
  CHECK(keys(predictions[0]) == Keys{"method", "amplitude", "frequency", "stable", "verdict", "cycle",
                                     "input_amplitude", "residual", "why", "harmonics", "uncertainty", "trust"});
  CHECK(predictions[0]["harmonics"] == 1);
  auto balanced = sample::relay();
  balanced.predictions[0].harmonics = 15;
  CHECK(OrderedJson::parse(predict_json(provenance(), balanced))["predictions"][0]["harmonics"] == 15);
  CHECK(predictions[0]["trust"].is_null());
  CHECK(predictions[0]["uncertainty"].is_null());
  balanced.predictions[0].spread = RootSpread{0.02, 0.01};
  CHECK(OrderedJson::parse(predict_json(provenance(), balanced))["predictions"][0]["uncertainty"] ==
        OrderedJson({{"amplitude", 0.02}, {"frequency", 0.01}}));
  CHECK(document["absence"].is_null());
  CHECK(predictions[0]["verdict"] == "confirmed");
  CHECK(predictions[0]["cycle"] == 0);
  CHECK(predictions[1]["verdict"] == "false");
  CHECK(predictions[1]["cycle"].is_null());
  CHECK(predictions[1]["stable"].is_null());
  CHECK(document["missed"] == OrderedJson::array());
  CHECK(document["outcomes"][0] ==
        OrderedJson({{"start", "y(0) = 1"}, {"outcome", "cycle"}, {"cycle", 0}, {"why", "it settles"}}));
  CHECK(document["search"] == OrderedJson({{"amplitude", {1e-6, 1.0}}, {"frequency", {0.01, 1000.0}}}));
  CHECK(document["notes"] == OrderedJson::array({"a note"}));
  CHECK(OrderedJson::parse(predict_json(provenance(), sample::hunting()))["missed"] ==
        OrderedJson::array({{{"method", "describing-function"}, {"cycle", 0}}}));
}

TEST_CASE("predict: trust indicators, bands without ends and the proof of absence") {
  const auto document = OrderedJson::parse(predict_json(provenance(), sample::trusted()));
  CHECK(document["predictions"][0]["trust"] ==
        OrderedJson({{"filter_ratio", 0.0075512345},
                     {"worst_harmonic", 3},
                     {"harmonic_residual", 0.0081},
                     {"sticking_fraction", 0.0},
                     {"band",
                      {{"kind", "rigorous"},
                       {"verdict", "proved"},
                       {"frequency", {0.98, 1.03}},
                       {"amplitude", {0.6, 0.7}},
                       {"input_amplitude", {1.2, 1.4}},
                       {"why", "crossed completely"}}},
                     {"sentence", "the loop filters the harmonics well: a cycle within 6 % of it is proved"}}));
  const auto& poor = document["predictions"][1]["trust"];
  CHECK(poor["band"]["kind"] == "heuristic");
  CHECK(poor["band"]["verdict"] == "undecided");
  CHECK(poor["band"]["frequency"] == OrderedJson::array({0.0, nullptr}));
  CHECK(poor["worst_harmonic"] == 5);
  CHECK(poor["sticking_fraction"] == 0.01);
  const auto open =
      OrderedJson::parse(predict_json(provenance(), sample::without_roots(BandVerdict::undecided)))["absence"];
  CHECK(open == OrderedJson({{"verdict", "undecided"},
                             {"frequency", {0.01, 100.0}},
                             {"input_amplitude", {1e-3, 10.0}},
                             {"undecided", {{0.01, 0.4}, {0.5, 0.6}}},
                             {"why", "an oscillation is not excluded between 0.01 and 0.6 rad/s"}}));
  const auto proved =
      OrderedJson::parse(predict_json(provenance(), sample::without_roots(BandVerdict::proved)))["absence"];
  CHECK(proved["verdict"] == "proved");
  CHECK(proved["undecided"] == OrderedJson::array());
}

TEST_CASE("predict: a number that does not exist is null") {
  auto report = sample::hunting();
  report.cycles[0].offset = not_a_number;
  report.cycles[0].error = std::numeric_limits<double>::infinity();
  report.cycles[0].multipliers = {{not_a_number, 0.0}};
  report.cycles[0].stable.reset();
  const auto cycle = OrderedJson::parse(predict_json(provenance(), report))["cycles"][0];
  CHECK(cycle["offset"].is_null());
  CHECK(cycle["error"].is_null());
  CHECK(cycle["stable"].is_null());
  CHECK(cycle["multipliers"] == OrderedJson::array({OrderedJson::array({nullptr, 0.0})}));
}

TEST_CASE("df: keys and values, one line a point") {
  DescribingFunction result;
  result.gain = {1.5, 0.25};
  result.mean = 0.125;
  result.harmonics = {{3.0, 0.5}, {0.0, -1.0}};
  result.dissipation = 3.14;
  result.error = 1e-9;
  result.method = "fft";
  DescribingFunction unanswered;
  unanswered.status = Status::not_finite;
  unanswered.harmonics = {{0.0, 0.0}};
  unanswered.method = "quadrature";
  const auto text = df_json(provenance(), {{2.0, 3.0, 0.5}, {1.0, 2.0, 0.0}}, {result, unanswered});
  const auto document = OrderedJson::parse(text);
  const auto& point = document["points"][0];
  CHECK(keys(point) == Keys{"amplitude", "frequency", "bias", "gain", "mean", "harmonics", "dissipation", "error",
                            "method", "status"});
  CHECK(point == OrderedJson({{"amplitude", 2.0},
                              {"frequency", 3.0},
                              {"bias", 0.5},
                              {"gain", {1.5, 0.25}},
                              {"mean", 0.125},
                              {"harmonics", {{3.0, 0.5}, {0.0, -1.0}}},
                              {"dissipation", 3.14},
                              {"error", 1e-9},
                              {"method", "fft"},
                              {"status", "converged"}}));
  CHECK(document["points"][1]["gain"] == OrderedJson::array({nullptr, nullptr}));
  CHECK(document["points"][1]["error"].is_null());
  CHECK(document["points"][1]["status"] == "not_finite");
  CHECK(document["status"] == "converged");
  CHECK(text.find("\n    {\"amplitude\"") != std::string::npos);
}

TEST_CASE("df: a table that was cut short says so") {
  const std::vector<DfPoint> points(3);
  CHECK(OrderedJson::parse(df_json(provenance(), points, {DescribingFunction{}}))["status"] == "interrupted");
  CHECK_THROWS_AS(df_json(provenance(), {}, {DescribingFunction{}}), std::invalid_argument);
}

TEST_CASE("simulate: columns, rows, events") {
  Simulation run;
  run.columns = {"t", "y"};
  run.rows = {{0.0, 1.0}, {0.1, not_a_number}};
  run.events = {{0.05, "loop.friction: stick"}};
  run.stepper = "rodas5p";
  run.steps = 12;
  const auto document = OrderedJson::parse(simulate_json(provenance(), run));
  CHECK(document["columns"] == OrderedJson({"t", "y"}));
  CHECK(document["rows"] == OrderedJson::array({OrderedJson::array({0.0, 1.0}), OrderedJson::array({0.1, nullptr})}));
  CHECK(document["events"] == OrderedJson::array({{{"t", 0.05}, {"what", "loop.friction: stick"}}}));
  CHECK(document["stepper"] == "rodas5p");
  CHECK(document["steps"] == 12);
  CHECK(document["status"] == "converged");
  CHECK(document["outcome"] == "undecided");
  CHECK(document["period"].is_null());
  CHECK(document["agreement"].is_null());

  Agreement second;
  second.rtol = 1e-9;
  second.period_difference = not_a_number;
  second.phase_drift = 0.25;
  second.why = "because";
  run.outcome = Outcome::cycle;
  run.period = 2.0;
  const auto both = OrderedJson::parse(simulate_json(provenance(), run, second));
  CHECK(both["outcome"] == "cycle");
  CHECK(both["period"] == 2.0);
  CHECK(both["agreement"]["rtol"] == 1e-9);
  CHECK(both["agreement"]["agrees"] == false);
  CHECK(both["agreement"]["period_difference"].is_null());
  CHECK(both["agreement"]["phase_drift"] == 0.25);
  CHECK(both["agreement"]["why"] == "because");
}

TEST_CASE("simulate: energy, with null for what the loop does not have") {
  Simulation run;
  run.notes = {"take care"};
  CHECK(OrderedJson::parse(simulate_json(provenance(), run))["energy"].is_null());
  CHECK(OrderedJson::parse(simulate_json(provenance(), run))["notes"] == OrderedJson::array({"take care"}));
  EnergyBalance energy;
  energy.of_friction = energy.of_storage = true;
  energy.rubbing = 2.0;
  energy.in_friction = 0.5;
  energy.friction = 1.25;
  energy.turnover = 2.0;
  auto document = OrderedJson::parse(simulate_json(provenance(), run, std::nullopt, energy))["energy"];
  CHECK(document["of"] == "friction");
  CHECK(document["supplied"]["friction"] == 2.0);
  CHECK(document["supplied"]["command"].is_null());
  CHECK(document["stored"]["friction"] == 0.5);
  CHECK(document["balance_difference"] == 0.25);
  CHECK(document["balanced"] == false);
  energy.of_storage = false;
  document = OrderedJson::parse(simulate_json(provenance(), run, std::nullopt, energy))["energy"];
  CHECK(document["balanced"].is_null());
  CHECK(document["dissipated"]["friction"] == 1.25);
}

TEST_CASE("text from a user cannot break a document") {
  auto from = provenance();
  from.title = "quote \" backslash \\ newline \n </script> \xFF\xFE";
  const auto document = OrderedJson::parse(predict_json(from, {}));
  CHECK(document["case"]["title"].get<std::string>() ==
        "quote \" backslash \\ newline \n </script> \xEF\xBF\xBD\xEF\xBF\xBD");
}
