#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

namespace limcycle {
namespace {

constexpr double first_peak = 2.6, zigzag_half_period = 1.0;  // of the zig-zag, s
constexpr int zigzag_cycles = 16, averaged_cycles = 4;
constexpr double zigzag_low = 0.2, zigzag_high = 0.8;  // N

Signal slide_and_zigzag() {
  std::vector<double> t{0.0, 2.0, 2.1}, u{0.0, 2.0, 0.5};
  for (int k = 0; k <= 2 * zigzag_cycles; ++k) {
    t.push_back(first_peak + k * zigzag_half_period);
    u.push_back(k % 2 == 0 ? zigzag_high : zigzag_low);
  }
  return signal_through(std::move(t), std::move(u));
}

/// A drift must exceed this share of the motion within a cycle (or this length, m) to count, because of rounding and
/// steps.
bool drifts(double drift, double swing) { return std::abs(drift) > std::max(1e-3 * swing, 1e-11); }

/// A drift goes on; the ringing of a law without damping changes the mean by as much one way as the other.
bool goes_on(double drift, double earlier) { return std::abs(drift - earlier) < 0.3 * std::abs(drift); }

LawPart zigzag_of_law(const LawSetting& printed) {
  const LawSetting setting = printed.with("vs", 0.01);
  const double end = first_peak + 2.0 * zigzag_cycles * zigzag_half_period, before = end - 2.0 * zigzag_half_period;
  ForcedOptions options;
  options.duration = end;
  options.rtol = 1e-8;
  options.longest_step = 0.02;
  options.stop = setting.stop;
  const ForcedRun run = run_forced(make_law(setting), slide_and_zigzag(), options);
  LawPart part;
  part.status = run.status;
  part.add(0, thinned("friction force", run.t, run.F));
  part.add(0, thinned("applied force", run.t, run.u));
  const std::size_t from = run.at(first_peak + 0.5);  // after the fall from sliding
  const std::vector<double> x(run.x.begin() + static_cast<std::ptrdiff_t>(from), run.x.end());
  const std::vector<double> F(run.F.begin() + static_cast<std::ptrdiff_t>(from), run.F.end());
  const std::vector<double> t(run.t.begin() + static_cast<std::ptrdiff_t>(from), run.t.end());
  std::vector<double> since(x);
  for (double& value : since) value -= x.front();
  part.add(1, thinned("", since, F));
  part.add(2, thinned("", t, since));
  if (run.status != Status::converged) {
    part.finding = "the run ended early at t = " + quantity(run.t.back(), "s");
    return part;
  }
  double swing_low = infinite, swing_high = -infinite, mismatch = 0.0;
  const std::size_t first = run.at(before);
  for (std::size_t i = first; i < run.t.size(); ++i) {
    swing_low = std::min(swing_low, run.x[i]);
    swing_high = std::max(swing_high, run.x[i]);
    mismatch = std::max(mismatch, std::abs(run.F[i] - run.u[i]));
  }
  const double peak = peak_of(run.t, run.F, run.F.size() - 1).value;
  // Laws without damping keep ringing: the drift is that of the mean over four cycles, with a weight that hides
  // ringing.
  const double window = 2.0 * averaged_cycles * zigzag_half_period;
  const auto mean = [&](double back) {
    return run.mean_displacement(end - (back + 1.0) * window, end - back * window);
  };
  const double drift = (mean(0.0) - mean(1.0)) / averaged_cycles, earlier = (mean(1.0) - mean(2.0)) / averaged_cycles;
  const double swing = swing_high - swing_low;
  part.rows.push_back({"", "", {peak, drift, swing, mismatch, area(run.x, run.F, first, run.x.size() - 1)}});
  if (!drifts(drift, swing))
    part.finding = "does not drift: " + quantity(drift, "m") + " a cycle of " + quantity(swing, "m");
  else if (!goes_on(drift, earlier) && !(drift * earlier > 0.0 && std::abs(drift) < std::abs(earlier)))
    part.finding = "shows no drift beyond its ringing: " + quantity(drift, "m") + " a cycle of " +
                   quantity(swing, "m") + " after " + quantity(earlier, "m") + " four cycles before";
  else if (std::abs(drift) < 0.9 * std::abs(earlier))
    part.finding = "still settles, by " + quantity(drift, "m") + " a cycle of " + quantity(swing, "m") + " after " +
                   quantity(earlier, "m") + " four cycles before";
  else
    part.finding = "drifts by " + quantity(drift, "m") + " a cycle, " + quantity(100.0 * std::abs(drift) / swing, "%") +
                   " of its motion within the cycle";
  part.finding += "; stiction peak " + quantity(peak, "N", 4);
  return part;
}

void claim_drift(Experiment& experiment, const std::string& law, bool expected, const std::string& source) {
  ExperimentClaim claim{"the " + law + " law " + (expected ? "drifts" : "does not drift") +
                            " under a zig-zag force below the Coulomb level",
                        source, ClaimOutcome::not_tested, ""};
  if (has_law(experiment, law)) {
    const double drift = experiment.value(law, "drift"), swing = experiment.value(law, "swing");
    claim.outcome = drifts(drift, swing) == expected ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure = quantity(drift, "m") + " a cycle";
  }
  experiment.claims.push_back(std::move(claim));
}

void claim_balance(Experiment& experiment) {
  ExperimentClaim claim{"below the Coulomb level the friction of the proposed law is virtually the applied force",
                        "thesis, section 3.6.1", ClaimOutcome::not_tested, ""};
  if (has_law(experiment, "non-drift")) {
    const double mismatch = experiment.value("non-drift", "mismatch");
    claim.outcome = mismatch < 0.01 * zigzag_high ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure = "they differ by at most " + quantity(mismatch, "N") + " (inertia)";
  }
  experiment.claims.push_back(std::move(claim));
  ExperimentClaim stiction{"the proposed law captures stiction: its force rises to Fs before it slides",
                           "thesis, section 3.6.1", ClaimOutcome::not_tested, ""};
  if (has_law(experiment, "non-drift")) {
    const double peak = experiment.value("non-drift", "peak");
    stiction.outcome = std::abs(peak - 1.5) < 0.05 * 1.5 ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    stiction.measure = "peak " + quantity(peak, "N", 4) + " of Fs = 1.5 N";
  }
  experiment.claims.push_back(std::move(stiction));
}

}  // namespace

Experiment non_drift_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "non-drift";
  e.title = "Does a force below the Coulomb level move the body on?";
  e.document = "thesis, figures 3.27 to 3.32 (section 3.6.1)";
  e.input =
      "a mass of 1 kg under a force that ramps to 2 N in 2 s, falls to 0.5 N in 0.1 s and then runs in a zig-zag "
      "between "
      "0.2 and 0.8 N with a period of 2 s. The thesis says only \"much greater than the stiction\", \"well below\" and "
      "\"zigzag\": the numbers are chosen here. Drift: of the mean over four cycles (weighted, so that the ringing of "
      "laws without damping does not count), against the four before. vs = 0.01 m/s where a law has it, as printed";
  e.quantities = {{"peak", "peak force", "N"},
                  {"drift", "drift a cycle", "m"},
                  {"swing", "swing a cycle", "m"},
                  {"mismatch", "|F - u|", "N"},
                  {"loop", "loop area", "J"}};
  e.figures = {
      {"force-time", "Friction and applied force over time (figures 3.27b, 3.28a to 3.32a)", "t", "s", "F", "N"},
      {"force-displacement", "Friction force over displacement since sliding ended (figures 3.28b to 3.31b)", "x", "m",
       "F", "N"},
      {"displacement-time", "Displacement since sliding ended (figure 3.32b)", "t", "s", "x", "m"}};
  run_by_law(e, options, zigzag_of_law);
  claim_balance(e);
  claim_drift(e, "non-drift", false, "thesis, section 3.6.1, figure 3.28b");
  claim_drift(e, "lugre", true, "thesis, section 3.6.1, figure 3.29b");
  claim_drift(e, "elasto-plastic", false, "thesis, section 3.6.1, figure 3.30");
  claim_drift(e, "gms", false, "thesis, section 3.6.1, figure 3.31");
  claim_drift(e, "xiong", false, "thesis, section 3.6.1 (the caption of figure 3.32 says the contrary of its text)");
  return e;
}

}  // namespace limcycle
