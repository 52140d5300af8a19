#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/breakaway.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

LawSetting setting(const std::string& label) {
  for (const auto& one : law_settings())
    if (one.label == label) return one;
  FAIL("no setting " << label);
  return {};
}

ExperimentOptions with(const std::vector<std::string>& labels, int threads = 1) {
  ExperimentOptions options;
  options.laws.clear();
  for (const auto& label : labels) options.laws.push_back(setting(label));
  options.threads = threads;
  return options;
}

ClaimOutcome outcome(const Experiment& e, const std::string& words) {
  for (const auto& claim : e.claims)
    if (claim.statement.find(words) != std::string::npos) return claim.outcome;
  FAIL("no claim about " << words);
  return ClaimOutcome::not_tested;
}

double peak(const LawSetting& law, double rate) { return break_away(law, rate, gross_displacement(law)).peak; }

}  // namespace

TEST_CASE("experiments: LuGre's break-away falls with the force rate as computed elsewhere") {
  // Peak friction force, m = 1, RK4 with small steps: rate, N.
  const auto lugre = setting("lugre").with("sigma2", 0.4, true);
  const std::pair<double, double> reference[] = {{0.05, 1.49069}, {0.1, 1.48521}, {0.2, 1.47655},
                                                 {1.0, 1.43242},  {5.0, 1.31321}, {10.0, 1.21995}};
  for (const auto& [rate, force] : reference) CHECK(peak(lugre, rate) == Approx(force).margin(1.5e-5));
}

TEST_CASE("experiments: break-away of the reconstructed non-drift law") {
  // The table of both definitions, by an independent program, to four digits.
  const auto law = setting("non-drift");
  const auto exponential = law.with("branch", std::string("exponential"), true);
  const auto linear = law.with("branch", std::string("linear"), true);
  const auto by_peak = [](const LawSetting& one, double rate) { return peak(one, rate); };
  CHECK(by_peak(law, 0.05) == Approx(1.4945).margin(1e-4));
  CHECK(by_peak(law, 0.1) == Approx(1.4873).margin(1e-4));
  CHECK(by_peak(law, 0.2) == Approx(1.4715).margin(1e-4));
  CHECK(by_peak(exponential, 0.05) == Approx(1.4925).margin(1e-4));
  CHECK(by_peak(exponential, 0.2) == Approx(1.4713).margin(1e-4));
  CHECK(by_peak(linear, 0.1) == Approx(1.4978).margin(1e-4));
  CHECK(by_peak(law.scaled("Zb", 0.5), 0.1) == Approx(1.4945).margin(1e-4));
  CHECK(by_peak(law.scaled("Zb", 2.0), 0.1) == Approx(1.4715).margin(1e-4));
  CHECK(by_peak(law.scaled("vs", 0.5), 0.1) == Approx(1.4603).margin(1e-4));
  CHECK(by_peak(law.scaled("vs", 2.0), 0.1) == Approx(1.4965).margin(1e-4));
  CHECK(by_peak(law.scaled("sigma", 0.5), 0.1) == Approx(1.4817).margin(1e-4));
  CHECK(by_peak(law.scaled("sigma", 2.0), 0.1) == Approx(1.4918).margin(1e-4));
  CHECK(break_away(linear, 0.05, 2e-3).applied == Approx(1.5056).margin(2e-4));
  CHECK(break_away(linear, 0.1, 2e-3).applied == Approx(1.5085).margin(2e-4));
  CHECK(break_away(linear, 0.2, 2e-3).applied == Approx(1.5103).margin(2e-4));
}

TEST_CASE("experiments: a law with stiction only breaks away at its level") {
  const auto coulomb = break_away(setting("coulomb"), 0.1, 2e-3);
  CHECK(coulomb.peak == Approx(1.5).epsilon(1e-9));
  CHECK(coulomb.displacement == 0.0);
  CHECK(std::isinf(coulomb.stiffness));
  // From rest at u = Fs: m x'' = (Fs - Fc) + rate t.
  const double t = (coulomb.applied - 1.5) / 0.1;
  CHECK(0.5 * 0.5 * t * t + 0.1 * t * t * t / 6.0 == Approx(2e-3).epsilon(1e-4));
}

