// Roots of made-up functions of p = ln A, q = ln w: near folds, tangencies, many roots, noise, edges, limits of cost.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"

using namespace limcycle;
using Complex = std::complex<double>;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const SearchBox unit_box{std::exp(-3.0), std::exp(3.0), std::exp(-2.0), std::exp(2.0)};

struct Known {
  double p, q;
  int index;
};

template <typename Function>
LoopEquation in_logarithms(Function f) {
  return [=](double A, double w, double) -> Complex { return f(std::log(A), std::log(w)); };
}

// Each known root is found once, nothing else is.
void check_roots(const RootSearch& found, const std::vector<Known>& expected, double tolerance) {
  CHECK(to_string(found.status) == (expected.empty() ? "no_cycle" : "converged"));
  CHECK(found.winding_number == found.index_sum);
  CHECK(found.roots.size() == expected.size());
  int sum = 0;
  for (const Known& known : expected) {
    sum += known.index;
    int hits = 0;
    for (const Root& root : found.roots) {
      const double p = std::log(root.amplitude), q = std::log(root.frequency);
      hits += std::hypot(p - known.p, q - known.q) < tolerance && root.index == known.index ? 1 : 0;
    }
    INFO("root at " << known.p << ", " << known.q);
    CHECK(hits == 1);
  }
  CHECK(found.index_sum == sum);
  for (const Root& root : found.roots) CHECK(root.residual < 1e-9);
}

// x^2 - eps2 + i y with (x, y) turned by an angle, bent and multiplied by a matrix of condition 20.
struct Fold {
  double a, b, angle, bend, eps2;

  Complex operator()(double p, double q) const {
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = c * (p - a) + s * (q - b), y = -s * (p - a) + c * (q - b) + bend * x * x;
    const double f1 = x * x - eps2;
    return {f1 + 0.9 * y, 0.5 * f1 + 5.0 * y};
  }
  std::vector<Known> roots() const {
    std::vector<Known> out;
    if (eps2 <= 0.0) return out;
    for (const int side : {-1, 1}) {
      const double x = side * std::sqrt(eps2), y = -bend * x * x;
      out.push_back(
          {a + std::cos(angle) * x - std::sin(angle) * y, b + std::sin(angle) * x + std::cos(angle) * y, side});
    }
    return out;
  }
};

// A relative error of N of the requested size, different at each point (and repeatable).
template <typename Function>
LoopEquation with_noise(Function f) {
  return [=](double A, double w, double accuracy) -> Complex {
    std::uint64_t bits = 0, more = 0;
    std::memcpy(&bits, &A, sizeof A);
    std::memcpy(&more, &w, sizeof w);
    std::mt19937_64 generator(bits ^ (more * 0x9e3779b97f4a7c15U));
    const double size = 2.0 * static_cast<double>(generator() >> 11U) / 9007199254740992.0 - 1.0;
    return 1.0 + (f(std::log(A), std::log(w)) - 1.0) * (1.0 + accuracy * size);
  };
}

}  // namespace

TEST_CASE("near folds of every kind are resolved", "[root_search]") {
  const double separation = GENERATE(3e-4, 1e-4, 1e-5);
  const double angle = GENERATE(0.0, 0.4, 0.785398163397, 2.0);
  const double bend = GENERATE(0.0, 2.0);
  const Fold fold{0.3171, -0.2213, angle, bend, 0.25 * separation * separation};
  RootSearchOptions options;
  if (separation < 5e-5) options.fine_accuracy = 1e-14;  // |f| between the pair is 1e-11
  const auto found = find_roots(in_logarithms(fold), unit_box, options);
  INFO("separation " << separation << ", angle " << angle << ", bend " << bend);
  check_roots(found, fold.roots(), 0.05 * separation);
  CHECK(found.evaluations < 8000);
}

TEST_CASE("a pair at the limit of the accuracy is resolved or flagged", "[root_search]") {
  const double separation = GENERATE(1e-5, 5e-6, 2e-6, 1e-6);
  const double angle = GENERATE(0.0, 0.4, 2.0);
  const Fold fold{0.3171, -0.2213, angle, 2.0, 0.25 * separation * separation};
  const auto found = find_roots(in_logarithms(fold), unit_box);
  INFO("separation " << separation << ", angle " << angle);
  if (found.status == Status::converged) {
    check_roots(found, fold.roots(), 0.05 * separation);
  } else {
    CHECK(to_string(found.status) == "incomplete");
    CHECK_FALSE(found.near_misses.empty());
  }
}

TEST_CASE("a near miss is not a root", "[root_search]") {
  const double distance = GENERATE(3e-4, 1e-4, 1e-5);
  const double angle = GENERATE(0.0, 0.4, 2.0);
  const Fold fold{0.3171, -0.2213, angle, 2.0, -0.25 * distance * distance};
  RootSearchOptions options;
  if (distance < 5e-5) options.fine_accuracy = 1e-14;
  const auto found = find_roots(in_logarithms(fold), unit_box, options);
  check_roots(found, {}, 0.0);
  CHECK(found.evaluations < 8000);
}

