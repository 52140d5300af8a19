#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/law_march.hpp"

// Every friction law on every scalar: the same values, and derivatives that agree with differences.
using namespace limcycle;
using namespace limcycle::test;

namespace {

struct Point {
  Input<double> in;
  Mode mode;
  std::vector<double> z;
  int fired = -1;  ///< guard that switches here
};

/// Points on a motion of the law through pre-sliding, sliding and reversals. A law that needs the applied force is
/// evaluated at inputs of any kind in the resulting modes.
template <class Law>
std::vector<Point> points_of(const Law& law, const Sample& sample) {
  std::vector<Point> points;
  const double own = law.scales().displacement, L = own < infinite ? own : 1e-4;
  const double v = std::min(law.scales().velocity, 1e-3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  if (drive_band(law) > 0.0) {
    if constexpr (HasModes<Law, double>) {
      for (int k = 0; k < 60; ++k) {
        std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
        const Input<double> in{0.0, 3.0 * drive_band(law) * u(random), 2.0 * sample.level * u(random)};
        points.push_back({in, law.start(in, z), z});
      }
    }
    return points;
  }
  LawMarch march(law, {0.05 * L, 0.2 * v, 0.1 * sample.fastest});
  long seen = 0;
  march.watch = [&](const Input<double>& in, Mode mode, const std::vector<double>& z) {
    if (++seen % 13 == 0) points.push_back({in, mode, z});
  };
  march.switching = [&](const Input<double>& in, Mode mode, const std::vector<double>& z, int fired) {
    points.push_back({in, mode, z, fired});
  };
  for (const double x : {0.5, 0.1, 4.0, 3.0, 3.4, -2.0}) march.glide(x * L, std::abs(x * L - march.x()) / (2.0 * v));
  if (points.size() > 100) {
    std::ranges::shuffle(points, random);
    points.resize(100);
  }
  return points;
}

/// All values of a law at one point: output, rates, guards, and the state after a switch.
template <class S, class Law>
std::vector<S> sayings(const Law& law, const Input<S>& in, const Point& at, std::vector<S> z) {
  std::vector<S> all{law.output(in, at.mode, z)};
  std::vector<S> rates(z.size());
  law.rate(in, at.mode, z, rates);
  all.insert(all.end(), rates.begin(), rates.end());
  if constexpr (HasModes<Law, S>) {
    std::vector<S> guards(static_cast<std::size_t>(law.guards(at.mode)));
    law.guard(in, at.mode, z, guards);
    all.insert(all.end(), guards.begin(), guards.end());
    if (at.fired >= 0) {
      law.next(in, at.mode, std::span<S>(z), at.fired);
      all.insert(all.end(), z.begin(), z.end());
    }
  }
  return all;
}

bool near(double a, double b, double tolerance, double floor) {
  return a == b || std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b)) + floor;
}

/// Compares derivatives with differences. Where those to both sides, over two distances, disagree, there is a kink or
/// too much curvature for a comparison.
struct Comparison {
  long same = 0, kinks = 0, wrong = 0;
  double worst_got = 0.0, worst_expected = 0.0;

  /// `all` gives the values at a distance from the point, `got` their derivatives by it there; `size`: of value i.
  void add(const std::vector<double>& got, double shift, auto&& all, auto&& size) {
    const auto here = all(0.0), low = all(-shift), high = all(shift), near_low = all(-0.25 * shift),
               near_high = all(0.25 * shift);
    for (std::size_t i = 0; i < got.size(); ++i) {
      const double left = (here[i] - low[i]) / shift, right = (high[i] - here[i]) / shift;
      const double closer = (near_high[i] - near_low[i]) / (0.5 * shift);
      if (!std::isfinite(left) || !std::isfinite(right)) continue;
      const double rounding = 1e-12 * std::max({size(i), std::abs(here[i]), std::abs(low[i])}) / shift;
      if (!near(left, right, 1e-3, rounding) || !near(closer, left, 1e-3, rounding)) {
        ++kinks;
      } else if (near(got[i], closer, 1e-3, rounding)) {
        ++same;
      } else {
        ++wrong;
        worst_got = got[i], worst_expected = closer;
      }
    }
  }
};

/// Sizes of the values of sayings(): forces, then rates and guards.
template <class Law>
double size_of(const Law& law, const Sample& sample, const Point& at, std::size_t i) {
  return i == 0 ? sample.level : std::abs(at.in.v) + 1e-3 * std::min(law.scales().velocity, 1e-3);
}

}  // namespace

