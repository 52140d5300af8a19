// Roots of 1 + N(A, w) G(jw) = 0 for loops whose roots are known in closed form.
#include "limcycle/analysis/frequency/roots/root_search.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

using namespace limcycle;
using Complex = std::complex<double>;
using std::numbers::pi;

namespace {

const Complex j(0.0, 1.0);
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const SearchBox default_box{1e-3, 1e3, 1e-2, 1e2};

Complex three_lags(double w) { return 1.0 / std::pow(1.0 + j * w, 3); }
double relay(double A) { return 4.0 / (pi * A); }
// slope 1, limit 1
double saturation(double A) {
  if (A <= 1.0) return 1.0;
  return 2.0 / pi * (std::asin(1.0 / A) + std::sqrt(1.0 - 1.0 / (A * A)) / A);
}
double relay_with_dead_zone(double A, double level, double d) {
  return A <= d ? 0.0 : 4.0 * level / (pi * A) * std::sqrt(1.0 - d * d / (A * A));
}

template <typename Gain, typename Response>
LoopEquation loop(Gain gain, Response response) {
  return [=](double A, double w, double) -> Complex { return 1.0 + gain(A) * response(w); };
}

// Amplitude (> 1) at which the saturation has the gain n, by bisection.
double saturation_amplitude(double n) {
  double low = 1.0, high = 1e9;
  for (int k = 0; k < 200; ++k) {
    const double middle = std::sqrt(low * high);
    (saturation(middle) > n ? low : high) = middle;
  }
  return low;
}

void check_root(const Root& root, double amplitude, double frequency, int index) {
  CHECK(root.amplitude == Approx(amplitude).epsilon(1e-11));
  CHECK(root.frequency == Approx(frequency).epsilon(1e-11));
  CHECK(root.residual < 1e-9);
  CHECK(root.index == index);
  CHECK(root.jacobian_determinant * index > 0.0);
}

void check_consistent(const RootSearch& found, Status status) {
  CHECK(to_string(found.status) == to_string(status));
  CHECK(found.winding_number == found.index_sum);
  CHECK(found.near_misses.empty());
}

}  // namespace

TEST_CASE("relay with three lags: one stable cycle", "[root_search]") {
  const auto found = find_roots(loop(relay, three_lags), default_box);
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  check_root(found.roots[0], 1.0 / (2.0 * pi), std::sqrt(3.0), 1);
  // U + jV = 1 + N G, N ~ 1/A: dF/dlnA = 1, dF/dlnw = -w G'/G = 3 j w / (1 + j w)
  CHECK(found.roots[0].jacobian_determinant == Approx(3.0 * std::sqrt(3.0) / 4.0).epsilon(1e-6));
  CHECK(found.evaluations < 4000);
}

TEST_CASE("relay with an integrator and two lags", "[root_search]") {
  const auto plant = [](double w) { return 1.0 / (j * w * std::pow(1.0 + j * w, 2)); };
  const auto found = find_roots(loop(relay, plant), default_box);
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  check_root(found.roots[0], 2.0 / pi, 1.0, 1);
  CHECK(found.evaluations < 4000);
}

TEST_CASE("cubic element with three lags: one unstable cycle", "[root_search]") {
  const double c = 2.0;
  const auto found = find_roots(loop([=](double A) { return 0.75 * c * A * A; }, three_lags), default_box);
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  check_root(found.roots[0], std::sqrt(32.0 / (3.0 * c)), std::sqrt(3.0), -1);
  CHECK(found.evaluations < 4000);
}

TEST_CASE("saturation with a plant that is stable for some gains only: two cycles", "[root_search]") {
  // K (s+1)^2 / (s^3 (tau s + 1)^2) has phase -pi where tau w^2 - (1 - tau) w + 1 = 0
  const double tau = 0.02, K = 200.0;
  const auto plant = [=](double w) {
    return K * std::pow(1.0 + j * w, 2) / (std::pow(j * w, 3) * std::pow(1.0 + j * tau * w, 2));
  };
  const auto found = find_roots(loop(saturation, plant), {0.1, 1e4, 1e-2, 1e3});
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 2);
  const double b = 1.0 - tau, root = std::sqrt(b * b - 4.0 * tau);
  const double w_low = (b - root) / (2.0 * tau), w_high = (b + root) / (2.0 * tau);
  check_root(found.roots[0], saturation_amplitude(1.0 / std::abs(plant(w_low))), w_low, -1);
  check_root(found.roots[1], saturation_amplitude(1.0 / std::abs(plant(w_high))), w_high, 1);
  CHECK(found.index_sum == 0);
  CHECK(found.evaluations < 4000);
}

