#include "limcycle/analysis/study/predict/predict.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/awrejcewicz.hpp"
#include "limcycle/tests/analysis/predictions.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

constexpr std::string_view df = "describing-function", composite = "composite-describing-function",
                           harmonic = "harmonic-balance";

PredictReport predicted(const Loop& loop, std::optional<SearchBox> within = {}) {
  PredictOptions options;
  options.search = within;
  return predict(loop, options);
}

Loop delayed(Element element, double gain, double delay) {
  LoopParts parts;
  parts.plant = TransferFunction{{gain}, {1.0, 1.0}, delay};
  parts.element = std::move(element);
  return build_loop(parts);
}

/// The servo with ideal stiction (claim B7, first row) with something more.
LoopParts sticking_servo() { return servo_parts(coulomb(1.5, 1.0)); }
constexpr double B7_period = 23.36927229, B7_amplitude = 0.06724015;

void check_B7(const PredictReport& report) {
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(B7_period).epsilon(1e-9));
  CHECK(report.cycles[0].amplitude == Approx(B7_amplitude).epsilon(1e-7));
  CHECK(report.cycles[0].stable == true);
}

/// x' = -x + K sat(-x(t - L)) by the Runge-Kutta method of order 4, the past interpolated by cubics; period and half
/// swing of its final motion.
std::pair<double, double> delayed_saturation(double K, double L, int steps) {
  const double h = L / steps;
  std::vector<double> x{1.0}, rate;
  const auto command = [&](std::ptrdiff_t i, double part) {  // at t = (i + part) h - L
    i -= steps;
    if (i < 0) return std::clamp(-1.0, -1.0, 1.0);
    const auto k = static_cast<std::size_t>(i);
    const double left = 1.0 - part, step = k + 1 < x.size() ? x[k + 1] - x[k] : 0.0;
    const double here = part == 0.0
                            ? x[k]
                            : left * x[k] + part * x[k + 1] -
                                  part * left * ((1.0 - 2.0 * part) * step + h * (part * rate[k + 1] - left * rate[k]));
    return std::clamp(-here, -1.0, 1.0);
  };
  std::vector<double> crossings;
  double low = 0.0, high = 0.0;
  for (std::ptrdiff_t i = 0; crossings.size() < 40; ++i) {
    const double now = x.back(), u0 = K * command(i, 0.0), um = K * command(i, 0.5), u1 = K * command(i + 1, 0.0);
    rate.push_back(u0 - now);
    const double k1 = rate.back(), k2 = um - now - 0.5 * h * k1, k3 = um - now - 0.5 * h * k2, k4 = u1 - now - h * k3;
    x.push_back(now + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4));
    if (crossings.size() == 39) low = std::min(low, now), high = std::max(high, now);
    if (now < 0.0 && x.back() >= 0.0) crossings.push_back(h * (static_cast<double>(i) + now / (now - x.back())));
  }
  return {crossings[39] - crossings[38], 0.5 * (high - low)};
}

}  // namespace

TEST_CASE("the hunting servo: one stable cycle, which only the composite describing function sees, and with a bias") {
  const auto report = predicted(servo(lugre()), SearchBox{1e-6, 1.0, 0.01, 1000.0});
  CHECK(report.status == Status::converged);
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(24.436786455993).epsilon(1e-8));
  CHECK(predictions_of(report, df).empty());
  CHECK(misses(report, df, 0));

  const auto seen = predictions_of(report, composite);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].verdict == Verdict::biased);
  CHECK(seen[0].cycle == 0U);
  CHECK(seen[0].amplitude > 2.0 * report.cycles[0].first_harmonic);
  CHECK(seen[0].frequency > 1.5 * report.cycles[0].frequency());
  CHECK_FALSE(misses(report, composite, 0));

  // Harmonic balance cannot follow a body that sticks on bristles, and reports that instead of a guess.
  CHECK(predictions_of(report, harmonic).empty());
  CHECK(misses(report, harmonic, 0));
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("harmonic balance was not tried on cycle 0") && Contains("sticks"));
}

