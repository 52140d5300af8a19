#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

Element coulomb(double Fc) {
  Coulomb<double> law;
  law.Fs = law.Fs_minus = law.Fc = law.Fc_minus = Fc;
  return law;
}

/// v = V0 + B cos wt: mean force and gain from velocity to force.
struct BiasedGain {
  double mean = 0.0, gain = 0.0;
  DescribingFunction df;
};

BiasedGain biased_gain(double Fc, double V0, double B, double w, bool by_fft) {
  BiasedGain result;
  result.df = computed_gain(coulomb(Fc), {B / w, w, V0}, by_fft, by_fft ? 1e-8 : 1e-10);
  result.mean = result.df.mean;
  result.gain = result.df.gain.imag() / w;
  return result;
}

bool check_bias(ClaimChecks& checks, double Fc, double V0, double B, double w, bool by_fft) {
  const BiasedGain found = biased_gain(Fc, V0, B, w, by_fft);
  if (!found.df.answered()) {
    checks.stop(found.df.status);
    return false;
  }
  const std::string at = place({{"Fc", Fc, "N"}, {"V0", V0, "m/s"}, {"B", B, "m/s"}, {"w", w, "rad/s"}});
  const double u = V0 / B, size = 4.0 * Fc / (pi * B);
  const bool reverses = std::abs(u) < 1.0;
  const double mean = reverses ? 2.0 * Fc / pi * std::asin(u) : std::copysign(Fc, V0);
  const double gain = reverses ? size * std::sqrt((1.0 - u) * (1.0 + u)) : 0.0;
  const double allowed = found.df.error + 1e-12;
  checks.equal(at, "mean force", "N", mean, found.mean, 10.0 * allowed, Fc);
  checks.equal(at, "gain", "N s/m", gain, found.gain, allowed, size);
  checks.equal(at, "in-phase part of the gain", "N/m", 0.0, found.df.gain.real(), allowed, size * w);
  return true;
}