TEST_CASE("friction laws: double and dual numbers have the same values and the same switches") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      const auto one = recast<Kind, Dual<1>>(law);
      const auto four = recast<Kind, Dual<4>>(law);
      CHECK(one.states() == law.states());
      long wrong = 0;
      const auto points = points_of(law, sample);
      CHECK(points.size() >= 20);
      for (const Point& at : points) {
        const auto compare = [&]<class S>(const auto& dual, S) {
          const Input<S> in{S(at.in.x), S(at.in.v), S(at.in.drive)};
          std::vector<S> z(at.z.begin(), at.z.end());
          const auto expected = sayings<double>(law, at.in, at, at.z);
          const auto got = sayings<S>(dual, in, at, z);
          for (std::size_t i = 0; i < got.size(); ++i)
            if (!near(value_of(got[i]), expected[i], 1e-14, 0.0)) ++wrong;
          if constexpr (HasModes<Kind<double>, double>) {
            std::vector<double> plain = at.z;
            if (at.fired >= 0 && !(dual.next(in, at.mode, std::span<S>(z), at.fired) ==
                                   law.next(at.in, at.mode, std::span<double>(plain), at.fired)))
              ++wrong;
          }
        };
        compare(one, Dual<1>{});
        compare(four, Dual<4>{});
      }
      CHECK(wrong == 0);
    });
  });
}

TEST_CASE("friction laws: derivatives by rate, drive and state are those of differences") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      using S = Dual<4>;
      const auto dual = recast<Kind, S>(law);
      const double v_scale = std::min(law.scales().velocity, 1e-3);
      const auto n = static_cast<std::size_t>(law.states());
      Comparison comparison;
      for (const Point& at : points_of(law, sample)) {
        Input<S> in{S(at.in.x), S::variable(at.in.v, 0), S(at.in.drive)};
        const bool driven = std::isfinite(at.in.drive);
        if (driven) in.drive = S::variable(at.in.drive, 3);
        std::vector<S> z(at.z.begin(), at.z.end());
        if (n > 0) z[0].d[1] = 1.0;
        if (n > 1) z[n - 1].d[2] = 1.0;
        const auto got = sayings<S>(dual, in, at, z);
        const auto along = [&](std::size_t which, double shift, auto&& shifted) {
          std::vector<double> slopes;
          for (const S& value : got) slopes.push_back(value.d[which]);
          const auto all = [&](double by) {
            Point there = at;
            shifted(there, by);
            return sayings<double>(law, there.in, there, there.z);
          };
          comparison.add(slopes, shift, all, [&](std::size_t i) { return size_of(law, sample, at, i); });
        };
        if (std::abs(at.in.v) > 1e-3 * v_scale)
          along(0, 1e-5 * std::abs(at.in.v), [](Point& p, double by) { p.in.v += by; });
        const auto shift = [&](std::size_t i) { return 1e-5 * law.state_scale(static_cast<int>(i)); };
        if (n > 0) along(1, shift(0), [](Point& p, double by) { p.z.front() += by; });
        if (n > 1) along(2, shift(n - 1), [](Point& p, double by) { p.z.back() += by; });
        if (driven) along(3, 1e-5 * sample.level, [](Point& p, double by) { p.in.drive += by; });
      }
      INFO(comparison.wrong << " wrong, as " << comparison.worst_got << " instead of " << comparison.worst_expected);
      CHECK(comparison.wrong == 0);
      CHECK(comparison.same > 3 * comparison.kinks);
    });
  });
}

TEST_CASE("friction laws: derivatives by every parameter are those of differences") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      using S = Dual<1>;
      const auto points = points_of(law, sample);
      const auto table = Kind<double>::parameters();
      const auto dual_table = Kind<S>::parameters();
      // The number, or the first entry of the list, in row `row` of a table; null for anything else.
      const auto number = []<class T>(auto& owner, const auto& parameter, T) -> T* {
        using Owner = std::decay_t<decltype(owner)>;
        if (const auto* member = std::get_if<T Owner::*>(&parameter.member)) return &(owner.*(*member));
        if (const auto* list = std::get_if<std::vector<T> Owner::*>(&parameter.member))
          if (!(owner.*(*list)).empty()) return &(owner.*(*list)).front();
        return nullptr;
      };
      for (std::size_t row = 0; row < table.size(); ++row) {
        INFO(Kind<double>::kind << ", " << sample.name << ", " << table[row].key);
        Kind<double> changed = law;
        double* value = number(changed, table[row], 0.0);
        if (!value || *value == 0.0) continue;
        const double here = *value, shift = 1e-6 * std::abs(here);
        bool valid = true;
        for (const double by : {-shift, shift}) {
          *value = here + by;
          valid = valid && !changed.validate();
        }
        if (!valid) continue;  // a whole number, or a value at the end of its range
        auto dual = recast<Kind, S>(law);
        number(dual, dual_table[row], S{})->d[0] = 1.0;
        Comparison comparison;
        for (const Point& at : points) {
          std::vector<double> slopes;
          for (const S& said :
               sayings<S>(dual, {S(at.in.x), S(at.in.v), S(at.in.drive)}, at, std::vector<S>(at.z.begin(), at.z.end())))
            slopes.push_back(said.d[0]);
          const auto all = [&](double by) {
            *value = here + by;
            return sayings<double>(changed, at.in, at, at.z);
          };
          comparison.add(slopes, shift, all, [&](std::size_t i) { return size_of(law, sample, at, i); });
        }
        INFO(comparison.wrong << " wrong, as " << comparison.worst_got << " instead of " << comparison.worst_expected);
        CHECK(comparison.wrong == 0);
        CHECK(comparison.same > comparison.kinks);
      }
    });
  });
}
