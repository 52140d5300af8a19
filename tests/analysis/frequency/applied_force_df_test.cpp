// Describing functions of the laws that need the applied force or the acceleration, and of the multistate law of Xiong
// et al., against computations without modes, collocation or meshes.
#include <array>
#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/frequency/composite/composite_describing_function.hpp"
#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/analysis/frequency/harmonic_balance/harmonic_response.hpp"
#include "limcycle/analysis/frequency/march/prescribed_harmonics.hpp"
#include "limcycle/models/friction/dry/awrejcewicz.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/quinn.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/dry/wojewoda.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"

using namespace limcycle;

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

template <class Law>
Law levels(double Fs = 1.5, double vs = 1e-2) {
  Law law;
  law.Fs = law.Fs_minus = Fs;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = vs;
  law.sigma2 = 0.4;
  return law;
}

template <template <class> class Kind>
DescribingFunction by_quadrature(const Kind<double>& law, double A, double w, double bias, double accuracy) {
  const PrescribedMotion motion(A, w, bias, true);
  DfOptions options;
  options.accuracy = accuracy;
  return QuadratureRoute(law, motion, law.odd() && bias == 0.0, options).refine();
}

/// The gain by samples agrees with the other one within the errors of both.
template <template <class> class Kind>
void check_samples(const Kind<double>& law, double A, double w, double bias, const DescribingFunction& other) {
  const PrescribedMotion motion(A, w, bias, true);
  DfOptions options;
  options.accuracy = 1e-5;
  const auto df = FftRoute(law, motion, law.odd() && bias == 0.0, bias, options).refine(other);
  CHECK(df.status == Status::converged);
  CHECK(std::abs(df.gain - other.gain) <= (df.error + other.error) * std::abs(other.gain));
  CHECK(df.error <= 1e-5);
}

struct ReferenceGain {
  Complex gain;
  double mean = 0.0, work = 0.0;
};

/// Wojewoda's law from its description: from each reversal a spring that starts with the force left by slip and yields
/// at Fs, then slip on the upper curve while |v| grows, on the lower one while it falls. Simpson's rule between the
/// corners.
ReferenceGain wojewoda_by_pieces(const Wojewoda<double>& law, double A, double w, double bias) {
  ReferenceGain sum;
  double sine = 0.0, cosine = 0.0;
  const double first = std::acos(-bias / (A * w));  // v = bias + A w cos(theta) turns negative
  const auto x = [&](double t) { return bias * t / w + A * std::sin(t); };
  const auto v = [&](double t) { return bias + A * w * std::cos(t); };
  const auto integrate = [&](double from, double to, auto&& force) {
    if (!(to > from)) return;
    const int n = 4000;
    const double h = (to - from) / n;
    for (int i = 0; i <= n; ++i) {
      const double t = from + i * h, weight = h / 3.0 * (i == 0 || i == n ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
      const double F = force(t) + law.sigma2 * v(t);
      sine += weight * F * std::sin(t);
      cosine += weight * F * std::cos(t);
      sum.mean += weight * F / (2.0 * pi);
      sum.work += weight * F * v(t) / w;
    }
  };
  const auto stretch = [&](double from, double to, double d) {
    const double Fs = d > 0.0 ? law.Fs : law.Fs_minus, Fc = d > 0.0 ? law.Fc : law.Fc_minus;
    const double left = d > 0.0 ? -(2.0 * law.Fc_minus - law.Fs_minus) : 2.0 * law.Fc - law.Fs;
    const auto spring = [&](double t) { return left + law.ks * (x(t) - x(from)); };
    double low = from, high = to;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (d * spring(middle) < Fs ? low : high) = middle;
    }
    integrate(from, low, spring);
    const double fastest = d > 0.0 ? 2.0 * pi : pi;  // phase of the largest speed
    const auto share = [&](double t) { return (Fs - Fc) * std::exp(-std::pow(v(t) / law.vs, 2.0)); };
    const double turn = std::clamp(fastest, low, to);
    integrate(low, turn, [&](double t) { return d * (Fc + share(t)); });
    integrate(turn, to, [&](double t) { return d * (Fc - share(t)); });
  };
  stretch(first, 2.0 * pi - first, -1.0);
  stretch(2.0 * pi - first, 2.0 * pi + first, 1.0);
  sum.gain = Complex(sine, cosine) / (pi * A);
  return sum;
}

/// Half-wave symmetric response of one element of Xiong's law, event by event: Runge and Kutta in (b, a) and the two
/// integrals of f sin, f cos, with the ends of a stretch found by bisection of the step.
class OneElement {
 public:
  OneElement(const Xiong<double>& law, std::size_t i, double A, double w) : law_(law), i_(i), A_(A), w_(w) {}

