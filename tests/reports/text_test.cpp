#include "limcycle/reports/text.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <sstream>

#include "limcycle/reports/figures/multipliers.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"
#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::size_t widest(const std::string& text) {
  std::size_t width = 0;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) width = std::max(width, display_width(line));
  return width;
}

PredictReport quiet(std::vector<Outcome> outcomes) {
  auto report = sample::hunting();
  report.cycles.clear();
  report.missed.clear();
  report.outcomes.clear();
  for (const auto outcome : outcomes) report.outcomes.push_back({"a start", outcome, "", {}, {}});
  return report;
}

}  // namespace

TEST_CASE("predict: the answer stands first, in words") {
  const auto text = predict_text("A servo", sample::hunting(), {});
  CHECK_THAT(text,
             StartsWith("A servo\n\nThis loop hunts: it settles into a limit cycle of period 24.44 s and amplitude\n"
                        "0.06390 m.\nThe describing function does not find this cycle.\n"));
  CHECK_THAT(text, Contains("24.436786456  0.06390312346"));
  CHECK_THAT(text, Contains("- a note") || Contains("-  a note"));
  CHECK(widest(text) <= 80);
}

TEST_CASE("predict: predictions with their verdicts and deviations") {
  const VerdictText words = answer(sample::relay(), {"", ""});
  CHECK(words.what_happens ==
        "This loop oscillates: it settles into a limit cycle of period 6.283 s and amplitude 0.6583.");
  REQUIRE(words.worth.size() == 1);
  CHECK(words.worth[0] == "The describing function predicts 2 limit cycles: 1 confirmed, 1 false.");
  auto one = sample::relay();
  one.predictions.resize(1);
  CHECK(answer(one, {}).worth[0] ==
        "The describing function finds it: amplitude 2.0 % too low, frequency 1.0 % too high.");
  one.predictions[0].verdict = Verdict::biased;
  CHECK_THAT(answer(one, {}).worth[0],
             Contains("finds it, but the amplitude is 2.0 % too low and the frequency 1.0 % too high."));
  one.predictions[0].verdict = Verdict::wrong;
  CHECK(answer(one, {}).worth[0] ==
        "The describing function predicts a limit cycle (amplitude 0.6370 m, frequency 1.010 rad/s) that does not "
        "exist.");
  one.missed = {{"describing-function", 0}};
  CHECK_THAT(answer(one, {}).worth[0], Contains("does not exist; it does not find the cycle that exists."));
  const auto text = predict_text("Relay", sample::relay(), {"", ""});
  CHECK_THAT(text, Contains("confirmed") && Contains("false") && Contains("it comes to rest"));
  CHECK(widest(text) <= 80);
}

TEST_CASE("predict: of several cycles the one that is predicted is told") {
  auto two = sample::relay();
  two.predictions.resize(1);
  two.cycles.push_back(two.cycles[0]);
  two.cycles[0].stable = false;
  CHECK_THAT(answer(two, {}).worth[0],
             StartsWith("The describing function finds the unstable cycle of period 6.283 s: amplitude 2.0 %"));
  CHECK_THAT(answer(two, {}).what_happens, Contains(". One more is unstable."));
  two.cycles[0].stable.reset();
  CHECK_THAT(answer(two, {}).worth[0], StartsWith("The describing function finds the cycle of period 6.283 s: "));
  CHECK_THAT(answer(two, {}).what_happens, Contains(" One more is not stable or undecided."));
}

TEST_CASE("predict: trust in the predictions, with bands that are proved, heuristic or unknown") {
  const auto text = predict_text("Relay", sample::trusted(), {});
  CHECK_THAT(text, Contains("Trust in the predictions") && Contains("a cycle within 6 % of it is proved"));
  CHECK_THAT(text, Contains("0.9800 to 1.030") && Contains("0.6000 to 0.7000  proved\n"));
  CHECK_THAT(text, Contains("unknown") && Contains("heuristic\n") && Contains("0.0076") && Contains("1 %"));
  CHECK(widest(text) <= 80);
  const auto table = trust_table(sample::trusted(), {});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].back() == "proved");
  CHECK(table.rows[1].back() == "heuristic");  // it is never called proved, whatever the result
  CHECK(trust_table(sample::relay(), {}).rows.empty());
  CHECK(predict_text("Relay", sample::relay(), {}).find("Trust") == std::string::npos);
}

TEST_CASE("predict: absence of oscillations is proved, or said not to be") {
  CHECK_THAT(predict_text("x", sample::without_roots(BandVerdict::proved), {}),
             Contains("Absence of oscillations\nProved (Mees and Bergen 1975): no error disc meets -Psi.\n"));
  CHECK_THAT(predict_text("x", sample::without_roots(BandVerdict::undecided), {}),
             Contains("Not proved (Mees and Bergen 1975): an oscillation is not excluded"));
  CHECK(absence_in_words(sample::hunting()).empty());
}

