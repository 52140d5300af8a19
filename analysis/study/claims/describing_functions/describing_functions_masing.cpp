#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/models/friction/sliders/iwan.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;
using Complex = std::complex<double>;

const std::string masing_by_computation =
    "describing function of the iwan law, whose force follows from its virgin curve and Masing's rule: FFT of the "
    "sampled force and quadrature at the printed points, quadrature at random ones, without the closed form";

/// Integral of a function that is smooth inside and may be singular at the ends, to 1e-11 of its size.
double integral(const std::function<double(double)>& f, double from, double to) {
  const std::unique_ptr<gsl_integration_workspace, void (*)(gsl_integration_workspace*)> work(
      gsl_integration_workspace_alloc(400), gsl_integration_workspace_free);
  gsl_function function{[](double x, void* p) { return (*static_cast<const std::function<double(double)>*>(p))(x); },
                        const_cast<std::function<double(double)>*>(&f)};
  double value = NAN, error = NAN;
  gsl_integration_qags(&function, from, to, 0.0, 1e-11, 400, work.get(), &value, &error);
  return value;
}

enum VirginCurve : int {
  virgin_exponential = 0,
  virgin_hyperbolic = 1,
  virgin_koizumi_shibazaki = 2,
  virgin_linear = 3
};

/// Virgin curve over Fs at u = z/Zb >= 0.
double virgin(int curve, double u) {
  switch (curve) {
    case virgin_exponential:
      return -std::expm1(-u);
    case virgin_hyperbolic:
      return u / (1.0 + u);
    case virgin_koizumi_shibazaki:
      return u >= 1.0 ? 1.0 : u > 0.0 ? u * (1.0 - std::log(u)) : 0.0;
    default:
      return std::min(u, 1.0);
  }
}

/// The integrals of A11, split where a curve saturates.
Complex masing_gain(int curve, double Fs, double Z, double A) {
  const double a = A / Z;
  const auto fv = [&](double u) { return virgin(curve, u); };
  const double break_u = std::min(a, 1.0);
  const double area = integral(fv, 0.0, break_u) + (a > 1.0 ? integral(fv, 1.0, a) : 0.0);
  const auto part = [&](double t) {
    const double half = std::sin(0.5 * t);
    return fv(a * half * half) * std::cos(t);
  };
  const double break_t = a > 1.0 ? 2.0 * std::asin(std::sqrt(1.0 / a)) : pi;
  const double first = integral(part, 0.0, break_t) + (a > 1.0 ? integral(part, break_t, pi) : 0.0);
  const double W = Z * Fs * (8.0 * area - 4.0 * a * fv(a));
  return {-4.0 * Fs / (pi * A) * first, W / (pi * A * A)};
}

/// p: Fs, Zb, number of the curve.
Element iwan(const Numbers& p, double elements = 0.0) {
  Iwan<double> law;
  law.Fs = p[0];
  law.Zb = p[1];
  law.curve.index = static_cast<int>(p[2]);
  law.elements = elements;
  return law;
}

GainPoint drawn_masing_point(RandomPoints& random, int curve, double least, double most) {
  const Numbers p{random.log_between(0.1, 10.0), random.log_between(1e-5, 1e-2), static_cast<double>(curve)};
  return {p, p[1] * random.log_between(least, most)};
}

GainFormula masing_formula() {
  GainFormula f;
  f.unit = "N/m";
  f.amplitude_unit = "m";
  f.names = {{"Fs", "N"}, {"Zb", "m"}, {"curve", ""}};
  f.element = [](const Numbers& p) { return iwan(p); };
  return f;
}

