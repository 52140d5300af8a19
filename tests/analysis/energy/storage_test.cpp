#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/element/element.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/law_march.hpp"

// Energy stored by laws: properties that each of them must have, and the closed form of a stack of return points.
using namespace limcycle;
using namespace limcycle::test;

namespace {

double length(const Element& law) {
  const double own = law.scales().displacement;
  return own < infinite ? own : 1e-4;
}

/// Strokes to and fro, long and short, fast and slow.
void wander(LawMarch<Element>& march, const Sample& sample, unsigned seed) {
  const auto& law = march.law();
  const double speed = law.scales().velocity < infinite ? law.scales().velocity : 1e-3;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  double direction = 1.0;
  for (int stroke = 0; stroke < 12; ++stroke) {
    const double way = length(law) * 0.05 * std::pow(600.0, u(random)), v = speed * 0.01 * std::pow(3000.0, u(random));
    const double longest = sample.slowest > 0.0 ? 10.0 * sample.slowest : infinite;
    if (u(random) < 0.75) direction = -direction;
    march.glide(march.x() + direction * way, std::min(way / v, longest));
  }
}

void for_laws_with_energy(auto&& check) {
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      const Element erased{Element(law)};
      if (!erased.has_storage() || erased.states() == 0) return;
      INFO(Kind<double>::kind << ", " << sample.name);
      const double speed = erased.scales().velocity < infinite ? erased.scales().velocity : 1e-3;
      check(erased, sample, MarchSteps{0.05 * length(erased), 0.2 * speed, 0.1 * sample.fastest});
    });
  });
}

}  // namespace

TEST_CASE("energy of a law: none without history, never negative, does not rise at a switch") {
  int laws = 0;
  for_laws_with_energy([&](const Element& law, const Sample& sample, const MarchSteps& steps) {
    ++laws;
    std::vector<double> rest(static_cast<std::size_t>(law.states()), 0.0);
    const Mode virgin = law.has_modes() ? law.start({0.0, 0.0, infinite}, rest) : Mode{};
    CHECK(law.storage(virgin, rest) == 0.0);
    LawMarch<Element> march(law, steps);
    const double size = law.scales().output * length(law);
    double least = 0.0, rise = 0.0, largest = 0.0;
    march.watch = [&](const Input<double>&, Mode mode, const std::vector<double>& z) {
      least = std::min(least, law.storage(mode, z));
      largest = std::max(largest, law.storage(mode, z));
    };
    march.switching = [&](const Input<double>& in, Mode mode, const std::vector<double>& z, int guard) {
      std::vector<double> after = z;
      const Mode next = law.next(in, mode, std::span<double>(after), guard);
      rise = std::max(rise, law.storage(next, after) - law.storage(mode, z));
    };
    for (unsigned seed = 1; seed <= 2; ++seed) wander(march, sample, seed);
    CHECK(least >= -1e-12 * size);
    CHECK(largest > 1e-3 * size);
    CHECK(rise <= 1e-9 * size);
  });
  CHECK(laws > 30);
}

TEST_CASE("energy of a law: a passive law stores no more than it is supplied with, however it moves") {
  for_laws_with_energy([](const Element& law, const Sample& sample, const MarchSteps& steps) {
    // The energy of a spring to a place is not part of it; other parameters of bouc-wen have another storage function.
    if (!sample.passive || law.follows_position() || sample.name == "beyond the condition") return;
    LawMarch<Element> march(law, steps);
    double worst = 0.0, highest = -infinite;
    march.watch = [&](const Input<double>&, Mode mode, const std::vector<double>& z) {
      const double lost = march.work() - law.storage(mode, z);
      highest = std::max(highest, lost);
      worst = std::max(worst, highest - lost);
    };
    wander(march, sample, 3);
    CHECK(worst <= 1e-5 * sample.level * length(law));
    CHECK(march.work() > 0.0);
  });
}

TEST_CASE("energy of return points is that of the springs of the elements they stand for") {
  // Seven elements of equal force with yields (i - 1/2) Zb/7, once by Masing's rule and once individually.
  const int count = 7;
  std::vector<double> k, W;
  for (int i = 0; i < count; ++i) {
    W.push_back(1.5 / count);
    k.push_back(W.back() / ((i + 0.5) / count * 1e-4));
  }
  const auto iwan = made<Iwan<double>>({{"Fs", 1.5}, {"Zb", 1e-4}, {"curve", "koizumi-shibazaki"}, {"elements", 7.0}});
  const auto springs = made<MaxwellSlip<double>>({{"k", k}, {"W", W}});
  LawMarch<Iwan<double>> stack(iwan, {2e-6, infinite, infinite});
  LawMarch<MaxwellSlip<double>> each(springs, {2e-6, infinite, infinite});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  double gap = 0.0, largest = 0.0;
  for (int stroke = 0; stroke < 60; ++stroke) {
    const double to = (stroke % 10 == 0 ? 4e-4 : 1.5e-4) * u(random);
    stack.slide(to, 1.0);
    each.slide(to, 1.0);
    const double by_stack = iwan.storage(stack.mode(), stack.z()), by_springs = springs.storage(each.mode(), each.z());
    gap = std::max(gap, std::abs(by_stack - by_springs));
    largest = std::max(largest, by_springs);
  }
  CHECK(largest > 3e-5);
  CHECK(gap <= 1e-9 * largest);
}

TEST_CASE("energy of the virgin curves is the integral of way times slope") {
  const auto check = [](auto&& virgin, auto&& energy, double Zb) {
    for (const double u : {0.03, 0.4, 0.95}) {
      double sum = 0.0;
      const int steps = 20'000;
      for (int i = 0; i < steps; ++i) {
        const double a = u * Zb * i / steps, b = u * Zb * (i + 1) / steps;
        sum += 0.5 * (a + b) * (virgin(b) - virgin(a));
      }
      CHECK(energy(u * Zb) == Approx(sum).epsilon(1e-6));
    }
  };
  const std::vector<std::string> curves{"exponential", "hyperbolic", "koizumi-shibazaki", "linear"};
  for (const auto& curve : curves) {
    const auto law = made<Iwan<double>>({{"Fs", 1.5}, {"Zb", 1e-4}, {"curve", curve}});
    std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
    check([&](double way) { return law.virgin(way); },
          [&](double way) {
            z[0] = way;
            return law.storage(Mode{}, z);
          },
          1e-4);
  }
  const std::vector<std::string> branches{"koizumi-shibazaki", "exponential", "rational", "linear"};
  for (const auto& branch : branches) {
    const auto law =
        made<NonDrift<double>>(with(stribeck_set, {{"Zb", 1e-4}, {"sigma", root}, {"tau", 2e-3}, {"branch", branch}}));
    std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
    z.back() = 1.0;
    check(
        [&](double way) {
          z[0] = way;
          return law.output({}, Mode{}, z);
        },
        [&](double way) {
          z[0] = way;
          return law.storage(Mode{}, z);
        },
        1e-4);
  }
  const auto two_point = made<NonDrift<double>>(
      with(stribeck_set, {{"Zb", 1e-4}, {"sigma", root}, {"tau", 2e-3}, {"memory", "two-point"}}));
  CHECK_FALSE(two_point.has_storage());
}
