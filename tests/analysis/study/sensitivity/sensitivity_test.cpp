#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/cycle_knobs.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

ParameterSpread spread_of(std::vector<SpreadParameter> parameters) {
  ParameterSpread spread;
  spread.parameters = std::move(parameters);
  spread.samples = 64;
  return spread;
}

SpreadParameter evenly(const std::string& path, double low, double high) {
  SpreadParameter one;
  one.path = path;
  one.value = one.mean = 0.5 * (low + high);
  one.low = low;
  one.high = high;
  return one;
}

LoopNumber number_of(const LoopParts& parts, const test::Knob& knob) {
  return {knob.name, "", test::value(parts, knob), [parts, knob](double to) -> std::optional<Loop> {
            if (to < 0.0) return std::nullopt;
            return test::with(parts, knob, to);
          }};
}

}  // namespace

TEST_CASE(
    "many loops are asked at once: as predict says, whatever stands beside, and values that are no case are missing") {
  const std::vector<std::optional<Loop>> loops{test::servo(test::lugre()), std::nullopt,
                                               test::servo(test::lugre(1.0, 1.0)), test::servo(test::lugre(2.0, 1.0))};
  const EnsembleQuestion question = ensemble_question(*loops[0]);
  const auto answers = ensemble_outcomes(loops, question);
  REQUIRE(answers.size() == 4);
  CHECK(answers[0].hunts == 1.0);
  CHECK(answers[0].period == Approx(24.4368).epsilon(3e-4));
  CHECK(answers[0].amplitude == Approx(0.0639025).epsilon(3e-4));
  CHECK(std::isnan(answers[1].hunts));
  CHECK(answers[2].hunts == 0.0);
  CHECK(std::isnan(answers[2].amplitude));
  CHECK(answers[3].hunts == 1.0);
  const auto alone = ensemble_outcomes(std::span(loops).subspan(3, 1), question);
  CHECK(alone[0].period == answers[3].period);  // to the last bit

  EnsembleQuestion stopped = question;
  stopped.stop = [] { return true; };
  CHECK(ensemble_outcomes(loops, stopped).size() < 4);
}

TEST_CASE("global sensitivity: where a loop hunts is shared out as it should be") {
  // Hunts if a > 1/2, whatever b: amplitude 1 + 2 a + 0 b there, none elsewhere.
  const GlobalPlan plan(spread_of({evenly("a", 0.0, 1.0), evenly("b", 10.0, 20.0)}), 20, 512, false);
  std::vector<std::optional<EnsembleOutcome>> answers;
  for (std::size_t k = 0; k < plan.size(); ++k) {
    const auto at = plan.values(k);
    REQUIRE((at[1] > 10.0 && at[1] < 20.0));
    const bool hunts = at[0] > 0.5;
    answers.push_back(EnsembleOutcome{hunts ? 1.0 : 0.0, hunts ? 1.0 + 2.0 * at[0] : NAN, hunts ? at[0] : NAN});
  }
  const GlobalSensitivity found = global_sensitivity(plan, answers, 0.0);
  REQUIRE(found.outputs.size() == 3);
  CHECK(found.hunting.among_decided.value == Approx(0.5).margin(0.01));
  CHECK(found.matters_most == std::size_t{0});
  CHECK(found.outputs[0].sobol.parameters[0].total.value == Approx(1.0).margin(0.05));
  CHECK(found.outputs[0].sobol.parameters[1].total.value == Approx(0.0).margin(0.01));
  CHECK(found.outputs[0].share_without_answer == 0.0);
  CHECK(found.outputs[1].share_without_answer == Approx(0.5).margin(0.01));
  CHECK(found.outputs[1].sobol.parameters[0].first.value == Approx(1.0).margin(0.1));
  CHECK(found.outputs[1].morris.parameters[1].mu_star.value == Approx(0.0).margin(1e-12));
  CHECK_THROWS_AS(global_sensitivity(plan, std::span(answers).first(3), 0.0), std::invalid_argument);

  // A quarter of the points are no valid case, and are not undecided.
  auto part = answers;
  for (std::size_t k = 0; k < plan.size(); ++k)
    if (plan.values(k)[1] < 12.5) part[k].reset();
  const GlobalSensitivity valid =
      global_sensitivity(plan, part, 0.0, [&](std::size_t row) { return plan.values(row)[1] >= 12.5; });
  CHECK(valid.hunting.undecided == 0);
  CHECK(valid.not_valid + valid.hunting.yes + valid.hunting.no == plan.fair_rows());
  CHECK(static_cast<double>(valid.not_valid) == Approx(0.25 * static_cast<double>(plan.fair_rows())).epsilon(0.02));
  CHECK(valid.hunting.high < 0.6);
  CHECK(global_sensitivity(plan, part, 0.0).hunting.undecided == valid.not_valid);

  // Nothing computed yet: everything is unknown, and nothing is NaN.
  const GlobalSensitivity none =
      global_sensitivity(plan, std::vector<std::optional<EnsembleOutcome>>(plan.size()), 0.0);
  CHECK(!none.hunting.among_decided.known);
  CHECK(none.outputs[1].share_without_answer == 1.0);
  CHECK(!none.outputs[1].sobol.parameters[0].total.known);
}

