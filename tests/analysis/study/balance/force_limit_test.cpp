#include "limcycle/analysis/study/balance/force_limit.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/study/balance/loop_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::mt19937_64 numbers(11);  // NOLINT(cert-msc51-cpp): the same loops in every run

double between(double from, double to) {
  return std::exp(std::uniform_real_distribution<double>(std::log(from), std::log(to))(numbers));
}

Loop random_servo(const Element& friction) {
  const double m = between(0.1, 10.0), w = between(0.5, 50.0);
  return loop_of(Mass{m, between(1e-3, 1.0) * m * w, 0.0},
                 pid(m * w * w, between(0.05, 1.0) * m * w * w * w, between(0.5, 3.0) * m * w), friction);
}

/// A part of the box, at most a tenth of its decades long.
SearchBox random_part(const SearchBox& box) {
  const double A = between(box.amplitude_min, box.amplitude_max), w = between(box.frequency_min, box.frequency_max);
  const double longer = std::pow(box.amplitude_max / box.amplitude_min, 0.1);
  const double higher = std::pow(box.frequency_max / box.frequency_min, 0.1);
  return {A, std::min(A * between(1.001, longer), box.amplitude_max), w,
          std::min(w * between(1.001, higher), box.frequency_max)};
}

}  // namespace

TEST_CASE("force limit: |N G| < 1 in every part that it forbids, for every law that states its largest force") {
  int laws = 0, parts = 0, forbidden = 0;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_some_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      const Loop loop = random_servo(law);
      const SearchBox box = default_search_box(loop);
      const auto limit = ForceLimit::of(loop, box);
      if (!limit) return;
      CHECK(Element(law).force_bound(1.0));
      ++laws;
      const LoopBalance balance(loop);
      for (int k = 0; k < samples(30); ++k) {
        ++parts;
        const SearchBox part = random_part(box);
        if (!limit->forbids(part)) continue;
        ++forbidden;
        const double A = between(part.amplitude_min, part.amplitude_max);
        const double w = between(part.frequency_min, part.frequency_max);
        INFO(Kind<double>::kind << ", " << sample.name << ", A = " << A << ", w = " << w);
        const auto f = balance(A, w, 1e-3);
        if (std::isfinite(f.real())) CHECK(std::abs(f - 1.0) < 1.0);
      }
    });
  });
  CHECK(laws > 5);
  CHECK(6 * forbidden > parts);
}

TEST_CASE("force limit: for Coulomb friction the border lies within the factor left between samples") {
  // |N| = 4 Fc/(pi A) exactly, so that |N G| = 1 at A = (4/pi) Fc |G|.
  const Loop loop = loop_of(Mass{1.0, 0.0, 0.0}, pid(3.0, 4.0, 6.0), coulomb(1.0, 1.0));
  const SearchBox box{1e-6, 1e2, 1e-2, 1e2};
  const auto limit = ForceLimit::of(loop, box);
  REQUIRE(limit);
  for (const double w : {0.02, 0.3, 1.0, 7.0, 80.0}) {
    const double border = 4.0 / std::numbers::pi * std::abs(loop.element_response(w)(0, 0));
    CHECK_FALSE(limit->forbids({1.9 * border, 1.95 * border, w, w * 1.001}));
    CHECK(limit->forbids({2.1 * border, 2.2 * border, w, w * 1.001}));
  }
}

TEST_CASE("force limit: none where G may have peaks between its samples, or where it is not of one friction alone") {
  const SearchBox box{1e-6, 1e2, 1e-2, 1e2};
  const Element friction = coulomb(1.5, 1.0);
  const auto limit = [&](const LoopParts& parts) { return ForceLimit::of(build_loop(parts), box); };
  LoopParts parts = servo_parts(friction);
  CHECK(limit(parts));
  LoopParts resonant = parts;
  resonant.plant = Mass{1.0, 0.0, 100.0};
  resonant.controller = pid(1.0, 0.0, 0.1);
  CHECK_FALSE(limit(resonant));
  LoopParts limited = parts;
  Pid saturated = pid(3.0, 4.0, 6.0);
  saturated.saturation = 10.0;
  limited.controller = saturated;
  CHECK_FALSE(limit(limited));
  LoopParts relay_loop;
  relay_loop.plant = TransferFunction{{100.0}, {1.0, 20.0, 0.0}, 0.0};
  relay_loop.element = relay(1.0);
  CHECK_FALSE(limit(relay_loop));
}
