#include "limcycle/analysis/energy/one_state/one_state.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/energy/passivity/reference_march.hpp"
#include "limcycle/analysis/energy/passivity/storage_slopes.hpp"
#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/lugre_spline.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/kikuuwe.hpp"
#include "limcycle/models/friction/dry/wojewoda.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/friction_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

template <class Law>
Element erased(const Settings& settings) {
  return Element(made<Law>(settings));
}

PassivityOptions up_to(double speed) {
  PassivityOptions options;
  options.top_speed = speed;
  return options;
}

Settings lugre_1995() { return with(bristle, {{"sigma1", root}, {"sigma2", 0.4}}); }

Settings bouc_wen(double beta, double gamma, double n = 1.0, double alpha = 0.0) {
  return {{"k", 1e5}, {"D", 1e-5}, {"beta", beta}, {"gamma", gamma}, {"n", n}, {"alpha", alpha}};
}

/// The counter-example exists, is confirmed, and takes out more from cycle to cycle.
void check_refuted(const Element& law, const Passivity& answer) {
  INFO(answer.why);
  REQUIRE(answer.passive == Passive::no);
  REQUIRE(answer.counterexample);
  const Counterexample& example = *answer.counterexample;
  CHECK(example.energy > 0.0);
  CHECK(answer.deficit == example.energy);
  CHECK(example.error < 1e-3 * example.energy);
  CHECK(example.confirmed == Approx(example.energy).epsilon(1e-6));
  REQUIRE(example.taken.size() >= 10);
  // Close to a threshold a cycle gives so little that a thousand do not make up for the lead: they still grow.
  if (example.taken.size() < 1000) CHECK(example.taken.back() > 0.0);
  for (std::size_t i = example.taken.size() - 5; i < example.taken.size(); ++i)
    CHECK(example.taken[i] - example.taken[i - 1] == Approx(example.energy).epsilon(0.02));
  const ReferenceMarch again = reference_march(law, example.input, example.z0, example.mode0, 1);
  REQUIRE(again.status == Status::converged);
  CHECK(again.taken.at(0) == example.confirmed);
}

}  // namespace

TEST_CASE("lugre with the values of 1995 is refuted by a cycle") {
  for (const double sigma2 : {0.0, 0.4, 0.999 * 0.5 * root}) {
    INFO("sigma2 = " << sigma2);
    const auto law = erased<LuGre<double>>(with(lugre_1995(), {{"sigma2", sigma2}}));
    check_refuted(law, one_state_passivity(law));
  }
}

TEST_CASE("lugre is passive from sigma2 = sigma1 (Fs - Fc)/Fc on, for random parameters") {
  std::mt19937_64 random(7);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<>(0.0, 1.0)(random));
  };
  for (int k = 0; k < 5; ++k) {
    const double Fc = between(0.1, 10.0), Fs = Fc * (1.0 + between(0.05, 2.0)), sigma1 = between(1.0, 1e3);
    const Settings settings{
        {"Fs", Fs}, {"Fc", Fc}, {"vs", between(1e-4, 0.1)}, {"sigma0", between(1e3, 1e7)}, {"sigma1", sigma1}};
    const double threshold = sigma1 * (Fs - Fc) / Fc;
    INFO("Fs = " << Fs << ", Fc = " << Fc << ", sigma1 = " << sigma1);
    const auto above = erased<LuGre<double>>(with(settings, {{"sigma2", 1.001 * threshold}}));
    const auto below = erased<LuGre<double>>(with(settings, {{"sigma2", 0.999 * threshold}}));
    CHECK(one_state_passivity(above).passive == Passive::yes);
    check_refuted(below, one_state_passivity(below));
  }
}

TEST_CASE("too close to the threshold lugre stays undecided, never passive") {
  const auto at = [](double share) {
    return one_state_verdict(erased<LuGre<double>>(with(lugre_1995(), {{"sigma2", share * 0.5 * root}})), infinite);
  };
  CHECK(at(1.0 - 1e-11) == Passive::undecided);
  CHECK(at(1.0 - 1e-7) == Passive::no);
  CHECK(at(1.0 + 1e-7) == Passive::yes);
}

TEST_CASE("every one-state sample that claims to be passive is") {
  const auto check = [](auto law, const Sample& sample) {
    if (!sample.passive) return;
    INFO(law.kind << " " << sample.name);
    const Passivity answer = one_state_passivity(Element(law));
    INFO(answer.why);
    CHECK(answer.passive == Passive::yes);
    CHECK(answer.deficit == 0.0);
    CHECK_FALSE(answer.counterexample);
  };
  for_samples<Dahl>(check);
  for_samples<BoucWen>(check);
  for_samples<LuGre>(check);
  for_samples<LuGreSpline>(check);
  for_samples<ElastoPlastic>(check);
  for_samples<Jenkins>(check);
  for_samples<Kikuuwe>(check);
}

