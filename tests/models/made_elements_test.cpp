#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"
#include "limcycle/models/element/of_controllers/output_rate.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Complex = std::complex<double>;

namespace {

Quantizer<double> quantizer_of(double step) {
  Quantizer<double> element;
  element.step = step;
  return element;
}

DelayedRelay<double> delayed(double level, double delay, double hysteresis = 0.0, double dead_zone = 0.0) {
  DelayedRelay<double> element;
  element.level = level;
  element.delay = delay;
  element.hysteresis = hysteresis;
  element.dead_zone = dead_zone;
  return element;
}

/// First harmonic gain of a function of x for the input bias + A sin, by the midpoint rule over one period.
double gain_by_sampling(const auto& function, double A, double bias) {
  constexpr int n = 2'000'000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double s = std::sin(2.0 * std::numbers::pi * (i + 0.5) / n);
    sum += function(bias + A * s) * s;
  }
  return 2.0 * sum / n / A;
}

}  // namespace

TEST_CASE("compensation: the sign of v, from whichever side it comes") {
  Compensation<double> element;
  element.level = 1.3;
  std::vector<double> none;
  CHECK(element.start({0.0, 0.2, 0.0}, none) == element.forward);
  CHECK(element.start({5.0, -0.2, infinite}, none) == element.backward);
  CHECK(element.start({0.0, 0.0, -infinite}, none) == element.backward);  // about to move backwards
  CHECK(element.start({0.0, 0.0, infinite}, none) == element.forward);
  CHECK(element.output({0.0, 0.2, 0.0}, element.forward, none) == 1.3);
  CHECK(element.output({0.0, -0.2, 0.0}, element.backward, none) == -1.3);
  double g[1];
  element.guard({9.0, 0.2, 0.0}, element.forward, none, g);
  CHECK(g[0] == 0.2);
  element.guard({9.0, 0.2, 0.0}, element.backward, none, g);
  CHECK(g[0] == -0.2);
  CHECK(element.next({0.0, 0.0, 0.0}, element.forward, none, 0) == element.backward);
  CHECK(element.next({0.0, 0.0, 0.0}, element.backward, none, 0) == element.forward);
  CHECK(element.mirror(element.forward) == element.backward);
  const auto friction = coulomb(1.3, 1.3);  // the describing function is that of Coulomb friction of the same size
  for (const double bias : {0.0, 0.3, -0.9, 2.0})
    CHECK(std::abs(*element.exact_describing_function(0.5, 2.0, bias) -
                   *friction.exact_describing_function(0.5, 2.0, bias)) < 1e-15);
}

TEST_CASE("the selection of a set-valued law: sign while sliding, share of the break-away level while stuck") {
  auto law = coulomb(2.0, 1.0);
  law.Fs_minus = 4.0;
  CHECK(law.selection({1}, 1.0) == 1.0);
  CHECK(law.selection({-1}, -1.0) == -1.0);
  CHECK(law.selection({0}, 0.5) == 0.25);
  CHECK(law.selection({0}, -1.0) == -0.25);
  STATIC_REQUIRE(HasSelection<Stribeck<double>, double>);
  STATIC_REQUIRE_FALSE(HasSelection<LuGre<double>, double>);
}

TEST_CASE("quantizer: levels, thresholds and steps between them") {
  const auto element = quantizer_of(0.2);
  std::vector<double> none;
  for (const double x : {0.0, 0.09, -0.09, 0.11, 0.29, -0.31, 123.456, -7.77}) {
    const Mode mode = element.start({x, 0.0, 0.0}, none);
    CHECK(element.output({x, 0.0, 0.0}, mode, none) == Approx(0.2 * std::round(x / 0.2)));
    double g[2];
    element.guard({x, 0.0, 0.0}, mode, none, g);
    CHECK(g[0] >= 0.0);
    CHECK(g[1] >= 0.0);
    CHECK(g[0] + g[1] == Approx(0.2));
    CHECK(element.output({-x, 0.0, 0.0}, element.mirror(mode), none) == -element.output({x, 0.0, 0.0}, mode, none));
  }
  double g[2];
  element.guard({0.5, 0.0, 0.0}, {2}, none, g);
  CHECK(g[0] == Approx(0.0).margin(1e-15));
  CHECK(element.next({0.5, 0.0, 0.0}, {2}, none, 0) == Mode{3});
  CHECK(element.next({0.3, 0.0, 0.0}, {2}, none, 1) == Mode{1});
  CHECK(element.start({1e300, 0.0, 0.0}, none).value > 0);  // far beyond what an integer holds
  CHECK(element.start({-1e300, 0.0, 0.0}, none).value < 0);
}