TEST_CASE("without stiction the servo has no cycle from any start and nothing is confirmed") {
  const auto report = predicted(servo(lugre(1.0, 1.0)), SearchBox{1e-6, 1.0, 0.01, 1000.0});
  CHECK(report.cycles.empty());
  CHECK(report.missed.empty());
  CHECK(predictions_of(report, df).empty());
  for (const auto& p : report.predictions) {
    CHECK((p.verdict == Verdict::wrong || p.verdict == Verdict::undecided));
    CHECK_FALSE(p.cycle);
    CHECK_FALSE(p.why.empty());
  }
  REQUIRE(report.outcomes.size() >= 4);
  for (const auto& outcome : report.outcomes) CHECK(outcome.outcome == Outcome::rest);
}

TEST_CASE("relay loops are confirmed, with the numbers of claim B1, and roots solve the balance they came from") {
  const Loop loop = forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  const auto report = predicted(loop);
  REQUIRE(report.cycles.size() == 1);
  const auto plain = predictions_of(report, df);
  REQUIRE(plain.size() == 1);
  const Prediction& p = plain[0];
  CHECK(p.frequency == Approx(std::sqrt(3.0)).epsilon(1e-9));
  CHECK(p.amplitude == Approx(0.5 / std::numbers::pi).epsilon(1e-9));
  CHECK(p.stable == true);
  CHECK(p.verdict == Verdict::confirmed);
  CHECK(std::abs(FirstHarmonicBalance(loop)(p.input_amplitude, p.frequency, 1e-12)) < 1e-9);
  // With more harmonics the bias of 1.4 % of the frequency is gone.
  const auto more = predictions_of(report, harmonic);
  REQUIRE(more.size() == 1);
  CHECK(more[0].verdict == Verdict::confirmed);
  CHECK(more[0].harmonics > 9);
  CHECK(more[0].frequency == Approx(1.70750300).epsilon(1e-5));
  CHECK(more[0].amplitude == Approx(report.cycles[0].first_harmonic).epsilon(1e-5));
  CHECK(report.missed.empty());
}

TEST_CASE("relay with dead zone: the unstable cycle between rest and the stable one is found too") {
  const auto report = predicted(forward(relay(1.0, 0.0, 0.05), {1.0}, {1.0, 3.0, 3.0, 1.0}));
  REQUIRE(report.cycles.size() == 2);
  CHECK(report.missed.empty());
  const auto plain = predictions_of(report, df);
  REQUIRE(plain.size() == 2);
  for (const auto& p : plain) {
    REQUIRE(p.cycle);
    CHECK(report.cycles[*p.cycle].stable == p.stable);
    CHECK(p.verdict == (*p.stable ? Verdict::confirmed : Verdict::biased));
  }
  for (const auto& p : predictions_of(report, harmonic)) CHECK(p.verdict == Verdict::confirmed);
}

TEST_CASE("belt with LuGre, no viscous part: the describing function is far off and is called biased") {
  const auto report = predict(belt(lugre(1.5, 1.0, 0.0)), df_only(SearchBox{1e-3, 10.0, 0.1, 10.0}));
  REQUIRE(report.predictions.size() == 1);
  CHECK(report.predictions[0].verdict == Verdict::biased);
  REQUIRE(report.predictions[0].cycle);
  const Cycle& cycle = report.cycles[*report.predictions[0].cycle];
  CHECK(cycle.period == Approx(7.49381).epsilon(1e-6));
  CHECK(report.predictions[0].amplitude < 0.5 * cycle.first_harmonic);
}

TEST_CASE("dead time: every root of the phase condition in the box") {
  const auto report = predict(delayed(relay(1.0), 1.0, 0.5), roots_only(SearchBox{1e-4, 10.0, 0.1, 200.0}));
  // Roots: 0.5 w + atan w = (2k + 1) pi, one for each k with w below 200.
  std::size_t expected = 0;
  while (0.5 * 200.0 + std::atan(200.0) > (2.0 * static_cast<double>(expected) + 1.0) * std::numbers::pi) ++expected;
  CHECK(report.predictions.size() == expected);
  for (const auto& p : report.predictions) {
    const double turns = (0.5 * p.frequency + std::atan(p.frequency)) / std::numbers::pi;
    CHECK(turns == Approx(std::round(turns)).epsilon(1e-9));
    CHECK_FALSE(p.stable);  // Loeb's rule does not cover the infinitely many other roots
  }
}

