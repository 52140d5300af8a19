#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"

// A mass on every friction law, pushed back and forth with a biased force below sliding, to test for drift.
using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Displacements of 1 kg at the end of each cycle of a force that goes from F1 to F2, waits, goes back and waits, each
/// for T/4. The plant's own damping is such that the mass follows without ringing on a spring a hundred times as stiff
/// as `stiffness`.
std::vector<double> positions(const Element& law, double F1, double F2, double T, int cycles, double stiffness) {
  LoopParts parts;
  parts.plant = Mass{1.0, 20.0 * std::sqrt(stiffness), 0.0};
  parts.friction = law;
  Signal steps{.kind = Signal::Kind::table, .times = {0.0, T}, .values = {0.0, F1}};
  for (int k = 1; k <= cycles; ++k) {
    for (const double part : {0.25, 0.5, 0.75, 1.0}) steps.times.push_back((k + part) * T);
    steps.values.insert(steps.values.end(), {F2, F2, F1, F1});
  }
  SimulateOptions options;
  options.duration = (cycles + 1.0) * T;
  options.force = steps;
  options.rtol = 1e-7;
  options.sample = T;
  const Simulation run = simulate(build_loop(parts), options);
  INFO(run.why);
  CHECK(run.status == Status::converged);
  if (run.status != Status::converged) return {0.0, infinite};
  const auto column = std::ranges::find(run.columns, "y") - run.columns.begin();
  std::vector<double> y;
  for (const auto& row : run.rows) y.push_back(row[static_cast<std::size_t>(column)]);
  REQUIRE(y.size() >= static_cast<std::size_t>(cycles) + 2);
  return y;
}

template <class Law>
double stiffness_of(const Law& law) {
  const double L = law.scales().displacement;
  return L < infinite ? law.scales().output / L : 100.0;
}

}  // namespace

TEST_CASE("friction laws: no drift below the force claimed, after shakedown, and drift where the law says so") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_some_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      INFO(Kind<double>::kind << ", " << sample.name);
      const double k = stiffness_of(law), T = 20000.0 / std::sqrt(k) + 20.0 * sample.slowest;
      const bool drifts = Kind<double>::features.drifts;
      if (!drifts) CHECK(sample.holds_below > 0.0);
      const auto drift = [&](double F1, double F2) {
        const auto y = positions(law, F1, F2, T, 10, k);
        CHECK(y.back() >= 0.0);
        return y.back() - y[y.size() - 2];
      };
      const double holds = sample.holds_below;
      if (holds > 0.0) CHECK(std::abs(drift(0.1 * holds, 0.95 * holds)) < sample.wobbles);
      if (drifts && sample.per_way == 0.0) CHECK(drift(0.3, 0.87 * sample.level) > 1e-3 * law.scales().displacement);
    });
  });
}

TEST_CASE("dahl and slow lugre drift by (Fs/sigma0) ln[(1 - (F1/Fs)^2)/(1 - (F2/Fs)^2)] a cycle (claim D3)") {
  const auto check = [](const Element& law) {
    const auto y = positions(law, 0.5, 1.0, 3000.0, 4, 1e5);
    CHECK(y.back() - y[y.size() - 2] == Approx(7.050054e-6).epsilon(1e-3));
  };
  check(made<Dahl<double>>({{"Fc", 1.5}, {"sigma0", 1e5}}));
  check(made<LuGre<double>>(with(bristle, {{"sigma1", root}, {"sigma2", 0.4}})));
}