TEST_CASE("local sensitivity: damping beside viscous friction, borders, and numbers that are not there") {
  LoopParts parts = test::servo_parts(test::lugre());
  const Loop loop = build_loop(parts);
  SettleOptions options;
  options.shooting.accuracy = 1e-9;
  options.shooting.rtol = 1e-10;
  options.shooting.tolerance = 1e-11;
  const auto settled = settle(loop, displaced(loop, 1.0), options);
  REQUIRE(settled.shot);
  const Cycle& cycle = settled.shot->cycle;
  const std::vector<LoopNumber> numbers{number_of(parts, test::of_law<LuGre<double>>("sigma2", &LuGre<double>::sigma2)),
                                        number_of(parts, test::of_plant("damping", &Mass::damping)),
                                        number_of(parts, test::of_law<LuGre<double>>("vd", &LuGre<double>::vd)),
                                        number_of(parts, test::of_pid("tf", &Pid::tf))};
  const auto local = local_sensitivities(loop, cycle, numbers);
  REQUIRE(local.size() == 4);
  // Viscous friction and damping of the mass are equivalent.
  CHECK(local[0].why.empty());
  CHECK(local[1].why.empty());
  CHECK(local[1].period == Approx(local[0].period).epsilon(1e-6));
  CHECK(local[1].amplitude == Approx(local[0].amplitude).epsilon(1e-6));
  CHECK(local[0].error < 1e-5);
  CHECK(local[1].first_harmonic == Approx(local[0].first_harmonic).epsilon(1e-6));
  CHECK(std::abs(local[0].first_harmonic) > 1e-3);
  CHECK(std::abs(local[0].offset) <= local[0].offset_error);
  // At 0 these two represent something absent.
  CHECK(!local[2].why.empty());
  CHECK(std::isnan(local[2].period));
  CHECK(std::isnan(local[2].offset));
  CHECK(!local[3].why.empty());
  CHECK(std::isnan(local[3].amplitude));
}

namespace {

/// Relay with a dead zone of 0.05, followed by 1/(s + 1)^3.
LoopParts relay_chain() {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  parts.element = test::relay(1.0, 0.0, 0.05);
  return parts;
}
std::vector<LoopNumber> relay_numbers(const LoopParts& parts) {
  return {number_of(parts, test::of_relay("level", &Relay<double>::level)),
          number_of(parts, test::of_relay("dead_zone", &Relay<double>::dead_zone)),
          number_of(parts, test::of_relay("hysteresis", &Relay<double>::hysteresis))};
}

}  // namespace

