#include "limcycle/analysis/energy/passivity/passivity.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "limcycle/analysis/energy/passivity/adversary.hpp"
#include "limcycle/analysis/energy/passivity/certificate.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/share.hpp"

// Passivity of the laws: certificates, counter-examples, and neither.
using namespace limcycle;
using namespace limcycle::test;

namespace {

Element erased(const Element& element) { return Element(element); }

void check_counterexample(const Passivity& result) {
  REQUIRE(result.passive == Passive::no);
  REQUIRE(result.counterexample);
  const Counterexample& example = *result.counterexample;
  CHECK(result.deficit == example.energy);
  CHECK(example.energy > 100.0 * example.error);
  CHECK(example.confirmed == Approx(example.energy).epsilon(1e-4));
  REQUIRE(example.taken.size() >= 10);
  CHECK(example.taken.back() - example.taken[example.taken.size() - 2] == Approx(example.energy).epsilon(1e-3));
  CHECK(example.input.period() > 0.0);
  CHECK_FALSE(example.words.empty());
}

Element one_block(double Fs = 1.5) {
  return made<Gms<double>>({{"Fs", Fs},
                            {"Fc", 1.0},
                            {"vs", 1e-3},
                            {"k", std::vector<double>{460.0}},
                            {"alpha", std::vector<double>{1.0}},
                            {"C", 10.0}});
}

Element leuven(double n, double sigma1, double sigma2) {
  return made<Leuven<double>>(
      with(stribeck_set, {four_stops[0], four_stops[1], {"n", n}, {"sigma1", sigma1}, {"sigma2", sigma2}}));
}

}  // namespace

TEST_CASE("passivity: laws with a storage function are certified by it") {
  int certified = 0;
  const auto check = [&]<template <class> class Kind>(std::initializer_list<std::string_view> left_out = {}) {
    for_some_samples<Kind>([&](const Kind<double>& law, const Sample& sample) {
      if (!sample.passive || std::ranges::find(left_out, sample.name) != left_out.end()) return;
      INFO(Kind<double>::kind << ", " << sample.name);
      const Passivity result = passivity(Element(law));
      CHECK(result.passive == Passive::yes);
      CHECK(result.method == "storage function of the law");
      CHECK(result.deficit == 0.0);
      CHECK(result.status == Status::converged);
      ++certified;
    });
  };
  check.operator()<MaxwellSlip>();
  check.operator()<Iwan>();
  check.operator()<Xiong>();
  check.operator()<NonDrift>({"two-point", "two-point, exponential"});
  check.operator()<Gms>();
  check.operator()<Wojewoda>();
  CHECK(certified >= samples(16));
  CHECK((one_in() > 1 || certified == 16));
  CHECK(passivity(leuven(1.0, 0.0, 0.0)).passive == Passive::yes);
}

TEST_CASE("passivity: laws and elements without memory are judged by their supply") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](const Kind<double>& law, const Sample& sample) {
      if (law.states() > 0) return;
      INFO(Kind<double>::kind << ", " << sample.name);
      const Passivity result = passivity(Element(law));
      CHECK(result.method == "supply at every input");
      CHECK((result.passive == Passive::yes) == sample.passive);
      if (!sample.passive) check_counterexample(result);
    });
  });
  Relay<double> relay;
  relay.level = 1.0;
  CHECK(passivity(relay).passive == Passive::yes);
  relay.hysteresis = 0.1;
  check_counterexample(passivity(relay));
  relay.dead_zone = 0.2;
  CHECK(passivity(relay).passive == Passive::yes);
  Saturation<double> saturation;
  saturation.limit = 2.0;
  CHECK(passivity(saturation).passive == Passive::yes);
  DeadZone<double> dead_zone;
  dead_zone.half_width = 0.1;
  CHECK(passivity(dead_zone).passive == Passive::yes);
  Quantizer<double> quantizer;
  quantizer.step = 0.01;
  CHECK(passivity(quantizer).passive == Passive::yes);
  Cubic<double> cubic;
  cubic.coefficient = 3.0;
  CHECK(passivity(cubic).passive == Passive::yes);
  cubic.coefficient = -3.0;
  check_counterexample(passivity(cubic));
  Backlash<double> backlash;
  backlash.half_gap = 0.3;
  check_counterexample(passivity(backlash));
}