TEST_CASE("relay with an integrator and a delay: several cycles", "[root_search]") {
  // e^{-jw} / (jw): w = pi/2 + 2 pi k, A = 4 / (pi w)
  const auto plant = [](double w) { return std::exp(-j * w) / (j * w); };
  const auto found = find_roots(loop(relay, plant), {1e-2, 1e1, 0.1, 40.0});
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 7);
  for (int k = 0; k < 7; ++k) {
    const double w = pi / 2.0 + 2.0 * pi * k;
    check_root(found.roots[static_cast<std::size_t>(k)], 4.0 / (pi * w), w, 1);
  }
}

TEST_CASE("no cycle where the loop has none", "[root_search]") {
  const auto plant = [](double w) { return 1.0 / std::pow(1.0 + j * w, 2); };
  const auto found = find_roots(loop(relay, plant), default_box);
  check_consistent(found, Status::no_cycle);
  CHECK(found.roots.empty());
  CHECK(found.evaluations < 6000);
}

TEST_CASE("parts known to have no root are not sampled, and change no other") {
  const auto plant = [](double w) { return 1.0 / (j * w * std::pow(1.0 + j * w, 2)); };
  const auto all = find_roots(loop(relay, plant), default_box);
  // |N G| < 1 beyond A = 4/(pi |w|), G being at most 1/w.
  RootSearchOptions options;
  options.rootless = [](const SearchBox& part) { return 4.0 / (pi * part.amplitude_min * part.frequency_min) < 1.0; };
  const auto rest = find_roots(loop(relay, plant), default_box, options);
  check_consistent(rest, Status::converged);
  REQUIRE(rest.roots.size() == 1);
  CHECK(rest.roots[0].amplitude == Approx(all.roots[0].amplitude).epsilon(1e-12));
  CHECK(5 * rest.evaluations < 4 * all.evaluations);
  options.rootless = [](const SearchBox&) { return true; };
  const auto none = find_roots(loop(relay, plant), default_box, options);
  check_consistent(none, Status::no_cycle);
}

TEST_CASE("a phase that only tends to -pi gives a long valley and no root", "[root_search]") {
  // phase -pi + atan(w) - atan(w/10): the distance from zero falls to 1e-6 with the frequency
  const auto plant = [](double w) { return -(1.0 + j * w) / (w * w * (1.0 + 0.1 * j * w)); };
  const auto found = find_roots(loop(saturation, plant), {1e-2, 1e14, 1e-6, 1e2});
  check_consistent(found, Status::no_cycle);
  CHECK(found.evaluations < 10000);
}

TEST_CASE("relay with dead zone: a pair of cycles, also just before it vanishes", "[root_search]") {
  // N = 8 where x (1 - x) = 4 pi^2 d^2 / level^2 with x = (d/A)^2
  const double d = 0.1;
  const double separation = GENERATE(0.7, 1e-2, 3e-4, 1e-4, 1e-5);
  const double level = 4.0 * pi * d / std::sqrt(1.0 - separation * separation);
  const auto found =
      find_roots(loop([=](double A) { return relay_with_dead_zone(A, level, d); }, three_lags), default_box);
  check_consistent(found, Status::converged);
  CHECK(found.index_sum == 0);
  REQUIRE(found.roots.size() == 2);
  const bool ordered = found.roots[0].amplitude < found.roots[1].amplitude;
  const Root& small = found.roots[ordered ? 0 : 1];
  const Root& large = found.roots[ordered ? 1 : 0];
  // the amplitude is known to (rounding of f) / separation
  const double tolerance = 1e-14 / separation + 1e-12;
  CHECK(small.amplitude == Approx(d / std::sqrt(0.5 * (1.0 + separation))).epsilon(tolerance));
  CHECK(large.amplitude == Approx(d / std::sqrt(0.5 * (1.0 - separation))).epsilon(tolerance));
  CHECK(small.frequency == Approx(std::sqrt(3.0)).epsilon(tolerance));
  CHECK(small.index == -1);
  CHECK(large.index == 1);
  CHECK(found.evaluations < 6000);
}

TEST_CASE("relay with dead zone: no root just after the pair has vanished", "[root_search]") {
  const double d = 0.1;
  const double beyond = GENERATE(0.5, 1e-2, 3e-4, 1e-4, 1e-5);
  const double level = 4.0 * pi * d / std::sqrt(1.0 + beyond * beyond);
  const auto found =
      find_roots(loop([=](double A) { return relay_with_dead_zone(A, level, d); }, three_lags), default_box);
  CHECK(found.roots.empty());
  check_consistent(found, Status::no_cycle);
  CHECK(found.evaluations < 6000);
}