TEST_CASE("a double root is reported as a near miss, never as an answer", "[root_search]") {
  const Fold fold{0.3171, -0.2213, GENERATE(0.0, 0.4), 1.0, GENERATE(0.0, 1e-14, -1e-14)};
  const auto found = find_roots(in_logarithms(fold), unit_box);
  CHECK(found.roots.empty());
  CHECK(to_string(found.status) == "incomplete");
  REQUIRE_FALSE(found.near_misses.empty());
  for (const NearMiss& miss : found.near_misses) {
    CHECK(std::log(miss.amplitude) == Approx(fold.a).margin(1e-4));
    CHECK(std::log(miss.frequency) == Approx(fold.b).margin(1e-4));
    CHECK(miss.residual < 1e-5);
  }
  CHECK(found.evaluations < 8000);
}

TEST_CASE("the accuracy that is asked for follows what must be resolved", "[root_search]") {
  const double separation = GENERATE(3e-4, 1e-4, 2e-5);
  const int sign = GENERATE(1, -1);
  const Fold fold{0.3171, -0.2213, 0.4, 1.0, 0.25 * sign * separation * separation};
  const auto found = find_roots(with_noise(fold), unit_box);
  check_roots(found, fold.roots(), 0.05 * separation);
  CHECK(found.evaluations < 10000);
}

TEST_CASE("random products of known roots of both indices", "[root_search]") {
  // (Z - z_k) has index +1, its conjugate -1; the factor in front is smooth and has no zero
  long evaluations = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const int count = static_cast<int>(generator() % 7);
    const double spread = seed % 3 == 0 ? 0.05 : 1.0;  // every third configuration is crowded
    std::vector<Known> known;
    for (int k = 0; k < count; ++k) {
      known.push_back(
          {2.5 * spread * uniform(generator), 1.5 * spread * uniform(generator), generator() % 2 == 0 ? 1 : -1});
    }
    const double a = uniform(generator), b = uniform(generator), c = 3.0 * uniform(generator);
    const auto f = [=](double p, double q) {
      Complex product = std::exp(Complex(a * p + b * q, c + std::sin(a * q - b * p)));
      for (const Known& root : known) {
        const Complex factor(p - root.p, q - root.q);
        product *= root.index > 0 ? factor : std::conj(factor);
      }
      return product;
    };
    INFO("seed " << seed);
    const auto found = find_roots(in_logarithms(f), unit_box);
    check_roots(found, known, 1e-8);
    evaluations += found.evaluations;
  }
  CHECK(evaluations / 300 < 5000);
}

TEST_CASE("roots on lines of the grid, on the edge and in the corner of the box", "[root_search]") {
  // 12 blocks: block lines at multiples of 0.5 and 1/3, with the corner (0, 0)
  const double p = GENERATE(-3.0, 0.0, 0.25, 0.5, 1.0, 3.0), q = GENERATE(-2.0, 0.0, 1.0 / 3.0, 2.0);
  const int index = GENERATE(1, -1);
  const auto f = [=](double x, double y) {
    return Complex((x - p) + 0.2 * (y - q) * (y - q), index * (y - q) * (1.0 + 0.1 * (y - q) * (y - q)));
  };
  INFO("root at " << p << ", " << q);
  const auto found = find_roots(in_logarithms(f), unit_box);
  check_roots(found, {{p, q, index}}, 1e-9);
  CHECK(found.evaluations < 5000);
}

TEST_CASE("a root outside the box is not reported", "[root_search]") {
  const double outside = GENERATE(1e-2, 1e-5, 1e-8);
  const auto f = [=](double x, double y) { return Complex(x - 3.0 - outside, y - 0.1); };
  check_roots(find_roots(in_logarithms(f), unit_box), {}, 0.0);
}

TEST_CASE("the answer does not depend on the size of the initial grid", "[root_search]") {
  RootSearchOptions options;
  options.initial_cells_amplitude = GENERATE(5, 8, 50);
  options.initial_cells_frequency = GENERATE(6, 24);
  const Fold fold{0.3171, -0.2213, 0.4, 1.0, 1e-8};
  check_roots(find_roots(in_logarithms(fold), unit_box, options), fold.roots(), 1e-6);
}

TEST_CASE("a curve of roots ends as incomplete at a bounded cost", "[root_search]") {
  const auto found = find_roots(in_logarithms([](double p, double q) { return Complex(p + 0.3 * q, 0.0); }), unit_box);
  CHECK(to_string(found.status) == "incomplete");
  CHECK(found.roots.empty());
  CHECK(found.evaluations < 10000);
}

