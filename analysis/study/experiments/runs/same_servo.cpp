#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

using Clock = std::chrono::steady_clock;

/// A law without an answer of the methods by then is left undecided, s.
constexpr double patience = 60.0, patience_with_mass = 6.0;
constexpr int most_states = 2, starts = 2;

constexpr double viscous = 0.4;  // N s/m, for the laws with a viscous part

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

Loop servo(const LawSetting& setting) {
  Mass mass;
  mass.mass = 1.0;
  Pid pid;
  pid.kp = 3.0;
  pid.ki = 4.0;
  pid.kd = 6.0;
  const LawSetting with_viscous =
      has_parameter(setting.kind, "sigma2") ? setting.with("sigma2", viscous, true) : setting;
  LoopParts parts;
  parts.plant = mass;
  parts.controller = pid;
  parts.friction = make_law(with_viscous);
  return build_loop(parts);
}

bool unfinished(const PredictReport& report, const std::string& method) {
  return std::ranges::find(report.unfinished, method) != report.unfinished.end();
}

std::string verdict_on(const PredictReport& report, const std::string& method, double seconds) {
  if (unfinished(report, method)) return "not answered within " + quantity(seconds, "s");
  std::string words;
  for (const auto& one : report.predictions) {
    if (one.method != method) continue;
    words += (words.empty() ? "" : ", ") + std::string(to_string(one.verdict));
  }
  const bool missed = std::ranges::any_of(report.missed, [&](const Missed& m) { return m.method == method; });
  if (words.empty() && !searched_completely(report, method)) words = "finds none (search incomplete)";
  if (words.empty()) words = missed ? "does not find it" : "predicts none";
  return words;
}

double count_of(const PredictReport& report, const std::string& method) {
  if (unfinished(report, method)) return NAN;
  return static_cast<double>(std::ranges::count(report.predictions, method, &Prediction::method));
}

/// Both methods in turn: that of mass and law together only for laws of few states, and with less patience, so that the
/// answer of the other is not lost.
struct Answers {
  PredictReport alone;
  std::optional<PredictReport> together;
};

PredictReport asked(const Loop& loop, bool with_mass, double seconds, const std::function<bool()>& stop) {
  const auto begin = Clock::now();
  PredictOptions options;
  options.starts = starts;
  options.methods = {!with_mass, with_mass, false};
  options.stop = [&] { return seconds_since(begin) > seconds || (stop && stop()); };
  return predict(loop, options);
}

Answers answers(const LawSetting& setting) {
  const Loop loop = servo(setting);
  Answers found{asked(loop, false, patience, setting.stop), std::nullopt};
  const int states = loop.elements.back().states();
  if (states <= most_states) found.together = asked(loop, true, patience_with_mass, setting.stop);
  return found;
}

std::string in_words(const std::optional<PredictReport>& report) {
  if (!report) return "not computed, too many states";
  return verdict_on(*report, "composite-describing-function", patience_with_mass);
}

LawPart one(const LawSetting& setting) {
  const auto begin = Clock::now();
  const Answers found = answers(setting);
  const PredictReport& report = found.alone;
  const double cost = seconds_since(begin);
  LawPart part;
  part.status = report.status == Status::no_cycle ? Status::converged : report.status;
  const auto cycle = std::ranges::find_if(report.cycles, [](const Cycle& c) { return c.stable == true; });
  const bool hunts = cycle != report.cycles.end();
  const double composite = found.together ? count_of(*found.together, "composite-describing-function") : NAN;
  part.rows.push_back({"",
                       "",
                       {count_of(report, "describing-function"), composite, hunts ? cycle->period : NAN,
                        hunts ? cycle->amplitude : NAN, hunts ? cycle->sticking_fraction : NAN, cost}});
  if (hunts) {
    part.add(0, thinned("", cycle->trace.t, cycle->trace.y));
    part.add(1, thinned("", cycle->trace.input, cycle->trace.output));
    part.finding = "hunts with a period of " + quantity(cycle->period, "s", 5) + " and an amplitude of " +
                   quantity(cycle->amplitude, "m", 4);
  } else if (report.status == Status::interrupted && report.outcomes.size() < starts) {
    part.finding = "not answered within " + quantity(patience, "s");
  } else {
    const bool rests =
        std::ranges::any_of(report.outcomes, [](const OutcomeOfStart& o) { return o.outcome == Outcome::rest; });
    part.finding = rests ? "comes to rest" : "no limit cycle found, nor rest";
  }
  part.finding += "; describing function: " + verdict_on(report, "describing-function", patience) +
                  "; with the mass: " + in_words(found.together) + "; " + quantity(cost, "s", 2);
  return part;
}

}  // namespace

Experiment same_servo_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "same-servo";
  e.title = "One PID servo, every friction law: which hunt, and which methods predict it";
  e.document =
      "the PID example of the LuGre paper of 1995; the thesis uses its describing function for such a prediction "
      "without printing the result";
  e.input =
      "mass 1 kg, kp = 3, ki = 4, kd = 6, set-point 0; every limit cycle predicted by describing functions (of the law "
      "alone, and of mass and law together) and checked by simulation and shooting; the cost is time on a clock. "
      "sigma2 = 0.4 N s/m where a law has it, as in that paper; a search that takes longer than 60 s (6 s with the "
      "mass) "
      "is left unanswered";
  e.quantities = {{"df", "DF cycles", ""},         {"composite", "composite", ""}, {"period", "period", "s"},
                  {"amplitude", "amplitude", "m"}, {"stuck", "stuck", ""},         {"cost", "cost", "s"}};
  e.figures = {{"position-time", "Position over one period of the limit cycle", "t", "s", "y", "m"},
               {"force-displacement", "Friction force over displacement", "x", "m", "F", "N"}};
  run_by_law(e, options, one);
  ExperimentClaim claim{"a describing function of the hysteretic friction function serves to predict limit cycles",
                        "thesis, section 3.7", ClaimOutcome::not_tested, ""};
  int hunting = 0, seen = 0;
  for (const auto& row : e.rows) {
    if (!std::isfinite(row.values[2])) continue;
    ++hunting;
    if (row.values[0] > 0.0) ++seen;
  }
  if (hunting > 0) {
    claim.outcome = seen == hunting ? ClaimOutcome::confirmed
                    : seen > 0      ? ClaimOutcome::depends
                                    : ClaimOutcome::not_confirmed;
    claim.measure = "of " + std::to_string(hunting) +
                    " laws that hunt, the describing function of the law alone predicts "
                    "a cycle for " +
                    std::to_string(seen);
  }
  e.claims.push_back(std::move(claim));
  return e;
}

}  // namespace limcycle