TEST_CASE("hysteretic relay: undefined below the half-width", "[root_search]") {
  // with 1/(s+1)^2: choose w, then A = 4 / (pi (1 + w^2)), h = 2 w A / (1 + w^2); w -> 1 brings the root to A = h
  const double w = GENERATE(3.0, 1.5, 1.05, 1.001);
  const bool with_hint = GENERATE(false, true);
  const double amplitude = 4.0 / (pi * (1.0 + w * w)), h = 2.0 * w * amplitude / (1.0 + w * w);
  const LoopEquation f = [=](double A, double frequency, double) -> Complex {
    if (A < h) return {not_a_number, not_a_number};
    return 1.0 + relay(A) * std::exp(-j * std::asin(h / A)) / std::pow(1.0 + j * frequency, 2);
  };
  RootSearchOptions options;
  if (with_hint) options.amplitude_hints = {h};
  const auto found = find_roots(f, default_box, options);
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  CHECK(found.roots[0].amplitude == Approx(amplitude).epsilon(1e-9));
  CHECK(found.roots[0].frequency == Approx(w).epsilon(1e-9));
  CHECK(found.roots[0].index == 1);
  CHECK(found.evaluations < 8000);
}

TEST_CASE("box of 12 decades of amplitude and 8 of frequency", "[root_search]") {
  const auto found = find_roots(loop(relay, three_lags), {1e-8, 1e4, 1e-4, 1e4});
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  check_root(found.roots[0], 1.0 / (2.0 * pi), std::sqrt(3.0), 1);
  CHECK(found.evaluations < 4000);
}

TEST_CASE("lightly damped resonances found through hints", "[root_search]") {
  // K / ((s^2/w0^2 + 2 zeta s/w0 + 1)(tau s + 1)): phase -pi at w^2 = w0^2 + 2 zeta w0 / tau
  const double zeta = GENERATE(1e-3, 1e-4), w0 = GENERATE(1.0, 37.0);
  const double tau = 1.0 / w0, K = 10.0 * zeta;
  const auto plant = [=](double w) {
    return K / ((1.0 - w * w / (w0 * w0) + 2.0 * zeta * j * w / w0) * (1.0 + j * tau * w));
  };
  const double w = w0 * std::sqrt(1.0 + 2.0 * zeta);
  RootSearchOptions options;
  options.frequency_hints = {w0};
  const auto found = find_roots(loop(saturation, plant), {1e-3, 1e4, 1e-3, 1e4}, options);
  check_consistent(found, Status::converged);
  REQUIRE(found.roots.size() == 1);
  CHECK(found.roots[0].amplitude == Approx(saturation_amplitude(1.0 / std::abs(plant(w)))).epsilon(1e-9));
  CHECK(found.roots[0].frequency == Approx(w).epsilon(1e-11));
  CHECK(found.roots[0].index == 1);
  CHECK(found.evaluations < 6000);
}

TEST_CASE("undamped resonance: the hint is a pole", "[root_search]") {
  // 1 / ((s^2 + 1)(s/10 + 1)) is infinite at w = 1 and has phase -pi nowhere else
  const auto plant = [](double w) { return 0.1 / ((1.0 - w * w) * (1.0 + 0.1 * j * w)); };
  RootSearchOptions options;
  options.frequency_hints = {1.0};
  const auto found = find_roots(loop(saturation, plant), default_box, options);
  CHECK(found.roots.empty());
  CHECK(found.evaluations < 20000);
}

TEST_CASE("bad input of the root search is refused and quoted", "[root_search]") {
  const LoopEquation f = loop(relay, three_lags);
  const auto refuses = [&](auto change, const char* quoted) {
    RootSearchOptions options;
    change(options);
    CHECK_THROWS_WITH(find_roots(f, default_box, options), Catch::Contains(quoted));
    CHECK_THROWS_AS(validate(options), std::invalid_argument);
  };
  refuses([](auto& o) { o.initial_cells_amplitude = 0; }, "not 0");
  refuses([](auto& o) { o.initial_cells_frequency = -7; }, "-7");
  refuses([](auto& o) { o.max_depth = 41; }, "41");
  refuses([](auto& o) { o.max_border_depth = 30; }, "30");
  refuses([](auto& o) { o.max_evaluations = -5; }, "-5");
  refuses([](auto& o) { o.residual = not_a_number; }, "nan");
  refuses([](auto& o) { o.fine_accuracy = 1e-17; }, "1e-17");
  refuses([](auto& o) { o.coarse_accuracy = 1e-13; }, "1e-13");
  refuses([](auto& o) { o.frequency_hints = {1.0, -2.5}; }, "-2.5");
  refuses([](auto& o) { o.amplitude_hints = {not_a_number}; }, "nan");
  CHECK_THROWS_WITH(find_roots(f, {-0.125, 1.0, 1.0, 2.0}), Catch::Contains("-0.125"));
  CHECK_THROWS_WITH(find_roots(f, {0.1, 1.0, 4.5, 2.5}), Catch::Contains("4.5") && Catch::Contains("2.5"));
  CHECK_THROWS_AS(find_roots(f, {0.1, not_a_number, 1.0, 2.0}), std::invalid_argument);
}