TEST_CASE("passivity: what holds a body up in a band about rest does so in proportion to the mass and the band") {
  const auto energy = [](double dv) {
    const Passivity result = passivity(Element(made<Quinn<double>>(with(stribeck_set, {{"dv", dv}}))));
    check_counterexample(result);
    return result.deficit;
  };
  CHECK(energy(1e-5) == Approx(100.0 * energy(1e-6)).epsilon(1e-3));
  // Braking all the way at the pull Fs gives m dv^2 int_0^(1/2) (1 - 2 w)/2 dw = m dv^2/8 for g = Fs at most.
  CHECK(energy(1e-6) < 1.0 / 8.0 * 1e-12);
  CHECK(energy(1e-6) > 0.04 * 1e-12);
}

TEST_CASE("passivity: gms is refuted by loading fast and creeping, unless Fs = Fc") {
  PassivityOptions slow;
  slow.top_speed = 1e-2;
  const Passivity bounded = passivity(one_block(), slow);
  check_counterexample(bounded);
  CHECK(bounded.method == "search");
  CHECK(bounded.deficit > 1e-3);
  CHECK(bounded.searched <= -bounded.deficit);
  // Much more at any speed: a bristle stretched beyond the level of the new speed continues to pull while it slips.
  const Passivity unbounded = passivity(one_block());
  check_counterexample(unbounded);
  CHECK(unbounded.deficit > 0.05);
  CHECK(passivity(one_block(1.0)).passive == Passive::yes);
  for_samples<Gms>([](const Gms<double>& law, const Sample& sample) {
    INFO(sample.name);
    if (!sample.passive) check_counterexample(passivity(Element(law)));
  });
}

TEST_CASE("passivity: the cycle of the literature takes (Fs^2 - Fc^2)/k out of one gms element") {
  const Element law = erased(one_block());
  const double fast = 1e-2, creep = 1e-7, unload = 1.5 / 460.0, load = 1.0 / 460.0;
  const std::vector<SignalPiece> half{
      {load / fast, fast, fast}, {10.0, creep, creep}, {unload / creep, -creep, -creep}};
  std::vector<SignalPiece> cycle = half;
  for (const auto& piece : half) cycle.push_back({piece.duration, -piece.from, -piece.to});
  SupplyMarch march(law, 1e-10);
  const CycleSupply supply = periodic_supply(march, cycle, 20, 1e-9);
  REQUIRE(supply.status == Status::converged);
  const double limit = (1.5 * 1.5 - 1.0) / 460.0;
  CHECK(-supply.supplied < limit);
  CHECK(-supply.supplied > 0.97 * limit);
}

TEST_CASE("passivity: leuven's threshold is sigma2/sigma1 = (Fs/Fc)^n - 1") {
  for (const double n : some_of(std::vector<double>{1.0, 2.0})) {
    const double ratio = std::pow(1.5, n) - 1.0;
    INFO("n = " << n);
    CHECK(passivity(leuven(n, 50.0, 50.0 * ratio * (1.0 + 1e-6))).passive == Passive::yes);
    CHECK_FALSE(certify(erased(leuven(n, 50.0, 50.0 * ratio * 0.999)),
                        motion_scales(erased(leuven(n, 50.0, 0.0)), infinite), {})
                    .holds);
    // The nearer the threshold, the higher the speed required: the search reaches this ratio.
    check_counterexample(passivity(leuven(n, 50.0, 50.0 * ratio * 0.8)));
  }
}

TEST_CASE("passivity: a hysteretic force that drives a body that slows down is refuted, for Fs > 2 Fc only") {
  const auto law = [](double Fc) {
    return Element(made<Wojewoda<double>>({{"Fs", 1.5}, {"Fc", Fc}, {"vs", 1e-3}, {"ks", 1e5}}));
  };
  check_counterexample(passivity(law(0.7)));
  CHECK(passivity(law(0.75)).passive == Passive::yes);
}