TEST_CASE("quantizer: describing function") {
  const auto element = quantizer_of(1.0);
  const auto rounded = [](double x) { return std::round(x); };
  CHECK(*element.exact_describing_function(0.499, 1.0, 0.0) == 0.0);
  // Up to three half steps it is a relay with a dead zone.
  for (const double A : {0.51, 1.0, 1.49})
    CHECK(std::abs(*element.exact_describing_function(A, 1.0, 0.0) -
                   *relay(1.0, 0.0, 0.5).exact_describing_function(A, 1.0, 0.0)) < 1e-15);
  const double A = 2.7;
  double sum = 0.0;
  for (int i = 1; (2 * i - 1) * 0.5 < A; ++i) sum += std::sqrt(1.0 - std::pow((2 * i - 1) * 0.5 / A, 2));
  CHECK(element.exact_describing_function(A, 1.0, 0.0)->real() == Approx(4.0 / (std::numbers::pi * A) * sum));
  for (const double bias : {0.0, 0.2, 0.5, -3.3})
    CHECK(element.exact_describing_function(1.7, 1.0, bias)->real() ==
          Approx(gain_by_sampling(rounded, 1.7, bias)).epsilon(3e-6));
  CHECK(element.exact_describing_function(1e4, 1.0, 0.0)->real() == Approx(1.0).epsilon(1e-5));
  CHECK_FALSE(element.exact_describing_function(1e7, 1.0, 0.0));
}

TEST_CASE("rate of a dead zone's and a saturation's output") {
  DeadZone<double> dead_zone;
  dead_zone.slope = 3.0;
  dead_zone.half_width = 0.4;
  Saturation<double> limited;
  limited.slope = 2.0;
  limited.limit = 0.5;
  std::vector<double> none;
  const auto check = [&](const auto& element) {
    const auto rate = OutputRate<double>::of(element);
    for (const double x : {-1.0, -0.41, -0.26, -0.24, 0.1, 0.39, 0.9}) {
      const Input<double> in{x, 0.7, 0.0}, later{x + 0.7e-6, 0.7, 0.0};
      const Mode mode = element.start(in, none);
      CHECK(rate.start(in, none) == mode);
      REQUIRE(rate.guards(mode) == element.guards(mode));
      double g[2] = {}, same[2] = {};
      rate.guard(in, mode, none, g);
      element.guard(in, mode, none, same);
      CHECK(g[0] == same[0]);
      CHECK(g[1] == same[1]);
      for (int k = 0; k < element.guards(mode); ++k)
        CHECK(rate.next(in, mode, none, k) == element.next(in, mode, none, k));
      CHECK(rate.output(in, mode, none) ==
            Approx((element.output(later, mode, none) - element.output(in, mode, none)) / 1e-6).margin(1e-8));
    }
    for (const double A : {0.1, 0.3, 2.0})
      CHECK(std::abs(*rate.exact_describing_function(A, 5.0, 0.0) -
                     Complex(0.0, 5.0) * *element.exact_describing_function(A, 5.0, 0.0)) < 1e-14);
  };
  check(dead_zone);
  check(limited);
}

TEST_CASE("delayed relay: modes hold decision, output and queue") {
  using Queue = DelayedRelay<double>::Queue;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> sign(-1, 1), length(0, 15);
  const auto element = delayed(1.0, 0.5);
  for (int i = 0; i < 500; ++i) {
    Queue queue;
    queue.decision = sign(random);
    queue.output = sign(random);
    queue.count = length(random);
    for (int k = 0; k < queue.count; ++k) queue.pending[k] = sign(random);
    const Queue back = Queue::of(queue.mode()), mirrored = Queue::of(element.mirror(queue.mode()));
    CHECK(back.decision == queue.decision);
    CHECK(back.output == queue.output);
    CHECK(back.count == queue.count);
    CHECK(mirrored.decision == -queue.decision);
    CHECK(mirrored.output == -queue.output);
    CHECK(mirrored.count == queue.count);
    for (int k = 0; k < 15; ++k) {
      CHECK(back.pending[k] == queue.pending[k]);
      CHECK(mirrored.pending[k] == -queue.pending[k]);
    }
  }
  CHECK(Queue{}.mode() == Mode{});
}

TEST_CASE("delayed relay: a decision comes out after the delay, in the order of the decisions") {
  // Input sin t decides at every multiple of pi; with a delay of 10 three or four decisions are pending.
  const auto element = delayed(2.0, 10.0);
  std::vector<double> z(15, -1.0), dz(15);
  Mode mode = element.start({1.0, 0.0, 0.0}, z);
  CHECK(z == std::vector<double>(15, 0.0));
  double t = 0.5 * std::numbers::pi, decide = std::numbers::pi;
  int most = 0;
  while (t < 100.0) {
    const int count = DelayedRelay<double>::Queue::of(mode).count;
    most = std::max(most, count);
    REQUIRE(element.guards(mode) == 1 + (count > 0 ? 1 : 0));
    element.rate({}, mode, z, dz);
    for (int k = 0; k < 15; ++k) CHECK(dz[static_cast<std::size_t>(k)] == (k < count ? -1.0 : 0.0));
    const double out = count > 0 ? t + z[0] : infinite, next = std::min(out, decide), middle = 0.5 * (t + next);
    const double past = middle - 10.0;
    CHECK(element.output({}, mode, z) == (past < 0.0 || std::sin(past) > 0.0 ? 2.0 : -2.0));
    double g[2] = {};
    element.guard({std::sin(middle), 0.0, 0.0}, mode, z, g);
    CHECK(g[0] > 0.0);
    if (count > 0) CHECK(g[1] == z[0]);
    for (int k = 0; k < count; ++k) z[static_cast<std::size_t>(k)] -= next - t;
    t = next;
    mode = element.next({}, mode, z, next == out ? 1 : 0);
    if (next == decide) decide += std::numbers::pi;
  }
  CHECK(most == 4);
}