TEST_CASE("sensitivity of what the describing function predicts: both oscillations of a relay with dead zone") {
  // N = 4 M/(pi A) sqrt(1 - (d/A)^2) = 8 at w = sqrt(3); A is proportional to M at constant d/M.
  const LoopParts parts = relay_chain();
  const Loop loop = build_loop(parts);
  std::vector<std::string> notes;
  const auto found = predicted_sensitivities(loop, default_search_box(loop), relay_numbers(parts), notes);
  REQUIRE(found.size() == 2);
  CHECK(notes.empty());
  for (const auto& one : found) {
    REQUIRE(one.found.status == Status::converged);
    CHECK(one.found.gain.real() == Approx(8.0).epsilon(1e-8));
    CHECK(one.found.frequency == Approx(std::sqrt(3.0)).epsilon(1e-8));
    REQUIRE(one.numbers.size() == 3);
    const double A = one.found.amplitude, by_level = one.numbers[0].by.amplitude, by_zone = one.numbers[1].by.amplitude;
    CHECK(by_level + 0.05 * by_zone == Approx(A).epsilon(1e-7));
    // pi/4 N A^2 = M sqrt(A^2 - d^2): (2 pi/4 N A sqrt(A^2 - d^2) - M A) dA = -M d dd.
    const double root = std::sqrt(A * A - 0.0025);
    CHECK(by_zone == Approx(-0.05 / (4.0 * std::acos(-1.0) * A * root - A)).epsilon(1e-6));
    CHECK(std::abs(one.numbers[2].by.frequency) > 1.0);  // at a hysteresis of 0
  }

  // A loop of several elements, or one without a prediction, is noted.
  notes.clear();
  const Loop servo = test::servo(test::lugre());
  CHECK(predicted_sensitivities(servo, default_search_box(servo), {}, notes).empty());
  CHECK(notes.size() == 1);
}

TEST_CASE("sensitivity of a threshold that a margin found") {
  const LoopParts parts = relay_chain();
  const auto numbers = relay_numbers(parts);
  const auto report = margin(build_loop(parts), {{"dead_zone", "1", 0.05, false, numbers[1].loop_at}}, {});
  REQUIRE(report.parameters.size() == 1);
  const MarginSide& side = report.parameters[0].up;
  REQUIRE(side.what == MarginSide::What::ends);
  REQUIRE(side.event == BranchEvent::Type::fold);
  REQUIRE(side.cycle);
  CHECK_FALSE(report.parameters[0].down.cycle);
  LoopParts there = parts;
  law_of<Relay<double>>(*there.element).dead_zone = side.value;
  const auto moved = threshold_sensitivities(build_loop(there), side, relay_numbers(there), 1);
  REQUIRE(moved.size() == 2);
  CHECK(moved[0].path == "level");
  CHECK(moved[0].why.empty());
  CHECK(moved[0].by.value == Approx(side.value).epsilon(1e-5));
  CHECK(std::abs(moved[0].by.value - side.value) <= moved[0].by.error + 1e-6 * side.value);
  // The hysteresis can only grow, so its neighbours are on one side.
  CHECK(moved[1].why.empty());
  LoopParts more = parts;
  law_of<Relay<double>>(*more.element).hysteresis = 2e-4;
  const auto beyond = margin(build_loop(more), {{"dead_zone", "1", 0.05, false, relay_numbers(more)[1].loop_at}}, {});
  const double slope = (beyond.parameters[0].up.value - side.value) / 2e-4;
  CHECK(moved[1].by.value == Approx(slope).epsilon(0.01));

  MarginSide elsewhere = side;
  elsewhere.cycle.reset();
  for (const auto& one : threshold_sensitivities(build_loop(there), elsewhere, relay_numbers(there), 1))
    CHECK_FALSE(one.why.empty());
}

