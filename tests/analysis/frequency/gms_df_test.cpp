// GMS under prescribed motion, against a march of its own: Runge-Kutta steps of fixed length with switches found by
// bisection, and the closed form of the limit without Stribeck effect.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

/// Ten elements of different shares, of stiffness k0, 2 k0, ... 10 k0.
Gms<double> ten_elements(double k0, double C) {
  Gms<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 0.01;
  law.C = C;
  for (int i = 0; i < 10; ++i) {
    law.k.push_back(k0 * (i + 1));
    law.alpha.push_back((11.0 + ((7 * i) % 10)) / 155.0);
  }
  return law;
}

/// The law again, from its equations alone, with the classical Runge-Kutta method in the phase. The integrals of the
/// force by sine and cosine are states like the others, so that everything is of order 4.
class GmsReference {
 public:
  GmsReference(const Gms<double>& law, double A, double w, double bias) : p_(law), A_(A), w_(w), bias_(bias) {
    y_.assign(law.k.size() + 3, 0.0);
    slip_.assign(law.k.size(), 0);
    const double r = std::acos(std::clamp(-bias / (A * w), -1.0, 1.0));
    turn_ = {r, 2.0 * pi - r, 2.0 * pi + r};
  }

  /// Gain after `periods` periods of 2 `steps` steps each.
  std::complex<double> gain(int periods, int steps) {
    for (int period = 0; period < periods; ++period) {
      for (int c = 0; c < 3; ++c) y_[p_.k.size() + static_cast<std::size_t>(c)] = 0.0;
      for (int half = 0; half < 2; ++half) {
        direction_ = half == 0 ? -1.0 : 1.0;
        slip_.assign(slip_.size(), 0);
        const double from = turn_[static_cast<std::size_t>(half)], to = turn_[static_cast<std::size_t>(half + 1)];
        for (int j = 0; j < steps; ++j) advance(from + (to - from) * j / steps, from + (to - from) * (j + 1) / steps);
      }
    }
    const std::size_t n = p_.k.size();
    mean = y_[n + 2] / (2.0 * pi);
    return std::complex<double>(y_[n], y_[n + 1]) / (pi * A_);
  }
  double mean = 0.0;

 private:
  using Y = std::vector<double>;
  double v(double theta) const { return bias_ + A_ * w_ * std::cos(theta); }
  double g(double theta) const {
    const double ratio = v(theta) / p_.vs;
    const bool minus = direction_ < 0.0;
    const double fs = minus ? p_.Fs_minus : p_.Fs, fc = minus ? p_.Fc_minus : p_.Fc;
    return fc + (fs - fc) * std::exp(-ratio * ratio);
  }

  Y slope(double theta, const Y& y) const {
    const std::size_t n = p_.k.size();
    Y dy(y.size());
    const double speed = v(theta), level = g(theta);
    double force = p_.sigma2 * speed;
    for (std::size_t i = 0; i < n; ++i) {
      const double rate = slip_[i] ? p_.C * (direction_ * p_.alpha[i] - y[i] / level) : p_.k[i] * speed;
      force += y[i] + (p_.sigma1.empty() ? 0.0 : p_.sigma1[i] / p_.k[i] * rate);
      dy[i] = rate / w_;
    }
    dy[n] = force * std::sin(theta);
    dy[n + 1] = force * std::cos(theta);
    dy[n + 2] = force;
    return dy;
  }
  Y step(double from, double to) const {
    const double h = to - from;
    const auto at = [&](const Y& k, double share) {
      Y y = y_;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += share * k[i];
      return y;
    };
    const Y a = slope(from, y_), b = slope(from + h / 2, at(a, h / 2)), c = slope(from + h / 2, at(b, h / 2)),
            d = slope(to, at(c, h));
    Y y = y_;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    return y;
  }
  bool beyond(const Y& y, double theta, std::size_t i) const {
    return !slip_[i] && std::abs(y[i]) > p_.alpha[i] * g(theta) * (1.0 + 1e-13);
  }
  bool any_beyond(const Y& y, double theta) const {
    for (std::size_t i = 0; i < p_.k.size(); ++i)
      if (beyond(y, theta, i)) return true;
    return false;
  }
  void advance(double from, double to) {
    for (std::size_t i = 0; i < p_.k.size(); ++i)
      if (beyond(y_, from, i)) slip_[i] = 1;
    Y y = step(from, to);
    while (any_beyond(y, to)) {
      double low = from, high = to;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (any_beyond(step(from, middle), middle) ? high : low) = middle;
      }
      y_ = step(from, high);
      for (std::size_t i = 0; i < p_.k.size(); ++i)
        if (beyond(y_, high, i)) slip_[i] = 1;
      from = high;
      y = step(from, to);
    }
    y_ = y;
  }

  Gms<double> p_;
  double A_, w_, bias_, direction_ = -1.0;
  std::array<double, 3> turn_;
  Y y_;
  std::vector<char> slip_;
};

