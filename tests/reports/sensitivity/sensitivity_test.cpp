#include "limcycle/reports/sensitivity/sensitivity.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

using namespace limcycle;
using nlohmann::json;

namespace {

SensitivityReport sample_sensitivity() {
  SensitivityReport report;
  Cycle cycle;
  cycle.amplitude = 2.0;
  cycle.first_harmonic = 2.5;
  cycle.period = 4.0;
  report.cycle = cycle;
  LocalSensitivity known{"loop.element.level", "N", 0.5, 4.0, 1.0, {}, 1e-8, {}, 5.0, 1e-12, 1e-9, 1e-9, 1e-9, 2.0};
  const double none = std::numeric_limits<double>::quiet_NaN();
  LocalSensitivity unknown{
      "loop.controller.lag", "s", 0.0, none, none, {}, none, "no value", none, none, none, none, none, none};
  report.local = {known, unknown};

  PredictedOscillation predicted;
  predicted.found.amplitude = 2.0;
  predicted.found.frequency = 1.5;
  predicted.found.gain = {8.0, -0.25};
  predicted.found.gain_error = 1e-9;
  predicted.numbers = {{"loop.element.level", "N", 0.5, {{{16.0, 0.0}, 1e-7}, 4.0, 1e-8, 0.0, 1e-8}, {}},
                       {"loop.controller.lag", "s", 0.0, {}, "no value"}};
  report.predicted.push_back(predicted);

  ThresholdSensitivity threshold{"loop.element.level", "N", 0.5, true, false, 0.25, 1e-9, "the branch turns back", {}};
  threshold.numbers = {{"loop.plant.mass", "kg", 1.0, {0.125, 1e-7}, {}},
                       {"loop.reference", "m", 0.0, {1e-9, 1e-7}, {}},
                       {"loop.controller.lag", "s", 0.0, {}, "no value"}};
  report.thresholds.push_back(threshold);
  return report;
}

}  // namespace

TEST_CASE("sensitivity reports: tables of harmonics, predictions and thresholds") {
  const auto report = sample_sensitivity();
  const Units units;
  const Table derivatives = derivative_table(report, units);
  REQUIRE(derivatives.rows.size() == 1);  // the derivative of the period is within its error
  CHECK(derivatives.rows[0] == std::vector<std::string>{"element.level", "0.500000", "4.000000000", "0", "1.000", "0"});
  const Table harmonics = harmonic_table(report, units);
  REQUIRE(harmonics.rows.size() == 1);
  CHECK(harmonics.rows[0] == std::vector<std::string>{"element.level", "5.000000000", "0", "1.000"});
  const Table predictions = predicted_table(report.predicted[0], units);
  REQUIRE(predictions.rows.size() == 1);
  CHECK(predictions.rows[0].back() == "0");  // within its error
  CHECK(gain_table(report.predicted[0], units).rows.at(0).at(2) == "0");
  CHECK(predicted_heading(report, 0) == "What the describing function predicts");
  CHECK(predicted_sentence(report.predicted[0], units).find("8.000000000 - 0.250000000j") != std::string::npos);
  const Table thresholds = threshold_table(report.thresholds[0]);
  REQUIRE(thresholds.rows.size() == 2);
  CHECK(thresholds.rows[0].back() == "0.5000");
  CHECK(thresholds.rows[1][2] == "0");
  CHECK(threshold_sentence(report.thresholds[0]).starts_with("Hunting ends at loop.element.level = 0.25"));

  const std::string text = sensitivity_text("title", report, units);
  CHECK(text.find("Threshold") != std::string::npos);
  CHECK(text.find("nan") == std::string::npos);
  // The common reason is stated once.
  CHECK(text.find("no derivative by controller.lag") != std::string::npos);
  CHECK(text.find("no derivative of the threshold") == std::string::npos);
  CHECK(threshold_picture(report.thresholds[0]).find("plant.mass") != std::string::npos);
  CHECK(threshold_picture(report.thresholds[0]).find("reference") == std::string::npos);
}

TEST_CASE("sensitivity reports: a threshold that was not found, and one that cannot be derived") {
  auto report = sample_sensitivity();
  report.thresholds[0].known = false;
  report.thresholds[0].why = "it hunts all the way";
  report.thresholds[0].numbers.clear();
  CHECK(threshold_sentence(report.thresholds[0]) ==
        "No threshold of loop.element.level was found: it hunts all the way.");
  CHECK(threshold_picture(report.thresholds[0]).empty());
  const json none = json::parse(sensitivity_json({}, report))["thresholds"][0];
  CHECK(none["at"].is_null());
  CHECK(none["what"] == "none");

  report = sample_sensitivity();
  for (auto& one : report.thresholds[0].numbers) one.why = "the branch ends otherwise";
  const auto notes = sensitivity_notes(report);
  CHECK(std::ranges::count(notes, "no derivatives of the threshold of element.level: the branch ends otherwise") == 1);
}

TEST_CASE("sensitivity reports: JSON and CSV") {
  const auto report = sample_sensitivity();
  const json document = json::parse(sensitivity_json({}, report));
  CHECK(document["parameters"][0]["derivative"]["first_harmonic"] == 5.0);
  CHECK(document["parameters"][0]["elasticity"]["first_harmonic"] == 1.0);
  CHECK(document["parameters"][1]["derivative"]["offset"].is_null());
  CHECK(document["predicted"][0]["gain"][1] == -0.25);
  CHECK(document["predicted"][0]["parameters"][0]["elasticity"]["amplitude"] == 1.0);
  CHECK(document["predicted"][0]["parameters"][1]["derivative"]["gain"].is_null());
  CHECK(document["thresholds"][0]["at"] == 0.25);
  CHECK(document["thresholds"][0]["parameters"][0]["elasticity"] == 0.5);
  CHECK(document["thresholds"][0]["parameters"][2]["derivative"].is_null());
  const std::string csv = sensitivity_csv(report);
  CHECK(csv.find("local,loop.element.level,first_harmonic,5,,,,derivative") != std::string::npos);
  CHECK(csv.find("predicted,loop.element.level,real gain of prediction 0,16,,,,derivative") != std::string::npos);
  CHECK(csv.find("threshold,loop.plant.mass,loop.element.level,0.125,,,,derivative") != std::string::npos);
  CHECK(csv.find("threshold,loop.controller.lag") == std::string::npos);
}
