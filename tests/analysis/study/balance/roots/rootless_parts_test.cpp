#include "limcycle/analysis/study/balance/roots/rootless_parts.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
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

TEST_CASE("rootless parts: too weak, or without energy, at every point, for every law that proves a bound") {
  int laws = 0, parts = 0, forbidden = 0, starved = 0;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_some_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      const Loop loop = random_servo(law);
      const SearchBox box = default_search_box(loop);
      const auto limit = RootlessParts::of(loop, box);
      if (!limit) return;
      CHECK((Element(law).force_bound(1.0) || Element(law).is_passive()));
      ++laws;
      const FirstHarmonicBalance balance(loop);
      for (int k = 0; k < samples(30); ++k) {
        ++parts;
        const SearchBox part = random_part(box);
        if (!limit->forbids(part)) continue;
        ++forbidden;
        const double A = between(part.amplitude_min, part.amplitude_max);
        const double w = between(part.frequency_min, part.frequency_max);
        INFO(Kind<double>::kind << ", " << sample.name << ", A = " << A << ", w = " << w);
        const auto f = balance(A, w, 1e-3);
        if (!std::isfinite(f.real())) continue;
        const auto H = loop.element_response(w)(0, 0), N = (1.0 - f) / H;
        const bool weak = std::abs(f - 1.0) < 1.0;
        const bool without_energy =
            Element(law).is_passive() && (1.0 / H).imag() < 0.0 && N.imag() >= -1e-2 * std::abs(N);
        CHECK((weak || without_energy));
        starved += weak ? 0 : 1;
      }
    });
  });
  CHECK(laws > 5);
  CHECK(4 * forbidden > parts);
  CHECK(20 * starved > parts);
}

TEST_CASE("rootless parts: for Coulomb friction the border of force lies within the factor left between samples") {
  // |N| = 4 Fc/(pi A) exactly, so that |N G| = 1 at A = (4/pi) Fc |G|.
  const Loop loop = loop_of(Mass{1.0, 0.0, 0.0}, pid(3.0, 4.0, 6.0), coulomb(1.0, 1.0));
  const SearchBox box{1e-6, 1e2, 1e-2, 1e2};
  const auto limit = RootlessParts::of(loop, box);
  REQUIRE(limit);
  for (const double w : {0.02, 0.3, 1.0, 7.0, 80.0}) {
    const double border = 4.0 / std::numbers::pi * std::abs(loop.element_response(w)(0, 0));
    CHECK_FALSE(limit->forbids({1.9 * border, 1.95 * border, w, w * 1.001}));
    CHECK(limit->forbids({2.1 * border, 2.2 * border, w, w * 1.001}));
  }
}

TEST_CASE("rootless parts: a passive law has none where the controller takes energy out of the motion") {
  // 1/H = m w^2 - kp + j(ki/w - kd w): no energy is supplied above w = sqrt(ki/kd), whatever the amplitude.
  Jenkins<double> law;
  law.k = 1e3;
  law.Fc = 1e3;
  const Loop loop = loop_of(Mass{1.0, 0.0, 0.0}, pid(3.0, 4.0, 6.0), Element(law));
  const double border = std::sqrt(4.0 / 6.0);
  const auto known = RootlessParts::of(loop, {1e-6, 1e2, 1e-2, 1e2});
  REQUIRE(known);
  CHECK_FALSE(known->forbids({1e-6, 1e-5, 0.5 * border, 0.99 * border}));
  CHECK_FALSE(known->forbids({1e-6, 1e-5, 0.9 * border, 1.5 * border}));
  CHECK(known->forbids({1e-6, 1e-5, 1.03 * border, 1.5 * border}));
  CHECK(known->forbids({1.0, 1e2, 1.03 * border, 20.0 * border}));
  const auto not_passive =
      RootlessParts::of(loop_of(Mass{1.0, 0.0, 0.0}, pid(3.0, 4.0, 6.0), Element(lugre())), {1e-6, 1e2, 1e-2, 1e2});
  CHECK_FALSE((not_passive && not_passive->forbids({1e-6, 1e-5, 1.03 * border, 1.5 * border})));
}

TEST_CASE("passive laws: no sinusoid takes energy out of one that states it") {
  int tried = 0;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_some_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      const Element element(law);
      if (!element.is_passive()) return;
      const Scales scales = element.scales();
      const double way = std::min(scales.displacement, 1.0), speed = std::min(scales.velocity, 1e3 * way);
      for (int k = 0; k < samples(12); ++k, ++tried) {
        const double A = way * between(1e-3, 1e3), w = speed / way * between(1e-4, 1e3);
        INFO(Kind<double>::kind << ", " << sample.name << ", A = " << A << ", w = " << w);
        const auto N = describing_function(element, {A, w, 0.0}, {.harmonics = 1, .accuracy = 1e-4});
        if (N.status == Status::converged) CHECK(N.gain.imag() >= -2e-4 * std::abs(N.gain));
      }
    });
  });
  CHECK(tried >= 5 * samples(12));
}

TEST_CASE("rootless parts: none where H may have peaks between its samples, or where it is not of one friction alone") {
  const SearchBox box{1e-6, 1e2, 1e-2, 1e2};
  const Element friction = coulomb(1.5, 1.0);
  const auto limit = [&](const LoopParts& parts) { return RootlessParts::of(build_loop(parts), box); };
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
