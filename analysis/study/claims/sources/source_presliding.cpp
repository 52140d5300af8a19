#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/claims/sources/source_documents.hpp"

namespace limcycle {
namespace {

/// A zig-zag force between two levels below the Coulomb level, after a slide (the thesis's test) or without one.
struct ZigZag {
  double low = 0.2, high = 0.8;  // N
  bool after_slide = true;
};

/// Drift in the last cycles.
struct Drift {
  double per_cycle = NAN;  ///< m: change of the mean over four cycles, from the four before
  double swing = NAN;      ///< m, within the last cycle
  double mismatch = NAN;   ///< largest |F - u| there, N
  double peak = NAN;       ///< largest F of the run, N
  Status status = Status::converged;
};

constexpr int periods = 40, averaged = 4;
constexpr double period = 2.0;  // s

Drift drift_under(const LawSetting& setting, const ZigZag& force, const std::function<bool()>& stop) {
  std::vector<double> t{0.0}, u{0.0};
  const auto to = [&](double time, double value) {
    t.push_back(time);
    u.push_back(value);
  };
  if (force.after_slide) {
    to(2.0, 2.0);
    to(2.1, 0.5);
  }
  const double first = t.back() + 0.5;
  for (int k = 0; k <= 2 * periods; ++k) to(first + 0.5 * period * k, k % 2 == 0 ? force.high : force.low);
  ForcedOptions how;
  how.duration = t.back();
  how.rtol = 1e-9;
  how.longest_step = 0.05;
  how.stop = stop;
  const ForcedRun run = run_forced(make_law(setting), signal_through(std::move(t), std::move(u)), how);
  Drift drift;
  drift.status = run.status;
  if (run.status != Status::converged) return drift;
  const double window = averaged * period, end = how.duration;
  drift.per_cycle =
      (run.mean_displacement(end - window, end) - run.mean_displacement(end - 2.0 * window, end - window)) / averaged;
  double low = HUGE_VAL, high = -HUGE_VAL;
  drift.mismatch = 0.0;
  for (std::size_t i = run.at(end - period); i < run.t.size(); ++i) {
    low = std::min(low, run.x[i]);
    high = std::max(high, run.x[i]);
    drift.mismatch = std::max(drift.mismatch, std::abs(run.F[i] - run.u[i]));
  }
  drift.swing = high - low;
  drift.peak = *std::ranges::max_element(run.F);
  return drift;
}

std::string zigzag_in_words(const ZigZag& force) {
  return "force between " + short_number(force.low) + " and " + short_number(force.high) + " N" +
         (force.after_slide ? " after a slide" : "");
}

/// Levels below a Coulomb level, not of mean zero: a law that drifts does so only under a mean force.
ZigZag random_force(RandomShares& random, double Fc) {
  const double high = Fc * random.between(0.5, 0.95);
  return {high * random.between(0.0, 0.5), high, false};
}

/// The thesis's zig-zag with vs as printed, then random ones; test(drift, where) compares.
template <class Test>
ClaimResult over_forces(const std::string& label, const ClaimOptions& options, const Test& test) {
  ClaimChecks checks;
  RandomShares random(options.seed);
  const LawSetting printed = document_law(label).with("vs", 0.01);
  // A run of the proposed law costs 0.3 s.
  const int points = label == "non-drift" ? options.random_points / 4 : options.random_points;
  for (int k = 0; k <= points; ++k) {
    checks.random(k > 0);
    const bool proposed = label == "non-drift" && k > 0;
    const LawSetting setting = proposed ? random_proposed_law(random) : printed;
    const ZigZag force = k == 0 ? ZigZag{} : random_force(random, setting.number("Fc"));
    const Drift drift = drift_under(setting, force, options.stop);
    if (drift.status != Status::converged) {
      checks.stop(drift.status);
      break;
    }
    test(drift, (proposed ? values_of(setting) + ", " : "") + zigzag_in_words(force), force, checks);
  }
  return checks.result();
}

/// Below this share of the motion within a cycle, a drift is an accumulation of step errors.
constexpr double none = 1e-6;

Claim no_drift(const std::string& id, const std::string& label, const std::string& name, const std::string& source,
               Evidence evidence) {
  return {id,
          name + " does not drift: a force that varies below the Coulomb level leaves no displacement per cycle.",
          "x(t + T) = x(t) for |u| < Fc",
          source,
          evidence,
          "zig-zag of 2 s between 0.2 and 0.8 N after a slide (values chosen here: the thesis prints none), vs = 0.01 "
          "m/s; at random: forces between 0 and 0.95 Fc" +
              std::string(label == "non-drift" ? ", and parameters" : ""),
          "a mass of 1 kg for 40 cycles; mean displacement over the last four against the four before, over the motion "
          "within a cycle",
          ClaimVerdict::holds,
          [label](const ClaimOptions& options) {
            return over_forces(
                label, options, [](const Drift& d, const std::string& where, auto&, ClaimChecks& checks) {
                  checks.equal(where, "drift per cycle over swing", "", 0.0, d.per_cycle / d.swing, none);
                });
          }};
}

Claim lugre_drifts() {
  return {"thesis-drift-lugre",
          "LuGre drifts under a force that varies below the Coulomb level.",
          "|x(t + T) - x(t)| > 0 for |u| < Fc",
          "thesis, section 3.6.1, figure 3.29b",
          Evidence::read,
          "as thesis-non-drift; the mean force is not zero",
          "as thesis-non-drift: at least a thousandth of the motion "
          "within a cycle, and a hundred times what the others may have",
          ClaimVerdict::holds,
          [](const ClaimOptions& options) {
            return over_forces(
                "lugre", options, [](const Drift& d, const std::string& where, auto&, ClaimChecks& checks) {
                  checks.at_least(where, "drift per cycle over swing", "", 1e-3, d.per_cycle / d.swing, 0.0);
                });
          }};
}

Claim balance() {
  return {"thesis-balance",
          "Below the Coulomb level the friction of the proposed law is virtually the applied force.",
          "F = u",
          "thesis, section 3.6.1, figure 3.28a (the law is a reconstruction)",
          Evidence::reconstruction,
          "as thesis-non-drift",
          "largest |F - u| over a cycle (the inertia of 1 kg), over the largest force: at most 2 %",
          ClaimVerdict::holds,
          [](const ClaimOptions& options) {
            return over_forces("non-drift", options,
                               [](const Drift& d, const std::string& where, const ZigZag& force, ClaimChecks& checks) {
                                 checks.at_most(where, "largest |F - u| over the force", "", 0.02,
                                                d.mismatch / force.high, 0.0);
                               });
          }};
}

Claim stiction() {
  return {"thesis-stiction",
          "The proposed law captures stiction: its force rises to Fs before it slides.",
          "peak F = Fs",
          "thesis, section 3.6.1, figure 3.28a (the law is a reconstruction)",
          Evidence::reconstruction,
          "the printed parameters with vs = 0.01 m/s, as the section has them",
          "force ramp of 1 N/s on a mass of 1 kg; largest friction force against Fs, to 1 %",
          ClaimVerdict::holds,
          [](const ClaimOptions& options) {
            ClaimChecks checks;
            const Drift drift = drift_under(document_law("non-drift").with("vs", 0.01), {}, options.stop);
            if (drift.status != Status::converged) checks.stop(drift.status);
            checks.equal("ramp of 1 N/s", "largest F", "N", 1.5, drift.peak, 0.01);
            return checks.result();
          }};
}

Claim limited_by_zba() {
  return {"thesis-drift-zba",
          "That the elasto-plastic law does not drift is limited by the value of its break-away displacement z_ba.",
          "drift if and only if max |u| > sigma0 z_ba",
          "thesis, section 3.6.1; the threshold is derived (quasi-static)",
          Evidence::derived,
          "z_ba from 0.3 to 0.9 of the steady deflection; force between 0.2 and 0.8 N",
          "drift of a mass of 1 kg after 40 cycles on either side of sigma0 z_ba = 0.8 N",
          ClaimVerdict::holds,
          [](const ClaimOptions& options) {
            ClaimChecks checks;
            for (const double ratio : {0.3, 0.4, 0.45, 0.6, 0.69, 0.9}) {
              const LawSetting law = document_law("elasto-plastic").with("vs", 0.01).with("zba_ratio", ratio);
              const Drift drift = drift_under(law, {.after_slide = false}, options.stop);
              if (drift.status != Status::converged) checks.stop(drift.status);
              const double share = drift.per_cycle / drift.swing;
              const std::string where = "z_ba = " + short_number(ratio) + " z_ss";
              if (ratio * 1.5 < 0.8)
                checks.at_least(where, "drift per cycle over swing", "", 1e-4, share, 0.0);
              else
                checks.equal(where, "drift per cycle over swing", "", 0.0, share, none);
            }
            return checks.result();
          }};
}

}  // namespace

std::vector<Claim> document_presliding_claims() {
  return {no_drift("thesis-non-drift", "non-drift", "The proposed law",
                   "thesis, section 3.6.1, figure 3.28b (the law is a reconstruction)", Evidence::reconstruction),
          lugre_drifts(),
          no_drift("thesis-drift-ep", "elasto-plastic", "The elasto-plastic law with z_ba = 0.69 z_ss",
                   "thesis, section 3.6.1, figure 3.30", Evidence::read),
          no_drift("thesis-drift-gms", "gms", "GMS", "thesis, section 3.6.1, figure 3.31", Evidence::read),
          no_drift("thesis-drift-xiong", "xiong", "Xiong's multistate law",
                   "thesis, section 3.6.1, text (the caption of figure 3.32 says the contrary)", Evidence::read),
          limited_by_zba(),
          balance(),
          stiction()};
}

}  // namespace limcycle
