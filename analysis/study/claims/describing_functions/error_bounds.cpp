#include <cmath>
#include <numbers>
#include <optional>

#include "limcycle/analysis/frequency/describing_function/error_band.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/claims/claim_points.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

const std::string source =
    "A. I. Mees, A. R. Bergen (1975), IEEE TAC 20(4), 473-478 (reference confirmed, statement from knowledge; Khalil, "
    "Nonlinear Systems, section 7.2)";
const std::string range =
    "x = -G n(x), n the unit saturation, G = K/((s+p1)(s+p2)(s+p3)) with K from 1.1 to 4 times the critical one, or G "
    "= "
    "-s/(s^2 + c s + k), c from 0.2 to 0.9";

/// G = numerator/denominator, highest power first, around the unit saturation, with the root of its describing
/// function.
struct Example {
  std::string where;
  std::vector<double> numerator, denominator;
  double w = 0.0, a = 0.0;

  Loop loop() const {
    LoopParts parts;
    parts.plant = TransferFunction{numerator, denominator, 0.0};
    Saturation<double> element;
    element.limit = 1.0;
    parts.element = element;
    return build_loop(parts);
  }
  Complex inverse(double frequency) const {
    const Complex s(0.0, frequency);
    const auto value = [s](const std::vector<double>& coefficients) {
      Complex sum;
      for (const double c : coefficients) sum = sum * s + c;
      return sum;
    };
    return value(denominator) / value(numerator);
  }
};

/// Psi(a) of the unit saturation, claim A6.
double psi(double a) {
  if (a <= 1.0) return 1.0;
  const double u = 1.0 / a;
  return 2.0 / pi * (std::asin(u) + u * std::sqrt((1.0 - u) * (1.0 + u)));
}

double amplitude_of(double gain) {
  double low = 1.0, high = 10.0 / gain;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (psi(middle) > gain ? low : high) = middle;
  }
  return low;
}

// Slopes from 0 to 1: centre and half-width of the band of slopes.
constexpr double centre = 0.5, gamma = 0.5;

/// rho(w) over the odd harmonics up to 2001: beyond them 1/G of a filter has grown.
double rho(const Example& example, double w) {
  double least = infinite;
  for (int k = 3; k <= 2001; k += 2) least = std::min(least, std::abs(centre + example.inverse(k * w)));
  return least;
}
double sigma(const Example& example, double w) { return gamma * gamma / (rho(example, w) - gamma); }

Example resonant(double c, double k) {
  return {"G = -s/(s^2 + c s + k), " + place({{"c", c}, {"k", k}}),
          {-1.0, 0.0},
          {1.0, c, k},
          std::sqrt(k),
          amplitude_of(c)};
}

Example three_lags(double p1, double p2, double p3, double margin) {
  const double a2 = p1 + p2 + p3, a1 = p1 * p2 + p1 * p3 + p2 * p3, a0 = p1 * p2 * p3;
  const double critical = a1 * a2 - a0, K = margin * critical;
  return {"G = K/((s+p1)(s+p2)(s+p3)), " + place({{"p1", p1}, {"p2", p2}, {"p3", p3}, {"K", K}}),
          {K},
          {1.0, a2, a1, a0},
          std::sqrt(a1),
          margin > 1.0 ? amplitude_of(1.0 / margin) : 0.0};
}

/// The example of the list of claims.
Example printed_example() { return resonant(0.8, 8.0); }

Example drawn_example(RandomPoints& random, int i) {
  if (i % 2 == 0) {
    const double c = random.between(0.2, 0.9);
    return resonant(c, random.log_between(2.0, 30.0));
  }
  const double p1 = random.log_between(0.3, 3.0), p2 = random.log_between(0.3, 3.0), p3 = random.log_between(0.3, 3.0);
  return three_lags(p1, p2, p3, random.between(1.1, 4.0));
}

/// The cycle that the loop approaches, simulated and closed by shooting; notes in `checks` if there is none.
std::optional<Cycle> true_cycle(ClaimChecks& checks, const Example& example, const ClaimOptions& options) {
  const Loop loop = example.loop();
  SettleOptions settle_options;
  settle_options.stop = options.stop;
  settle_options.shooting.stop = options.stop;
  const Settled settled = settle(loop, displaced(loop, example.a), settle_options);
  if (settled.outcome == Outcome::cycle && settled.shot) return settled.shot->cycle;
  checks.stop(stopped(options) ? Status::interrupted : Status::incomplete);
  return {};
}

