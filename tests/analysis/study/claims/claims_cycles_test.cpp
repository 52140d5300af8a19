#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::cycle_claims;
using limcycle::test::one_in;
using limcycle::test::samples;

namespace {

ClaimOptions few() {
  ClaimOptions options;
  options.seed = 7;
  options.random_points = samples(3);
  return options;
}

void refuses(const ClaimResult& result) {
  CHECK(result.verdict == ClaimVerdict::fails);
  CHECK_FALSE(result.counterexample.empty());
}

}  // namespace

TEST_CASE("claims B and E: each holds, by fixed and by random points, and says what it is") {
  std::set<std::string> ids;
  int number = 0;
  for (const auto& list : {limit_cycle_claims(), stability_claims()})
    for (const Claim& claim : list) {
      CAPTURE(claim.id);
      CHECK(ids.insert(claim.id).second);
      for (const auto* text : {&claim.statement, &claim.source, &claim.range, &claim.test}) CHECK_FALSE(text->empty());
      if (!test::is_done(number++)) continue;
      const auto result = claim.run(few());
      INFO(result.finding << " " << result.counterexample);
      CHECK(result.verdict == claim.expected);
      CHECK(result.status == Status::converged);
      const auto random = std::ranges::count(result.checks, true, &ClaimCheck::random);
      CHECK((random > 0 || claim.id == "B9"));
      CHECK(static_cast<std::ptrdiff_t>(result.checks.size()) > random);
    }
  for (const char* id :
       {"B1", "B2", "B3", "B4", "B5", "B6", "B7-1", "B7-2", "B7-3", "B7-4", "B8", "B9", "B10", "E1", "E2", "E3", "E4"})
    CHECK(ids.count(id) == 1);
}

TEST_CASE("claims B and E: the same seed draws the same points, another one others") {
  const auto where = [](std::uint64_t seed) {
    ClaimOptions options = few();
    options.seed = seed;
    return test_dead_time(options).checks.back().where;
  };
  CHECK(where(1) == where(1));
  CHECK(where(1) != where(2));
}

TEST_CASE("claims B and E: a stop leaves them undecided") {
  ClaimOptions options = few();
  options.stop = [] { return true; };
  for (const auto& list : {limit_cycle_claims(), stability_claims()})
    for (const Claim& claim : list) {
      CAPTURE(claim.id);
      CHECK(claim.run(options).verdict != ClaimVerdict::holds);
    }
}

TEST_CASE("claims B1 to B3: wrong formulas are refused") {
  refuses(test_relay_condition(
      few(), [](const RelayFeedback& relay, double h) { return 1.01 * switching_output(relay, h) + 1e-3; }));
  refuses(test_dead_time(few(), [](const LagWithDeadTime& lag) {
    return lag.time * std::log(2.0 * std::exp(lag.delay / lag.time) - 1.0001);
  }));
  refuses(test_dead_time(few(), dead_time_half_period,
                         [](const LagWithDeadTime& lag) { return 1.0001 * dead_time_amplitude(lag); }));
  const auto with = [](auto change) {
    auto formulas = van_der_pol_formulas();
    change(formulas);
    return test_van_der_pol(few(), formulas);
  };
  refuses(with([](auto& f) { f.period = [](double mu) { return 2.0 * std::acos(-1.0) * (1.0 + mu * mu / 16.0); }; }));
  refuses(with([](auto& f) { f.frequency = [](double mu) { return 1.0 - mu * mu / 16.0; }; }));
  refuses(with([](auto& f) { f.amplitude = [](double mu) { return 2.0 + mu * mu / 90.0; }; }));
  refuses(with([](auto& f) { f.slow_period = [](double mu) { return 1.613706 * mu; }; }));
  refuses(with([](auto& f) { f.trace = [](double mu, double x) { return mu * (1.0 - 1.001 * x * x); }; }));
}

TEST_CASE("claims B4 to B6: wrong formulas are refused") {
  refuses(test_stick_slip(few(), [](const StickSlipBelt& belt) { return 1.001 * slip_time(belt); }));
  refuses(test_stick_slip(few(), slip_time, [](const StickSlipBelt& belt) { return 0.5 * stick_time(belt); }));
  refuses(test_stick_slip(few(), slip_time, stick_time,
                          [](const StickSlipBelt& belt) { return 1.001 * belt_amplitude(belt); }));
  refuses(test_free_decay(few(), 4.0));
  refuses(test_den_hartog(few(), [](const ForcedOscillator& o) { return forced_df_amplitude(o); }));
  refuses(test_den_hartog(few(), den_hartog_amplitude, den_hartog_amplitude));
}

TEST_CASE("claim B6: its condition tells where the formula may not be used") {
  ForcedOscillator slow;
  slow.ratio = 0.4;
  CHECK_FALSE(never_stops(slow, den_hartog_amplitude(slow)));
  CHECK(never_stops({}, den_hartog_amplitude({})));
}

TEST_CASE("claims B7: wrong conditions are refused") {
  refuses(test_blind_describing_function(few(), [](RandomPoints& draw) {
    Servo servo = stabilising_servo(draw);
    servo.ki = 1.3 * servo.kd * servo.kp / servo.mass;  // not stabilising
    return servo;
  }));
  refuses(test_hunting(few(), [](double, double) { return true; }));
  refuses(test_hunting(few(), [](double, double) { return false; }));
  refuses(test_hunting_construction(few(), [](const Servo& servo, const Coulomb<double>& friction) {
    auto cycle = hunting_cycle(servo, friction);
    if (cycle) cycle->stick *= 1.0001;
    return cycle;
  }));
}

TEST_CASE("claim B7: no construction where there is no drop from break-away to sliding") {
  CHECK_FALSE(hunting_cycle({}, coulomb(1.0, 1.0)).has_value());
}

TEST_CASE("claims B8 to B10: wrong formulas are refused") {
  if (one_in() == 1) {
    const auto off = [](const RelayFeedback& relay, double h) { return switching_output(relay, h) + 1e-3; };
    refuses(test_friction_cycles(few(), off));
    refuses(test_friction_cycles(few(), switching_output, 0.99));
    refuses(test_switch_and_bristles(few(), [](double, double Fc) -> Element { return lugre(Fc, Fc, 0.0); }));
  }
  refuses(test_sliding(few(), [](const LuGre<double>& law, double v, double) {
    return std::complex<double>(quasi_static_damping(law.Fs, law.Fc, law.vs, law.sigma2, v));
  }));
  if (one_in() > 1) return;
  refuses(test_sliding(few(), dynamic_damping, [](double Fs, double Fc, double vs, double sigma2, double v) {
    return 1.01 * quasi_static_damping(Fs, Fc, vs, sigma2, v);
  }));
}

TEST_CASE("claims E: wrong formulas are refused") {
  refuses(test_smooth_multipliers(few(), 1.001));
  refuses(test_forced_smooth(few(), 2.0));
  refuses(test_forced_smooth(few(), 0.1));
  refuses(test_saltation(few(), false));
  refuses(test_loeb(few(), -1.0));
}