ClaimResult test_bias(const ClaimOptions& options) {
  ClaimChecks checks;
  const BiasedGain printed = biased_gain(1.0, 0.3, 1.0, 1.0, false);
  const std::string at = place({{"Fc", 1.0, "N"}, {"V0", 0.3, "m/s"}, {"B", 1.0, "m/s"}});
  check_printed(checks, at, "mean force", "N", 0.193973, 1e-6, printed.mean);
  check_printed(checks, at, "gain", "N s/m", 1.214593, 1e-6, printed.gain);
  check_bias(checks, 1.0, 0.3, 1.0, 1.0, true);
  // Dither makes friction viscous: the mean force of a small mean velocity, to u^2/6.
  const BiasedGain small = biased_gain(1.0, 1e-4, 1.0, 1.0, false);
  checks.equal("V0 = 1e-4 m/s, B = 1 m/s, Fc = 1 N", "mean force over mean velocity", "N s/m", 2.0 / pi,
               small.mean / 1e-4, 1e-8);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double Fc = random.log_between(0.1, 10.0), B = random.log_between(1e-4, 1.0);
    const double V0 = B * random.between(-1.5, 1.5), w = random.log_between(0.1, 100.0);
    if (!check_bias(checks, Fc, V0, B, w, false)) break;
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

struct LuGreRow {
  double A, w, re, im, peak;  ///< peak 0: not printed
};

/// Fs = 1.5, Fc = 1, vs = 1e-3, delta = 2, sigma0 = 1e5, sigma1 = sqrt(1e5), sigma2 = 0.
constexpr LuGreRow lugre_table[] = {
    {5e-6, 1.0, 95968.896, 13849.060, 0.0},       {5e-6, 10.0, 95579.339, 16585.322, 0.0},
    {1.5e-5, 1.0, 73153.016, 30586.475, 1.14237}, {1.5e-5, 10.0, 72116.506, 32672.162, 1.14036},
    {1e-4, 1.0, 8653.452, 16223.919, 1.49872},    {1e-4, 10.0, 7156.846, 13889.236, 1.40000},
    {1e-3, 1.0, 274.198, 1588.540, 1.48577},      {1e-3, 10.0, 143.591, 1265.369, 1.15178},
    {1e-2, 1.0, 7.219, 127.419, 1.39056},         {1e-2, 10.0, 1.121, 127.357, 1.34008}};

Element lugre(double Fs, double Fc, double vs, double sigma0, double sigma1) {
  LuGre<double> law;
  law.Fs = law.Fs_minus = Fs;
  law.Fc = law.Fc_minus = Fc;
  law.vs = vs;
  law.sigma0 = sigma0;
  law.sigma1 = sigma1;
  return law;
}

/// First harmonic and peak of the force in the last of a number of periods, marched from the virgin state.
struct MarchedPeriod {
  Complex gain;
  double peak = 0.0;
};

MarchedPeriod marched(const Element& law, double A, double w, int periods, int steps) {
  DrivenLaw motion(law);
  const auto velocity = [A, w](double t) { return A * w * std::cos(w * t); };
  const double T = 2.0 * pi / w;
  MarchedPeriod result;
  // From one reversal to the next, so that no step contains the kink of|v| inside.
  motion.go(velocity, 0.25 * T, steps / 4);
  for (int k = 0; k < periods; ++k)
    for (int half = 0; half < 2; ++half) {
      const double sign = half == 0 ? -1.0 : 1.0;
      if (k == periods - 1)
        motion.watch = [&](double t) {
          const double F = motion.force(), phase = w * t;
          result.gain += 2.0 / (steps * A) * F * sign * Complex(-std::cos(phase), std::sin(phase));
          result.peak = std::max(result.peak, std::abs(F));
        };
      motion.go([A, w, sign](double t) { return sign * A * w * std::sin(w * t); }, 0.5 * T, steps / 2);
    }
  return result;
}

void check_lugre_row(ClaimChecks& checks, const LuGreRow& row) {
  const auto law = lugre(1.5, 1.0, 1e-3, 1e5, std::sqrt(1e5));
  const std::string at = place({{"A", row.A, "m"}, {"w", row.w, "rad/s"}});
  const auto df = computed_gain(law, {row.A, row.w, 0.0}, false, 1e-11);
  if (!df.answered()) return checks.stop(df.status);
  const double error = df.error * std::abs(df.gain);
  // Three decimals are printed. At the smallest amplitude the two methods here agree on 95968.9002 and 95579.3430: the
  // third decimal of the table is not warranted there.
  const double last_digit = row.A < 1e-5 ? 1e-2 : 1e-3, size = std::abs(df.gain);
  check_printed(checks, at, "Re N", "N/m", row.re, last_digit, df.gain.real(), error);
  check_printed(checks, at, "Im N", "N/m", row.im, last_digit, df.gain.imag(), error);
  // The memory of the virgin state fades at most by exp(-4 A sigma0/Fs) per period.
  const MarchedPeriod period = marched(law, row.A, row.w, row.A < 1e-5 ? 16 : 5, 40000);
  const double allowed = 0.6 * last_digit / size + 3e-7;
  checks.equal(at, "Re N by marching", "N/m", row.re, period.gain.real(), allowed, size);
  checks.equal(at, "Im N by marching", "N/m", row.im, period.gain.imag(), allowed, size);
  if (row.peak != 0.0) check_printed(checks, at, "peak of F", "N", row.peak, 1e-5, period.peak);
}

/// Slow or sigma1 = 0 and g = Fs: the loop is that of A12 with the level Fs. Here for the law, w -> 0.
void check_slow_limit(ClaimChecks& checks, double Fs, double Fc, double sigma0, double A) {
  const auto law = lugre(Fs, Fc, 1e-3, sigma0, std::sqrt(sigma0));
  Dahl<double> dahl;
  dahl.Fc = Fs;
  dahl.sigma0 = sigma0;
  // At this w the speed is 1e-7 of vs, and sigma1 dz/dt 1e-7 of the force at most.
  const double w = 1e-10 * std::min(1.0, 1.0 / A) / (1.0 + A * sigma0 / Fs);
  const auto slow = computed_gain(law, {A, w, 0.0}, false, 1e-10),
             limit = computed_gain(dahl, {A, 1.0, 0.0}, false, 1e-10);
  if (!slow.answered() || !limit.answered()) return checks.stop(slow.answered() ? limit.status : slow.status);
  const std::string at = place({{"Fs", Fs, "N"}, {"Fc", Fc, "N"}, {"sigma0", sigma0, "N/m"}, {"A", A, "m"}});
  const double size = std::abs(limit.gain);
  checks.equal(at, "Re N at w -> 0", "N/m", limit.gain.real(), slow.gain.real(), 1e-7, size);
  checks.equal(at, "Im N at w -> 0", "N/m", limit.gain.imag(), slow.gain.imag(), 1e-7, size);
}

ClaimResult test_lugre(const ClaimOptions& options) {
  ClaimChecks checks;
  for (const LuGreRow& row : lugre_table) {
    if (!stopped(options)) check_lugre_row(checks, row);
  }
  const std::string at = "sigma1 = 0, g = 1.5 N, A = 1.5e-05 m, w = 1e-04 rad/s";
  const auto constant = lugre(1.5, 1.5, 1e-3, 1e5, 0.0);
  const auto df = computed_gain(constant, {1.5e-5, 1e-4, 0.0}, false, 1e-11);
  check_printed(checks, at, "Re N", "N/m", 73250.7545, 1e-4, df.gain.real());
  check_printed(checks, at, "Im N", "N/m", 30354.7748, 1e-4, df.gain.imag());
  check_printed(checks, at, "peak of F", "N", 1.14239, 1e-5, marched(constant, 1.5e-5, 1e-4, 6, 20000).peak);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double Fc = random.log_between(0.1, 10.0), Fs = Fc * random.between(1.0, 3.0);
    const double sigma0 = random.log_between(1e3, 1e6);
    check_slow_limit(checks, Fs, Fc, sigma0, Fs / sigma0 * random.log_between(0.1, 100.0));
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

}  // namespace

std::vector<Claim> friction_gain_claims() {
  return {
      {"A14",
       "Coulomb friction under an oscillating velocity with a mean: the mean force rises with asin, and a small mean "
       "velocity meets viscous friction (dither).",
       "v = V0 + B cos wt, |V0| < B: mean (2 Fc/pi) asin(V0/B), gain (4 Fc/(pi B)) sqrt(1 - (V0/B)^2); 2 Fc/(pi B) "
       "for a small mean; |V0| >= B: mean Fc sgn V0, gain 0",
       "derived; checked by computation", Evidence::derived, "Fc, B > 0, V0 from -1.5 B to 1.5 B",
       "FFT of the sampled force and quadrature at the printed point, quadrature at random ones, without the closed "
       "form",
       ClaimVerdict::holds, test_bias},
      {"A15",
       "LuGre has no closed form but in the limit of slow motion, where it is Dahl's with the level Fs (A12). "
       "Reference values for Fs = 1.5, Fc = 1, vs = 1e-3, sigma0 = 1e5, sigma1 = sqrt(1e5), sigma2 = 0.",
       "N(A, w -> 0) = A12 with Fc -> Fs", "computed elsewhere by exact-exponential stepping, 4e5 steps a period",
       Evidence::derived, "the ten printed points; the limit for Fs/Fc from 1 to 3, A from 0.1 to 100 Fs/sigma0",
       "quadrature of the periodic state, and a Runge-Kutta march of five periods for gain and peak; the limit "
       "against Dahl's law, both by quadrature",
       ClaimVerdict::holds, test_lugre},
      passive_gain_claim()};
}

}  // namespace limcycle
