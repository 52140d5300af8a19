#include "limcycle/analysis/study/claims/user_claim.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/energy/passivity/bounds.hpp"
#include "limcycle/analysis/energy/passivity/threshold.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

/// A computed number, its absolute error, and the reason if there is none.
struct Computed {
  double value = NAN, error = 0.0;
  double size = 0.0;  ///< reference size of an equality, if a better one is known than the number itself
  Status status = Status::converged;
  bool exists = true;  ///< false: it was sought, and does not exist
};

/// True if the outcome of every start was recognised.
bool all_decided(const PredictReport& report) {
  return !report.outcomes.empty() && std::ranges::none_of(report.outcomes, [](const OutcomeOfStart& one) {
    return one.outcome == Outcome::undecided;
  });
}

Computed of_cycle(const std::string& quantity, const ClaimPoint& point, const PredictOptions& options) {
  const PredictReport report = predict(*point.loop, options);
  if (report.status == Status::interrupted) return {.status = report.status};
  const Cycle* cycle = largest_stable(report.cycles);
  const bool decided = all_decided(report);
  if (quantity == "hunts") {
    if (cycle == nullptr && !decided) return {.status = Status::incomplete};
    return {.value = cycle != nullptr ? 1.0 : 0.0};
  }
  if (quantity == "cycles") {
    if (!decided || report.status != Status::converged) return {.status = Status::incomplete};
    return {.value = static_cast<double>(report.cycles.size())};
  }
  if (cycle == nullptr) return {.status = decided ? Status::converged : Status::incomplete, .exists = !decided};
  if (quantity == "period") return {cycle->period, cycle->error * cycle->period};
  if (quantity == "frequency") return {cycle->frequency(), cycle->error * cycle->frequency()};
  if (quantity == "amplitude") return {cycle->amplitude, cycle->error * cycle->amplitude};
  if (quantity == "first_harmonic") return {cycle->first_harmonic, cycle->error * cycle->first_harmonic};
  // Their own errors are not given: those of the cycle's motion are used, with a margin.
  if (quantity == "offset") return {cycle->offset, 10.0 * cycle->error * cycle->amplitude, cycle->amplitude};
  if (quantity == "sticking_fraction") return {cycle->sticking_fraction, 10.0 * cycle->error};
  const double largest = cycle->multipliers.empty() ? 0.0 : std::abs(cycle->multipliers.front());
  return {largest, std::max(cycle->multiplier_error, 1e-6 + 10.0 * cycle->error)};
}

Computed of_describing_function(const std::string& quantity, const ClaimPoint& point) {
  DfOptions options;
  options.accuracy = 1e-9;
  options.method = DfMethod::quadrature;  // not a closed form, which the claim may state
  const DescribingFunction df = describing_function(*point.element, point.at, options);
  if (!df.answered()) return {.status = df.status};
  const double size = std::abs(df.gain), error = df.error * size;
  if (quantity == "gain.real") return {df.gain.real(), error, size};
  if (quantity == "gain.imag") return {df.gain.imag(), error, size};
  // No error is given for these: that of the output is used, as large as that of the first harmonic.
  const double output = error * point.at.amplitude;
  if (quantity == "mean") return {df.mean, output, size * point.at.amplitude};
  const double way = 4.0 * point.at.amplitude + 6.3 * std::abs(point.at.bias) / point.at.frequency;
  return {df.dissipation, output * way};
}

Computed of_bound(bool of_force, const ClaimPoint& point, const ClaimOptions& options) {
  BoundsOptions how;
  how.seed = options.seed;
  how.inputs = 0;  // values reached by a search are no bound
  how.stop = options.stop;
  const Bounds found = bounds(*point.element, how);
  if (found.status != Status::converged) return {.status = found.status};
  if (of_force) {
    if (found.force.kind == BoundKind::searched) return {.status = Status::incomplete};
    return {.value = found.force.value};
  }
  double largest = 0.0;
  for (const auto& state : found.states) {
    if (state.kind == BoundKind::searched) return {.status = Status::incomplete};
    largest = std::max({largest, std::abs(state.low), std::abs(state.high)});
  }
  return {.value = largest};
}

Computed of_law(const std::string& quantity, const ClaimPoint& point, const ClaimOptions& options) {
  if (quantity == "state_bound" || quantity == "force_bound")
    return of_bound(quantity == "force_bound", point, options);
  if (quantity == "threshold.sigma2") {
    ThresholdOptions how;
    how.accuracy = 1e-8;
    how.stop = options.stop;
    const LeastDamping least = least_sigma2(*point.element, how);
    return {least.value, least.error, 0.0, least.status};
  }
  PassivityOptions how;
  how.seed = options.seed;
  how.stop = options.stop;
  const Passivity answer = passivity(*point.element, how);
  if (answer.passive == Passive::undecided)
    return {.status = answer.status == Status::converged ? Status::incomplete : answer.status};
  return {.value = answer.passive == Passive::yes ? 1.0 : 0.0};
}

void compare(const UserClaim& user, const std::string& unit, const std::string& where, double claimed,
             const Computed& computed, ClaimChecks& checks) {
  if (computed.status != Status::converged) return checks.stop(computed.status);
  if (!computed.exists) return checks.is_true(where, "there is a stable limit cycle", false);
  const double value = computed.value, error = computed.error;
  // If the error of the computed value exceeds the difference, nothing is decided.
  switch (user.comparison) {
    case Comparison::equal: {
      const double size = std::max(std::abs(claimed), computed.size), share = error / (size > 0.0 ? size : 1.0);
      const bool near = std::abs(value - claimed) <= (user.tolerance + share) * (size > 0.0 ? size : 1.0);
      if (near && share > user.tolerance) return checks.stop(Status::incomplete);
      return checks.equal(where, user.quantity, unit, claimed, value, user.tolerance + share, size);
    }
    case Comparison::at_most:
      return checks.at_most(where, user.quantity, unit, claimed, value, error);
    case Comparison::at_least:
      return checks.at_least(where, user.quantity, unit, claimed, value, error);
    default:
      if (error > 0.0 && std::abs(value - claimed) <= error) return checks.stop(Status::incomplete);
      if (user.comparison == Comparison::less)
        checks.at_most(where, user.quantity, unit, std::nextafter(claimed, -HUGE_VAL), value, 0.0);
      else
        checks.at_least(where, user.quantity, unit, std::nextafter(claimed, HUGE_VAL), value, 0.0);
  }
}

