// Jenkins and Maxwell-slip under prescribed motion: closed forms A8 and A9, and with a mean velocity the piecewise
// exact path of each element.
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/models/friction/sliders/maxwell_slip.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using std::numbers::pi;

namespace {

MaxwellSlip<double> ten_sliders() {
  MaxwellSlip<double> law;
  for (int i = 0; i < 10; ++i) {
    law.k.push_back(1000.0 + 350.0 * i);
    law.W.push_back(0.05 + 0.02 * ((7 * i) % 10));
  }
  return law;
}

/// Gain and mean force of one element in x = bias t + A sin wt: the stretch after a reversal at x_r follows x until it
/// meets the limit, and stays there. The limit met is found by bisection, the rest are integrals of smooth pieces.
struct ExactElement {
  double k, W, A, w, bias;
  std::complex<double> gain;
  double mean = 0.0;

  double x(double theta) const { return bias * theta / w + A * std::sin(theta); }

  void piece(double from, double to, const auto& force) {
    constexpr double node[] = {0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    const int panels = 40;
    const double half = (to - from) / (2 * panels);
    for (int p = 0; p < panels; ++p)
      for (int i = -2; i <= 2; ++i) {
        const double theta = from + half * (2 * p + 1 + (i < 0 ? -1 : 1) * node[std::abs(i)]);
        const double part = half * weight[std::abs(i)] * force(theta);
        gain += part * std::complex<double>(std::sin(theta), std::cos(theta)) / (pi * A);
        mean += part / (2.0 * pi);
      }
  }

  ExactElement(double stiffness, double limit, double amplitude, double frequency, double velocity)
      : k(stiffness), W(limit), A(amplitude), w(frequency), bias(velocity) {
    const double r = std::acos(-bias / (A * w));  // forward to backward at r, backward to forward at 2 pi - r
    double s = W / k;                             // forwards it slips for certain where the drift is forwards
    for (int half = 0; half < 2; ++half) {
      const double from = half == 0 ? r : 2.0 * pi - r, to = half == 0 ? 2.0 * pi - r : 2.0 * pi + r;
      const double toward = half == 0 ? -W / k : W / k, start = s, x_r = x(from);
      const auto stretch = [&](double theta) { return start + x(theta) - x_r; };
      double low = from, high = to;
      if (std::abs(stretch(to) - start) > std::abs(toward - start)) {
        while (high - low > 1e-15 * high) {
          const double middle = 0.5 * (low + high);
          (std::abs(stretch(middle) - start) < std::abs(toward - start) ? low : high) = middle;
          if (middle == low && middle == high) break;
          if (0.5 * (low + high) == low || 0.5 * (low + high) == high) break;
        }
      }
      piece(from, high, [&](double theta) { return k * stretch(theta); });
      if (high < to) piece(high, to, [&](double) { return k * toward; });
      s = high < to ? toward : stretch(to);
    }
  }
};

}  // namespace

TEST_CASE("jenkins and maxwell-slip: claims A8 and A9", "[df][friction][claims]") {
  const Jenkins<double> one{1000.0, 1.5};
  CHECK(std::abs(stop_gain(1000.0, 1.5, 0.004) - std::complex<double>(342.518821, 298.415518)) < 1e-6);
  for (const double A : {1e-4, 1.5e-3, 1.5001e-3, 4e-3, 0.3}) {
    CAPTURE(A);
    const auto df = quadrature(one, A, 2.0, 0.0, 1e-10, 5);
    CHECK(df.status == Status::converged);
    CHECK(df.symmetric);
    CHECK(apart(df.gain, *one.exact_describing_function(A, 2.0, 0.0)) <= df.error);
    CHECK(df.error <= 1e-10);
    CHECK(df.dissipation == Approx(4.0 * 1.5 * std::max(0.0, A - 1.5e-3)).epsilon(1e-9).margin(1e-16));
  }
  CHECK_FALSE(one.exact_describing_function(1.0, 1.0, 0.1));
  const auto law = ten_sliders();
  for (const double A : {1e-5, 3e-5, 6e-5, 1e-3}) {
    CAPTURE(A);
    const auto df = quadrature(law, A, 7.0, 0.0, 1e-10, 5);
    CHECK(df.status == Status::converged);
    CHECK(apart(df.gain, *law.exact_describing_function(A, 7.0, 0.0)) <= std::min(df.error, 1e-10));
  }
}

TEST_CASE("maxwell-slip: 31 elements that slip one after another or all at once", "[df][friction]") {
  MaxwellSlip<double> spread, equal;
  for (int i = 0; i < most_sliders; ++i) {
    spread.k.push_back(100.0);
    spread.W.push_back(0.01 * (i + 1));
    equal.k.push_back(100.0);
    equal.W.push_back(0.1);
  }
  for (const auto& law : {spread, equal}) {
    const auto df = quadrature(law, 2e-3, 5.0, 0.0, 1e-4, 5);
    CHECK(df.status == Status::converged);
    CHECK(apart(df.gain, *law.exact_describing_function(2e-3, 5.0, 0.0)) <= df.error);
  }
}

TEST_CASE("maxwell-slip: with a mean velocity each element follows its exact path", "[df][friction]") {
  const auto law = ten_sliders();
  for (const auto& [A, w, bias] : {std::tuple{1e-3, 2.0, 2e-4}, {3e-4, 2.0, 5.5e-4}, {4e-5, 50.0, 1e-4}}) {
    CAPTURE(A, w, bias);
    const auto df = quadrature(law, A, w, bias, 1e-9, 5);
    std::complex<double> gain;
    double mean = 0.0;
    for (std::size_t i = 0; i < law.k.size(); ++i) {
      const ExactElement element(law.k[i], law.W[i], A, w, bias);
      gain += element.gain;
      mean += element.mean;
    }
    CHECK(df.status == Status::converged);
    CHECK(apart(df.gain, gain) < 1e-9);
    CHECK(df.mean == Approx(mean).epsilon(1e-9));
    const auto back = quadrature(law, A, w, -bias, 1e-9, 5);
    CHECK(back.mean == Approx(-mean).epsilon(1e-9));
  }
  const auto sliding = quadrature(law, 1e-3, 1.0, 1.0, 1e-6, 5);  // never turns back
  CHECK(sliding.gain == 0.0);
  CHECK(sliding.mean == Approx(law.sum_of_limits()).epsilon(1e-11));
}

TEST_CASE("maxwell-slip: the two routes agree, and the frequency does not matter to rounding", "[df][friction]") {
  const auto law = ten_sliders();
  const double A = 6e-5;
  const auto slow = quadrature(law, A, 1e-4, 0.0, 1e-8, 5), fast = quadrature(law, A, 3e5, 0.0, 1e-8, 5);
  CHECK(apart(fast.gain, slow.gain) < 1e-13);
  for (std::size_t i = 0; i < slow.harmonics.size(); ++i)
    CHECK(std::abs(fast.harmonics[i] - slow.harmonics[i]) < 1e-13 * std::abs(slow.harmonics[0]));
  const PrescribedMotion motion(A, 2.0, 0.0, true);
  const auto fft = FftRoute(law, motion, true, 0.0, {.harmonics = 5, .accuracy = 1e-7}).refine(slow);
  CHECK(fft.status == Status::converged);
  CHECK(apart(fft.gain, slow.gain) < 1e-7);
}
