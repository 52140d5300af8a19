#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/law_march.hpp"
#include "limcycle/tests/share.hpp"

// Properties that the describing function of every friction law must have.
using namespace limcycle;
using namespace limcycle::test;

namespace {

using std::numbers::pi;

template <class Law>
double length(const Law& law) {
  const double own = law.scales().displacement;
  return own < infinite ? own : 1e-4;
}

/// Amplitudes and frequencies from pre-sliding to sliding, from slow to fast against the Stribeck velocity.
template <class Law>
std::vector<DfPoint> points_of(const Law& law) {
  const double v = std::min(law.scales().velocity, 1e-3), L = length(law);
  std::vector<DfPoint> points;
  for (const double a : {0.3, 1.3, 11.0})
    for (const double s : {0.03, 3.0}) points.push_back({a * L, s * v / (a * L), 0.0});
  return points;
}

/// Runs check(law, sample) on every sample of every law that has a value under every prescribed motion.
void for_laws(auto&& check) {
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    for_some_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      if (drive_band(law) == 0.0) check(law, sample);
    });
  });
}

}  // namespace

TEST_CASE("friction laws: the describing function converges, is dissipative where the law is passive, and bounded") {
  int slow = 0, answered = 0;
  for_laws([&](const auto& law, const Sample& sample) {
    for (const DfPoint& at : points_of(law)) {
      for (const double bias : some_of(std::vector<double>{0.0, 0.4, 1.5})) {
        if (bias > 0.0 && !sample.sustained) continue;
        if (bias > 1.0 && at.amplitude > 2.0 * length(law)) continue;  // steady sliding without end
        const DfPoint point{at.amplitude, at.frequency, bias * at.amplitude * at.frequency};
        INFO("A " << point.amplitude << ", w " << point.frequency << ", bias " << point.bias);
        const auto df = describing_function(law, point, {.harmonics = 3});
        if (sample.settles_slowly) {
          ++slow;
          answered += df.status == Status::converged ? 1 : 0;
          if (df.status != Status::converged) continue;
        }
        CHECK(df.status == Status::converged);
        const double A = point.amplitude, speed = A * point.frequency * (1.0 + bias);
        // Work per period: of the oscillation, and of the mean force along the mean way.
        const double work = pi * A * A * df.gain.imag() + df.mean * point.bias * 2.0 * pi / point.frequency;
        const double size = sample.level * A;
        CHECK(std::abs(df.dissipation - work) <= 1e-6 * (std::abs(work) + size));
        if (sample.passive) CHECK(df.dissipation >= -1e-9 * size);
        if (sample.passive && bias == 0.0) CHECK(df.gain.imag() >= -1e-9 * sample.level / A);
        if (sample.per_way == 0.0)
          CHECK(std::abs(df.gain) * A <= 4.0 / pi * (sample.level + sample.per_speed * speed) * (1.0 + 1e-6));
        // If return points of the approach are kept, the half-wave symmetric state need not be the one reached.
        const bool local = std::decay_t<decltype(law)>::features.memory != Memory::non_local;
        if (law.odd() && bias == 0.0 && local) CHECK(df.symmetric);
        if (df.symmetric) CHECK(std::abs(df.mean) <= 1e-6 * sample.level);
      }
    }
  });
  CAPTURE(slow, answered);
  CHECK(answered >= 0.75 * slow);
}

TEST_CASE("friction laws: a rate-independent law has one gain at all frequencies, to rounding") {
  for_laws([](const auto& law, const Sample& sample) {
    if (!sample.rate_independent) return;
    for (const double a : {0.3, 1.3, 11.0}) {
      for (const double bias : {0.0, 0.4}) {
        if (bias > 0.0 && !sample.sustained) continue;
        const double A = a * length(law);
        const auto slow = describing_function(law, {A, 1e-3, bias * A * 1e-3});
        const auto fast = describing_function(law, {A, 1e3, bias * A * 1e3});
        INFO("A " << A << ", bias " << bias);
        CHECK(std::abs(slow.gain - fast.gain) <= 1e-11 * std::abs(slow.gain));
      }
    }
  });
}

TEST_CASE("friction laws: the dissipation is that of a march of another kind") {
  for_laws([](const auto& law, const Sample& sample) {
    const double L = length(law), v = std::min(law.scales().velocity, 1e-3);
    for (const double a : {0.8, 6.0}) {
      // Strokes from rest to rest along half a cosine are a sinusoid: x = -A cos wt.
      const double A = a * L, w = 0.7 * v / A, T = pi / w;
      INFO("A " << A << ", w " << w);
      LawMarch march(law, {0.02 * A, 0.1 * law.scales().velocity, std::min(0.1 * sample.fastest, T / 200.0)});
      march.glide(-A, 0.5 * T);
      double before = 0.0, work = 0.0;
      for (int period = 0; period < 40; ++period) {
        before = march.work();
        march.glide(A, T);
        march.glide(-A, T);
        const double now = march.work() - before;
        if (period > 3 && std::abs(now - work) <= 1e-9 * std::abs(now)) break;
        work = now;
      }
      const auto df = describing_function(law, {A, w, 0.0});
      if (sample.settles_slowly && df.status != Status::converged) continue;
      CHECK(std::abs(march.work() - before - df.dissipation) <= 1e-5 * (std::abs(df.dissipation) + sample.level * A));
    }
  });
}

TEST_CASE("friction laws that need the applied force: a gain outside the band, none where the motion enters it") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      const double band = drive_band(law);
      if (band == 0.0) return;
      INFO(Kind<double>::kind << ", " << sample.name);
      const auto inside = describing_function(law, {1e-3, 1.0, 0.0});
      CHECK(inside.status == Status::undefined);
      CHECK(inside.gain == 0.0);
      CHECK(describing_function(law, {1e-3, 1.0, 0.99e-3 + band}).status == Status::undefined);
      const auto outside = describing_function(law, {1e-3, 1.0, 1.01e-3 + band});
      CHECK(outside.status == Status::converged);
      CHECK(outside.dissipation > 0.0);
    });
  });
}

TEST_CASE("stiff friction laws have the describing function of Coulomb friction, j 4 Fc/(pi A)") {
  // Deviation of dahl at a = sigma0 A/Fc: (1 - tanh(a)/a) in the imaginary part, sqrt(pi/(2a)) in the real one, both
  // relative to 4 Fc/(pi A) (claim A12).
  const auto check = [](const Element& law) {
    const double a = 1e6, coulomb = 4.0 / (pi * 1e-3);
    const auto df = describing_function(law, {1e-3, 1e-3, 0.0});
    CHECK(df.status == Status::converged);
    CHECK(df.gain.imag() == Approx(coulomb * (1.0 - 1.0 / a)).epsilon(1e-9));
    CHECK(df.gain.real() == Approx(coulomb * std::sqrt(0.5 * pi / a)).epsilon(1e-5));
  };
  check(made<Dahl<double>>({{"Fc", 1.0}, {"sigma0", 1e9}}));
  check(made<LuGre<double>>(with(stribeck_set, {{"Fs", 1.0}, {"sigma0", 1e9}})));
}
