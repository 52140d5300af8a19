#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"

namespace limcycle {
namespace {

constexpr double robustness_amplitude = 5e-3, robustness_frequency = 0.2, stribeck_velocity = 1e-3;  // m/s, rad/s, m/s
constexpr double Fs = 1.5;

/// Mean square of the difference of two forces, separately for low and high speeds.
struct Difference {
  double low = 0.0, high = 0.0, low_time = 0.0, high_time = 0.0;
};

Difference difference(const VelocityRun& base, const VelocityRun& other) {
  Difference sum;
  std::size_t k = 1;
  for (std::size_t i = 1; i < base.t.size(); ++i) {
    const double t = base.t[i], dt = t - base.t[i - 1];
    while (k + 1 < other.t.size() && other.t[k] < t) ++k;
    const double span = other.t[k] - other.t[k - 1];
    const double share = span > 0.0 ? std::clamp((t - other.t[k - 1]) / span, 0.0, 1.0) : 1.0;
    const double gap = other.F[k - 1] + share * (other.F[k] - other.F[k - 1]) - base.F[i];
    if (!std::isfinite(gap)) continue;
    const bool is_low = std::abs(base.v[i]) < stribeck_velocity;
    (is_low ? sum.low : sum.high) += gap * gap * dt;
    (is_low ? sum.low_time : sum.high_time) += dt;
  }
  return sum;
}

double root_mean(double sum, double time) { return time > 0.0 ? std::sqrt(sum / time) / Fs : NAN; }

bool comparable(const VelocityRun& run) {
  return (run.status == Status::converged || run.status == Status::incomplete) && run.t.size() > 2;
}

LawPart robustness_of_law(const LawSetting& setting) {
  LawPart part;
  const VelocityRun base = run_velocity(make_law(setting), 0.0, robustness_amplitude, robustness_frequency, 4);
  part.status = base.status;
  if (!comparable(base)) {
    part.finding = "has no periodic answer to compare with";
    return part;
  }
  double low = 0.0, high = 0.0, worst = 0.0;
  int runs = 0;
  std::string worst_key;
  part.add(0, thinned("default", base.v, base.F, 200));
  for (const auto& key : shape_keys(setting))
    for (const double factor : {0.5, 2.0}) {
      const auto changed = varied(setting, key, factor);
      if (!changed) continue;
      const VelocityRun other = run_velocity(make_law(*changed), 0.0, robustness_amplitude, robustness_frequency, 4);
      if (!comparable(other)) continue;
      const Difference d = difference(base, other);
      const double below = root_mean(d.low, d.low_time), above = root_mean(d.high, d.high_time);
      const std::string name = key + (factor < 1.0 ? " x 0.5" : " x 2");
      part.rows.push_back({"", name, {below, above}});
      part.add(0, thinned(name, other.v, other.F, 150));
      low += below * below;
      high += above * above;
      ++runs;
      if (below >= worst) {
        worst = below;
        worst_key = name;
      }
    }
  if (runs == 0) {
    part.finding = "nothing but levels to vary";
    return part;
  }
  low = std::sqrt(low / runs);
  high = std::sqrt(high / runs);
  part.rows.push_back({"", "all", {low, high}});
  part.finding = "the force changes by " + quantity(100.0 * low, "% of Fs", 2) +
                 " (rms) below the Stribeck velocity, by " + quantity(100.0 * high, "%", 2) + " above; most by " +
                 worst_key + " (" + quantity(100.0 * worst, "%", 2) + ")";
  return part;
}

ExperimentClaim most_robust(const Experiment& e, const std::string& key, const std::string& where) {
  ExperimentClaim claim{
      "the proposed law is more robust to variations of its parameters than LuGre, elasto-plastic, GMS "
      "and Xiong, " +
          where,
      "thesis, section 3.7", ClaimOutcome::not_tested, ""};
  const double own = e.value("non-drift", key, "all");
  if (!std::isfinite(own)) return claim;
  bool right = true, any = false;
  claim.measure = "rms change, % of Fs: non-drift " + quantity(100.0 * own, "", 2);
  for (const char* law : {"lugre", "elasto-plastic", "gms", "xiong"}) {
    const double other = e.value(law, key, "all");
    if (!std::isfinite(other)) continue;
    any = true;
    right = right && own < other;
    claim.measure += std::string(", ") + law + " " + quantity(100.0 * other, "", 2);
  }
  if (any) claim.outcome = right ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
  return claim;
}

}  // namespace

Experiment robustness_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "robustness";
  e.title = "How much the force changes when parameters are wrong by a factor of two";
  e.document = "thesis, section 3.7 (a statement without a number)";
  e.input =
      "velocity 0.005 cos(0.2t) m/s, imposed; steady state. Each parameter that is not a level of force at half and "
      "twice "
      "its value; the rms of the change of force over the time below and above the Stribeck velocity (0.001 m/s), in "
      "units of Fs = 1.5 N; \"all\" is the rms over the parameters. The measure is ours: the thesis gives none";
  e.quantities = {{"low", "below vs", ""}, {"high", "above vs", ""}};
  e.figures = {{"force-velocity", "Friction force over velocity, parameters halved and doubled", "v", "m/s", "F", "N"}};
  run_by_law(e, options, robustness_of_law);
  e.claims = {most_robust(e, "low", "below the Stribeck velocity"), most_robust(e, "high", "above it")};
  return e;
}

}  // namespace limcycle