TEST_CASE("delayed relay: decisions with dead zone and hysteresis are those of the relay") {
  const auto slow = delayed(1.0, 0.5, 0.1, 0.5);
  const auto quick = relay(1.0, 0.1, 0.5);
  std::vector<double> z(15), none;
  Mode mode = slow.start({0.0, 0.0, 0.0}, z);
  CHECK(mode == Mode{});
  double g[3], same[2];
  for (const double x : {-0.7, 0.3, 0.55}) {
    slow.guard({x, 0.0, 0.0}, mode, z, g);
    quick.guard({x, 0.0, 0.0}, {0}, none, same);
    CHECK(g[0] == same[0]);
    CHECK(g[1] == same[1]);
  }
  mode = slow.next({0.6, 0.0, 0.0}, mode, z, 0);  // on
  CHECK(slow.output({}, mode, z) == 0.0);
  REQUIRE(slow.guards(mode) == 2);
  slow.guard({0.55, 0.0, 0.0}, mode, z, g);
  CHECK(g[0] == Approx(0.15));  // off at 0.4
  CHECK(g[1] == 0.5);
  mode = slow.next({0.4, 0.0, 0.0}, mode, z, 0);  // off again, before the first decision came out
  CHECK(slow.guards(mode) == 3);
  z[0] = 0.0;
  mode = slow.next({0.0, 0.0, 0.0}, mode, z, 2);
  CHECK(slow.output({}, mode, z) == 1.0);
  CHECK(z[0] == 0.5);
  mode = slow.next({0.0, 0.0, 0.0}, mode, z, 2);
  CHECK(slow.output({}, mode, z) == 0.0);
  CHECK(slow.guards(mode) == 2);
  CHECK(slow.start({0.61, 0.0, 0.0}, z) == slow.mirror(slow.start({-0.61, 0.0, 0.0}, z)));
}

TEST_CASE("delayed relay: what does not fit into its queue makes its state NaN, never wrong") {
  const auto element = delayed(1.0, 1.0);
  std::vector<double> z(15);
  Mode mode = element.start({1.0, 0.0, 0.0}, z);
  for (int i = 0; i < 15; ++i) {
    mode = element.next({}, mode, z, 0);
    CHECK(z[static_cast<std::size_t>(i)] == 1.0);
  }
  element.next({}, mode, z, 0);
  for (const double timer : z) CHECK(std::isnan(timer));
}

TEST_CASE("delayed relay in front of K/(T s + 1): half period T ln(2 exp(L/T) - 1), amplitude K d (1 - exp(-L/T))") {
  const double K = 3.0, T = 0.7, L = 1.1, d = 2.0;  // claim B2
  const auto element = delayed(d, L);
  std::vector<double> z(15);
  double y = 0.4, t = 0.0, peak = 0.0, last = 0.0, half = 0.0;
  Mode mode = element.start({-y, 0.0, 0.0}, z);
  for (int event = 0; event < 60; ++event) {
    const auto queue = DelayedRelay<double>::Queue::of(mode);
    const double target = K * element.output({}, mode, z);
    const double to_zero = y / target < 0.0 ? T * std::log(1.0 - y / target) : infinite;
    const double to_switch = queue.count > 0 ? z[0] : infinite;
    const double h = std::min(to_zero, to_switch);
    REQUIRE(std::isfinite(h));
    y = to_zero < to_switch ? 0.0 : target + (y - target) * std::exp(-h / T);
    t += h;
    for (int k = 0; k < queue.count; ++k) z[static_cast<std::size_t>(k)] -= h;
    const bool decides = to_zero < to_switch;
    mode = element.next({-y, 0.0, 0.0}, mode, z, decides ? 0 : element.guards(mode) - 1);
    if (decides) {
      half = t - last;
      last = t;
    } else {
      peak = std::abs(y);
    }
  }
  CHECK(half == Approx(T * std::log(2.0 * std::exp(L / T) - 1.0)).epsilon(1e-12));
  CHECK(peak == Approx(K * d * (1.0 - std::exp(-L / T))).epsilon(1e-12));
}

TEST_CASE("delayed relay: its describing function is the relay's, turned by the delay") {
  const Complex expected = *relay(1.0, 0.2).exact_describing_function(1.5, 3.0, 0.0) * std::exp(Complex(0.0, -1.2));
  CHECK(std::abs(*delayed(1.0, 0.4, 0.2).exact_describing_function(1.5, 3.0, 0.0) - expected) < 1e-15);
  CHECK_FALSE(delayed(1.0, 0.4, 0.2).exact_describing_function(0.1, 3.0, 0.0));
}