TEST_CASE("experiments: LuGre drifts as its slow closed form says, stiction and the proposed law do not") {
  const auto e = non_drift_experiment(with({"lugre", "coulomb", "elasto-plastic", "non-drift"}));
  REQUIRE(e.status == Status::converged);
  const double slow = 1.5e-5 * std::log((1.0 - 0.04 / 2.25) / (1.0 - 0.64 / 2.25));
  CHECK(e.value("lugre", "drift") == Approx(slow).epsilon(2e-3));
  CHECK(e.value("coulomb", "drift") == 0.0);
  CHECK(std::abs(e.value("elasto-plastic", "drift")) < 1e-11);
  CHECK(std::abs(e.value("non-drift", "drift")) < 1e-9);
  CHECK(outcome(e, "lugre law drifts") == ClaimOutcome::confirmed);
  CHECK(outcome(e, "elasto-plastic law does not drift") == ClaimOutcome::confirmed);
  CHECK(outcome(e, "non-drift law does not drift") == ClaimOutcome::confirmed);
  CHECK(outcome(e, "gms law") == ClaimOutcome::not_tested);
  REQUIRE(e.findings.size() == 4);
  CHECK_THAT(e.findings[0].text, Contains("drifts by 4.75e-06 m a cycle"));
}

TEST_CASE("experiments: elasto-plastic drift ends where its break-away force is above the force") {
  const auto e = drift_against_zba_experiment(with({"elasto-plastic"}));
  CHECK(e.value("elasto-plastic", "drift", "zba_of steady-state, 0.3") > 1e-8);
  CHECK(e.value("elasto-plastic", "drift", "zba_of steady-state, 0.5") > 1e-11);
  CHECK(std::abs(e.value("elasto-plastic", "drift", "zba_of steady-state, 0.55")) < 1e-11);
  CHECK(e.value("elasto-plastic", "drift", "zba_of coulomb, 0.75") > 1e-11);
  CHECK(std::abs(e.value("elasto-plastic", "drift", "zba_of coulomb, 0.85")) < 1e-11);
  CHECK(outcome(e, "depends on z_ba") == ClaimOutcome::confirmed);
}

TEST_CASE("experiments: memory of LuGre is local, of the proposed law non-local") {
  const auto e = non_local_memory_experiment(with({"lugre", "non-drift", "maxwell-slip"}));
  CHECK(e.value("lugre", "worst", "to 0.9 N") > 0.1);
  CHECK(e.value("non-drift", "worst", "to 0.9 N") < 1e-3);
  CHECK(e.value("maxwell-slip", "worst", "to 1.2 N") < 1e-3);
}

TEST_CASE("experiments: pre-sliding displacement of LuGre") {
  const auto e = pre_sliding_experiment(with({"lugre"}));
  CHECK(e.value("lugre", "first") == Approx(4.4936e-5).epsilon(3e-3));
  CHECK(outcome(e, "4.4936e-5") == ClaimOutcome::confirmed);
}

TEST_CASE("experiments: a mass pulled by a spring sticks and slips with the known period") {
  const auto e = stick_slip_experiment(with({"coulomb", "lugre"}));
  CHECK(e.value("coulomb", "period", "pulled") == Approx(7.611259).epsilon(1e-6));
  CHECK(e.value("coulomb", "fastest", "pulled") == Approx(0.467423).epsilon(1e-5));
  CHECK(e.value("lugre", "period", "pulled") == Approx(7.49381).epsilon(2e-6));
  CHECK(e.value("lugre", "fastest", "pulled") == Approx(0.45873).epsilon(1e-4));
}

TEST_CASE("experiments: steady force is the Stribeck curve") {
  const auto e = steady_velocity_experiment(with({"lugre", "stribeck", "xiong", "non-drift"}));
  for (const char* law : {"lugre", "stribeck", "xiong", "non-drift"}) CHECK(e.value(law, "off") < 1e-6);
  CHECK(e.value("lugre", "at_vs") == Approx(1.183940).margin(1e-6));
}

