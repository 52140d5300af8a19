#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;
using Complex = std::complex<double>;

Element viscous_coulomb(double Fc, double sigma2) {
  Coulomb<double> law;
  law.Fs = law.Fs_minus = law.Fc = law.Fc_minus = Fc;
  law.sigma2 = sigma2;
  return law;
}

/// W = 4 Fc A and the harmonics 4 Fc/(pi k) of odd order k, alternating in sign.
void check_square_wave(ClaimChecks& checks, const std::string& where, const GainPoint& at,
                       const DescribingFunction& df) {
  const double Fc = at.p[0], error = stated_error(df);
  checks.equal(where, "W", "J", 4.0 * Fc * at.amplitude, df.dissipation, error);
  for (const int k : {3, 5, 7}) {
    const Complex computed = df.harmonics[static_cast<std::size_t>(k - 1)];
    const double claimed = 4.0 * Fc / (pi * k) * (k % 4 == 1 ? 1.0 : -1.0);
    // The error of a higher harmonic is not given; it is at most that of the first times its order.
    checks.equal(where, "harmonic " + std::to_string(k), "N", 0.0, std::abs(computed - Complex(0.0, claimed)),
                 10.0 * k * error, 4.0 * Fc / pi);
    checks.equal(where, "harmonic " + std::to_string(k - 1), "N", 0.0,
                 std::abs(df.harmonics[static_cast<std::size_t>(k - 2)]), 10.0 * k * error, 4.0 * Fc / pi);
  }
}

/// THD from the mean square of the force, sampled from one reversal to the next, and its first harmonic.
void check_distortion(ClaimChecks& checks, const ClaimOptions&) {
  const double Fc = 1.0, A = 0.01;
  DrivenLaw motion(viscous_coulomb(Fc, 0.0));
  double squares = 0.0, first = 0.0, last = 0.0;
  motion.watch = [&](double t) {
    squares += motion.force() * motion.force() * (t - last);
    first += motion.force() * (std::cos(last) - std::cos(t));
    last = t;
  };
  motion.go([A](double t) { return A * std::sin(t); }, pi, 4096);
  const double amplitude = 2.0 / pi * first, mean_square = squares / pi;
  const double distortion = std::sqrt(mean_square / (0.5 * amplitude * amplitude) - 1.0);
  const std::string at = place({{"Fc", Fc, "N"}, {"A", A, "m"}});
  checks.equal(at, "THD (harmonics over fundamental)", "", std::sqrt(pi * pi / 8.0 - 1.0), distortion, 1e-10);
  check_printed(checks, at, "THD", "", 0.483426, 1e-6, distortion);
}

GainClaim dry() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.names = {{"Fc", "N"}};
  f.element = [](const Numbers& p) { return viscous_coulomb(p[0], 0.0); };
  f.gain = [](const GainPoint& at) -> Complex { return {0.0, 4.0 * at.p[0] / (pi * at.amplitude)}; };
  f.printed = {{{{1.0}, 0.01}, {0.0, 127.323954}, 1e-6}};
  f.draw = [](RandomPoints& random) {
    return GainPoint{{random.log_between(0.1, 10.0)}, random.log_between(1e-6, 1.0), random.log_between(0.1, 100.0)};
  };
  f.more = check_square_wave;
  f.once = check_distortion;
  return {
      {"A2",
       "Coulomb friction on a sinusoidal displacement is a square wave of the velocity's sign: a purely imaginary "
       "gain, odd harmonics that fall with 1/k, and a dissipation of 4 Fc A a period.",
       "N = j 4 Fc/(pi A); W = 4 Fc A; harmonics 4 Fc/(pi k), k odd; THD = sqrt(pi^2/8 - 1)",
       "derived; checked by computation",
       Evidence::derived,
       "Fc > 0, any A and w",
       "FFT of the sampled force at the printed point, quadrature at random ones, without the closed form; THD from "
       "the mean square of the force marched along a half period",
       ClaimVerdict::holds,
       {}},
      f};
}

GainClaim dry_and_viscous() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.names = {{"Fc", "N"}, {"sigma2", "N s/m"}};
  f.element = [](const Numbers& p) { return viscous_coulomb(p[0], p[1]); };
  f.gain = [](const GainPoint& at) -> Complex {
    return {0.0, 4.0 * at.p[0] / (pi * at.amplitude) + at.p[1] * at.frequency};
  };
  f.draw = [](RandomPoints& random) {
    return GainPoint{{random.log_between(0.1, 10.0), random.log_between(0.01, 100.0)},
                     random.log_between(1e-4, 1.0),
                     random.log_between(0.1, 100.0)};
  };
  return {{"A3",
           "Viscous friction adds to the describing function of Coulomb friction.",
           "N = j (4 Fc/(pi A) + sigma2 w)",
           "derived",
           Evidence::derived,
           "Fc > 0, sigma2 >= 0, any A and w",
           "quadrature at random points, without the closed form",
           ClaimVerdict::holds,
           {}},
          f};
}

}  // namespace

std::vector<GainClaim> coulomb_gain_claims() { return {dry(), dry_and_viscous()}; }

}  // namespace limcycle