const ClaimQuantity& quantity_of(const UserClaim& user) {
  const auto& all = claim_quantities();
  return *std::ranges::find(all, std::string_view(user.quantity), &ClaimQuantity::name);
}

ClaimResult test(const UserClaim& user, const PredictOptions& predict_options, const ClaimPoints& points,
                 const ClaimOptions& options) {
  const ClaimQuantity& quantity = quantity_of(user);
  ClaimChecks checks;
  const auto one = [&](const ClaimPoint& point, const std::string& where) {
    PredictOptions how = predict_options;
    how.stop = options.stop;
    how.progress = {};
    const Computed computed = quantity.of == QuantityOf::cycle ? of_cycle(user.quantity, point, how)
                              : quantity.of == QuantityOf::describing_function
                                  ? of_describing_function(user.quantity, point)
                                  : of_law(user.quantity, point, options);
    compare(user, std::string(quantity.unit), where, point.claimed, computed, checks);
  };
  if (const auto own = points({})) one(*own, "the case's own numbers");
  RandomShares random(options.seed);
  checks.random(true);
  // Draws that give no valid case (such as Fs < Fc) are repeated, up to a limit.
  const int wanted = user.over.empty() ? 0 : user.random_points;
  int tested = 0;
  for (int tries = 0; tested < wanted && tries < 20 * wanted; ++tries) {
    if (options.stop && options.stop()) {
      checks.stop(Status::interrupted);
      break;
    }
    std::vector<std::pair<std::string, double>> values;
    std::string where;
    for (const auto& parameter : user.over) {
      values.emplace_back(parameter.path, parameter.quantile(random.share()));
      where += (where.empty() ? "" : ", ") + parameter.path.substr(parameter.path.rfind('.') + 1) + " = " +
               short_number(values.back().second, 6);
    }
    const auto point = points(values);
    if (!point) continue;
    one(*point, where);
    ++tested;
  }
  if (tested < wanted && !(options.stop && options.stop())) checks.stop(Status::incomplete);
  return checks.result();
}

}  // namespace

const std::vector<ClaimQuantity>& claim_quantities() {
  using enum QuantityOf;
  static const std::vector<ClaimQuantity> all{
      {"period", "s", cycle, "period of the stable limit cycle"},
      {"amplitude", "", cycle, "half the swing of y"},
      {"frequency", "rad/s", cycle, "2 pi over the period"},
      {"offset", "", cycle, "mean of y"},
      {"first_harmonic", "", cycle, "amplitude of y's first harmonic"},
      {"sticking_fraction", "", cycle, "share of the period that is stuck"},
      {"largest_multiplier", "", cycle, "largest modulus of the Floquet multipliers but the trivial 1"},
      {"cycles", "", cycle, "number of limit cycles found, unstable ones included"},
      {"hunts", "", cycle, "1 if there is a stable limit cycle, else 0"},
      {"gain.real", "", describing_function, "real part of N(A, w)"},
      {"gain.imag", "", describing_function, "imaginary part of N(A, w)"},
      {"dissipation", "", describing_function, "work per period against the element"},
      {"mean", "", describing_function, "mean output"},
      {"passive", "", law, "1 if the law is passive from v to F, 0 if not"},
      {"threshold.sigma2", "N s/m", law, "the least sigma2 with which the law is passive"},
      {"state_bound", "", law, "the largest size of a state, over all inputs"},
      {"force_bound", "N", law, "the largest |F|, over all inputs"}};
  return all;
}

Claim user_claim(const UserClaim& user, const PredictOptions& predict, const ClaimPoints& points,
                 const std::string& source) {
  const ClaimQuantity& quantity = quantity_of(user);
  Claim claim;
  claim.id = user.id;
  claim.formula = user.quantity + " " + std::string(to_string(user.comparison)) + " " + user.formula;
  claim.statement = user.statement.empty() ? claim.formula : user.statement;
  claim.source = user.source.empty() ? source : user.source;
  claim.evidence = Evidence::knowledge;
  claim.expected = user.expected;
  claim.range = "the case's own numbers";
  for (const auto& one : user.over)
    claim.range += ", " + one.path + " from " + short_number(one.low) + " to " + short_number(one.high) + " (" +
                   std::string(to_string(one.distribution)) + ")";
  claim.test = quantity.of == QuantityOf::cycle ? "the limit cycle is found by simulation and shooting, as in predict: "
               : quantity.of == QuantityOf::describing_function ? "the describing function is computed: "
                                                                : "over all inputs to the law: ";
  claim.test += std::string(quantity.meaning);
  claim.run = [user, predict, points](const ClaimOptions& options) { return test(user, predict, points, options); };
  return claim;
}

std::string_view to_string(Comparison comparison) {
  switch (comparison) {
    case Comparison::equal:
      return "=";
    case Comparison::less:
      return "<";
    case Comparison::at_most:
      return "<=";
    case Comparison::greater:
      return ">";
    case Comparison::at_least:
      return ">=";
  }
  return "?";
}

}  // namespace limcycle
