#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/models/element/memoryless/window.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/with_memory/hysteretic_dead_zone.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"

using namespace limcycle;
using std::numbers::pi;
using Complex = std::complex<double>;

namespace {

ClampedPi<double> clamped(double kp, double ki, double limit) {
  ClampedPi<double> element;
  element.kp = kp;
  element.ki = ki;
  element.limit = limit;
  return element;
}

constexpr int instants = 1'000'000;
double step_of(double w) { return 2.0 * pi / w / instants; }

/// First harmonic of the clamped PI by the rule itself at a million instants a period: u = kp x + z is limited, z moves
/// unless that would take u further beyond the limit. Error: some steps, where z chatters along the limit.
Complex by_small_steps(const ClampedPi<double>& pi_of, double A, double w, double bias, int periods) {
  const double h = step_of(w);
  double z = 0.0;
  Complex sum = 0.0;
  for (int period = 0; period < periods; ++period) {
    sum = 0.0;
    for (int i = 0; i < instants; ++i) {
      const double phase = 2.0 * pi * (i + 0.5) / instants, x = bias + A * std::sin(phase), u = pi_of.kp * x + z;
      const double y = std::clamp(u, -pi_of.limit, pi_of.limit);
      if (!((u > pi_of.limit && pi_of.ki * x > 0.0) || (u < -pi_of.limit && pi_of.ki * x < 0.0))) z += h * pi_of.ki * x;
      sum += y * Complex(std::sin(phase), std::cos(phase));
    }
  }
  return 2.0 / instants / A * sum;
}

}  // namespace

TEST_CASE("clamped integral: alone it is a stop, whose describing function has a closed form") {
  // z follows the way X = integral of ki x, as the force of a slider with stiffness 1 does.
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  for (const double A : {0.6, 1.0, 5.0, 80.0})
    for (const double w : {0.5, 3.0}) {
      const double ki = 4.0, limit = 1.3, way = A * ki / w;
      if (way <= limit) continue;  // it never stops: its mean is then that of the start
      Jenkins<double> slider;
      slider.k = 1.0;
      slider.Fc = limit;
      const Complex expected = *slider.exact_describing_function(way, w, 0.0) * Complex(0.0, -ki / w);
      CAPTURE(A, w);
      CHECK(std::abs(*clamped(0.0, ki, limit).exact_describing_function(A, w, 0.0) - expected) < 1e-12);
      const auto found = describing_function(clamped(0.0, ki, limit), {A, w, 0.0}, marched);
      CHECK(found.status == Status::converged);
      CHECK(found.method == "quadrature");
      CHECK(std::abs(found.gain - expected) <= found.error * std::abs(expected) + 1e-12);
    }
}

TEST_CASE("clamped integral: a PI as long as it does not reach the limit") {
  const ClampedPi<double> element = clamped(0.4, 2.0, 1.0);
  CHECK(*element.exact_describing_function(0.4, 1.0, 0.0) == Complex(0.4, -2.0));
  CHECK_FALSE(element.exact_describing_function(0.1, 1.0, 0.1));
}

TEST_CASE("clamped integral: with a proportional part and a bias, against its rule at small steps") {
  // On the way it is within the limit, beyond it and clamped, beyond it and coming back, and on it (A = 2, kp = 0.4).
  const struct {
    double kp, ki, A, w, bias;
  } settings[] = {{0.4, 2.0, 2.0, 1.0, 0.0}, {1.5, 1.0, 2.0, 0.7, 0.0},  {0.2, 3.0, 5.0, 2.0, 0.0},
                  {0.4, 2.0, 2.0, 1.0, 0.3}, {-0.3, 2.0, 3.0, 1.0, 0.0}, {0.4, -2.0, 2.0, 1.0, 0.0}};
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  for (const auto& [kp, ki, A, w, bias] : settings) {
    CAPTURE(kp, ki, A, w, bias);
    const ClampedPi<double> element = clamped(kp, ki, 1.0);
    const auto found = describing_function(element, {A, w, bias}, marched);
    CHECK(found.status == Status::converged);
    CHECK(found.method == "quadrature");
    CHECK(std::abs(found.gain - by_small_steps(element, A, w, bias, 4)) < 10.0 * step_of(w));
    const auto closed = element.exact_describing_function(A, w, bias);
    REQUIRE(closed.has_value() == (bias == 0.0));
    if (closed) CHECK(std::abs(*closed - found.gain) <= found.error * std::abs(found.gain) + 1e-12);
  }
}

TEST_CASE("clamped integral: mirrored and in other units it is the same") {
  const auto plain = describing_function(clamped(0.4, 2.0, 1.0), {2.0, 1.0, 0.0});
  // Input in units of 1e-6, output of 1e-3, time of 1e-4: kp and ki by 1e3 and 1e7.
  const auto scaled = describing_function(clamped(0.4e3, 2.0e7, 1e-3), {2e-6, 1e4, 0.0});
  CHECK(std::abs(scaled.gain / 1e3 - plain.gain) < 1e-9);
  const auto up = describing_function(clamped(0.4, 2.0, 1.0), {2.0, 1.0, 0.3}),
             down = describing_function(clamped(0.4, 2.0, 1.0), {2.0, 1.0, -0.3});
  CHECK(std::abs(up.gain - down.gain) < 1e-9);
}

