#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/claims/sources/source_documents.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/froude.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_loop.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"

namespace limcycle {
namespace {

/// LuGre's loops at a velocity of one sign open further with every frequency.
ClaimResult lag(const ClaimOptions& options) {
  ClaimChecks checks;
  RandomShares random(options.seed);
  for (int k = 0; k <= options.random_points / 4; ++k) {
    checks.random(k > 0);
    LawSetting law = document_law("lugre");
    if (k > 0)
      for (const char* key : {"vs", "sigma0"}) law = law.scaled(key, random.log_between(0.7, 1.5));
    const double vs = law.number("vs");
    double before = 0.0;
    // The lag is g/(sigma0 v): frequencies scale with sigma0 vs, which is 100 N/s for the paper's own parameters.
    for (const double own : {2.0, 10.0, 25.0, 50.0}) {
      const double w = own * law.number("sigma0") * vs / 100.0;
      if (options.stop && options.stop()) checks.stop(Status::interrupted);
      const VelocityRun run = run_velocity(make_law(law), 1.5 * vs, vs, w, 40);
      if (run.status != Status::converged) checks.stop(run.status);
      const double width = loop_shape(run, 1.5 * vs, vs).width;
      checks.at_least(values_of(law) + ", " + short_number(w) + " rad/s against the frequency before",
                      "widest opening of F over v", "N", before, width, 0.0);
      const double at = run.force_at(1.5 * vs, true) - run.force_at(1.5 * vs, false);
      checks.at_least(values_of(law) + ", " + short_number(w) + " rad/s, at the mean velocity",
                      "F accelerating - F decelerating", "N", 0.0, at, 0.0);
      before = width;
    }
  }
  return checks.result();
}

/// Runs the sensitivity experiment on LuGre.
ClaimResult of_lugre(const ClaimOptions& options, const std::function<void(const Experiment&, ClaimChecks&)>& test) {
  ExperimentOptions how;
  how.laws = {document_law("lugre")};
  how.stop = options.stop;
  const Experiment experiment = sensitivity_experiment(how);
  ClaimChecks checks;
  if (experiment.status != Status::converged) checks.stop(experiment.status);
  for (const auto& finding : experiment.findings)
    if (finding.status != Status::converged) checks.stop(finding.status);
  test(experiment, checks);
  return checks.result();
}

Claim lugre_claim(std::string id, std::string statement, std::string test,
                  const std::function<void(const Experiment&, ClaimChecks&)>& check) {
  return {std::move(id),
          std::move(statement),
          "",
          "thesis, section 3.5.3 (LuGre)",
          Evidence::read,
          "the thesis's parameters, one of them at half and twice its value",
          std::move(test),
          ClaimVerdict::holds,
          [check](const ClaimOptions& options) { return of_lugre(options, check); }};
}

std::vector<Claim> lugre_claims() {
  return {lugre_claim("thesis-lugre-sigma0", "sigma0 sets the slope of LuGre's pre-sliding.",
                      "secant slope at a tenth of the peak of a force ramp of 0.1 N/s: exponent p of slope ~ sigma0^p",
                      [](const Experiment& e, ClaimChecks& checks) {
                        checks.equal("sigma0 halved and doubled", "exponent of sigma0 in the slope", "", 1.0,
                                     e.value("lugre", "stiffness", "sigma0"), 0.01);
                      }),
          lugre_claim("thesis-lugre-sigma1", "A large sigma1 makes LuGre's force overshoot at break-away.",
                      "velocity that jumps to 0.01 m/s: by how much the force exceeds Fs, sigma1 halved and doubled",
                      [](const Experiment& e, ClaimChecks& checks) {
                        const double half = e.value("lugre", "overshoot_half", "sigma1");
                        checks.at_least("twice sigma1, against half", "overshoot over Fs", "N", half,
                                        e.value("lugre", "overshoot_double", "sigma1"), 0.0);
                        checks.at_least("twice sigma1", "overshoot over Fs", "N", 0.05 * 1.5,
                                        e.value("lugre", "overshoot_double", "sigma1"), 0.0);
                      }),
          lugre_claim("thesis-lugre-crossing", "A large sigma1 makes LuGre's frictional-lag loops cross themselves.",
                      "velocity 0.001 (1.5 + cos 10t) m/s: crossings of the two branches, sigma1 halved and doubled",
                      [](const Experiment& e, ClaimChecks& checks) {
                        checks.equal("half sigma1", "crossings", "", 0.0, e.value("lugre", "crossings_half", "sigma1"),
                                     0.0);
                        checks.at_least("twice sigma1", "crossings", "", 1.0,
                                        e.value("lugre", "crossings_double", "sigma1"), 0.0);
                      }),
          lugre_claim("thesis-lugre-vs", "vs affects LuGre's pre-sliding displacement.",
                      "displacement at the peak of a force ramp of 0.1 N/s: exponent p of x ~ vs^p, at least 0.05",
                      [](const Experiment& e, ClaimChecks& checks) {
                        checks.at_least("vs halved and doubled", "exponent of vs in the displacement", "", 0.05,
                                        e.value("lugre", "displacement", "vs"), 0.0);
                      })};
}

/// Robustness in the measure of limcycle's own experiment, because the thesis gives none.
ClaimResult robustness(const ClaimOptions& options) {
  ExperimentOptions how;
  how.laws.clear();
  for (const char* label : {"non-drift", "lugre", "elasto-plastic", "gms", "xiong"})
    how.laws.push_back(document_law(label));
  how.stop = options.stop;
  const Experiment e = robustness_experiment(how);
  ClaimChecks checks;
  if (e.status != Status::converged) checks.stop(e.status);
  for (const char* law : {"lugre", "elasto-plastic", "gms", "xiong"})
    checks.at_most(std::string("against ") + law + ", below the Stribeck velocity", "rms change of F over Fs", "",
                   e.value(law, "low", "all"), e.value("non-drift", "low", "all"), 0.0);
  return checks.result(
      "the proposed law's force changes as much as that of the others where Zb is wrong; GMS is as soft as printed");
}

/// Play of 0.02, 0.05 and 0.1 mm on some friction curves; `test` checks one curve.
ClaimResult with_play(const std::vector<std::string>& curves, const std::vector<double>& plays,
                      const ClaimOptions& options, const std::function<void(const FroudeSeries&, ClaimChecks&)>& test) {
  std::vector<FroudeSetting> settings;
  for (auto& setting : froude_settings())
    if (std::ranges::find(curves, setting.name) != curves.end()) settings.push_back(std::move(setting));
  const FroudeResult result = froude_experiment(settings, plays, 1, options.stop);
  ClaimChecks checks;
  if (result.status != Status::converged) checks.stop(result.status);
  for (const auto& series : result.series) test(series, checks);
  return checks.result();
}

std::string play_of(const FroudeSeries& series, const FroudeComparison& one) {
  return series.setting.name + " friction, play of " + short_number(1e3 * one.clearance) + " mm";
}

void keeps_the_swing(const FroudeSeries& series, ClaimChecks& checks) {
  for (const auto& one : series.clearances)
    if (one.clearance > 0.0)
      checks.at_most(play_of(series, one), "relative change of the swing", "", 0.05, std::abs(one.swing_change), 0.0);
}

std::vector<Claim> play_claims() {
  const std::string source =
      "Piatkowski and Wolski 2018, abstract (their equations of motion were not seen: "
      "reconstruction with a Hunt-Crossley contact, all numbers of our own choice)";
  const std::vector<double> plays{2e-5, 5e-5, 1e-4};
  return {
      {"pendulum-play-fast", "Radial play of up to 0.1 mm adds high-frequency oscillation to the Froude pendulum.", "",
       source, Evidence::reconstruction, "friction that is flat, falls slightly, falls steeply; play of 0.1 mm",
       "rms of the sliding velocity above 20 times the pendulum's frequency, against ten times that without play",
       ClaimVerdict::holds,
       [](const ClaimOptions& options) {
         return with_play({"flat", "slight", "steep, damped"}, {1e-4}, options, [](const auto& series, auto& checks) {
           const auto& without = series.clearances.front();
           const auto& with = series.clearances.back();
           checks.at_least(play_of(series, with), "fast part of the sliding velocity", "m/s",
                           10.0 * without.fast_rubbing, with.fast_rubbing, 0.0);
         });
       }},
      {"pendulum-play-swing", "That play hardly changes the angle.", "", source, Evidence::reconstruction,
       "friction that is flat, falls slightly, or falls steeply in a contact that damps well (20 s/m); play of 0.02, "
       "0.05 and 0.1 mm",
       "change of the swing of the angle: at most 5 %", ClaimVerdict::holds,
       [plays](const ClaimOptions& options) {
         return with_play({"flat", "slight", "steep, damped"}, plays, options, keeps_the_swing);
       }},
      {"pendulum-play-velocity", "That play hardly changes the sliding velocity.", "", source, Evidence::reconstruction,
       "friction that is flat; where it falls, the fast oscillation alone is 11 to 17 % of the sliding velocity (rms)",
       "rms of the difference of the sliding velocities over that without play: at most 5 %", ClaimVerdict::holds,
       [plays](const ClaimOptions& options) {
         return with_play({"flat"}, plays, options, [](const auto& series, auto& checks) {
           for (const auto& one : series.clearances)
             if (one.clearance > 0.0)
               checks.at_most(play_of(series, one), "relative rms change of the sliding velocity", "", 0.05,
                              one.rubbing_change, 0.0);
         });
       }},
      {"pendulum-play-any", "That play hardly changes the angle, whatever the friction and the contact.", "",
       source + "; the abstract states no limits", Evidence::reconstruction,
       "friction that falls steeply, as hunting needs it, in a contact that hardly damps (2 s/m); play of 0.05 mm",
       "change of the swing of the angle: at most 5 %", ClaimVerdict::fails, [](const ClaimOptions& options) {
         auto result = with_play({"steep"}, {5e-5}, options, keeps_the_swing);
         result.finding =
             "the falling friction that feeds the swing feeds the rattling of a poorly damped sleeve too, "
             "which takes the swing away; " +
             result.finding;
         return result;
       }}};
}

}  // namespace

std::vector<Claim> document_pendulum_claims() {
  std::vector<Claim> list = lugre_claims();
  list.push_back({"thesis-robustness",
                  "The force of the proposed law changes less with errors of its parameters than that of LuGre, "
                  "elasto-plastic, GMS and Xiong, below the Stribeck velocity.",
                  "", "thesis, section 3.7 (a statement without a measure)", Evidence::reconstruction,
                  "the thesis's parameters, each but the levels halved and doubled; velocity 0.005 cos(0.2t) m/s",
                  "rms change of the force over the time in which |v| < vs, over Fs; the measure is ours",
                  ClaimVerdict::fails, robustness});
  list.push_back(
      {"pendulum-lag",
       "At low velocities of one sense LuGre's friction lags behind the velocity, the more so the higher the "
       "frequency: its loop over velocity widens.",
       "", "Piatkowski and Wolski 2018, figure 1c and text", Evidence::read,
       "velocity vs (1.5 + cos wt) at the paper's w = 2, 10, 25, 50 rad/s; at random: vs and sigma0 up to 1.5 "
       "times smaller or larger",
       "imposed velocity, steady state: widest difference of the force accelerating and decelerating, each "
       "against that of the frequency before",
       ClaimVerdict::holds, lag});
  for (auto& claim : play_claims()) list.push_back(std::move(claim));
  return list;
}

}  // namespace limcycle