  Complex gain(int steps) {
    Point p{law_.Fs, A_, 0.0, 0.0};  // an element that never slips has a = x
    int where = 0;
    for (int half = 0; half < 40; ++half) {
      p[2] = p[3] = 0.0;
      const double h = pi / steps;
      for (int k = 0; k < steps; ++k) {
        double t = pi / 2.0 + k * h, left = h;
        for (int events = 0; events < 20; ++events) {
          const Point end = step(p, t, left, where);
          if (!leaves(end, t + left, where)) {
            p = end;
            break;
          }
          double low = 0.0, high = left;
          for (int j = 0; j < 60; ++j) {
            const double middle = 0.5 * (low + high);
            (leaves(step(p, t, middle, where), t + middle, where) ? high : low) = middle;
          }
          p = step(p, t, high, where);
          t += high;
          left -= high;
          where = where != 0 ? 0 : trial(p, t) > 0.0 ? 1 : -1;
        }
      }
      const Complex now = Complex(p[2], p[3]) * (2.0 / (pi * A_));
      if (half > 2 && std::abs(now - last_) < 1e-15 * std::abs(now)) return now;
      last_ = now;
      p[1] = -p[1];  // the other half of the period is its mirror image
      where = -where;
    }
    return last_;
  }

 private:
  using Point = std::array<double, 4>;

  double v(double t) const { return A_ * w_ * std::cos(t); }
  double trial(const Point& p, double t) const { return law_.K[i_] * p[1] + law_.sigma[i_] * v(t); }
  bool leaves(const Point& p, double t, int where) const {
    const double cap = law_.lambda[i_] * p[0], q = trial(p, t);
    return where == 0 ? std::abs(q) > cap : where * q < cap;
  }
  Point rate(const Point& p, double t, int where) const {
    const double f = where == 0 ? trial(p, t) : where * law_.lambda[i_] * p[0];
    const double g = law_.Fc + (law_.Fs - law_.Fc) * std::exp(-std::pow(v(t) / law_.vs, 2.0));
    return {(g - p[0]) / (law_.tau * w_), (f - law_.K[i_] * p[1]) / (law_.sigma[i_] * w_), f * std::sin(t),
            f * std::cos(t)};
  }
  Point step(const Point& p, double t, double h, int where) const {
    const auto along = [&](const Point& k, double part) {
      Point q = p;
      for (std::size_t j = 0; j < 4; ++j) q[j] += part * k[j];
      return q;
    };
    const Point k1 = rate(p, t, where), k2 = rate(along(k1, 0.5 * h), t + 0.5 * h, where),
                k3 = rate(along(k2, 0.5 * h), t + 0.5 * h, where), k4 = rate(along(k3, h), t + h, where);
    Point q = p;
    for (std::size_t j = 0; j < 4; ++j) q[j] += h / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
    return q;
  }

  const Xiong<double>& law_;
  std::size_t i_;
  double A_, w_;
  Complex last_;
};

}  // namespace

TEST_CASE("describing function of wojewoda: spring, two curves of slip") {
  auto law = levels<Wojewoda<double>>();
  law.ks = 1e4;
  auto uneven = law;
  uneven.Fs_minus = 1.2;
  uneven.Fc_minus = 0.9;
  struct Case {
    const Wojewoda<double>& law;
    double A, w, bias;
  };
  // The last but one yields after the velocity has passed its peak.
  for (const Case& c : {Case{law, 1e-3, 20.0, 0.0},
                        {law, 5e-3, 3.0, 4e-3},
                        {law, 3e-3, 2.0, -3e-3},
                        {law, 1.7e-4, 20.0, 0.0},
                        {uneven, 2e-3, 10.0, 1e-3}}) {
    CAPTURE(c.A, c.w, c.bias);
    const auto df = by_quadrature<Wojewoda>(c.law, c.A, c.w, c.bias, 1e-10);
    const auto want = wojewoda_by_pieces(c.law, c.A, c.w, c.bias);
    CHECK(df.status == Status::converged);
    CHECK(std::abs(df.gain - want.gain) < 1e-9 * std::abs(want.gain));
    CHECK(df.mean == Approx(want.mean).epsilon(1e-9).margin(1e-10));
    CHECK(df.dissipation == Approx(want.work).epsilon(1e-9));
    check_samples<Wojewoda>(c.law, c.A, c.w, c.bias, df);
  }
  // Below Fs/ks the spring alone, from the virgin state; in a slide without reversals the two curves alone.
  const auto spring = by_quadrature<Wojewoda>(law, 0.9e-4, 5.0, 0.0, 1e-10);
  CHECK(std::abs(spring.gain - Complex(1e4, 0.4 * 5.0)) < 1e-7);
  const double A = 1e-3, w = 10.0, V = 2e-2;
  const auto slide = by_quadrature<Wojewoda>(law, A, w, V, 1e-10);
  double sine = 0.0;
  for (int i = 0; i < 4000;
       ++i) {  // F - Fc - sigma2 v changes sign with the acceleration, so only its sine part is left
    const double t = pi * (i + 0.5) / 4000.0, v = V + A * w * std::cos(t);
    sine -= 2.0 / 4000.0 * 0.5 * std::exp(-std::pow(v / 1e-2, 2.0)) * std::sin(t);
  }
  CHECK(slide.gain.real() == Approx(sine / A).epsilon(1e-6));
  CHECK(slide.gain.imag() == Approx(0.4 * w).epsilon(1e-8));
}