TEST_CASE("a relay with dead time is exact in the time domain: claim B2") {
  const double K = 2.0, d = 0.7, L = 0.5;
  const auto report = predicted(delayed(relay(d), K, L), SearchBox{1e-3, 10.0, 0.1, 10.0});
  REQUIRE(report.cycles.size() == 1);
  const Cycle& cycle = report.cycles[0];
  CHECK(cycle.period == Approx(2.0 * std::log(2.0 * std::exp(L) - 1.0)).epsilon(1e-11));
  CHECK(cycle.amplitude == Approx(K * d * (1.0 - std::exp(-L))).epsilon(1e-11));
  CHECK(cycle.error < 1e-11);
  CHECK(cycle.stable == true);
  for (const auto method : {df, harmonic}) {
    const auto own = predictions_of(report, method);
    REQUIRE(own.size() == 1);
    CHECK(own[0].verdict == Verdict::confirmed);
  }
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Contains("exact") && Contains("in the time domain too"));
}

TEST_CASE("a relay experiment on a first-order process with dead time: its exact swing, in minutes") {
  const double K = 0.8, T = 240.0, L = 60.0, d = 15.0;
  LoopParts parts;
  parts.plant = FirstOrder{K, T, L};
  parts.element = relay(d);
  const auto report = predict(build_loop(parts), {});
  const auto slowest = std::ranges::max_element(report.cycles, {}, &Cycle::period);
  REQUIRE(slowest != report.cycles.end());
  CHECK(slowest->period == Approx(2.0 * T * std::log(2.0 * std::exp(L / T) - 1.0)).epsilon(1e-11));
  CHECK(slowest->amplitude == Approx(K * d * (1.0 - std::exp(-L / T))).epsilon(1e-11));
  CHECK(slowest->stable == true);
}

TEST_CASE("a relay on a process a hundred times slower than its dead time: the default search reaches that cycle") {
  // Roots of pi - 0.1 w = atan(10 w), and of w = pi/2L at an integrator: far above a hundred times the pole.
  for (const auto& [denominator, L, gain, w, A] :
       {std::tuple(std::vector{10.0, 1.0}, 0.1, 1.0, 15.771, 0.008073),
        std::tuple(std::vector{1.0, 0.0}, 0.002, 500.0, 785.398, 0.810569)}) {
    LoopParts parts;
    parts.plant = TransferFunction{{gain}, denominator, L};
    parts.element = relay(1.0);
    const auto report = predict(build_loop(parts), {});
    const auto own = predictions_of(report, df);
    const auto first = std::ranges::min_element(own, {}, &Prediction::frequency);
    REQUIRE(first != own.end());
    CHECK(first->frequency == Approx(w).epsilon(1e-4));
    CHECK(first->amplitude == Approx(A).epsilon(1e-3));
    CHECK(first->verdict != Verdict::wrong);
    CHECK(std::ranges::none_of(report.missed, [](const auto& one) { return one.method == df; }));
  }
}

TEST_CASE("search box: of a dead time the first turns and those up to a resonance, however fast the actuator") {
  const auto fastest = [](std::vector<double> denominator) {
    LoopParts parts;
    parts.plant = TransferFunction{{1.0}, std::move(denominator), 0.5};
    parts.element = relay(1.0);
    return default_search_box(build_loop(parts)).frequency_max;
  };
  CHECK(fastest({1.0, 1.0}) == Approx(60.0));
  CHECK(fastest({0.005, 1.005, 1.0}) == Approx(60.0));
  CHECK(fastest({1e-4, 1e-3, 1.0}) == Approx(300.0));
  CHECK(fastest({100.0, 1.0}) == Approx(4.0 * std::numbers::pi));  // one turn of the dead time
}