namespace {

ResetIntegrator<double> resetting(double gain, double share, double interval) {
  ResetIntegrator<double> element;
  element.gain = gain;
  element.share = share;
  element.interval = interval;
  return element;
}

/// First harmonic of the reset integrator by its rule at some instants a period, the last of `periods`.
Complex by_rule(const ResetIntegrator<double>& element, double A, double w, double bias, int periods) {
  constexpr int instants_of_period = 100'000;
  const double h = 2.0 * pi / w / instants_of_period;
  double z = 0.0, x = bias, since = infinite;
  Complex sum = 0.0;
  for (int period = 0; period < periods; ++period) {
    sum = 0.0;
    for (int i = 0; i < instants_of_period; ++i) {
      const double phase = 2.0 * pi * (i + 0.5) / instants_of_period, before = x;
      x = bias + A * std::sin(phase);
      z += h * element.gain * x;
      since += h;
      if (before * x < 0.0 && since >= element.interval) {
        z *= 1.0 - element.share;
        since = 0.0;
      }
      sum += z * Complex(std::sin(phase), std::cos(phase));
    }
  }
  return 2.0 / instants_of_period / A * sum;
}

}  // namespace

TEST_CASE("hysteretic dead zone: its describing function against quadrature, and without hysteresis that of a window") {
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  HystereticDeadZone<double> zone;
  zone.half_width = 0.2;
  for (const double hysteresis : {1e-3, 0.1, 0.5})
    for (const double A : {0.71, 1.0, 20.0}) {
      zone.hysteresis = hysteresis;
      const Complex expected = *zone.exact_describing_function(A, 3.0, 0.0);
      const auto found = describing_function(zone, {A, 3.0, 0.0}, marched);
      CAPTURE(hysteresis, A, found.gain, expected);
      CHECK(std::abs(found.gain - expected) < 1e-8);
      CHECK(expected.imag() < 0.0);  // it passes late
    }
  CHECK(*zone.exact_describing_function(0.69, 3.0, 0.0) == 0.0);
  CHECK_FALSE(zone.exact_describing_function(1.0, 3.0, 0.1));
  // Without hysteresis it passes what a window does not.
  zone.hysteresis = 1e-12;
  Window<double> window;
  window.half_width = 0.2;
  CHECK(std::abs(*zone.exact_describing_function(0.5, 1.0, 0.0) + *window.exact_describing_function(0.5, 1.0, 0.0) -
                 1.0) < 1e-9);
}

TEST_CASE("reset integrator: Clegg's describing function, and that of a partial reset, against quadrature") {
  const auto marched = test::with(DfMethod::quadrature, 1e-9);
  // Clegg (1958): 4/(pi w) (1 - j pi/4) A^0.
  CHECK(std::abs(*resetting(1.0, 1.0, 0.0).exact_describing_function(2.0, 0.5, 0.0) - Complex(8.0 / pi, -2.0)) < 1e-12);
  CHECK(std::abs(*resetting(3.0, 0.0, 0.0).exact_describing_function(2.0, 0.5, 0.0) - Complex(0.0, -6.0)) < 1e-12);
  for (const double share : {0.2, 1.0, 1.6})
    for (const double interval : {0.0, 0.7}) {
      const auto element = resetting(3.0, share, interval);
      const Complex expected = *element.exact_describing_function(2.0, 4.0, 0.0);
      const auto found = describing_function(element, {2.0, 4.0, 0.0}, marched);
      CAPTURE(share, interval, found.gain, expected);
      CHECK(found.status == Status::converged);
      CHECK(std::abs(found.gain - expected) <= found.error * std::abs(expected) + 1e-9);
      CHECK(std::abs(found.gain - by_rule(element, 2.0, 4.0, 0.0, 60)) < 2e-4 * std::abs(expected));
    }
}

TEST_CASE("reset integrator: no closed form with a bias, a long interval or a change of sign") {
  CHECK_FALSE(resetting(3.0, 1.0, 0.0).exact_describing_function(2.0, 4.0, 0.1));
  CHECK_FALSE(resetting(3.0, 1.0, 0.8).exact_describing_function(2.0, 4.0, 0.0));
  CHECK_FALSE(resetting(3.0, 2.0, 0.0).exact_describing_function(2.0, 4.0, 0.0));
  const auto biased =
      describing_function(resetting(3.0, 1.0, 0.0), {2.0, 4.0, 0.5}, test::with(DfMethod::quadrature, 1e-9));
  CHECK(biased.status == Status::converged);
  CHECK(std::abs(biased.gain - by_rule(resetting(3.0, 1.0, 0.0), 2.0, 4.0, 0.5, 3)) < 2e-4 * std::abs(biased.gain));
}

TEST_CASE("window: its describing function, against sums over a period") {
  Window<double> element;
  element.half_width = 0.8;
  for (const double A : {0.5, 0.81, 1.0, 7.0}) {
    double sum = 0.0;
    for (int i = 0; i < instants; ++i) {
      const double s = std::sin(2.0 * pi * (i + 0.5) / instants);
      if (A * std::abs(s) <= element.half_width) sum += s * s;
    }
    CHECK(element.exact_describing_function(A, 1.0, 0.0)->real() == Approx(2.0 * sum / instants).margin(3e-6));
    CHECK(describing_function(element, {A, 1.0, 0.0}).gain.real() == Approx(2.0 * sum / instants).margin(3e-6));
  }
}
