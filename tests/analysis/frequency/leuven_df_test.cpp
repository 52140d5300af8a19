// The modified Leuven law under prescribed motion: against LuGre and Dahl in their special cases, and against a
// separate march in which the elements are a function of z only.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/sliders/leuven.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

template <class Law>
Law levels_of() {
  Law law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  return law;
}

Leuven<double> five_elements(double n) {
  auto law = levels_of<Leuven<double>>();
  for (int i = 0; i < 5; ++i) {
    law.k.push_back(2000.0 * (i + 1));
    law.W.push_back(0.2 + 0.1 * i);
  }
  law.n = n;
  law.sigma1 = 5.0;
  law.sigma2 = 1.0;
  return law;
}

/// The law from its equations, by Runge-Kutta steps in z alone: within a step z is monotonic and each stretch is
/// s_i + dz cut off at its limits; steps in which an element meets a limit or z turns are halved down to nothing.
class LeuvenReference {
 public:
  LeuvenReference(const Leuven<double>& law, double A, double w, double bias)
      : p_(law), A_(A), w_(w), bias_(bias), s_(law.k.size(), 0.0) {}

  std::complex<double> gain(int periods, int steps) {
    const double r = std::acos(-bias_ / (A_ * w_));
    const double turn[] = {r, 2.0 * pi - r, 2.0 * pi + r};
    for (int period = 0; period < periods; ++period) {
      integral_ = 0.0;
      mean = 0.0;
      for (int half = 0; half < 2; ++half) {
        direction_ = half == 0 ? -1.0 : 1.0;
        for (int j = 0; j < steps; ++j)
          advance(turn[half] + (turn[half + 1] - turn[half]) * j / steps,
                  turn[half] + (turn[half + 1] - turn[half]) * (j + 1) / steps, 0);
      }
    }
    return integral_ / (pi * A_);
  }
  double mean = 0.0;

 private:
  double stretch(std::size_t i, double dz) const {
    const double limit = p_.W[i] / p_.k[i];
    return std::clamp(s_[i] + dz, -limit, limit);
  }
  double force(double dz) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < s_.size(); ++i) sum += p_.k[i] * stretch(i, dz);
    return sum;
  }
  double v(double theta) const { return bias_ + A_ * w_ * std::cos(theta); }
  double rate(double theta, double dz) const {
    const double speed = v(theta), ratio = speed / p_.vs, F = force(dz);
    const double fs = direction_ < 0.0 ? p_.Fs_minus : p_.Fs, fc = direction_ < 0.0 ? p_.Fc_minus : p_.Fc;
    const double q = direction_ * F / (fc + (fs - fc) * std::exp(-ratio * ratio));
    return speed * (1.0 - (q < 0.0 ? -1.0 : 1.0) * std::pow(std::abs(q), p_.n));
  }
  double output(double theta, double dz) const {
    return force(dz) + p_.sigma1 * rate(theta, dz) + p_.sigma2 * v(theta);
  }
  bool bends(double dz) const {
    for (std::size_t i = 0; i < s_.size(); ++i) {
      const double limit = p_.W[i] / p_.k[i], end = s_[i] + dz;
      if (std::abs(s_[i]) < limit && std::abs(end) > limit) return true;
    }
    return false;
  }

  void advance(double from, double to, int depth) {
    const double h = to - from, half = 0.5 * h, middle = from + half;
    const double a = rate(from, 0.0) / w_, b = rate(middle, half * a) / w_, c = rate(middle, half * b) / w_,
                 d = rate(to, h * c) / w_;
    const double dz = h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    const bool turns = a * rate(to, dz) < 0.0 && std::abs(dz) > 1e-15;
    if ((turns || bends(dz)) && depth < 30) {
      advance(from, middle, depth + 1);
      advance(middle, to, depth + 1);
      return;
    }
    // Simpson's rule with the middle of the cubic through both ends.
    const double dz_middle = 0.5 * dz + h / 8.0 * (a - rate(to, dz) / w_);
    const double F0 = output(from, 0.0), F1 = output(middle, dz_middle), F2 = output(to, dz);
    const auto turned = [](double theta) { return std::complex<double>(std::sin(theta), std::cos(theta)); };
    integral_ += h / 6.0 * (F0 * turned(from) + 4.0 * F1 * turned(middle) + F2 * turned(to));
    mean += h / 6.0 * (F0 + 4.0 * F1 + F2) / (2.0 * pi);
    for (std::size_t i = 0; i < s_.size(); ++i) s_[i] = stretch(i, dz);
  }

  Leuven<double> p_;
  double A_, w_, bias_, direction_ = -1.0;
  std::vector<double> s_;
  std::complex<double> integral_;
};

}  // namespace