TEST_CASE("experiments: a slow velocity loop of LuGre is the Stribeck curve, a fast one lags") {
  const auto law = make_law(setting("lugre"));
  const auto slow = run_velocity(law, 1.5e-3, 1e-3, 1e-3);
  CHECK(slow.force_at(1e-3, true) == Approx(1.183940).margin(1e-4));
  CHECK(slow.force_at(1e-3, false) == Approx(1.183940).margin(1e-4));
  const auto fast = run_velocity(law, 1.5e-3, 1e-3, 25.0);
  CHECK(fast.force_at(1.5e-3, true) > fast.force_at(1.5e-3, false) + 0.01);
  CHECK(std::isnan(fast.force_at(3e-3, true)));
}

TEST_CASE("experiments: the result does not depend on the threads") {
  const auto one = breakaway_rate_experiment(with({"lugre", "coulomb", "stribeck", "dahl"}, 1));
  const auto two = breakaway_rate_experiment(with({"lugre", "coulomb", "stribeck", "dahl"}, 2));
  REQUIRE(one.rows.size() == two.rows.size());
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    CHECK(one.rows[i].law == two.rows[i].law);
    CHECK(one.rows[i].values == two.rows[i].values);
  }
}

TEST_CASE("experiments: stopped early they say so, and claims without their law are not tested") {
  auto options = with({"lugre", "dahl"});
  options.stop = [] { return true; };
  const auto e = pre_sliding_experiment(options);
  CHECK(e.status == Status::interrupted);
  CHECK(e.rows.empty());
  for (const auto& claim : e.claims) CHECK(claim.outcome == ClaimOutcome::not_tested);
}

TEST_CASE("experiments: a setting that a law refuses is named") {
  CHECK_THROWS_WITH(make_law(setting("lugre").with("sigma0", -1.0)), Contains("lugre.sigma0") && Contains("-1"));
  CHECK_THROWS_WITH(make_law(setting("lugre").with("Fs", 0.5)), Contains("Fs"));
  CHECK_THROWS_WITH(make_law(setting("lugre").with("Zb", 0.5, true)), Contains("no such parameter"));
  CHECK_THROWS_WITH(make_law({"nothing", "nothing", {}}), Contains("nothing"));
  auto options = with({"lugre"});
  options.laws[0] = options.laws[0].with("sigma0", -1.0);
  const auto e = pre_sliding_experiment(options);
  REQUIRE(e.findings.size() == 1);
  CHECK_THAT(e.findings[0].text, Contains("could not be run") && Contains("sigma0"));
}

TEST_CASE("experiments: a thinned curve keeps its ends and corners") {
  std::vector<double> x, y;
  for (int i = 0; i <= 10000; ++i) {
    x.push_back(i);
    y.push_back(i < 5000 ? 0.0 : 1.0);
  }
  const Curve curve = thinned("", x, y, 100);
  CHECK(curve.x.size() < 220);
  CHECK(curve.x.front() == 0.0);
  CHECK(curve.x.back() == 10000.0);
  const auto jump = std::ranges::find(curve.y, 1.0) - curve.y.begin();
  CHECK(curve.x[static_cast<std::size_t>(jump)] == 5000.0);
  CHECK(curve.x[static_cast<std::size_t>(jump) - 1] == 4999.0);
}

TEST_CASE("experiments: a peak between samples is that of the parabola, a corner its own sample") {
  std::vector<double> t, smooth, corner;
  for (int i = 0; i <= 20; ++i) {
    t.push_back(0.1 * i);
    smooth.push_back(1.0 - (0.1 * i - 1.03) * (0.1 * i - 1.03));
    corner.push_back(i <= 10 ? 0.1 * i : 0.2);
  }
  CHECK(peak_of(t, smooth, 20).value == Approx(1.0).epsilon(1e-12));
  CHECK(peak_of(t, corner, 20).value == Approx(1.0).epsilon(1e-12));
}
