#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

Jenkins<double> jenkins_law(double k, double Fc) {
  Jenkins<double> law;
  law.k = k;
  law.Fc = Fc;
  return law;
}

Dahl<double> dahl_law(double Fc, double sigma0) {
  Dahl<double> law;
  law.Fc = Fc;
  law.sigma0 = sigma0;
  return law;
}

DescribingFunction by_quadrature(const Element& element, double A) {
  return computed_gain(element, {A, 1.0, 0.0}, false, 1e-10);
}

/// A8 = k (1 - A7), both computed.
void check_play_and_stop(ClaimChecks& checks, double k, double Fc, double A) {
  Backlash<double> play;
  play.half_gap = Fc / k;
  const auto stop = by_quadrature(jenkins_law(k, Fc), A), rest = by_quadrature(play, A);
  if (!stop.answered() || !rest.answered()) return checks.stop(stop.answered() ? rest.status : stop.status);
  const Complex claimed = k * (1.0 - rest.gain);
  const double allowed = stop.error + rest.error * k * std::abs(rest.gain) / std::abs(claimed) + 1e-13;
  const std::string at = place({{"k", k, "N/m"}, {"Fc", Fc, "N"}, {"A", A, "m"}});
  checks.equal(at, "Re N of the stop", "N/m", claimed.real(), stop.gain.real(), allowed, std::abs(claimed));
  checks.equal(at, "Im N of the stop", "N/m", claimed.imag(), stop.gain.imag(), allowed, std::abs(claimed));
}

/// A8 -> A2: the difference to the square wave falls with h/A, Im as 1 - h/A and Re as (16/(3 pi)) sqrt(h/A) h/A Fc/h.
void check_stiff_limit(ClaimChecks& checks, double Fc, double A) {
  for (const double ratio : {1e-2, 1e-4, 1e-6}) {
    const double k = Fc / (ratio * A), limit = 4.0 * Fc / (pi * A);
    const auto df = by_quadrature(jenkins_law(k, Fc), A);
    if (!df.answered()) return checks.stop(df.status);
    const std::string at = place({{"k", k, "N/m"}, {"Fc", Fc, "N"}, {"A", A, "m"}});
    checks.at_most(at, "|N - j 4 Fc/(pi A)| over its size", "", 1.5 * std::sqrt(ratio),
                   std::abs(df.gain - Complex(0.0, limit)) / limit, df.error);
  }
}

