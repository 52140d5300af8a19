/// @file
/// Reference describing functions of LuGre friction in long double, accurate to about 1e-13: over the half period
/// between two reversals the final bristle force is affine in the initial one, so that two integrations give the
/// periodic one; the Fourier integrals are integrated along, in a variable that is graded towards the reversals,
/// without sampling.
///   df_reference FILE      every 11th point of the 200 x 200 table, and the 25 of the plain programs
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cstdio>
#include <utility>

#include "limcycle/bench/bristle.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
using Real = long double;
using Complex = std::complex<Real>;

constexpr Real pi = 3.14159265358979323846264338327950288L;

/// Limit of the steps in tau: the error estimate of fehlberg78 does not cover pure quadratures.
constexpr Real longest_step = 0.08L;
/// Beyond this |tau| all quantities are constant to 18 digits.
constexpr Real end_of_tau = 42.0L;

/// Force at the end of a half period that starts with f0 at a reversal, and the integral of force e^(-j phase) over it.
/// In tau, with cos(phase) = 1/cosh(tau), sin(phase) = tanh(tau): transients next to a reversal, over any small
/// fraction of the period, take a tau of order 1.
std::pair<Real, Complex> half_period(const bench::Bristle<Real>& bristle, Real f0, Real tolerance, Real longest) {
  using State = std::array<Real, 3>;
  State y{f0, 0, 0};
  const auto rate = [&](const State& state, State& d, Real tau) {
    const Real cosine = 1 / std::cosh(tau);
    const Real v = bristle.amplitude * bristle.frequency * cosine;
    const Real F = bristle.force_at(state[0], v);
    d = {cosine * bristle.rate_at(state[0], v), cosine * F * cosine, -cosine * F * std::tanh(tau)};
  };
  const auto stepper = odeint::make_controlled(tolerance, tolerance, longest,
                                               odeint::runge_kutta_fehlberg78<State, Real, State, Real>());
  odeint::integrate_adaptive(stepper, rate, y, -end_of_tau, end_of_tau, longest);
  return {y[0], {y[1], y[2]}};
}

/// N = (b1 + j a1)/A, from the half period by odd symmetry.
Complex gain(double amplitude, double frequency, Real tolerance, Real longest) {
  const bench::Bristle<Real> bristle{amplitude, frequency};
  const auto [end0, integral0] = half_period(bristle, 0, tolerance, longest);
  const auto [end1, integral1] = half_period(bristle, bristle.Fs, tolerance, longest);
  // End = end0 + (end1 - end0) f0/Fs must be -f0.
  const Real f0 = -end0 / (1 + (end1 - end0) / bristle.Fs);
  const Complex integral = integral0 + (integral1 - integral0) * (f0 / bristle.Fs);
  // a1 - j b1 = (2/pi) integral, and b1 + j a1 = j (a1 - j b1).
  return Complex(0, 2) * integral / (pi * bristle.amplitude);
}

double log_spaced(double from, double to, double share) { return from * std::pow(to / from, share); }

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr) return 2;
  Real worst = 0;
  const auto write = [&](int index, double amplitude, double frequency) {
    const Complex N = gain(amplitude, frequency, 1e-15L, longest_step);
    if (index % 7 == 0 || index < 0)
      worst = std::max(worst, std::abs(gain(amplitude, frequency, 1e-13L, 2 * longest_step) / N - Real(1)));
    std::fprintf(file, "%d %.17g %.17g %.17g %.17g\n", index, amplitude, frequency, static_cast<double>(N.real()),
                 static_cast<double>(N.imag()));
  };
  for (int i = 0; i < 200 * 200; i += 11)
    write(i, log_spaced(1e-6, 1e-1, i / 200 / 199.0), log_spaced(0.1, 1000.0, i % 200 / 199.0));
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      write(-1, log_spaced(1e-6, 1e-1, (i + 0.5) / 5), log_spaced(0.1, 1000.0, (j + 0.5) / 5));
  std::printf("reference,df,steps twice as long and tolerance 1e-13 against 1e-15,%.2e\n", static_cast<double>(worst));
  return std::fclose(file) == 0 ? 0 : 2;
}