TEST_CASE("leuven: one element that never slips is LuGre, and Dahl without Stribeck effect", "[df][friction][claims]") {
  auto law = levels_of<Leuven<double>>();
  law.k = {1e5};
  law.W = {3.0};
  law.sigma1 = 316.22776601683796;
  auto lugre = levels_of<LuGre<double>>();
  lugre.sigma0 = 1e5;
  lugre.sigma1 = law.sigma1;
  for (const auto& [A, w, bias] :
       {std::tuple{5e-6, 1.0, 0.0}, {1e-4, 10.0, 0.0}, {1e-3, 1.0, 0.0}, {1e-4, 10.0, 3e-4}}) {
    CAPTURE(A, w, bias);
    const auto df = quadrature(law, A, w, bias, 1e-10, 3), expected = quadrature(lugre, A, w, bias, 1e-10, 3);
    CHECK(df.status == Status::converged);
    CHECK(apart(df.gain, expected.gain) < 1e-9);
  }
  law.sigma1 = 0.0;  // claim A12
  law.Fs = law.Fs_minus = 1.0;
  const auto dahl = quadrature(law, 1e-5, 1.0, 0.0, 1e-10, 3);
  CHECK(dahl.gain.real() == Approx(73250.7545).epsilon(1e-9));
  CHECK(dahl.gain.imag() == Approx(30354.7748).epsilon(1e-8));
}

TEST_CASE("leuven: five elements against a march of fixed steps", "[df][friction]") {
  for (const double n : {1.0, 2.0, 1.7}) {
    for (const auto& [A, w, bias] : {std::tuple{5e-5, 5.0, 0.0}, {3e-4, 5.0, 0.0}, {1e-3, 5.0, 1e-3}}) {
      CAPTURE(n, A, w, bias);
      const auto law = five_elements(n);
      const auto df = quadrature(law, A, w, bias, n == 1.7 ? 1e-7 : 1e-9, 3);  // |F_h|^1.7 is not smooth at 0
      LeuvenReference coarse(law, A, w, bias), fine(law, A, w, bias);
      const int periods = A < 1e-4 ? 12 : 4, steps = A < 1e-4 ? 300 : 1500;
      const auto half = coarse.gain(periods, steps), whole = fine.gain(periods, 2 * steps);
      CHECK(df.status == Status::converged);
      CHECK(apart(whole, half) < 1e-7);
      CHECK(apart(df.gain, whole) < 1e-7);
      CHECK(df.mean == Approx(fine.mean).epsilon(1e-7).margin(1e-7));
    }
  }
}

TEST_CASE("leuven: the two routes agree, uneven levels too", "[df][friction]") {
  auto law = five_elements(2.0);
  for (const double back : {1.5, 1.1}) {
    law.Fs_minus = back;
    law.Fc_minus = back - 0.5;
    const PrescribedMotion motion(3e-4, 5.0, 0.0, true);
    const auto other = quadrature(law, 3e-4, 5.0, 0.0, 1e-7, 3);
    const auto fft = FftRoute(law, motion, law.odd(), 0.0, {.harmonics = 3, .accuracy = 1e-6}).refine(other);
    CHECK(fft.status == Status::converged);
    CHECK(apart(fft.gain, other.gain) < 1e-6);
  }
}