ClaimResult test_stop(const ClaimOptions& options) {
  ClaimChecks checks;
  check_play_and_stop(checks, 1000.0, 1.5, 0.004);
  check_stiff_limit(checks, 1.5, 0.004);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double k = random.log_between(1e2, 1e6), Fc = random.log_between(0.1, 10.0);
    check_play_and_stop(checks, k, Fc, Fc / k * random.log_between(1.1, 100.0));
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

/// Limits of A12. For small a = A/l the loop is F = sigma0 x, off by no more than (4/(3 pi)) a; for large a it is the
/// square wave, off by the real part, sqrt(pi/(2 a)), and by 1/a.
void check_dahl_limits(ClaimChecks& checks, double Fc, double sigma0) {
  const double l = Fc / sigma0;
  for (const double a : {1e-3, 1e-2}) {
    const auto df = by_quadrature(dahl_law(Fc, sigma0), a * l);
    if (!df.answered()) return checks.stop(df.status);
    const std::string at = place({{"Fc", Fc, "N"}, {"sigma0", sigma0, "N/m"}, {"A/l", a}});
    checks.at_most(at, "|N - sigma0| over sigma0", "", 0.5 * a, std::abs(df.gain - sigma0) / sigma0, df.error);
  }
  for (const double a : {1e3, 1e5}) {
    const auto df = by_quadrature(dahl_law(Fc, sigma0), a * l);
    if (!df.answered()) return checks.stop(df.status);
    const double limit = 4.0 * Fc / (pi * a * l);
    const std::string at = place({{"Fc", Fc, "N"}, {"sigma0", sigma0, "N/m"}, {"A/l", a}});
    checks.at_most(at, "|N - j 4 Fc/(pi A)| over its size", "", std::sqrt(pi / (2.0 * a)) + 1.0 / a,
                   std::abs(df.gain - Complex(0.0, limit)) / limit, df.error);
  }
}

/// The loop of A12 by marching: as many periods as its memory needs to fade, then the ascending branch.
void check_dahl_loop(ClaimChecks& checks, double Fc, double sigma0, double a) {
  const double l = Fc / sigma0, A = a * l;
  const int steps = 100 + static_cast<int>(200.0 * a);
  DrivenLaw loop(dahl_law(Fc, sigma0));
  loop.slide(1.0, A, steps);
  for (int k = 0; k < 2 + static_cast<int>(10.0 / a); ++k) {
    loop.slide(-1.0, 2.0 * A, 2 * steps);
    loop.slide(1.0, 2.0 * A, 2 * steps);
  }
  const std::string at = place({{"Fc", Fc, "N"}, {"sigma0", sigma0, "N/m"}, {"A/l", a}});
  checks.equal(at, "peak of F", "N", Fc * std::tanh(a), loop.force(), 1e-8);
  loop.slide(-1.0, 2.0 * A, 2 * steps);
  for (int i = 1; i <= 4; ++i) {
    loop.slide(1.0, 0.5 * A, steps);
    const double x = A * (0.5 * i - 1.0);
    checks.equal(at + ", x/A = " + std::to_string(0.5 * i - 1.0).substr(0, 4), "F ascending", "N",
                 Fc * (1.0 - std::exp(-x / l) / std::cosh(a)), loop.force(), 1e-8, Fc);
  }
}

ClaimResult test_dahl(const ClaimOptions& options) {
  ClaimChecks checks;
  check_dahl_limits(checks, 1.0, 1e5);
  check_dahl_loop(checks, 1.0, 1e5, 1.0);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double Fc = random.log_between(0.1, 10.0), sigma0 = random.log_between(1e3, 1e6);
    check_dahl_loop(checks, Fc, sigma0, random.log_between(0.2, 20.0));
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

/// Rayleigh's law of hysteresis as a rule: over the displacement d from the last reversal the output changes by alpha d
/// + (nu/2) d^2, from the virgin state by alpha d + nu d^2. Sampled over the period after the first peak.
struct RayleighLoop {
  Complex gain;
  double area;  ///< of y over x: the energy supplied by the input
};

RayleighLoop rayleigh_loop(double alpha, double nu, double A) {
  constexpr int samples = 20000;
  const double peak = alpha * A + nu * A * A;
  double from_x = A, from_y = peak, sign = -1.0;
  double sine = 0.0, cosine = 0.0, area = 0.0, last_x = A, last_y = peak;
  for (int i = 1; i <= samples; ++i) {
    const double t = 0.5 * pi + 2.0 * pi * i / samples, x = A * std::sin(t);
    const double way = std::abs(x - from_x), y = from_y + sign * (alpha * way + 0.5 * nu * way * way);
    sine += y * std::sin(t);
    cosine += y * std::cos(t);
    area += 0.5 * (y + last_y) * (x - last_x);
    last_x = x;
    last_y = y;
    if (i == samples / 2) {
      from_x = x;
      from_y = y;
      sign = 1.0;
    }
  }
  return {2.0 / (samples * A) * Complex(sine, cosine), area};
}

/// The same from its microscopic picture: relays that switch up at b and down at a < b, spread evenly over the (a, b)
/// with the density nu in -A..A, in parallel to a line. Error of order A/cells. Begins at the peak, all relays up.
Complex preisach_gain(double alpha, double nu, double A) {
  constexpr std::size_t cells = 200;
  constexpr int samples = 1600;
  const double width = 2.0 * A / static_cast<double>(cells);
  std::vector<char> up(cells * cells, 1);
  double total = 0.0, sine = 0.0, cosine = 0.0;
  // A relay of weight w adds +-w/2; the density of its weight is nu, from the branch alpha d + (nu/2) d^2.
  const double weight = nu * width * width;
  for (std::size_t a = 0; a < cells; ++a) total += 0.5 * weight * static_cast<double>(cells - a);
  for (int i = 1; i <= samples; ++i) {
    const double t = 0.5 * pi + 2.0 * pi * i / samples, x = A * std::sin(t);
    const bool falls = i <= samples / 2;
    for (std::size_t a = 0; a < cells; ++a)
      for (std::size_t b = a; b < cells; ++b) {
        char& state = up[a * cells + b];
        const bool switches = falls ? state == 1 && x <= -A + (static_cast<double>(a) + 0.5) * width
                                    : state == 0 && x >= -A + (static_cast<double>(b) + 0.5) * width;
        if (!switches) continue;
        state = falls ? 0 : 1;
        total += falls ? -weight : weight;
      }
    sine += (alpha * x + total) * std::sin(t);
    cosine += (alpha * x + total) * std::cos(t);
  }
  return 2.0 / (samples * A) * Complex(sine, cosine);
}

void check_rayleigh(ClaimChecks& checks, double alpha, double nu, double A) {
  const Complex claimed(alpha + nu * A, -4.0 * nu * A / (3.0 * pi));
  const std::string at = place({{"alpha", alpha}, {"nu", nu}, {"A", A}});
  const RayleighLoop loop = rayleigh_loop(alpha, nu, A);
  checks.equal(at, "Re N", "", claimed.real(), loop.gain.real(), 1e-7, std::abs(claimed));
  checks.equal(at, "Im N", "", claimed.imag(), loop.gain.imag(), 1e-7, std::abs(claimed));
  checks.equal(at, "energy that the loop gives out a period", "", 4.0 / 3.0 * nu * A * A * A, -loop.area, 1e-7);
}

ClaimResult test_rayleigh(const ClaimOptions& options) {
  ClaimChecks checks;
  const std::string at = place({{"alpha", 1.0}, {"nu", 0.5}, {"A", 2.0}});
  check_rayleigh(checks, 1.0, 0.5, 2.0);
  const Complex gain = rayleigh_loop(1.0, 0.5, 2.0).gain;
  check_printed(checks, at, "Re N", "", 2.0, 1e-6, gain.real());
  check_printed(checks, at, "Im N", "", -0.424413, 1e-6, gain.imag());
  const Complex relays = preisach_gain(1.0, 0.5, 2.0);
  checks.equal(at, "Re N of 20100 relays", "", 2.0, relays.real(), 0.01);
  checks.equal(at, "Im N of 20100 relays", "", -0.424413, relays.imag(), 0.01);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double alpha = random.log_between(0.1, 10.0), nu = random.log_between(0.1, 10.0);
    check_rayleigh(checks, alpha, nu, random.log_between(0.01, 10.0));
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

}  // namespace

std::vector<Claim> gain_relation_claims() {
  return {
      {"A8b",
       "A Jenkins element is what play leaves of a spring, and becomes Coulomb friction as the spring gets stiff.",
       "A8 = k (1 - A7) with h = Fc/k; A8 -> A2 for k -> infinity", "derived", Evidence::derived,
       "k, Fc > 0; A from 1.1 h to 100 h; the limit at h/A = 1e-2, 1e-4, 1e-6",
       "all describing functions by quadrature, without the closed forms; the limit is approached with the root of "
       "h/A",
       ClaimVerdict::holds, test_stop},
      {"A12b",
       "Dahl's loop of exponent 1: the ascending branch and the peak; its gain goes to sigma0 for small amplitudes "
       "and to that of Coulomb friction for large ones.",
       "F = Fc (1 - exp(-x/l)/cosh a) ascending, peak Fc tanh a; N -> sigma0 for A << l, -> A2 for A >> l",
       "derived; checked by computation", Evidence::derived, "a = A/l from 0.2 to 20; limits at 1e-3 and 1e5",
       "the law marched to and fro between -A and A until its memory has faded; limits by quadrature",
       ClaimVerdict::holds, test_dahl},
      {"A13",
       "Rayleigh's hysteresis (a uniform Preisach model). With this orientation the loop gives out energy: as a "
       "friction force it is to be taken the other way round.",
       "y = (alpha + nu A) x -+ (nu/2)(A^2 - x^2), - on rising: N = (alpha + nu A) - j 4 nu A/(3 pi); area (4/3) nu "
       "A^3",
       "derived; checked by computation", Evidence::derived, "alpha, nu, A > 0",
       "Rayleigh's rule for branches after reversals, sampled over a period; at the printed point also 20100 relays "
       "(uniform Preisach) to 1 %. The program has no such law",
       ClaimVerdict::holds, test_rayleigh}};
}

}  // namespace limcycle
