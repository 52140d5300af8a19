#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/models/friction/sliders/maxwell_slip.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;
using Complex = std::complex<double>;

const std::string hysteresis_by_computation =
    "describing function by FFT of the sampled force and by quadrature split at the switches at the printed points, by "
    "quadrature at random ones, without the closed form; W is the work of the same period";

/// Claim A8.
Complex jenkins_gain(double k, double Fc, double A) {
  const double h = Fc / k;
  if (A <= h) return k;
  return {0.5 * k * (1.0 - share_inside(1.0 - 2.0 * h / A)), 4.0 * Fc / (pi * A) * (1.0 - h / A)};
}

GainClaim jenkins() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.names = {{"k", "N/m"}, {"Fc", "N"}};
  f.element = [](const Numbers& p) {
    Jenkins<double> law;
    law.k = p[0];
    law.Fc = p[1];
    return law;
  };
  f.gain = [](const GainPoint& at) { return jenkins_gain(at.p[0], at.p[1], at.amplitude); };
  f.printed = {{{{1000.0, 1.5}, 0.004}, {342.518821, 298.415518}, 1e-6}};
  f.draw = [](RandomPoints& random) {
    const Numbers p{random.log_between(1e2, 1e6), random.log_between(0.1, 10.0)};
    return GainPoint{p, p[1] / p[0] * random.log_between(0.3, 100.0)};
  };
  f.more = [](ClaimChecks& checks, const std::string& where, const GainPoint& at, const DescribingFunction& df) {
    const double h = at.p[1] / at.p[0], lost = std::max(0.0, 4.0 * at.p[1] * (at.amplitude - h));
    checks.equal(where, "W", "J", lost, df.dissipation, 2.0 * stated_error(df),
                 pi * at.amplitude * at.amplitude * std::abs(df.gain));
  };
  return {
      {"A8",
       "Jenkins element (spring k that slips at Fc): elastic up to A = Fc/k, then a parallelogram.",
       "N = (k/2)(1 - f(1 - 2 h/A)) + j 4 Fc/(pi A) (1 - h/A), h = Fc/k, f(u) = (2/pi)(asin u + u sqrt(1 - u^2)); k "
       "for A <= h; W = 4 Fc (A - h)",
       "derived; checked by computation",
       Evidence::derived,
       "k, Fc > 0; A from 0.3 h to 100 h",
       hysteresis_by_computation,
       ClaimVerdict::holds,
       {}},
      f};
}

/// p: the stiffnesses, then the limits.
GainClaim maxwell_slip() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.element = [](const Numbers& p) {
    const auto half = p.begin() + std::ssize(p) / 2;
    MaxwellSlip<double> law;
    law.k.assign(p.begin(), half);
    law.W.assign(half, p.end());
    return law;
  };
  f.gain = [](const GainPoint& at) {
    Complex sum;
    const std::size_t n = at.p.size() / 2;
    for (std::size_t i = 0; i < n; ++i) sum += jenkins_gain(at.p[i], at.p[n + i], at.amplitude);
    return sum;
  };
  f.draw = [](RandomPoints& random) {
    const int elements = random.whole(2, 8);
    GainPoint point;
    for (int i = 0; i < elements; ++i) point.p.push_back(random.log_between(300.0, 3e4));
    for (int i = 0; i < elements; ++i) point.p.push_back(random.log_between(0.03, 0.3));
    point.amplitude = random.log_between(1e-6, 3e-3);
    return point;
  };
  return {{"A9",
           "The describing function of parallel elements that do not know each other is the sum of theirs.",
           "N = sum of A8 over the elements",
           "derived; checked by computation",
           Evidence::derived,
           "2 to 8 elements, k 300 to 3e4 N/m, W 0.03 to 0.3 N; A from 1e-6 to 3e-3 m",
           hysteresis_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

/// exp(-x) I1(x) = (1/pi) int_0^pi exp(x (cos t - 1)) cos t dt by the trapezoidal rule, which converges geometrically
/// on a period.
double scaled_i1(double x) {
  const int n = 64 + static_cast<int>(20.0 * std::sqrt(x));
  double sum = 0.5 * (1.0 - std::exp(-2.0 * x));
  for (int i = 1; i < n; ++i) {
    const double c = std::cos(pi * i / n);
    sum += std::exp(x * (c - 1.0)) * c;
  }
  return sum / n;
}

double dahl_work(double Fc, double sigma0, double A) {
  const double l = Fc / sigma0;
  return 4.0 * Fc * (A - l * std::tanh(A / l));
}

GainClaim dahl() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.names = {{"Fc", "N"}, {"sigma0", "N/m"}};
  f.element = [](const Numbers& p) {
    Dahl<double> law;
    law.Fc = p[0];
    law.sigma0 = p[1];
    return law;
  };
  f.gain = [](const GainPoint& at) -> Complex {
    const double Fc = at.p[0], A = at.amplitude, a = A * at.p[1] / Fc;
    return {2.0 * Fc / A * scaled_i1(a) * 2.0 / (1.0 + std::exp(-2.0 * a)),
            4.0 * Fc / (pi * A) * (1.0 - std::tanh(a) / a)};
  };
  f.printed = {{{{1.0, 1e5}, 5e-6}, {91482.216, 19293.573}, 1e-3},
               {{{1.0, 1e5}, 1e-5}, {73250.7545, 30354.7748}, 1e-4},
               {{{1.0, 1e5}, 5e-5}, {13117.1858, 20372.2951}, 1e-4},
               {{{1.5, 1500.0}, 1e-3}, {1098.7613, 455.3216}, 1e-4}};
  f.draw = [](RandomPoints& random) {
    const Numbers p{random.log_between(0.1, 10.0), random.log_between(1e3, 1e6)};
    return GainPoint{p, p[0] / p[1] * random.log_between(0.1, 300.0)};
  };
  f.more = [](ClaimChecks& checks, const std::string& where, const GainPoint& at, const DescribingFunction& df) {
    checks.equal(where, "W", "J", dahl_work(at.p[0], at.p[1], at.amplitude), df.dissipation, 2.0 * stated_error(df),
                 pi * at.amplitude * at.amplitude * std::abs(df.gain));
  };
  return {{"A12",
           "Dahl's law of exponent 1 in its periodic steady state. It is no Masing loop: at A = 1 mm, l = 1 mm, 1.5 N "
           "the Masing loop of its virgin curve (A11a) has another gain.",
           "N = 2 Fc I1(a)/(A cosh a) + j 4 Fc/(pi A) (1 - tanh(a)/a), a = A/l, l = Fc/sigma0; W = 4 Fc (A - l tanh a)",
           "derived; checked by computation",
           Evidence::derived,
           "Fc, sigma0 > 0; A from 0.1 l to 300 l",
           hysteresis_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

}  // namespace

std::vector<GainClaim> stop_gain_claims() { return {jenkins(), maxwell_slip()}; }
std::vector<GainClaim> dahl_gain_claims() { return {dahl()}; }

}  // namespace limcycle
