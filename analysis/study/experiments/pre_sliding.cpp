#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

namespace limcycle {
namespace {

// The test of 1995: N, N/s, s.
constexpr double pre_sliding_top = 1.425, pre_sliding_rate = 0.1425, pre_sliding_hold = 5.0;

Signal held_ramps() {
  std::vector<double> t{0.0}, u{0.0};
  for (const double to : {pre_sliding_top, -pre_sliding_top, pre_sliding_top}) {
    t.push_back(t.back() + std::abs(to - u.back()) / pre_sliding_rate);
    u.push_back(to);
    t.push_back(t.back() + pre_sliding_hold);
    u.push_back(to);
  }
  return signal_through(std::move(t), std::move(u));
}

LawPart pre_sliding_of_law(const LawSetting& setting) {
  ForcedOptions options;
  options.duration =
      pre_sliding_top / pre_sliding_rate + 2.0 * (2.0 * pre_sliding_top / pre_sliding_rate) + 3.0 * pre_sliding_hold;
  options.rtol = 1e-8;
  options.until_displacement = 100.0 * setting.break_away;
  options.stop = setting.stop;
  const ForcedRun run = run_forced(make_law(setting), held_ramps(), options);
  LawPart part;
  part.status = run.status;
  part.add(0, thinned("", run.x, run.F, 400));
  part.add(1, thinned("", run.t, run.x));
  const double end_of_first = pre_sliding_top / pre_sliding_rate + pre_sliding_hold;
  if (run.status != Status::converged) {
    part.finding = "the run ended early at t = " + quantity(run.t.back(), "s");
    return part;
  }
  if (run.t.back() < options.duration) {
    part.rows.push_back({"", "", {NAN, NAN, NAN, NAN}});
    part.finding = "slides away " + std::string(run.t.back() < end_of_first ? "below" : "after") + " " +
                   quantity(pre_sliding_top, "N", 4) + ", at t = " + quantity(run.t.back(), "s");
    return part;
  }
  const double first = run.displacement(pre_sliding_top / pre_sliding_rate),
               after_hold = run.displacement(end_of_first);
  const double least = *std::ranges::min_element(run.x), greatest = *std::ranges::max_element(run.x);
  const std::size_t from = run.at(end_of_first), to = run.x.size() - 1;
  const double loop = area(run.x, run.F, from, to), gap = run.x.back() - after_hold;
  part.rows.push_back({"", "", {first, greatest - least, loop, gap}});
  if (greatest - least < 1e-12)
    part.finding = "rests: no displacement before break-away";
  else
    part.finding = "moves " + quantity(first, "m", 4) +
                   " under 95 % of Fs; the loop that follows "
                   "encloses " +
                   quantity(loop, "J") + " and ends " + quantity(std::abs(gap), "m") + " from where it began";
  return part;
}

void claim_hysteresis(Experiment& e) {
  ExperimentClaim claim{"friction over pre-sliding displacement is a hysteresis loop (LuGre)",
                        "pendulum paper, figure 1a", ClaimOutcome::not_tested, ""};
  if (has_law(e, "lugre")) {
    const double loop = e.value("lugre", "loop"), box = 2.0 * pre_sliding_top * e.value("lugre", "swing");
    claim.outcome = loop > 0.01 * box ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure = "the loop fills " + quantity(100.0 * loop / box, "%", 2) + " of its box";
  }
  e.claims.push_back(std::move(claim));
  ExperimentClaim closed{"LuGre's displacement at 95 % of Fs is -(Fs/sigma0) ln(1 - F/Fs) = 4.4936e-5 m",
                         "closed form of the slow law", ClaimOutcome::not_tested, ""};
  if (has_law(e, "lugre")) {
    // Printed values are 1.5 N and 1e5 N/m; the ramp is slow but not infinitely so.
    const double x = e.value("lugre", "first"), exact = -1.5e-5 * std::log(1.0 - pre_sliding_top / 1.5);
    closed.outcome = std::abs(x / exact - 1.0) < 0.02 ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    closed.measure = quantity(x, "m", 5) + ", " + change(exact, x);
  }
  e.claims.push_back(std::move(closed));
}

}  // namespace

Experiment pre_sliding_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "pre-sliding";
  e.title = "Friction over displacement before sliding";
  e.document = "pendulum paper, figure 1a";
  e.input =
      "a mass of 1 kg under a force that ramps with 0.1425 N/s between 1.425 N (95 % of Fs) and -1.425 N, held for 5 s "
      "at "
      "each: the test of the LuGre paper of 1995; the pendulum paper does not give its own";
  e.quantities = {
      {"first", "x at 1.425 N", "m"}, {"swing", "swing", "m"}, {"loop", "loop area", "J"}, {"gap", "gap", "m"}};
  e.figures = {{"force-displacement", "Friction force over displacement (figure 1a)", "x", "m", "F", "N"},
               {"displacement-time", "Displacement over time", "t", "s", "x", "m"}};
  run_by_law(e, options, pre_sliding_of_law);
  claim_hysteresis(e);
  return e;
}

}  // namespace limcycle