TEST_CASE("a saturation with dead time: the Pade approximation is owned up to, and the cycle is the true one") {
  auto options = df_only(SearchBox{0.1, 50.0, 0.5, 12.0});
  options.starts = 1;
  const auto report = predict(delayed(saturation(1.0), 20.0, 0.5), options);
  REQUIRE_FALSE(report.notes.empty());
  CHECK_THAT(report.notes[0], Contains("Pade approximation of order") && Contains("of the delayed signal up to "));
  REQUIRE(report.cycles.size() == 1);
  // Its harmonics beyond 12 rad/s come at the wrong time; an approximation of order 60 is off by 5e-7.
  const auto [period, amplitude] = delayed_saturation(20.0, 0.5, 2000);
  CHECK(report.cycles[0].period == Approx(period).epsilon(5e-4));
  CHECK(report.cycles[0].amplitude == Approx(amplitude).epsilon(2e-3));
  REQUIRE(report.predictions.size() == 1);
  CHECK(report.predictions[0].verdict == Verdict::confirmed);
  CHECK(report.predictions[0].cycle == 0U);
}

TEST_CASE("friction compensated too much behind a lag: it hunts, and the net force is what is predicted with") {
  // cases/over-compensated.toml; period and amplitude from an independent Runge-Kutta run with located events.
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  auto controller = pid(100.0, 0.0, 10.0);
  controller.friction_compensation = 1.3;
  controller.lag = 0.05;
  parts.controller = controller;
  parts.friction = coulomb(1.0, 1.0);
  const auto report = predicted(build_loop(parts), SearchBox{1e-4, 1.0, 0.1, 100.0});
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(0.8811007302).epsilon(1e-9));
  CHECK(report.cycles[0].amplitude == Approx(0.00709249722).epsilon(1e-8));
  CHECK(report.cycles[0].stable == true);
  const auto plain = predictions_of(report, df);
  REQUIRE(plain.size() == 1);
  CHECK(plain[0].verdict == Verdict::biased);
  CHECK(plain[0].frequency == Approx(6.586).epsilon(1e-4));
  CHECK_FALSE(misses(report, df, 0));
  // Compensated by no more than the friction, it comes to rest.
  controller.friction_compensation = 0.9;
  parts.controller = controller;
  const auto rest = predict(build_loop(parts), df_only(SearchBox{1e-4, 1.0, 0.1, 100.0}));
  CHECK(rest.cycles.empty());
  CHECK(rest.predictions.empty());
  for (const auto& outcome : rest.outcomes) CHECK(outcome.outcome == Outcome::rest);
}

TEST_CASE("friction and a saturated command: saturated from afar, the cycle is that of the free command") {
  // In the cycle the command stays within the break-away force of 1.5 N.
  auto parts = sticking_servo();
  auto controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 1.6;
  parts.controller = controller;
  const auto report = predicted(build_loop(parts), SearchBox{1e-4, 1.0, 0.01, 100.0});
  check_B7(report);
  CHECK(predictions_of(report, df).empty());
  CHECK(misses(report, df, 0));
  for (const auto& outcome : report.outcomes) CHECK(outcome.outcome == Outcome::cycle);
  // A command that cannot reach the break-away force moves nothing.
  controller.saturation = 1.4;
  parts.controller = controller;
  const auto stuck = predict(build_loop(parts), df_only(SearchBox{1e-4, 1.0, 0.01, 100.0}));
  CHECK(stuck.cycles.empty());
}

TEST_CASE("friction and a dead zone on the error: rest from near, hunting from afar") {
  // Dead zone of 0.02 m; period and amplitude from an independent Runge-Kutta run with located events.
  auto parts = sticking_servo();
  DeadZone<double> zone;
  zone.half_width = 0.02;
  parts.error = zone;
  const auto report = predicted(build_loop(parts), SearchBox{1e-4, 1.0, 0.01, 100.0});
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(22.0934654636).epsilon(1e-9));
  CHECK(report.cycles[0].amplitude == Approx(0.0925051370).epsilon(1e-8));
  CHECK(predictions_of(report, df).empty());
  CHECK(misses(report, df, 0));
  const auto count = [&](Outcome what) {
    return std::ranges::count_if(report.outcomes, [what](const auto& one) { return one.outcome == what; });
  };
  REQUIRE(report.outcomes.size() == 4);  // three displacements and a load step, which starts it too
  CHECK(report.outcomes[0].outcome == Outcome::cycle);
  CHECK(report.outcomes[2].outcome == Outcome::rest);
  CHECK(report.outcomes[3].start == "load step of 3");
  CHECK(count(Outcome::cycle) == 3);
}