TEST_CASE("local sensitivity: a dead zone that is not there spoils only its own derivative") {
  // With any dead zone the relay switches twice as often.
  LoopParts parts = relay_chain();
  law_of<Relay<double>>(*parts.element).dead_zone = 0.0;
  const Loop loop = build_loop(parts);
  const Cycle cycle = test::the_cycle(loop, 1.0);
  const auto local = local_sensitivities(loop, cycle, relay_numbers(parts));
  REQUIRE(local.size() == 3);
  CHECK(local[0].why.empty());
  CHECK(local[0].amplitude == Approx(cycle.amplitude).epsilon(1e-7));  // proportional to the level
  CHECK(std::abs(local[0].period) <= local[0].period_error);
  CHECK_FALSE(local[1].why.empty());
  CHECK(std::isnan(local[1].amplitude));
  CHECK(local[2].why.empty());
  CHECK(local[2].period > 1.0);
}

TEST_CASE("a plan of correlated numbers: a fair sample alone, its bands, and no share of the variance") {
  ParameterSpread spread = spread_of({});
  for (const char* path : {"a", "b"}) {
    SpreadParameter one = evenly(path, -100.0, 100.0);
    one.distribution = Distribution::normal;
    one.deviation = 1.0;
    spread.parameters.push_back(one);
  }
  const auto study = [&](double correlation) {
    ParameterSpread joint = spread;
    if (correlation != 0.0) joint.correlations = {{0, 1, correlation}};
    const GlobalPlan plan(joint, 10, 1024, true);
    CHECK(plan.correlated() == (correlation != 0.0));
    if (plan.correlated()) CHECK(plan.size() == 2048);
    CHECK(plan.fair_rows() == 2048);
    std::vector<std::optional<EnsembleOutcome>> answers;
    for (std::size_t k = 0; k < plan.size(); ++k) {
      const auto x = plan.values(k);
      answers.push_back(EnsembleOutcome{x[0] > 1.0 ? 0.0 : 1.0, 10.0 + x[0] + x[1], x[0] > 1.0 ? NAN : 5.0});
    }
    return global_sensitivity(plan, answers, 1e-6);
  };
  for (const double correlation : {0.0, 0.8, -0.8}) {
    INFO(correlation);
    const GlobalSensitivity found = study(correlation);
    CHECK(found.hunting.among_decided.value == Approx(0.8413).margin(0.005));
    const double deviation = std::sqrt(2.0 + 2.0 * correlation);
    const OutputSensitivity& amplitude = found.outputs[1];
    REQUIRE(amplitude.band);
    CHECK(amplitude.band->median == Approx(10.0).margin(0.05 * deviation));
    CHECK(amplitude.band->low == Approx(10.0 - 1.96 * deviation).margin(0.1 * deviation));
    CHECK(amplitude.band->high == Approx(10.0 + 1.96 * deviation).margin(0.1 * deviation));
    CHECK(amplitude.band->answers == 2048);
    CHECK_FALSE(found.outputs[0].band);
    CHECK(found.outputs[2].share_without_answer == Approx(0.1587).margin(0.005));
    CHECK(found.outputs[2].band->low == 5.0);
    CHECK(amplitude.sobol.parameters.empty() == (correlation != 0.0));
    CHECK(amplitude.morris.parameters.empty() == (correlation != 0.0));
    CHECK(found.matters_most.has_value() == (correlation == 0.0));
  }
}

TEST_CASE("a band needs enough loops that hunt") {
  const GlobalPlan plan(spread_of({evenly("a", 0.0, 1.0)}), 4, 64, false);
  std::vector<std::optional<EnsembleOutcome>> answers(plan.size());
  for (std::size_t k = 0; k < answers_of_a_band; ++k) answers[plan.fair_row(k)] = EnsembleOutcome{1.0, 2.0, 3.0};
  CHECK(global_sensitivity(plan, answers, 0.0).outputs[1].band);
  answers[plan.fair_row(0)].reset();
  CHECK_FALSE(global_sensitivity(plan, answers, 0.0).outputs[1].band);
}