TEST_CASE("describing function of xiong: each element event by event") {
  auto law = levels<Xiong<double>>(1.5, 1e-3);
  law.K = {1000.0, 4600.0, 8200.0};
  law.sigma = {5.0, 16.0, 27.5};
  law.lambda = {0.3, 0.33, 0.37};
  law.tau = 2e-3;
  REQUIRE_FALSE(law.validate());
  for (const auto& [A, w] : {std::pair{1e-3, 10.0}, {2e-4, 40.0}, {1.2e-4, 2.0}}) {
    CAPTURE(A, w);
    Complex want(0.0, law.sigma2 * w);
    for (std::size_t i = 0; i < 3; ++i) want += OneElement(law, i, A, w).gain(3000);
    const auto df = by_quadrature<Xiong>(law, A, w, 0.0, 1e-9);
    CHECK(df.status == Status::converged);
    CHECK(df.symmetric);
    CHECK(std::abs(df.gain - want) < 1e-8 * std::abs(want));
  }
  const auto df = by_quadrature<Xiong>(law, 1e-3, 10.0, 2e-3, 1e-8);
  CHECK(df.status == Status::converged);
  check_samples<Xiong>(law, 1e-3, 10.0, 2e-3, df);
  // Not slipping: springs and dampers in parallel.
  const auto small = by_quadrature<Xiong>(law, 1e-6, 10.0, 0.0, 1e-10);
  CHECK(std::abs(small.gain - Complex(13800.0, 10.0 * (48.5 + 0.4))) < 1e-6);
}

TEST_CASE("describing functions of laws with a band: outside it those of the Stribeck curve") {
  const double A = 1e-3, w = 10.0, V = 1.3e-2;
  Stribeck<double> stribeck;
  stribeck.Fs = stribeck.Fs_minus = 1.5;
  stribeck.Fc = stribeck.Fc_minus = 1.0;
  stribeck.vs = 1e-2;
  stribeck.sigma2 = 0.4;
  const auto check = [&]<template <class> class Kind>(Kind<double> law) {
    law.dv = 2.9e-3;
    for (const double side : {1.0, -1.0}) {
      const auto df = by_quadrature<Kind>(law, A, w, side * V, 1e-9);
      const auto want = by_quadrature<Stribeck>(stribeck, A, w, side * V, 1e-9);
      CHECK(df.status == Status::converged);
      CHECK(std::abs(df.gain - want.gain) < 1e-8 * std::abs(want.gain));
      CHECK(df.mean == Approx(want.mean));
    }
    CHECK(drive_band(law) == 2.9e-3);
  };
  check(levels<Karnopp<double>>());
  check(levels<Quinn<double>>());
  check(levels<Awrejcewicz<double>>());
}

TEST_CASE("within their band these laws have no describing function, and no number comes out") {
  const auto check = [](auto law) {
    law.dv = 2.9e-3;
    const Element element(law);
    const double A = 1e-3, w = 10.0;
    CHECK(undefined_under(element, 0.0, 0.0));
    CHECK(undefined_under(element, 2.9e-3, 0.0));
    CHECK_FALSE(undefined_under(element, 3e-3, 0.0));
    for (const double bias : {0.0, 5e-3, 1.28e-2, -1.28e-2})
      for (const DfMethod method : {DfMethod::automatic, DfMethod::fft, DfMethod::quadrature}) {
        const auto df = describing_function(element, {A, w, bias}, {.method = method});
        CHECK(df.status == Status::undefined);
        CHECK_FALSE(df.answered());
        CHECK(df.gain == 0.0);
        CHECK(df.harmonics.size() == 7);
      }
    CHECK(describing_function(element, {A, w, 1.3e-2}).status == Status::converged);
    Eigen::VectorXcd input(2);
    input << 0.0, A;
    CHECK(harmonic_response(element, input, w).status == Status::undefined);
    CHECK(harmonic_response(element, input, w, {.mean_rate = 1.3e-2}).status == Status::converged);
  };
  check(levels<Karnopp<double>>());
  check(levels<Quinn<double>>());
  check(levels<Awrejcewicz<double>>());
  CHECK_FALSE(undefined_under(levels<Wojewoda<double>>(), 0.0, 0.0));
  CHECK(to_string(Status::undefined) == "undefined");
}