GainClaim any_curve() {
  GainFormula f = masing_formula();
  f.gain = [](const GainPoint& at) { return masing_gain(static_cast<int>(at.p[2]), at.p[0], at.p[1], at.amplitude); };
  f.draw = [](RandomPoints& random) { return drawn_masing_point(random, random.whole(0, 3), 0.1, 30.0); };
  return {{"A11",
           "A Masing loop (branches are the virgin curve doubled) with any virgin curve fv: both parts of the gain are "
           "integrals of fv.",
           "Im N = W/(pi A^2), W = 8 int_0^A fv dz - 4 A fv(A); Re N = -(4/(pi A)) int_0^pi fv(A sin^2(t/2)) cos t dt",
           "derived",
           Evidence::derived,
           "four virgin curves (0 exponential, 1 hyperbolic, 2 koizumi-shibazaki, 3 linear), A from 0.1 Zb to 30 Zb",
           "the integrals by adaptive quadrature, against the " + masing_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim exponential_curve() {
  GainFormula f = masing_formula();
  f.gain = [](const GainPoint& at) -> Complex {
    const double Fs = at.p[0], A = at.amplitude, a = A / at.p[1];
    return {4.0 * Fs / A * gsl_sf_bessel_I1_scaled(0.5 * a),
            4.0 * Fs / (pi * A) * (1.0 + std::exp(-a) + 2.0 / a * std::expm1(-a))};
  };
  const Numbers p{1.5, 1e-3, virgin_exponential};
  f.printed = {{{p, 3e-4}, {1294.696482, 82.376637}, 1e-6},
               {{p, 1e-3}, {938.524819, 197.934618}, 1e-6},
               {{p, 3e-3}, {438.078775, 265.032311}, 1e-6},
               {{p, 1e-3}, {938.5248, 197.9346}, 1e-4}};
  f.draw = [](RandomPoints& random) { return drawn_masing_point(random, virgin_exponential, 0.1, 30.0); };
  return {{"A11a",
           "Masing loop of the exponential virgin curve.",
           "fv = Fs (1 - exp(-z/Z)): Re N = (4 Fs/A) exp(-a/2) I1(a/2), Im N = (4 Fs/(pi A)) (1 + exp(-a) - (2/a)(1 - "
           "exp(-a))), a = A/Z",
           "derived; checked by computation",
           Evidence::derived,
           "Fs, Z > 0; A from 0.1 Z to 30 Z",
           masing_by_computation,
           ClaimVerdict::holds,
           {}},
          f};
}

GainClaim hyperbolic_curve() {
  GainFormula f = masing_formula();
  f.gain = [](const GainPoint& at) -> Complex {
    const double Fs = at.p[0], Z = at.p[1], A = at.amplitude, a = A / Z;
    const double W = 8.0 * Fs * (A - Z * std::log1p(a)) - 4.0 * Fs * A * a / (1.0 + a);
    return {8.0 * Fs / (a * A) * ((1.0 + 0.5 * a) / std::sqrt(1.0 + a) - 1.0), W / (pi * A * A)};
  };
  const Numbers p{1.5, 1e-3, virgin_hyperbolic};
  // The first row prints 1148.896294 + j128.187672; the imaginary part is 128.187674 by formula and by computation, so
  // it is compared without the last digit.
  f.printed = {{{p, 3e-4}, {1148.89629, 128.18767}, 1e-5},
               {{p, 1e-3}, {727.922061, 217.161774}, 1e-6},
               {{p, 3e-3}, {333.333333, 207.413115}, 1e-6}};
  f.draw = [](RandomPoints& random) { return drawn_masing_point(random, virgin_hyperbolic, 0.1, 30.0); };
  return {
      {"A11b",
       "Masing loop of the hyperbolic virgin curve.",
       "fv = Fs z/(Z + z): Re N = (8 Fs/(a A)) ((1 + a/2)/sqrt(1 + a) - 1); W = 8 Fs (A - Z ln(1 + a)) - 4 Fs A a/(1 "
       "+ a), a = A/Z",
       "derived; checked by computation",
       Evidence::derived,
       "Fs, Z > 0; A from 0.1 Z to 30 Z",
       masing_by_computation,
       ClaimVerdict::holds,
       {}},
      f};
}

/// "Also reproduced to 5 digits by 4000 equal yield forces and uniform yield displacements."
void check_elements(ClaimChecks& checks, const ClaimOptions&) {
  const Numbers p{1.5, 1e-3, virgin_koizumi_shibazaki};
  const double A = 1e-3;
  const auto df = computed_gain(iwan(p, 4000.0), {A, 1.0, 0.0}, false, 1e-5);
  if (!df.answered()) return checks.stop(df.status);
  const Complex printed(1329.441542, 954.929659);
  const std::string where = place({{"Fs", p[0], "N"}, {"Zb", p[1], "m"}, {"A", A, "m"}, {"elements", 4000.0}});
  checks.equal(where, "Re N of 4000 elements", "N/m", printed.real(), df.gain.real(), 1e-5 + df.error);
  checks.equal(where, "Im N of 4000 elements", "N/m", printed.imag(), df.gain.imag(), 1e-5 + df.error);
}

GainClaim koizumi_shibazaki_curve() {
  GainFormula f = masing_formula();
  f.gain = [](const GainPoint& at) -> Complex {
    const double Fs = at.p[0], Zb = at.p[1], A = at.amplitude;
    // Beyond Zb only the imaginary part is claimed; the real one is the integral of A11.
    if (A > Zb)
      return {masing_gain(virgin_koizumi_shibazaki, Fs, Zb, A).real(), 4.0 * Fs / (pi * A) * (1.0 - Zb / (2.0 * A))};
    return {Fs / Zb * (2.0 * std::numbers::ln2 - 0.5 - std::log(A / Zb)), 2.0 * Fs / (pi * Zb)};
  };
  const Numbers p{1.5, 1e-3, virgin_koizumi_shibazaki};
  f.printed = {{{p, 3e-4}, {3135.400748, 954.929659}, 1e-6},
               {{p, 1e-3}, {1329.441542, 954.929659}, 1e-6},
               {{p, 2e-3}, {542.078, 716.197}, 1e-3}};
  f.draw = [](RandomPoints& random) { return drawn_masing_point(random, virgin_koizumi_shibazaki, 0.01, 10.0); };
  f.more = [](ClaimChecks& checks, const std::string& where, const GainPoint& at, const DescribingFunction& df) {
    if (at.amplitude > at.p[1]) return;
    checks.equal(where, "W", "J", 2.0 * at.p[0] * at.amplitude * at.amplitude / at.p[1], df.dissipation,
                 2.0 * stated_error(df) * std::abs(df.gain) / df.gain.imag());
  };
  f.once = check_elements;
  return {{"A11c",
           "Masing loop of the Koizumi-Shibazaki virgin curve, the candidate for the proposed model: up to A = Zb its "
           "loss factor does not depend on the amplitude.",
           "fv = Fs u (1 - ln u), u = z/Zb <= 1: for A <= Zb Re N = (Fs/Zb)(2 ln 2 - 1/2 - ln(A/Zb)), Im N = 2 Fs/(pi "
           "Zb), W = 2 Fs A^2/Zb; for A > Zb Im N = (4 Fs/(pi A))(1 - Zb/(2 A))",
           "derived; checked by computation",
           Evidence::derived,
           "Fs, Zb > 0; A from 0.01 Zb to 10 Zb (beyond Zb the real part is the integral of A11)",
           masing_by_computation + "; also 4000 elements of equal yield force",
           ClaimVerdict::holds,
           {}},
          f};
}

}  // namespace

std::vector<GainClaim> masing_gain_claims() {
  return {any_curve(), exponential_curve(), hyperbolic_curve(), koizumi_shibazaki_curve()};
}

}  // namespace limcycle
