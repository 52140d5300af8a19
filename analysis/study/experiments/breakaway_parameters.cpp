#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"

namespace limcycle {
namespace {

constexpr std::array factors{0.5, 1.0, 2.0};
constexpr std::array factor_names{"half", "default", "double"};
constexpr double ramp_rate = 0.1;  // N/s

std::string parameter_in_words(const std::string& key, double factor) {
  return factor == 1.0 ? "default" : key + " x " + short_number(factor);
}

std::string trend_over_parameter(double low, double middle, double high) {
  if (!std::isfinite(low) || !std::isfinite(middle) || !std::isfinite(high)) return "not known";
  const double least = 2e-5 * std::abs(middle);
  if (std::abs(low - middle) <= least && std::abs(high - middle) <= least) return "same";
  if (high >= middle - least && middle >= low - least) return "up";
  if (high <= middle + least && middle <= low + least) return "down";
  return "both ways";
}

LawPart breakaway_of_law(const LawSetting& setting) {
  LawPart part;
  const double gross = gross_displacement(setting);
  const BreakAway base = break_away(setting, ramp_rate, gross);
  part.status = base.run.status;
  const auto row = [&](const std::string& name, const BreakAway& b) {
    part.rows.push_back({"", name, {b.peak, b.displacement, b.velocity, b.applied, b.slope, b.fall_time}});
  };
  row("default", base);
  for (const auto& key : shape_keys(setting)) {
    std::array<BreakAway, factors.size()> runs;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      // The gross displacement is kept: it is the reference for the applied force, not a parameter of the law.
      const auto changed = varied(setting, key, factors[i]);
      if (!changed) continue;
      runs[i] = factors[i] == 1.0 ? base : break_away(*changed, ramp_rate, gross);
      if (runs[i].run.status != Status::converged) part.status = runs[i].run.status;
      if (factors[i] != 1.0) row(parameter_in_words(key, factors[i]), runs[i]);
      part.add(0, thinned(factor_names[i], runs[i].run.x, runs[i].run.F, 120), key);
      part.add(1, thinned(factor_names[i], runs[i].run.v, runs[i].run.F, 120), key);
    }
    part.finding += (part.finding.empty() ? "" : "; ") + key + " up: peak " +
                    trend_over_parameter(runs[0].peak, runs[1].peak, runs[2].peak) + " (" +
                    quantity(runs[0].peak, "", 5) + ", " + quantity(runs[1].peak, "", 5) + ", " +
                    quantity(runs[2].peak, "N", 5) + ")";
  }
  if (part.finding.empty()) part.finding = "nothing but levels to vary; peak " + quantity(base.peak, "N", 5);
  return part;
}

struct ThreeSizes {
  double half, normal, twice;
  std::string words(const std::string& unit, int digits = 5) const {
    return quantity(half, "", digits) + ", " + quantity(normal, "", digits) + ", " + quantity(twice, unit, digits);
  }
};

ThreeSizes triple(const Experiment& e, const std::string& key, const std::string& number) {
  return {e.value("non-drift", number, parameter_in_words(key, 0.5)), e.value("non-drift", number, "default"),
          e.value("non-drift", number, parameter_in_words(key, 2.0))};
}

ExperimentClaim decided(const std::string& statement, bool right, const std::string& measure) {
  return {statement, "thesis, section 3.6.2, figures 3.38 to 3.41",
          right ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed, measure};
}

ExperimentClaim by_both(const std::string& statement, const ThreeSizes& peak, const ThreeSizes& applied, bool rises) {
  const auto right = [rises](const ThreeSizes& t) {
    return rises ? t.half < t.normal && t.normal < t.twice : t.half > t.normal && t.normal > t.twice;
  };
  ExperimentClaim claim =
      decided(statement, right(peak) && right(applied),
              "half, default, double: peak " + peak.words("N") + "; applied force at 2 Zb " + applied.words("N"));
  if (right(peak) != right(applied)) claim.outcome = ClaimOutcome::depends;
  return claim;
}

std::vector<ExperimentClaim> parameter_claims(const Experiment& e) {
  const std::vector<std::string> statements{"sigma has little or no effect on the break-away force",
                                            "the break-away force falls as Zb rises",
                                            "gross sliding is reached sooner as Zb falls",
                                            "the break-away force rises with vs",
                                            "the velocity at break-away rises with vs",
                                            "tau has little effect on the break-away force",
                                            "tau reduces the steepness of the transition from stick to slip"};
  std::vector<ExperimentClaim> list;
  if (!has_law(e, "non-drift")) {
    for (const auto& statement : statements)
      list.push_back({statement, "thesis, section 3.6.2, figures 3.38 to 3.41", ClaimOutcome::not_tested, ""});
    return list;
  }
  const auto small = [](const ThreeSizes& t) {
    return std::max(std::abs(t.half - t.normal), std::abs(t.twice - t.normal)) < 0.01 * t.normal;
  };
  const ThreeSizes sigma = triple(e, "sigma", "peak"), tau = triple(e, "tau", "peak");
  const ThreeSizes x = triple(e, "Zb", "displacement"), v = triple(e, "vs", "velocity"), s = triple(e, "tau", "slope");
  list.push_back(decided(statements[0], small(sigma), "half, default, double: peak " + sigma.words("N")));
  list.push_back(by_both(statements[1], triple(e, "Zb", "peak"), triple(e, "Zb", "applied"), false));
  list.push_back(
      decided(statements[2], x.half < x.normal && x.normal < x.twice, "displacement at the peak " + x.words("m", 4)));
  list.push_back(by_both(statements[3], triple(e, "vs", "peak"), triple(e, "vs", "applied"), true));
  list.push_back(decided(statements[4], v.half < v.normal && v.normal < v.twice, "velocity " + v.words("m/s", 4)));
  list.push_back(decided(statements[5], small(tau), "half, default, double: peak " + tau.words("N")));
  list.push_back(
      decided(statements[6], s.half > s.normal && s.normal > s.twice, "fall of F over x " + s.words("N/m", 4)));
  return list;
}

}  // namespace

Experiment breakaway_parameters_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "breakaway-parameters";
  e.title = "Break-away as the parameters of a law are halved and doubled";
  e.document = "thesis, figures 3.38 to 3.41 (there for the proposed law; here for every law with such parameters)";
  e.input =
      "a mass of 1 kg under a force that rises with 0.1 N/s; each parameter that is not a level of force at half, once "
      "and twice its value, a list as a whole";
  e.quantities = {{"peak", "peak force", "N"},      {"displacement", "x at peak", "m"},
                  {"velocity", "v at peak", "m/s"}, {"applied", "u at gross x", "N"},
                  {"slope", "fall over x", "N/m"},  {"fall_time", "fall time", "s"}};
  e.figures = {{"force-displacement", "Friction force over displacement (figures 3.38a to 3.41a)", "x", "m", "F", "N"},
               {"force-velocity", "Friction force over velocity (figures 3.38b to 3.41b)", "v", "m/s", "F", "N"}};
  run_by_law(e, options, breakaway_of_law);
  e.claims = parameter_claims(e);
  return e;
}

}  // namespace limcycle
