#pragma once
#include <cmath>
#include <complex>
#include <numbers>

namespace limcycle {

/// @file
/// Describing functions of Masing loops in x = A sin wt, N/m, in closed form (claim A11):
///   Im N = W/(pi A^2), W = 8 int_0^A f_v dz - 4 A f_v(A);  Re N = -(4/(pi A)) int_0^pi f_v(A sin^2(t/2)) cos t dt.
/// Each is written so that it loses no digits at small or large A. Derived and checked numerically.

/// exp(-x) I1(x), x >= 0.
inline double scaled_bessel_i1(double x) {
  if (x < 40.0) return std::exp(-x) * std::cyl_bessel_i(1.0, x);
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 30; ++k) {
    const double odd = 2.0 * k - 1.0, next = term * (odd * odd - 4.0) / (8.0 * k * x);
    if (std::abs(next) >= std::abs(term)) break;
    sum += term = next;
  }
  return sum / std::sqrt(2.0 * std::numbers::pi * x);
}

/// f_v = Fs (1 - exp(-z/Z)):  Re = (4 Fs/A) exp(-a/2) I1(a/2),  Im = (4 Fs/(pi A)) (1 + exp(-a) - (2/a)(1 - exp(-a))).
inline std::complex<double> exponential_masing_gain(double Fs, double Z, double A) {
  const double a = A / Z;
  double lost = 1.0 + std::exp(-a) + 2.0 / a * std::expm1(-a);
  if (a < 1.0) {  // sum of (-a)^k (k - 1)/(k + 1)! from k = 2
    double term = a * a / 6.0;
    lost = 0.0;
    for (int k = 2; k < 25; ++k) {
      lost += term * (k - 1);
      term *= -a / (k + 2);
    }
  }
  return {4.0 * Fs / A * scaled_bessel_i1(0.5 * a), 4.0 * Fs / (std::numbers::pi * A) * lost};
}

/// f_v = Fs z/(Z + z):  Re = 4 Fs/(Z r (1 + r)^2), r = sqrt(1 + a);  W = 8 Fs (A - Z ln(1 + a)) - 4 Fs A a/(1 + a).
inline std::complex<double> hyperbolic_masing_gain(double Fs, double Z, double A) {
  const double a = A / Z, r = std::sqrt(1.0 + a);
  double lost = 8.0 * (1.0 - std::log1p(a) / a) - 4.0 * a / (1.0 + a);
  if (a < 0.25) {  // sum of (-a)^k (4 - 8/(k + 1)) from k = 2
    double power = a * a;
    lost = 0.0;
    for (int k = 2; k < 30; ++k, power *= -a) lost += power * (4.0 - 8.0 / (k + 1));
  }
  return {4.0 * Fs / (Z * r * (1.0 + r) * (1.0 + r)), Fs * lost / (std::numbers::pi * A)};
}

/// Clausen's integral Cl2(x) = -int_0^x ln(2 sin(t/2)) dt, 0 < x <= pi.
inline double clausen(double x) {
  const double t = x / (2.0 * std::numbers::pi);
  double sum = 0.0, power = 1.0;
  for (int k = 1; k < 30; ++k) {
    power *= t * t;
    sum += std::riemann_zeta(2.0 * k) / (k * (2.0 * k + 1.0)) * power;
  }
  return x * (1.0 - std::log(x) + sum);
}

/// f_v = Fs zeta (1 - ln zeta), zeta = z/Zb <= 1, Fs beyond. Up to A = Zb
///   Re = (Fs/Zb)(2 ln 2 - 1/2 - ln(A/Zb)),  Im = 2 Fs/(pi Zb);
/// beyond, with cos p = 1 - 2 Zb/A, the sum over its Jenkins elements gives
///   Re = (Fs/(pi Zb)) (2 p ln(2 sin(p/2)) + 2 Cl2(p) - sin p - p/2 - sin(2p)/4),  Im = (4 Fs/(pi A))(1 - Zb/(2A)).
inline std::complex<double> koizumi_shibazaki_masing_gain(double Fs, double Zb, double A) {
  using std::numbers::ln2;
  using std::numbers::pi;
  if (A <= Zb) return {Fs / Zb * (2.0 * ln2 - 0.5 - std::log(A / Zb)), 2.0 * Fs / (pi * Zb)};
  const double half_sine = std::sqrt(Zb / A), p = 2.0 * std::asin(half_sine), square = p * p;
  const double bracket = p < 0.02 ? p * square * (4.0 / 9.0 - square * (17.0 / 225.0 - square * 173.0 / 26460.0))
                                  : 2.0 * p * std::log(2.0 * half_sine) + 2.0 * clausen(p) - std::sin(p) - 0.5 * p -
                                        0.25 * std::sin(2.0 * p);
  return {Fs / (pi * Zb) * bracket, 4.0 * Fs / (pi * A) * (1.0 - Zb / (2.0 * A))};
}

}  // namespace limcycle