/// Mean square over a period of a signal known by values and rates: Simpson's rule on the cubic between samples.
double mean_square(const Trace& trace, double period) {
  double sum = 0.0;
  for (std::size_t i = 1; i < trace.t.size(); ++i) {
    const double h = trace.t[i] - trace.t[i - 1];
    const double middle = 0.5 * (trace.y[i - 1] + trace.y[i]) + 0.125 * h * (trace.rate[i - 1] - trace.rate[i]);
    sum += h / 6.0 * (trace.y[i - 1] * trace.y[i - 1] + 4.0 * middle * middle + trace.y[i] * trace.y[i]);
  }
  return sum / period;
}

using Test = void (*)(ClaimChecks&, const Example&, const Cycle&);

/// One test on the printed example and on random ones.
ClaimResult on_examples(const ClaimOptions& options, ClaimChecks& checks, Test test) {
  RandomPoints random(options.seed);
  for (int i = -1; i < options.random_points && !stopped(options); ++i) {
    checks.random(i >= 0);
    const Example example = i < 0 ? printed_example() : drawn_example(random, i);
    const auto cycle = true_cycle(checks, example, options);
    if (!cycle) break;
    test(checks, example, *cycle);
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

void check_disc(ClaimChecks& checks, const Example& example, const Cycle& cycle) {
  const double w = cycle.frequency(), a = cycle.first_harmonic;
  if (!(rho(example, w) > gamma)) return;  // not a filtered frequency
  checks.equal(example.where, "sigma of the program, at the frequency of the cycle", "", sigma(example, w),
               ErrorBand(example.loop()).sigma(w), 1e-6);
  checks.at_most(example.where, "|1/G(jw) + Psi(a)| of the cycle, below sigma(w)", "", sigma(example, w),
                 std::abs(example.inverse(w) + psi(a)), 1e-6);
}

ClaimResult test_disc(const ClaimOptions& options) {
  ClaimChecks checks;
  const Example example = printed_example();
  const std::string at = example.where;
  check_printed(checks, at, "w of the describing function", "rad/s", 2.828427, 1e-6, example.w);
  check_printed(checks, at, "a of the describing function", "", 1.455501, 1e-6, example.a);
  check_printed(checks, at, "rho at that w", "", 7.548, 1e-3, ErrorBand(example.loop()).rho(example.w));
  check_printed(checks, at, "sigma at that w", "", 0.035469, 1e-6, ErrorBand(example.loop()).sigma(example.w));
  return on_examples(options, checks, check_disc);
}

/// No frequencies around a true cycle may be excluded; those far from it are.
void check_not_excluded(ClaimChecks& checks, const Example& example, const Cycle& cycle) {
  const double w = cycle.frequency(), a = cycle.first_harmonic;
  const Absence around = ErrorBand(example.loop()).absence({0.9 * a, 1.1 * a, 0.99 * w, 1.01 * w});
  checks.is_true(example.where, "the neighbourhood of the cycle is not excluded",
                 around.verdict == BandVerdict::undecided);
}

/// Loops of too little gain: if absence is proved for every amplitude, simulations must come to rest.
void check_rest(ClaimChecks& checks, const Example& example, const ClaimOptions& options, int& proved) {
  const Loop loop = example.loop();
  const SearchBox box{1e-3, 1e3, 1e-2 * example.w, 1e2 * example.w};
  if (ErrorBand(loop).absence(box).verdict != BandVerdict::proved) return;
  ++proved;
  for (const double start : {0.5, 5.0, 100.0}) {
    SettleOptions settle_options;
    settle_options.stop = options.stop;
    const Settled settled = settle(loop, displaced(loop, start), settle_options);
    checks.is_true(example.where + ", " + place({{"y(0)", start}}), "the motion comes to rest",
                   settled.outcome == Outcome::rest);
  }
}

ClaimResult test_absence(const ClaimOptions& options) {
  ClaimChecks checks;
  int proved = 0;
  check_rest(checks, three_lags(1.0, 1.0, 1.0, 0.4), options, proved);
  RandomPoints random(options.seed + 1);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double p1 = random.log_between(0.3, 3.0), p2 = random.log_between(0.3, 3.0),
                 p3 = random.log_between(0.3, 3.0);
    check_rest(checks, three_lags(p1, p2, p3, random.log_between(0.05, 0.95)), options, proved);
  }
  checks.random(false);
  checks.is_true("all loops of too little gain", "absence was proved for some", proved > 0);
  return on_examples(options, checks, check_not_excluded);
}

void check_box(ClaimChecks& checks, const Example& example, const Cycle& cycle) {
  const Existence box = ErrorBand(example.loop()).existence(example.w, example.a);
  if (box.verdict != BandVerdict::proved) return;  // the theorem makes no statement there
  const double w = cycle.frequency(), a = cycle.first_harmonic, error = 10.0 * cycle.error;
  checks.at_least(example.where, "w of the cycle, least of the box", "rad/s", box.frequency.low, w, error * w);
  checks.at_most(example.where, "w of the cycle, most of the box", "rad/s", box.frequency.high, w, error * w);
  checks.at_least(example.where, "a of the cycle, least of the box", "", box.amplitude.low, a, error * a);
  checks.at_most(example.where, "a of the cycle, most of the box", "", box.amplitude.high, a, error * a);
}

ClaimResult test_existence(const ClaimOptions& options) {
  ClaimChecks checks;
  const Example example = printed_example();
  const std::string at = example.where;
  const Existence box = ErrorBand(example.loop()).existence(example.w, example.a);
  checks.is_true(at, "existence is proved", box.verdict == BandVerdict::proved);
  // The digits of the upper edge of w are cut off, not rounded.
  check_printed(checks, at, "least w of the box", "rad/s", 2.81060, 1e-5, box.frequency.low);
  check_printed(checks, at, "largest w of the box", "rad/s", 2.84606, 2e-5, box.frequency.high);
  check_printed(checks, at, "least a of the box", "", 1.37658, 1e-5, box.amplitude.low);
  check_printed(checks, at, "largest a of the box", "", 1.53943, 1e-5, box.amplitude.high);
  if (const auto cycle = true_cycle(checks, example, options)) {
    check_printed(checks, at, "w of the true cycle", "rad/s", 2.825810, 1e-6, cycle->frequency());
    check_printed(checks, at, "first harmonic of the true cycle", "", 1.455914, 1e-6, cycle->first_harmonic);
    check_printed(checks, at, "peak of the true cycle", "", 1.455735, 1e-6, cycle->amplitude);
  }
  return on_examples(options, checks, check_box);
}

void check_harmonics(ClaimChecks& checks, const Example& example, const Cycle& cycle) {
  const double w = cycle.frequency(), a = cycle.first_harmonic;
  if (!(rho(example, w) > gamma)) return;
  const double total = mean_square(cycle.trace, cycle.period);
  const double rest = std::sqrt(std::max(0.0, total - 0.5 * a * a)) / (a / std::sqrt(2.0));
  checks.at_most(example.where, "|harmonics|/|first|, below sigma(w)/gamma", "", sigma(example, w) / gamma, rest, 1e-4);
  checks.at_least(example.where, "|harmonics|/|first|, there are some", "", 1e-4, rest, 0.0);
}

ClaimResult test_harmonics(const ClaimOptions& options) {
  ClaimChecks checks;
  return on_examples(options, checks, check_harmonics);
}

}  // namespace