TEST_CASE("function that is undefined in part or everywhere", "[root_search]") {
  const auto nowhere =
      find_roots(in_logarithms([](double, double) { return Complex(not_a_number, not_a_number); }), unit_box);
  CHECK(to_string(nowhere.status) == "not_finite");
  CHECK(nowhere.roots.empty());

  // an oblique border 0.02 away from the root, then beyond it
  for (const double offset : {0.02, -0.02}) {
    const auto f = [=](double p, double q) {
      return p + 0.5 * q < -offset ? Complex(not_a_number, not_a_number) : Complex(p, q + 0.3 * p * p);
    };
    const auto found = find_roots(in_logarithms(f), unit_box);
    check_roots(found, offset > 0.0 ? std::vector<Known>{{0.0, 0.0, 1}} : std::vector<Known>{}, 1e-9);
    CHECK(found.evaluations < 40000);  // of 200000
  }
}

TEST_CASE("budget, interruption and exceptions of the caller end the search", "[root_search]") {
  const auto f = in_logarithms([](double p, double q) { return Complex(p - 0.1, q + 0.2); });
  RootSearchOptions options;
  options.max_evaluations = 1000;
  const auto cut = find_roots(f, unit_box, options);
  CHECK(to_string(cut.status) == "max_iterations");
  CHECK(cut.evaluations == 1000);

  options = {};
  int asked = 0;
  options.interrupted = [&] { return ++asked > 20; };
  const auto stopped = find_roots(f, unit_box, options);
  CHECK(to_string(stopped.status) == "interrupted");
  CHECK(asked == 21);

  // Called at every evaluation, also in the scan for borders of existence and within a cell.
  for (const long allowed : {0L, 5L, 100L, 1000L}) {
    options = {};
    long evaluated = 0;
    options.stop = [&] { return evaluated >= allowed; };
    const auto left = find_roots(
        [&](double A, double w, double accuracy) {
          ++evaluated;
          return f(A, w, accuracy);
        },
        unit_box, options);
    CHECK(to_string(left.status) == "interrupted");
    CHECK(evaluated == allowed);
    CHECK(left.evaluations == allowed);
  }

  struct Failure {};
  const LoopEquation fails = [&](double A, double w, double accuracy) {
    if (accuracy < 1e-11) throw Failure{};  // only polishing requests that here
    return f(A, w, accuracy);
  };
  CHECK_THROWS_AS(find_roots(fails, unit_box), Failure);
}

TEST_CASE("the same search gives the same bytes", "[root_search]") {
  const Fold fold{0.3171, -0.2213, 0.4, 1.0, 1e-8};
  const auto first = find_roots(in_logarithms(fold), unit_box), second = find_roots(in_logarithms(fold), unit_box);
  REQUIRE(first.roots.size() == 2);
  REQUIRE(second.roots.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(first.roots[k].amplitude == second.roots[k].amplitude);
    CHECK(first.roots[k].frequency == second.roots[k].frequency);
  }
  CHECK(first.roots[0].frequency <= first.roots[1].frequency);
  CHECK(first.evaluations == second.evaluations);
}

TEST_CASE(
    "root search: a jump beside a root is passed over, one across zero is a near miss, neither is bisected forever") {
  std::mt19937 generator(20261127);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int passed = 0, across = 0;
  for (int k = 0; k < 40; ++k) {
    const double a = 0.5 * unit(generator), b = 0.5 * unit(generator), tilt = unit(generator);
    const double c = a + 0.2 * unit(generator), height = 0.02 + 0.1 * std::abs(unit(generator));
    const Complex jump = height * std::polar(1.0, 3.0 * unit(generator)), side(1.0, 0.4 * unit(generator));
    const auto right = [=](double p, double q) { return p > c + tilt * (q - b); };
    const auto smooth = [=](double p, double q) { return Complex(p - a, q - b) * side * (1.0 + 0.1 * p); };
    const auto f = [=](double p, double q) { return smooth(p, q) + (right(p, q) ? jump : 0.0); };
    // The roots of either side, by simple steps on the smooth part.
    std::vector<Known> roots;
    for (const bool wanted : {false, true}) {
      double p = a, q = b;
      for (int i = 0; i < 100; ++i) {
        const Complex step = (smooth(p, q) + (wanted ? jump : 0.0)) / (side * (1.0 + 0.1 * p));
        p -= step.real();
        q -= step.imag();
      }
      if (right(p, q) == wanted) roots.push_back({p, q, 1});
    }
    const RootSearch found = find_roots(in_logarithms(f), unit_box);
    INFO(k << ": height " << height << ", roots " << roots.size());
    CHECK(found.evaluations < 40000);  // of 200000
    CHECK(found.roots.size() == roots.size());
    for (const Known& known : roots)
      CHECK(std::ranges::any_of(found.roots, [&](const Root& root) {
        return std::hypot(std::log(root.amplitude) - known.p, std::log(root.frequency) - known.q) < 1e-8;
      }));
    // With one root on the two sides together the jump does not cross zero.
    CHECK((found.status == Status::converged || found.status == Status::incomplete));
    if (roots.size() == 1) {
      passed += found.status == Status::converged ? 1 : 0;
    } else {
      ++across;
      CHECK(found.status == Status::incomplete);
    }
  }
  CHECK(passed >= 20);
  CHECK(across >= 1);
}
