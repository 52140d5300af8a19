#include <array>
#include <cmath>

#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_loop.hpp"

namespace limcycle {
namespace {

constexpr double sensitivity_ramp_rate = 0.1, lag_loop_mean = 1.5e-3, lag_loop_amplitude = 1e-3,
                 lag_loop_frequency = 10.0;

/// Results for one setting of the parameters.
struct ParameterOutcome {
  double stiffness = NAN, displacement = NAN, peak = NAN, lag = NAN;
  double overshoot = NAN;  ///< peak under a velocity that jumps to 0.01 m/s, over the break-away level, N
  int crossings = 0;
  ForcedRun run;
  VelocityRun loop;
  Status status = Status::converged;
};

ParameterOutcome parameter_outcome(const LawSetting& setting, double gross) {
  ParameterOutcome o;
  BreakAway ramp = break_away(setting, sensitivity_ramp_rate, gross, 1e-7);
  const Element law = make_law(setting);
  o.loop = run_velocity(law, lag_loop_mean, lag_loop_amplitude, lag_loop_frequency, 40);
  const LoopShape shape = loop_shape(o.loop, lag_loop_mean, lag_loop_amplitude);
  const VelocityRun jump = run_constant_velocity(law, 0.01, 10.0 * setting.break_away / 0.01);
  double highest = 0.0;
  for (const double F : jump.F)
    if (std::isfinite(F)) highest = std::max(highest, F);
  o.stiffness = ramp.stiffness;
  o.displacement = ramp.displacement;
  o.peak = ramp.peak;
  o.lag = shape.width;
  o.overshoot = std::max(0.0, highest - 1.5);
  o.crossings = shape.crossings;
  o.status = ramp.run.status != Status::converged ? ramp.run.status : o.loop.status;
  o.run = std::move(ramp.run);
  return o;
}

/// d ln y/d ln p from half to double; NaN if a logarithm does not exist.
double elasticity(double half, double twice) {
  return half > 0.0 && twice > 0.0 && std::isfinite(half) && std::isfinite(twice)
             ? std::log(twice / half) / std::log(4.0)
             : NAN;
}

std::string strongest(const std::string& key, const std::array<double, 4>& values) {
  static const std::array<std::string, 4> names{"stiffness", "displacement", "break-away force", "lag"};
  std::size_t best = names.size();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::isfinite(values[i]) && (best == names.size() || std::abs(values[i]) > std::abs(values[best]))) best = i;
  if (best == names.size() || std::abs(values[best]) < 5e-3) return key + ": hardly anything";
  return key + ": " + names[best] + " ~ " + key + "^" + quantity(values[best], "", 2);
}

LawPart sensitivity_of_law(const LawSetting& setting) {
  LawPart part;
  const double gross = gross_displacement(setting);
  const ParameterOutcome base = parameter_outcome(setting, gross);
  part.status = base.status;
  for (const auto& key : shape_keys(setting)) {
    const auto less = varied(setting, key, 0.5), more = varied(setting, key, 2.0);
    const ParameterOutcome half = less ? parameter_outcome(*less, gross) : ParameterOutcome{},
                           twice = more ? parameter_outcome(*more, gross) : ParameterOutcome{};
    const std::array values{elasticity(half.stiffness, twice.stiffness),
                            elasticity(half.displacement, twice.displacement), elasticity(half.peak, twice.peak),
                            elasticity(half.lag, twice.lag)};
    part.rows.push_back({"",
                         key,
                         {values[0], values[1], values[2], values[3], half.overshoot, twice.overshoot,
                          static_cast<double>(half.crossings), static_cast<double>(twice.crossings)}});
    part.finding += (part.finding.empty() ? "" : "; ") + strongest(key, values);
    for (const auto* o : {&half, &base, &twice}) {
      const std::string name = o == &half ? "half" : o == &base ? "default" : "double";
      part.add(0, thinned(name, o->run.x, o->run.F, 120), key);
      part.add(1, thinned(name, o->loop.v, o->loop.F, 120), key);
    }
  }
  if (part.finding.empty()) part.finding = "nothing but levels to vary";
  return part;
}

std::vector<ExperimentClaim> sensitivity_claims(const Experiment& e) {
  const std::string source = "thesis, section 3.5.3 (LuGre)";
  std::vector<ExperimentClaim> list{
      {"sigma0 sets the slope of pre-sliding", source, ClaimOutcome::not_tested, ""},
      {"a large sigma1 makes the force overshoot at break-away", source, ClaimOutcome::not_tested, ""},
      {"a large sigma1 makes frictional-lag loops cross themselves", source, ClaimOutcome::not_tested, ""},
      {"vs affects the pre-sliding displacement", source, ClaimOutcome::not_tested, ""}};
  if (!has_law(e, "lugre")) return list;
  const auto settle = [](ExperimentClaim& claim, bool right, std::string measure) {
    claim.outcome = right ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure = std::move(measure);
  };
  const double slope = e.value("lugre", "stiffness", "sigma0");
  settle(list[0], std::abs(slope - 1.0) < 0.1, "stiffness ~ sigma0^" + quantity(slope, "", 3));
  const double small = e.value("lugre", "overshoot_half", "sigma1"),
               large = e.value("lugre", "overshoot_double", "sigma1");
  settle(list[1], large > small && large > 0.01,
         "over 1.5 N by " + quantity(small, "N") + " with half, by " + quantity(large, "N") +
             " with double sigma1, when the velocity jumps to 0.01 m/s");
  const double crossings = e.value("lugre", "crossings_double", "sigma1");
  settle(list[2], crossings > 0.0, quantity(crossings, "", 1) + " crossings at twice sigma1 and 10 rad/s");
  const double x = e.value("lugre", "displacement", "vs");
  settle(list[3], std::abs(x) > 0.02, "displacement at break-away ~ vs^" + quantity(x, "", 2));
  return list;
}

}  // namespace

Experiment sensitivity_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "sensitivity";
  e.title = "What each parameter of a law changes";
  e.document = "thesis, section 3.5 (its method: each parameter at half, once and twice its value)";
  e.input =
      "a mass of 1 kg under a force that rises with 0.1 N/s (stiffness at a tenth of the peak, displacement and force "
      "at "
      "break-away), velocity 0.001 (1.5 + cos 10t) m/s (width of the lag loop, crossings), and a velocity that jumps "
      "to "
      "0.01 m/s (overshoot over 1.5 N). Exponents p: outcome ~ parameter^p between half and double";
  e.quantities = {{"stiffness", "stiffness", ""},
                  {"displacement", "x break-away", ""},
                  {"peak", "force", ""},
                  {"lag", "lag", ""},
                  {"overshoot_half", "over, half", "N"},
                  {"overshoot_double", "over, double", "N"},
                  {"crossings_half", "cross, half", ""},
                  {"crossings_double", "cross, double", ""}};
  e.figures = {
      {"force-displacement", "Friction force over displacement, force rising with 0.1 N/s", "x", "m", "F", "N"},
      {"force-velocity", "Friction force over velocity at 10 rad/s", "v", "m/s", "F", "N"}};
  run_by_law(e, options, sensitivity_of_law);
  e.claims = sensitivity_claims(e);
  return e;
}

}  // namespace limcycle