std::vector<Claim> error_bound_claims() {
  const std::string setting =
      "; n odd, memoryless, incremental slopes in [alpha, beta], gamma = (beta - alpha)/2; rho = inf over odd k >= 3 "
      "of "
      "|(alpha + beta)/2 + 1/G(jkw)| > gamma; sigma = gamma^2/(rho - gamma)";
  const std::string cycles = "cycles found by simulation and shooting (exact matrix exponentials)";
  return {
      {"C1",
       "Every half-wave symmetric oscillation at a filtered frequency lies in an error disc about the describing "
       "function's balance.",
       "|1/G(jw) + Psi(a)| <= sigma(w)" + setting, source, Evidence::knowledge, range,
       cycles + ", rho by brute force over 1000 harmonics", ClaimVerdict::holds, test_disc},
      {"C2",
       "There is no oscillation at a filtered frequency whose disc does not meet -Psi, nor where |(alpha + beta)/2 + "
       "1/G(jkw)| > gamma for all odd k (incremental circle criterion).",
       "none if |1/G(jw) + Psi(a)| > sigma(w) for all a", source, Evidence::knowledge,
       range + "; for absence K from 0.05 to 0.95 of the critical one",
       "where the program proves absence, simulations from three starts must come to rest; the neighbourhood of "
       "cycles found by shooting must not be excluded",
       ClaimVerdict::holds, test_absence},
      {"C3",
       "Where the discs sweep a band that -Psi crosses completely, about a regular crossing, there is at least one "
       "oscillation in the rectangle.",
       "a cycle with (w, a) in the rectangle on whose border |1/G(jw) + Psi(a)| > sigma(w)", source,
       Evidence::knowledge, range, cycles + " against the rectangle that the program proves", ClaimVerdict::holds,
       test_existence},
      {"C4", "The harmonics of such an oscillation are bounded by the same numbers.",
       "|x_h| <= (sigma/gamma) |x_1| in the mean square" + setting, "derived (short proof by contraction)",
       Evidence::derived, range, cycles + ": mean square of y less that of its first harmonic", ClaimVerdict::holds,
       test_harmonics}};
}

}  // namespace limcycle