TEST_CASE("passivity: the search alone refutes LuGre at its values of 1995, and not where it is passive") {
  const auto law = [](double sigma2) {
    return erased(made<LuGre<double>>(with(bristle, {{"sigma1", root}, {"sigma2", sigma2}})));
  };
  check_counterexample(searched_passivity(law(0.0), {}));
  check_counterexample(searched_passivity(law(0.4), {}));
  const Passivity passive = searched_passivity(law(158.2), {});
  CHECK(passive.passive == Passive::undecided);
  CHECK(passive.searched >= 0.0);
}

TEST_CASE("passivity: laws with no storage function that is known and no counter-example stay undecided") {
  const Passivity result = passivity(Element(made<TwoState<double>>(with(stribeck_set, {{"s", 1e-4}, {"tau", 2e-3}}))));
  CHECK(result.passive == Passive::undecided);
  CHECK(result.searched >= 0.0);
  CHECK(std::isnan(result.deficit));
  CHECK_FALSE(result.counterexample);
  CHECK_THAT(result.why, Catch::Contains("none took energy out"));
}

TEST_CASE(
    "passivity: random settings that are not passive are never certified, and the search agrees with certificates") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const auto log = [&](double low, double high) { return low * std::pow(high / low, u(random)); };
  int refuted = 0;
  for (int k = 0; k < 4 * samples(3); ++k) {
    const double Fc = log(0.1, 10.0), ratio = 1.0 + log(1e-3, 1.0), vs = log(1e-4, 1e-1), share = 0.2 + 0.6 * u(random);
    const Element blocks = made<Gms<double>>({{"Fs", Fc * ratio},
                                              {"Fc", Fc},
                                              {"vs", vs},
                                              {"k", std::vector<double>{log(1e2, 1e6), log(1e2, 1e6)}},
                                              {"alpha", std::vector<double>{share, 1.0 - share}},
                                              {"C", log(1e-2, 1e4)}});
    INFO("gms, setting " << k);
    CHECK_FALSE(certify(erased(blocks), motion_scales(erased(blocks), infinite), {}).holds);
    if (ratio > 1.05) {
      check_counterexample(passivity(blocks));
      ++refuted;
    }
    const double sigma1 = log(1.0, 1e3), n = 1.0 + 2.0 * u(random), need = std::pow(ratio, n) - 1.0;
    const auto bristles = [&](double part) {
      return Element(made<Leuven<double>>({{"Fs", Fc * ratio},
                                           {"Fc", Fc},
                                           {"vs", vs},
                                           {"k", std::vector<double>{1e5, 2e4}},
                                           {"W", std::vector<double>{0.7 * Fc * ratio, 0.4 * Fc * ratio}},
                                           {"n", n},
                                           {"sigma1", sigma1},
                                           {"sigma2", part * need * sigma1}}));
    };
    INFO("leuven, setting " << k);
    CHECK_FALSE(certify(erased(bristles(0.98)), motion_scales(erased(bristles(0.98)), infinite), {}).holds);
    CHECK(certify(erased(bristles(1.001)), motion_scales(erased(bristles(1.001)), infinite), {}).holds);
  }
  CHECK(refuted >= samples(4));
  for (const std::string_view kind : {"maxwell-slip", "gms"}) {
    FrictionLaws::for_each([&]<template <class> class Kind>() {
      if (Kind<double>::kind != kind) return;
      const Element law = erased(made<Kind<double>>(samples_of_kind(kind).back().settings));  // gms: Fs = Fc
      CHECK(searched_passivity(law, {}).searched >= 0.0);
    });
  }
}

TEST_CASE("passivity: the same seed gives the same answer, a stop is heeded, bad options are refused") {
  const Passivity once = passivity(one_block()), again = passivity(one_block());
  CHECK(once.deficit == again.deficit);
  CHECK(once.searched == again.searched);
  PassivityOptions options;
  options.stop = [] { return true; };
  const Passivity stopped = passivity(one_block(), options);
  CHECK(stopped.passive == Passive::undecided);
  CHECK(stopped.status == Status::interrupted);
  options.top_speed = -1.0;
  CHECK_THROWS_WITH(passivity(one_block(), options), Catch::Contains("-1"));
  options.top_speed = 1.0;
  options.effort = 0;
  CHECK_THROWS_WITH(passivity(one_block(), options), Catch::Contains("effort"));
}