TEST_CASE("predict: what is said without a cycle") {
  const auto first = [](const PredictReport& report) { return answer(report, {}).what_happens; };
  CHECK(first(quiet({Outcome::rest, Outcome::rest})) == "This loop does not hunt: from all 2 starts it comes to rest.");
  CHECK(first(quiet({Outcome::sliding})) == "This loop does not hunt: from its only start it ends in steady sliding.");
  CHECK_THAT(first(quiet({Outcome::rest, Outcome::undecided})),
             StartsWith("Whether this loop has a limit cycle is undecided"));
  CHECK_THAT(first(quiet({Outcome::rest, Outcome::divergence})), Contains("from 1 of 2 starts it diverges"));
  CHECK_THAT(first(quiet({})), Contains("Not verified in the time domain"));
  CHECK(answer(quiet({Outcome::rest}), {}).worth[0] == "The describing function predicts none either.");
  CHECK(answer(quiet({Outcome::undecided}), {}).worth[0] ==
        "The describing function predicts no limit cycle in the search box.");
}

TEST_CASE("predict: a method that was not applicable is not said to predict nothing") {
  auto report = quiet({Outcome::rest});
  report.describing_function = false;
  CHECK(answer(report, {}).worth.empty());
}

TEST_CASE("predict: harmonic balance, which searches no box, finds no cycle") {
  auto report = sample::hunting();
  report.missed.push_back({"harmonic-balance", 0});
  CHECK(answer(report, {}).worth.back() == "Harmonic balance finds no cycle here.");
  report.predictions = {
      {"harmonic-balance", 0.1, 7.0, 0.1, 2e-12, std::nullopt, Verdict::wrong, std::nullopt, "it comes to rest"}};
  CHECK_THAT(answer(report, {}).worth.back(), Contains("that does not exist; it does not find the cycle that exists."));
}

TEST_CASE("predict: Floquet multipliers, the largest few, of the period they belong to") {
  CHECK(multipliers_in_words({}) == "");
  CHECK(multipliers_in_words({{-1.25, 0.0}, {0.5, 0.0}}) == "-1.25, 0.500");
  CHECK(multipliers_in_words({{0.9, 0.1}, {0.9, -0.1}, {0.5, 0.0}, {1e-9, 0.0}, {0.0, 0.0}}) ==
        "0.900 ± 0.100j, 0.500, 2 below 1e-06");
  CHECK(multipliers_in_words(std::vector<std::complex<double>>(9, 0.5)) ==
        "0.500, 0.500, 0.500, 0.500, 0.500, 0.500, 0.500, 2 smaller");
  CHECK(multipliers_in_words({{0.0, 0.0}}) == "1 below 1e-06");
  CHECK(multipliers_in_words({{0.0095, -0.001}}) == "0.00950 - 0.00100j");
  const auto text = predict_text("A servo", sample::hunting(), {});
  CHECK_THAT(text, Contains("Floquet multipliers, without the trivial 1\n") &&
                       Contains("0  24.44  0.00950 - 0.00100j, 1 below 1e-06\n"));
  auto report = sample::hunting();
  report.cycles[0].multipliers.clear();
  CHECK(predict_text("A servo", report, {}).find("Floquet") == std::string::npos);
  report.cycles[0].multipliers.assign(40, {-0.123456789, 0.234567});
  CHECK(widest(predict_text("A servo", report, {})) <= 80);
}

TEST_CASE("predict: unstable cycles and interrupted work are named") {
  auto report = sample::hunting();
  report.cycles[0].stable = false;
  report.outcomes = {{"a start", Outcome::rest, "", {}, {}}};
  CHECK_THAT(answer(report, {}).what_happens, Contains("but it is unstable") && Contains("comes to rest"));
  report.cycles[0].stable.reset();
  CHECK_THAT(answer(report, {}).what_happens, Contains("stability was not determined"));
  report.status = Status::interrupted;
  CHECK_THAT(answer(report, {}).what_happens, StartsWith("Interrupted; partial result: "));
  CHECK_THAT(predict_text("x", report, {}), Contains("Status: interrupted"));
}

TEST_CASE("predict: a search that was interrupted is not said to predict none") {
  PredictReport report = sample::hunting();
  std::erase_if(report.predictions, [](const auto& one) { return one.method == "describing-function"; });
  report.missed.clear();
  report.unfinished = {"describing-function"};
  report.status = Status::interrupted;
  const std::string text = predict_text("servo", report, {});
  CHECK(text.find("The describing function was interrupted after 0 predictions: it may predict") != std::string::npos);
  CHECK(text.find("predicts none") == std::string::npos);
}