TEST_CASE("friction under gravity: the integrator carries the load and the cycle is that without it") {
  auto parts = sticking_servo();
  parts.load = -9.81;
  const auto report = predicted(build_loop(parts), SearchBox{1e-4, 1.0, 0.01, 100.0});
  check_B7(report);
  CHECK(std::abs(report.cycles[0].offset) < 1e-9);
  CHECK(predictions_of(report, df).empty());
  const auto seen = predictions_of(report, composite),
             without =
                 predictions_of(predicted(build_loop(sticking_servo()), SearchBox{1e-4, 1.0, 0.01, 100.0}), composite);
  REQUIRE(seen.size() == 1);
  REQUIRE(without.size() == 1);
  CHECK(seen[0].verdict == Verdict::biased);
  CHECK(seen[0].amplitude == Approx(without[0].amplitude).epsilon(1e-6));
  CHECK(seen[0].frequency == Approx(without[0].frequency).epsilon(1e-6));
}

TEST_CASE("a saturated command beside the friction is eliminated by its own describing function") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  auto limited = pid(3.0, 4.0, 6.0);
  limited.saturation = 1e6;  // never reached, hence without effect
  parts.controller = limited;
  const Loop with = build_loop(parts), without = servo(coulomb(1.5, 1.0));
  const FirstHarmonicBalance a(with), b(without);
  for (const double A : {1e-3, 0.1})
    for (const double w : {0.1, 2.0}) CHECK(std::abs(a(A, w, 1e-9) - b(A, w, 1e-9)) < 1e-9 * std::abs(b(A, w, 1e-9)));
}

TEST_CASE("a balance that more harmonics still move is no prediction, and a note says so") {
  // Below the smaller root of the describing function the play holds the motion: the balance from there drifts to ever
  // slower oscillations as harmonics are added.
  Backlash<double> play;
  play.half_gap = 0.5;
  const auto report = predicted(forward(play, {1.5}, {1.0, 2.0, 1.0, 0.0}), SearchBox{0.51, 50.0, 0.01, 100.0});
  CHECK(predictions_of(report, df).size() == 2);
  const auto balanced = predictions_of(report, harmonic);
  REQUIRE(balanced.size() == 1);
  CHECK(balanced[0].verdict == Verdict::confirmed);
  CHECK(std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.find("harmonic balance gives no prediction from one of its starts") != std::string::npos;
  }));
}

TEST_CASE("a backlash in which every motion decays has no cycle, however slowly it decays") {
  // The plant's motions within the gap shrink by 0.15 % in a half period at 1.093, and by 1 % at 1.085; the period
  // grows.
  for (const double gain : {1.085, 1.093, 1.0945}) {
    Backlash<double> play;
    play.half_gap = 0.5;
    const auto report = predict(forward(play, {gain}, {1.0, 2.0, 1.0, 0.0}));
    CAPTURE(gain);
    CHECK(report.cycles.empty());
    for (const auto& one : report.outcomes) CHECK((one.outcome == Outcome::rest || one.outcome == Outcome::undecided));
  }
}

TEST_CASE("a law without a describing function leaves a note, not a failure: its cycle is found by simulation") {
  auto law = with_levels<Awrejcewicz<double>>(1.5, 1.0);
  law.vs = 0.01;
  law.dv = 1e-3;
  const auto report = predicted(servo(law), SearchBox{1e-3, 1.0, 0.01, 100.0});
  CHECK_FALSE(report.cycles.empty());
  CHECK(report.status != Status::not_finite);  // which the program treats as no answer
  CHECK(std::ranges::find(report.incomplete, df) != report.incomplete.end());
  CHECK(std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.find("exists nowhere in the search box") != std::string::npos;
  }));
}

TEST_CASE("a stop is obeyed and what was computed is kept") {
  PredictOptions options;
  int asked = 0;
  options.stop = [&asked] { return ++asked > 2000; };
  const auto report = predict(servo(lugre()), options);
  CHECK(report.status == Status::interrupted);
}