TEST_CASE("harmonic response of wojewoda: its derivative moves the switches at zero acceleration") {
  auto law = levels<Wojewoda<double>>();
  law.ks = 1e4;
  const Element element(law);
  Eigen::VectorXcd input(4);
  input << 0.0, Complex(1e-3, 2e-4), 0.0, Complex(5e-5, -1e-4);
  const auto response = [&](const Eigen::VectorXcd& at, Eigen::MatrixXd* derivative) {
    const PrescribedHarmonics motion(at, 12.0, 0.0, true);
    ElementHarmonics harmonics(element);
    const auto found =
        derivative ? harmonics.with_derivative(motion, 3, 4, 1e-13, *derivative) : harmonics(motion, 3, 4, 1e-13);
    REQUIRE(found.status == Status::converged);
    return found.harmonics;
  };
  Eigen::MatrixXd derivative;
  response(input, &derivative);
  const double h = 1e-8;
  for (const Eigen::Index order : {1, 3})
    for (int part = 0; part < 2; ++part) {
      const Complex step = part == 0 ? Complex(h, 0.0) : Complex(0.0, h);
      Eigen::VectorXcd plus = input, minus = input;
      plus(order) += step;
      minus(order) -= step;
      const Eigen::VectorXcd slope = (response(plus, nullptr) - response(minus, nullptr)) / (2.0 * h);
      const Eigen::Index column = (order - 1) + part;
      for (const Eigen::Index k : {0, 1}) {
        CAPTURE(order, part, k);
        const double size = derivative.cwiseAbs().leftCols(4).maxCoeff();
        CHECK(derivative(2 * k, column) == Approx(slope(2 * k + 1).real()).margin(1e-5 * size));
        CHECK(derivative(2 * k + 1, column) == Approx(slope(2 * k + 1).imag()).margin(1e-5 * size));
      }
    }
}

TEST_CASE("mass and friction under a harmonic force: the applied force is known, dv to 0 gives the Stribeck curve") {
  Stribeck<double> stribeck;
  stribeck.Fs = stribeck.Fs_minus = 1.5;
  stribeck.Fc = stribeck.Fc_minus = 1.0;
  stribeck.vs = 1e-2;
  stribeck.sigma2 = 0.4;
  const CompositePoint point{2.5, 6.0};
  const auto response = [&](const Element& law) {
    CompositeDescribingFunction composite(law, 1.0);
    const auto found = composite(point, {.harmonics = 1, .accuracy = 1e-8});
    REQUIRE(found.status == Status::converged);
    return found.gain;
  };
  const Complex want = response(stribeck);
  const auto apart = [&](auto law, double dv) {
    law.dv = dv;
    return std::abs(response(law) - want) / std::abs(want);
  };
  const auto check = [&](auto law) {
    const double coarse = apart(law, 1e-3), fine = apart(law, 1e-5);
    CAPTURE(coarse, fine);
    CHECK(coarse < 0.02);
    CHECK(fine < 0.05 * coarse + 2e-6);
  };
  check(levels<Karnopp<double>>());
  check(levels<Quinn<double>>());
  check(levels<Awrejcewicz<double>>());
}

TEST_CASE("least speed and acceleration of a prescribed motion") {
  CHECK(PrescribedMotion(1e-3, 10.0, 1.3e-2, true).least_speed() == Approx(3e-3));
  CHECK(PrescribedMotion(1e-3, 10.0, -1.3e-2, true).least_speed() == Approx(3e-3));
  CHECK(PrescribedMotion(1e-3, 10.0, 0.9e-2, true).least_speed() == 0.0);
  Eigen::VectorXcd input(4);
  input << 0.0, Complex(1e-3, 2e-4), Complex(0.0, 1e-4), Complex(-5e-5, 1e-4);
  const PrescribedHarmonics reversing(input, 7.0, 0.0, false), sliding(input, 7.0, 0.1, false);
  CHECK(reversing.least_speed() == 0.0);
  double least = infinite;
  for (int i = 0; i < 20000; ++i) least = std::min(least, std::abs(sliding.at(0, 2.0 * pi * i / 20000.0).in.v));
  CHECK(sliding.least_speed() == Approx(least).epsilon(1e-6));
  const PrescribedMotion single(1e-3, 7.0, 3e-3, true);
  const auto check = [](const auto& motion, double size) {
    const double h = 1e-5;
    for (int anchor = 0; anchor <= 2; ++anchor)
      for (const double local : {-0.4, 0.0, 0.3, 1.1}) {
        const double slope = (motion.at(anchor, local + h).in.v - motion.at(anchor, local - h).in.v) / (2.0 * h);
        CHECK(motion.at(anchor, local).slope == Approx(slope).margin(1e-7 * size));
      }
  };
  check(single, 7e-3);
  check(reversing, 7e-3);
  check(sliding, 7e-3);
}