TEST_CASE("dahl is passive for every exponent") {
  for (const double exponent : {0.5, 1.0, 1.5, 2.0}) {
    const auto law = erased<Dahl<double>>({{"Fc", 1.0}, {"sigma0", 1e5}, {"exponent", exponent}});
    CHECK(one_state_passivity(law).passive == Passive::yes);
  }
}

TEST_CASE("bouc-wen is passive for beta >= 0, with gamma > beta too, and is not for beta < 0") {
  for (const auto& [beta, gamma, n] :
       {std::array{0.5, 0.5, 1.0}, {0.0, 1.0, 1.0}, {0.0, 1.0, 1.5}, {0.1, 0.9, 2.0}, {0.7, -0.3, 1.0}}) {
    INFO("beta = " << beta << ", gamma = " << gamma << ", n = " << n);
    CHECK(one_state_passivity(erased<BoucWen<double>>(bouc_wen(beta, gamma, n))).passive == Passive::yes);
  }
  // A wall, here 2e-9 wide, separates the states reached with v > 0 from those reached with v < 0.
  CHECK(one_state_passivity(erased<BoucWen<double>>(bouc_wen(1e-9, 1.0))).passive == Passive::yes);
  for (const auto& [beta, gamma, n, alpha] :
       {std::array{-0.05, 1.05, 1.0, 0.0}, {-0.05, 1.05, 1.0, 0.1}, {-0.05, 1.05, 1.5, 0.0}, {-0.5, 1.5, 2.0, 0.0}}) {
    INFO("beta = " << beta << ", gamma = " << gamma << ", n = " << n << ", alpha = " << alpha);
    const auto law = erased<BoucWen<double>>(bouc_wen(beta, gamma, n, alpha));
    check_refuted(law, one_state_passivity(law));
  }
}

TEST_CASE("stored energy of springs lies between the slopes, and is what can be taken out") {
  const auto check = [](const Element& law, double stiffness) {
    const Passivity answer = one_state_passivity(law);
    REQUIRE(answer.storage);
    const StorageCurve& curve = *answer.storage;
    REQUIRE(curve.z.size() > 100);
    for (std::size_t i = 0; i < curve.z.size(); ++i) {
      const double slope = stiffness * curve.z[i], size = 1e-12 * std::abs(slope);
      INFO("z = " << curve.z[i]);
      CHECK(curve.least[i] <= slope + size);
      CHECK(curve.most[i] >= slope - size);
      CHECK(curve.available[i] == Approx(0.5 * slope * curve.z[i]).epsilon(1e-6).margin(1e-20));
    }
  };
  check(erased<Jenkins<double>>({{"k", 1000.0}, {"Fc", 1.5}}), 1000.0);
  check(erased<Kikuuwe<double>>(with(stribeck_set, {{"K", 1e5}, {"B", root}})), 1e5);
}

TEST_CASE("available storage of bristles is that of the slow way back") {
  // dF/dx = sigma0 (1 + F/F0) on the way down: S = F0^2/sigma0 (u - ln(1 + u)), u = F/F0.
  const auto check = [](const Element& law, double level) {
    const Passivity answer = one_state_passivity(law);
    REQUIRE(answer.storage);
    for (std::size_t i = 0; i < answer.storage->z.size(); ++i) {
      const double u = std::abs(1e5 * answer.storage->z[i]) / level;
      INFO("u = " << u);
      CHECK(answer.storage->available[i] ==
            Approx(level * level / 1e5 * (u - std::log1p(u))).epsilon(1e-5).margin(1e-17));
    }
  };
  check(erased<Dahl<double>>({{"Fc", 1.0}, {"sigma0", 1e5}}), 1.0);
  check(erased<LuGre<double>>(bristle), 1.5);
}

