#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

std::string where(const GainFormula& formula, const GainPoint& point) {
  std::string text;
  for (std::size_t i = 0; i < formula.names.size() && i < point.p.size(); ++i)
    text += formula.names[i].first + " = " + short_number(point.p[i], 6) +
            (formula.names[i].second.empty() ? "" : " " + formula.names[i].second) + ", ";
  text +=
      "A = " + short_number(point.amplitude, 6) + (formula.amplitude_unit.empty() ? "" : " ") + formula.amplitude_unit;
  return point.frequency == 1.0 ? text : text + ", w = " + short_number(point.frequency, 6) + " rad/s";
}

/// The computed value at a point; empty, with the reason added to `checks`, if there is nothing to compare.
std::optional<DescribingFunction> computed(ClaimChecks& checks, const GainFormula& formula, const GainPoint& point,
                                           bool by_fft) {
  const double accuracy = by_fft ? std::max(1e-8, formula.accuracy) : formula.accuracy;
  DescribingFunction df =
      computed_gain(formula.element(point.p), {point.amplitude, point.frequency, 0.0}, by_fft, accuracy);
  // An estimate so large that it would excuse a wrong formula is not an answer.
  if (df.answered() && df.error <= 1e-5) return df;
  checks.stop(df.answered() ? Status::incomplete : df.status);
  return {};
}

/// One point, by formula and by computation; false if there is nothing to compare.
bool compare(ClaimChecks& checks, const GainFormula& formula, const GainPoint& point, bool by_fft) {
  const std::string at = where(formula, point);
  const auto df = computed(checks, formula, point, by_fft);
  if (!df) return false;
  check_gain(checks, at, formula.unit, formula.gain(point), *df);
  if (formula.more) formula.more(checks, at, point, *df);
  return true;
}

bool compare(ClaimChecks& checks, const GainFormula& formula, const PrintedGain& printed) {
  if (!compare(checks, formula, printed.at, true)) return false;
  const std::string at = where(formula, printed.at);
  const auto df = computed(checks, formula, printed.at, false);
  if (!df) return false;
  const double error = df->error * std::abs(df->gain);
  check_printed(checks, at, "Re N", formula.unit, printed.gain.real(), printed.last_digit, df->gain.real(), error);
  check_printed(checks, at, "Im N", formula.unit, printed.gain.imag(), printed.last_digit, df->gain.imag(), error);
  return true;
}

}  // namespace

DescribingFunction computed_gain(const Element& element, const DfPoint& point, bool by_fft, double accuracy,
                                 int harmonics) {
  DfOptions options;
  options.method = by_fft ? DfMethod::fft : DfMethod::quadrature;
  options.accuracy = accuracy;
  options.harmonics = harmonics;
  return describing_function(element, point, options);
}

void check_gain(ClaimChecks& checks, const std::string& where, const std::string& unit, std::complex<double> claimed,
                const DescribingFunction& computed, double slack) {
  const double allowed = computed.error + slack, size = std::abs(claimed);
  checks.equal(where, "Re N", unit, claimed.real(), computed.gain.real(), allowed, size);
  checks.equal(where, "Im N", unit, claimed.imag(), computed.gain.imag(), allowed, size);
}

double share_inside(double u) {
  if (std::abs(u) >= 1.0) return u < 0.0 ? -1.0 : 1.0;
  return 2.0 / std::numbers::pi * (std::asin(u) + u * std::sqrt((1.0 - u) * (1.0 + u)));
}

ClaimResult test_gain(const GainFormula& formula, const ClaimOptions& options) {
  ClaimChecks checks;
  for (const PrintedGain& printed : formula.printed) {
    if (stopped(options)) checks.stop(Status::interrupted);
    if (stopped(options) || !compare(checks, formula, printed)) return checks.result();
  }
  if (formula.once) formula.once(checks, options);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && formula.draw; ++i) {
    if (stopped(options)) checks.stop(Status::interrupted);
    if (stopped(options) || !compare(checks, formula, formula.draw(random), false)) break;
  }
  return checks.result();
}

Claim as_claim(GainClaim claim) {
  Claim made = std::move(claim.text);
  made.run = [formula = std::move(claim.formula)](const ClaimOptions& options) { return test_gain(formula, options); };
  return made;
}

}  // namespace limcycle