void check_against_reference(const Gms<double>& law, double A, double w, double bias, int periods, int steps,
                             double tolerance) {
  CAPTURE(law.C, law.k[0], A, w, bias);
  const auto df = quadrature(law, A, w, bias, 1e-9, 3);
  const auto coarse = GmsReference(law, A, w, bias).gain(periods, steps / 2);
  GmsReference reference(law, A, w, bias);
  const auto fine = reference.gain(periods, steps);
  CHECK(df.status == Status::converged);
  CHECK(apart(fine, coarse) / 15.0 < 0.2 * tolerance);  // of the reference itself, of order 4
  CHECK(apart(df.gain, fine) < tolerance);
  CHECK(df.mean == Approx(reference.mean).epsilon(tolerance).margin(tolerance));
}

}  // namespace

TEST_CASE("gms: ten elements against a march of fixed steps", "[df][friction]") {
  check_against_reference(ten_elements(1000.0, 10.0), 5e-4, 20.0, 0.0, 14, 2000, 1e-7);
  check_against_reference(ten_elements(1000.0, 1000.0), 5e-4, 20.0, 0.0, 3, 4000, 1e-7);
  check_against_reference(ten_elements(10.0, 10.0), 0.02, 2.0, 0.0, 6, 4000, 1e-7);
  check_against_reference(ten_elements(10.0, 1000.0), 0.02, 2.0, 0.0, 3, 8000, 1e-7);
  check_against_reference(ten_elements(5000.0, 10.0), 1e-4, 2.0, 0.0, 6, 1000, 1e-7);
}

TEST_CASE("gms: bias, uneven levels and damping against a march of fixed steps", "[df][friction]") {
  check_against_reference(ten_elements(1000.0, 100.0), 5e-4, 20.0, 2e-3, 6, 2000, 1e-7);
  auto law = ten_elements(1000.0, 100.0);
  law.Fs_minus = 1.2;
  law.Fc_minus = 0.7;
  law.sigma1.assign(10, 0.4);
  law.sigma2 = 3.0;
  check_against_reference(law, 5e-4, 20.0, 0.0, 6, 2000, 1e-7);
  law.Fs_minus = 0.5;  // at a reversal elements are above the new level and slip at once
  law.Fc_minus = 0.4;
  check_against_reference(law, 5e-4, 20.0, 0.0, 6, 2000, 1e-7);
  check_against_reference(law, 5e-4, 20.0, 3e-3, 6, 2000, 1e-7);
}

TEST_CASE("gms: without Stribeck effect it is maxwell-slip for any C, claim A9", "[df][friction][claims]") {
  for (const double C : {1e-3, 10.0, 1e5}) {
    auto law = ten_elements(1000.0, C);
    law.Fs = law.Fs_minus = law.Fc;
    for (const double A : {2e-5, 1e-4, 1e-2}) {
      CAPTURE(C, A);
      std::complex<double> sum;
      for (std::size_t i = 0; i < 10; ++i) sum += stop_gain(law.k[i], law.alpha[i] * law.Fc, A);
      const auto df = quadrature(law, A, 2.0, 0.0, 1e-9, 3);
      CHECK(df.status == Status::converged);
      CHECK(apart(df.gain, sum) < 1e-9);
    }
  }
}

TEST_CASE("gms: one stiff element with fast attraction is the Stribeck curve", "[df][friction]") {
  Gms<double> law = ten_elements(1e11, 1e6);
  law.k.resize(1);
  law.alpha = {1.0};
  const double A = 5e-3, w = 2.0;
  const int panels = 20000;
  double sum = 0.0;
  for (int j = 0; j < panels; ++j) {
    const double theta = 0.5 * pi * (j + 0.5) / panels, speed = A * w * std::cos(theta);
    sum += law.level(speed) * std::cos(theta) * 0.5 * pi / panels;
  }
  const std::complex<double> stribeck(0.0, 4.0 * sum / (pi * A));
  CHECK(apart(quadrature(law, A, w, 0.0, 1e-8, 3).gain, stribeck) < 1e-3);
}

TEST_CASE("gms: the two routes agree", "[df][friction]") {
  const auto law = ten_elements(1000.0, 1000.0);
  const PrescribedMotion motion(5e-4, 20.0, 0.0, true);
  const auto other = quadrature(law, 5e-4, 20.0, 0.0, 1e-8, 3);
  const auto fft = FftRoute(law, motion, true, 0.0, {.harmonics = 3, .accuracy = 1e-6}).refine(other);
  CHECK(fft.status == Status::converged);
  CHECK(apart(fft.gain, other.gain) < 1e-6);
}
