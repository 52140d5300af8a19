#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

namespace limcycle {
namespace {

constexpr double drift_force_low = 0.2, drift_force_high = 0.8, drift_half_period = 1.0;  // N, N, s
constexpr int drift_cycles = 20, drift_averaged = 4;

std::string ratio_in_words(double ratio) { return short_number(ratio, 3); }

std::vector<double> ratios() {
  std::vector<double> list;
  for (int k = 0; k <= 13; ++k) list.push_back(0.3 + 0.05 * k);
  return list;
}

Signal drift_force() {
  std::vector<double> t{0.0, 1.0}, u{0.0, drift_force_high};
  for (int k = 1; k <= 2 * drift_cycles; ++k) {
    t.push_back(1.0 + k * drift_half_period);
    u.push_back(k % 2 == 0 ? drift_force_high : drift_force_low);
  }
  return signal_through(std::move(t), std::move(u));
}

/// Drift per cycle, m: over the last cycles, and over as many before them.
struct TwoDrifts {
  double late = NAN, early = NAN;
};

TwoDrifts drift(const LawSetting& setting, Status& status) {
  ForcedOptions options;
  options.duration = 1.0 + 2.0 * drift_cycles * drift_half_period;
  options.rtol = 1e-9;
  options.stop = setting.stop;
  const ForcedRun run = run_forced(make_law(setting), drift_force(), options);
  if (run.status != Status::converged) {
    status = run.status;
    return {};
  }
  // The mean over some cycles, with a weight that hides the ringing of laws without damping.
  const double end = options.duration, window = 2.0 * drift_averaged * drift_half_period;
  const auto mean = [&](int back) { return run.mean_displacement(end - (back + 1) * window, end - back * window); };
  return {(mean(0) - mean(1)) / drift_averaged, (mean(1) - mean(2)) / drift_averaged};
}

/// LuGre without break-away range, slow: the closed form.
double slow_drift() {
  return 1.5e-5 * std::log((1.0 - (drift_force_low / 1.5) * (drift_force_low / 1.5)) /
                           (1.0 - (drift_force_high / 1.5) * (drift_force_high / 1.5)));
}

/// A smaller drift is due to the steps, m.
constexpr double negligible_drift = 1e-11;

/// A drift that has halved since then is the end of a shakedown, or of a ringing of the mass, not a drift.
std::string drift_in_words(const TwoDrifts& drift) {
  if (!std::isfinite(drift.late)) return "was not answered in time";
  if (std::abs(drift.late) < negligible_drift) return "does not drift";
  if (std::abs(drift.late) < 0.5 * std::abs(drift.early))
    return "does not drift but is still settling, by " + quantity(drift.late, "m") + " a cycle, after " +
           quantity(drift.early, "m");
  return "drifts by " + quantity(drift.late, "m") + " a cycle";
}

LawPart drift_of_law(const LawSetting& setting) {
  LawPart part;
  if (setting.kind != "elasto-plastic") {
    const TwoDrifts own = drift(setting, part.status);
    part.rows.push_back({"", "", {own.late}});
    part.finding = drift_in_words(own);
    return part;
  }
  for (const std::string of : {"steady-state", "coulomb"}) {
    const LawSetting kind = setting.with("zba_of", of, true);
    std::vector<double> x, y;
    double free = NAN;
    for (const double ratio : ratios()) {
      const double one = drift(kind.with("zba_ratio", ratio), part.status).late;
      part.rows.push_back({"", "zba_of " + of + ", " + ratio_in_words(ratio), {one}});
      x.push_back(ratio);
      y.push_back(one);
      if (std::isnan(free) && std::abs(one) < negligible_drift) free = ratio;
    }
    part.add(0, {"z_ba of " + of, x, y});
    part.finding += (part.finding.empty() ? "" : "; ") + std::string("z_ba as a share of the ") +
                    (of == "coulomb" ? "Coulomb" : "steady") + " deflection: " +
                    (std::isnan(free) ? "drifts at every ratio"
                                      : "no drift from a ratio of " + ratio_in_words(free) + " on, at 0.3 " +
                                            quantity(y.front(), "m") + " a cycle");
  }
  return part;
}

}  // namespace

Experiment drift_against_zba_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "drift-against-zba";
  e.title = "Drift of the elasto-plastic law over its break-away ratio";
  e.document =
      "thesis, section 3.6.1 (\"the non-drift feature of the elasto-plastic model is limited by the value of the "
      "breakaway displacement parameter\")";
  e.input =
      "a mass of 1 kg under a zig-zag force between 0.2 and 0.8 N with a period of 2 s, 20 cycles; drift a cycle over "
      "the last four, against that over the four before. z_ba as the ratio of the steady deflection g(v)/sigma0, and "
      "of Fc/sigma0; the other laws once, to "
      "compare";
  e.quantities = {{"drift", "drift a cycle", "m"}};
  e.figures = {{"drift-ratio", "Drift a cycle over the break-away ratio", "z_ba ratio", "", "drift", "m"}};
  run_by_law(e, options, drift_of_law);
  ExperimentClaim claim{"the elasto-plastic law's freedom from drift depends on z_ba", "thesis, section 3.6.1",
                        ClaimOutcome::not_tested, ""};
  if (has_law(e, "elasto-plastic")) {
    const double least = e.value("elasto-plastic", "drift", "zba_of steady-state, 0.3");
    const double printed = e.value("elasto-plastic", "drift", "zba_of steady-state, 0.7");
    claim.outcome = least > negligible_drift && std::abs(printed) < negligible_drift ? ClaimOutcome::confirmed
                                                                                     : ClaimOutcome::not_confirmed;
    claim.measure =
        quantity(least, "m") + " a cycle at 0.3, " + quantity(printed, "m") +
        " at 0.7; it must end where sigma0 z_ba = 0.8 N, at 0.533 of the steady deflection at rest, or 0.8 of "
        "the Coulomb one";
  }
  e.claims.push_back(std::move(claim));
  e.notes.push_back("LuGre without such a range drifts by " + quantity(slow_drift(), "m", 4) +
                    " a cycle under a slow force of these limits (closed form)");
  return e;
}

}  // namespace limcycle