TEST_CASE("spline lugre is passive where the sufficient condition asks for fourteen times its damping") {
  const Settings curve{{"velocity", std::vector<double>{0.0, 5e-4, 1e-3, 1.5e-3, 2e-3}},
                       {"coefficients", std::vector<double>{1.5, 1.5, 1.2, 0.9, 1.2, 1.45, 1.45}},
                       {"sigma0", 1e5},
                       {"sigma1", root}};
  const auto law = made<LuGreSpline<double>>(curve);
  REQUIRE(law.level(0.0) == Approx(1.5));
  REQUIRE(law.level(1e-3) == Approx(1.0));
  REQUIRE(law.level(2e-3) == Approx(1.45));
  REQUIRE(root * (1.5 - 1.0) / 1.0 > 158.0);  // sufficient: (max g - min g)/min g
  CHECK(one_state_passivity(erased<LuGreSpline<double>>(with(curve, {{"sigma2", 11.0}}))).passive == Passive::yes);
  const auto less = erased<LuGreSpline<double>>(with(curve, {{"sigma2", 10.8}}));
  check_refuted(less, one_state_passivity(less));
}

TEST_CASE("elasto-plastic and uneven lugre are decided, on both sides of the threshold") {
  for (const std::string zba : {"steady-state", "coulomb"}) {
    const Settings settings = with(bristle, {{"sigma1", root}, {"zba_of", zba}});
    const auto below = erased<ElastoPlastic<double>>(with(settings, {{"sigma2", 158.0}}));
    check_refuted(below, one_state_passivity(below));
    const auto above = erased<ElastoPlastic<double>>(with(settings, {{"sigma2", 158.2}}));
    CHECK(one_state_passivity(above).passive == Passive::yes);
  }
  const Settings settings = with(uneven, {{"sigma0", 1e5}, {"sigma1", 10.0}});  // forwards (1.5 - 1)/1, backwards 0.5
  const auto below = erased<LuGre<double>>(with(settings, {{"sigma2", 4.99}}));
  check_refuted(below, one_state_passivity(below));
  CHECK(one_state_passivity(erased<LuGre<double>>(with(settings, {{"sigma2", 5.01}}))).passive == Passive::yes);
}

TEST_CASE("a limited speed makes lugre passive, and random places agree") {
  // F v/f by the equations of the law alone: what a passage down gives must not exceed what one up costs.
  const auto law = erased<LuGre<double>>(lugre_1995());
  const double speed = 0.0381;
  CHECK(one_state_passivity(law, up_to(speed)).passive == Passive::yes);
  check_refuted(law, one_state_passivity(law, up_to(0.0383)));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> part(0.0, 1.0);
  long compared = 0;
  double worst = -infinite;
  for (long k = 0; k < 200'000; ++k) {
    const double z = 1.5e-5 * (2.0 * part(random) - 1.0);
    double least = -infinite, most = infinite;
    for (int i = 0; i < 2; ++i) {
      const double v = std::copysign(speed * std::pow(10.0, -6.0 * part(random)), part(random) - 0.5);
      const double g = 1.0 + 0.5 * std::exp(-v * v * 1e6), f = v - 1e5 * std::abs(v) * z / g;
      const double ratio = (1e5 * z + root * f + 0.4 * v) * v / f;
      if (f < 0.0) least = std::max(least, ratio);
      if (f > 0.0) most = std::min(most, ratio);
    }
    if (!(std::isfinite(least) && std::isfinite(most))) continue;
    ++compared;
    worst = std::max(worst, least - most);
  }
  CHECK(compared > 50'000);
  CHECK(worst <= 1e-12);
}

TEST_CASE("damping that fades with speed restores passivity") {
  for (const double vd : {1e-3, 1e-2, 0.088}) {
    const auto law = erased<LuGre<double>>(with(lugre_1995(), {{"sigma2", 0.0}, {"vd", vd}}));
    CHECK(one_state_passivity(law).passive == Passive::yes);
  }
  const auto law = erased<LuGre<double>>(with(lugre_1995(), {{"sigma2", 0.0}, {"vd", 0.089}}));
  check_refuted(law, one_state_passivity(law));
}

TEST_CASE("laws of another kind are refused, and a stop is heard") {
  CHECK_FALSE(OneStateLaw::fits(Element(made<Wojewoda<double>>(with(stribeck_set, {{"ks", 1e5}})))));
  CHECK_FALSE(OneStateLaw::fits(Element(made<Coulomb<double>>(levels))));
  CHECK_THROWS_AS(one_state_passivity(erased<Coulomb<double>>(levels)), std::invalid_argument);
  CHECK_THROWS_AS(one_state_passivity(erased<LuGre<double>>(lugre_1995()), up_to(0.0)), std::invalid_argument);
  PassivityOptions stopped;
  stopped.stop = [] { return true; };
  const Passivity answer = one_state_passivity(erased<LuGre<double>>(lugre_1995()), stopped);
  CHECK(answer.passive == Passive::undecided);
  CHECK(answer.status == Status::interrupted);
}