TEST_CASE("df: a short table is printed, a long one summarised") {
  DescribingFunction result;
  result.gain = {7.219, 127.419};
  result.dissipation = 0.04;
  result.error = 3e-7;
  result.method = "quadrature";
  const std::vector<DfPoint> points(longest_table + 1, {1e-2, 1.0, 0.0});
  const auto small = df_text("LuGre", {points[0]}, {result});
  CHECK_THAT(small, Contains("7.21900  127.4190") && Contains("3.0e-07") && Contains("1 of 1 points"));
  CHECK(small.find("bias") == std::string::npos);
  CHECK(widest(small) <= 80);
  const auto large = df_text("LuGre", points, std::vector(points.size(), result));
  CHECK_THAT(large, Contains("--csv") && Contains("201 of 201 points") && Contains("201 by\nquadrature."));
  CHECK(large.size() < 1000);
}

TEST_CASE("df: points without an answer show none") {
  DescribingFunction none;
  none.status = Status::not_finite;
  const auto text = df_text("x", {{1.0, 1.0, 0.0}}, {none});
  CHECK_THAT(text, Contains("1 point: not_finite."));
  CHECK_THAT(text, Contains("-  ") || Contains("  -"));
}

TEST_CASE("simulate: how it went and where it has been") {
  Simulation run;
  run.columns = {"t", "y"};
  run.rows = {{0.0, 1.0}, {0.5, -2.0}, {1.0, 0.5}};
  run.events = {{0.2, "stick"}, {0.4, "stick"}};
  run.stepper = "rodas5p";
  run.steps = 7;
  const auto text = simulate_text("x", run);
  CHECK_THAT(text, Contains("3 samples, 7 steps of rodas5p.") && Contains("-2.00000") && Contains("2  stick"));
  run.status = Status::stalled;
  run.why = "the step became too small";
  CHECK_THAT(simulate_text("x", run), Contains("ended early: stalled") && Contains("too small"));
}

TEST_CASE("simulate: the energy balance") {
  Simulation run;
  run.notes = {"take care"};
  EnergyBalance energy;
  energy.of_plant = energy.of_friction = true;
  energy.command = 4.0;
  energy.kinetic = 1.0;
  energy.friction = 2.999;
  energy.turnover = 4.0;
  energy.allowed = 0.01;
  const auto text = simulate_text("x", run, std::nullopt, energy);
  CHECK_THAT(text, Contains("The energy balances to 2.5e-04 of 4.000 J turned over.") && Contains("take care"));
  CHECK_THAT(text, Contains("by the command") && Contains("2.99900") && Contains("by friction (or stored in it)"));
  CHECK_THAT(text, !Contains("by the load") && !Contains("dampers"));  // zeros
  CHECK(widest(text) <= 80);
  energy.allowed = 1e-4;
  CHECK_THAT(energy_in_words(energy), Catch::Matchers::StartsWith("Warning: the energy does not balance"));
  energy.of_plant = false;
  energy.rubbing = 2.999;
  CHECK_THAT(energy_in_words(energy), Contains("no balance"));
  CHECK_THAT(simulate_text("x", run, std::nullopt, energy), Contains("to the friction"));
  CHECK_THAT(simulate_text("x", run), !Contains("nergy"));
}

TEST_CASE("simulate: what it comes to, and what a second run says of it") {
  Simulation run;
  run.outcome = Outcome::cycle;
  run.period = 24.4367;
  run.amplitude = 0.0687;
  Agreement second;
  second.rtol = 1e-9;
  second.agrees = true;
  second.position_difference = 1.2e-6;
  second.phase_drift = 3e-5;
  second.period_difference = 2e-8;
  second.amplitude_difference = 4e-8;
  const auto text = simulate_text("x", run, second);
  CHECK_THAT(text, Contains("It settles on a cycle of period 24.437 s and amplitude 0.0687") &&
                       Contains("Agrees with a second run with rtol = 1.0e-09"));
  CHECK(widest(text) <= 80);
  second.period_difference = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(agreement_in_words(second), Contains("1.2e-06") && Contains("3.0e-05 s.") && !Contains("period"));
  second.agrees = false;
  second.why = "y parts at t = 37 s";
  CHECK(agreement_in_words(second) ==
        "Warning: a second run with rtol = 1.0e-09 disagrees: y parts at t = 37 s. Try --set simulate.rtol=1.0e-09.");
  run.outcome = Outcome::rest;
  CHECK_THAT(simulate_text("x", run), Contains("It comes to rest.") && !Contains("second run"));
}
