#include "limcycle/analysis/energy/passivity/threshold.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/lugre_spline.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/friction_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Settings damped() { return with(bristle, {{"sigma1", root}}); }

ThresholdOptions scanned(int values, bool logarithmic = false) {
  ThresholdOptions options;
  options.scan = values;
  options.logarithmic = logarithmic;
  return options;
}

}  // namespace

TEST_CASE("the threshold of lugre in sigma2 is sigma1 (Fs - Fc)/Fc, within its stated error") {
  const Element law = made<LuGre<double>>(damped());
  const double expected = 0.5 * root;
  const Threshold found = passivity_threshold(family_of(law, "sigma2"), 0.0, 1000.0, scanned(2));
  REQUIRE(found.changes.size() == 1);
  CHECK(found.status == Status::converged);
  CHECK(found.at_low == Passive::no);
  CHECK(found.at_high == Passive::yes);
  CHECK(std::abs(found.changes[0].value - expected) <= found.changes[0].error);
  CHECK(found.changes[0].error < 1e-5 * expected);
  const LeastDamping least = least_sigma2(law);
  CHECK(std::abs(least.value - expected) <= least.error);
  CHECK(least.error < 1e-5 * expected);
}

TEST_CASE("elasto-plastic needs the sigma2 of lugre, sigma1 = 0 needs none") {
  for (const std::string zba : {"steady-state", "coulomb"}) {
    const LeastDamping least = least_sigma2(made<ElastoPlastic<double>>(with(damped(), {{"zba_of", zba}})));
    CHECK(std::abs(least.value - 0.5 * root) <= least.error);
  }
  CHECK(least_sigma2(made<LuGre<double>>(bristle)).value == 0.0);
}

TEST_CASE("a spline curve needs what its level at the highest speed asks for") {
  const auto law =
      made<LuGreSpline<double>>({{"velocity", std::vector<double>{0.0, 5e-4, 1e-3, 1.5e-3, 2e-3}},
                                 {"coefficients", std::vector<double>{1.5, 1.5, 1.2, 0.9, 1.2, 1.45, 1.45}},
                                 {"sigma0", 1e5},
                                 {"sigma1", root}});
  ThresholdOptions options;
  options.accuracy = 1e-3;
  const LeastDamping least = least_sigma2(law, options);
  CHECK(std::abs(least.value - root * (1.5 / 1.45 - 1.0)) <= least.error);  // 10.904; sufficient: 158
}

TEST_CASE("thresholds in other parameters are found by a scan") {
  ThresholdOptions options = scanned(13, true);
  options.accuracy = 1e-4;
  const Threshold vd = passivity_threshold(family_of(made<LuGre<double>>(damped()), "vd"), 1e-4, 1e2, options);
  REQUIRE(vd.changes.size() == 1);
  CHECK(vd.at_low == Passive::yes);
  // The largest sigma1(v) v is sigma1 vd/sqrt(2 e), and must not exceed the 12 N of the passive speed (below).
  CHECK(std::abs(vd.changes[0].value - 12.0 * std::sqrt(2.0 * std::exp(1.0)) / root) <= vd.changes[0].error);
  CHECK(vd.changes[0].error < 1e-3 * vd.changes[0].value);
  const auto bouc_wen = made<BoucWen<double>>({{"k", 1e5}, {"D", 1e-5}, {"beta", 0.5}, {"gamma", 1.0}});
  const Threshold beta = passivity_threshold(family_of(bouc_wen, "beta"), -0.91, 0.83, scanned(9));
  REQUIRE(beta.changes.size() == 1);
  CHECK(beta.status == Status::converged);
  CHECK(std::abs(beta.changes[0].value) <= beta.changes[0].error);
  CHECK(beta.changes[0].error < 1e-5);
}

TEST_CASE("every change is reported, and what is not valid makes the answer incomplete") {
  const auto family = [](double value) -> std::optional<Element> {
    if (value > 9.0) return std::nullopt;
    Coulomb<double> law = made<Coulomb<double>>(levels);
    law.sigma2 = value;
    return law;
  };
  ThresholdOptions options = scanned(41);
  options.verdict = [](const Element& law) {
    const double value = law_of<Coulomb<double>>(law).sigma2;
    if (std::abs(value - 5.0) < 1e-3) return Passive::undecided;
    return value < 2.0 || value > 5.0 ? Passive::yes : Passive::no;
  };
  const Threshold found = passivity_threshold(family, 0.0, 8.0, options);
  REQUIRE(found.changes.size() == 2);
  CHECK(found.status == Status::converged);
  CHECK(std::abs(found.changes[0].value - 2.0) <= found.changes[0].error);
  CHECK(found.changes[0].error < 1e-5);
  CHECK(found.changes[0].below == Passive::yes);
  // An interval without a verdict is part of the error.
  CHECK(found.changes[1].value - found.changes[1].error == Approx(4.999).epsilon(1e-5));
  CHECK(found.changes[1].value + found.changes[1].error == Approx(5.001).epsilon(1e-5));
  CHECK(passivity_threshold(family, 0.0, 10.0, options).status == Status::incomplete);
  CHECK_THROWS_AS(passivity_threshold(family, 1.0, 1.0, options), std::invalid_argument);
  CHECK_THROWS_AS(family_of(made<Coulomb<double>>(levels), "sigma1"), std::invalid_argument);
}

TEST_CASE("the speed up to which a law is passive") {
  const auto speed_at = [](double sigma2) {
    return passive_speed(made<LuGre<double>>(with(damped(), {{"sigma2", sigma2}})));
  };
  // Far beyond vs a passage down at the top speed V gives sigma1 V - F/(F/Fc - 1), F = sigma0 z; one up at v -> 0 costs
  // F/(1 - F/Fs). Without sigma2 they meet first at F = 1.2 N, where sigma1 V = 6 N + 6 N.
  const PassiveSpeed undamped = speed_at(0.0);
  CHECK(std::abs(undamped.value - 12.0 / root) <= undamped.error);
  CHECK(undamped.error < 1e-5 * undamped.value);
  const PassiveSpeed found = speed_at(0.4);
  CHECK(found.value == Approx(0.0381883068).epsilon(1e-6));  // the same with (sigma1 - sigma2/(F/Fc - 1)) V, minimised
  CHECK(speed_at(158.0).value > 1e3);
  CHECK(speed_at(158.2).value == infinite);
  CHECK(passive_speed(made<Dahl<double>>({{"Fc", 1.0}, {"sigma0", 1e5}})).value == infinite);
  const auto never = made<BoucWen<double>>({{"k", 1e5}, {"D", 1e-5}, {"beta", -0.05}, {"gamma", 1.05}});
  CHECK(passive_speed(never).value == 0.0);
}
