#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/analysis/study/predict/loop_in_time.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/remedy/cause.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

/// Sampled loops without friction, in which the steps of the encoder or of the command are all that is not linear.

using namespace limcycle;
using namespace limcycle::test;

namespace {

struct FreeServo {
  double mass = 1.0, kp = 3.0, ki = 4.0, kd = 6.0, h = 0.02, input_step = 1e-3, output_step = 0.0;
};

LoopParts parts_of(const FreeServo& of) {
  LoopParts parts;
  parts.plant = Mass{of.mass, 0.0, 0.0};
  Pid controller = pid(of.kp, of.ki, of.kd);
  controller.sample_time = of.h;
  controller.input_step = of.input_step;
  controller.output_step = of.output_step;
  parts.controller = controller;
  return parts;
}

/// The same as a diagram.
LoopParts diagram_of(const FreeServo& of) {
  const LoopParts slots = parts_of(of);
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  diagram.output = {1.0, "axis", "y"};
  diagram.load_on = "axis";
  diagram.blocks = {{"axis", "diagram.axis", slots.plant, {{{1.0, "pid", ""}}}},
                    {"pid", "diagram.pid", slots.controller, {{{1.0, "r", ""}, {-1.0, "axis", "y"}}}}};
  return parts;
}

const PredictOptions two_starts{.starts = 2};

double in_steps(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

/// From sample to sample in closed form: least and largest y, and the mean time between upward crossings of its middle,
/// after a long transient.
struct Swing {
  double half_range = 0.0, mean_period = 0.0;
};
Swing swing_of(const FreeServo& of, double y0) {
  constexpr int samples = 400'000, transient = 200'000;
  double y = y0, v = 0.0, integral = 0.0, last = -in_steps(y0, of.input_step), low = infinite, high = -infinite;
  std::vector<double> motion;
  for (int k = 0; k < samples; ++k) {
    const double e = -in_steps(y, of.input_step);
    integral += of.h * e;
    const double u = in_steps(of.kp * e + of.ki * integral + of.kd * (e - last) / of.h, of.output_step),
                 a = u / of.mass;
    last = e;
    const auto at = [&](double t) { return y + v * t + 0.5 * a * t * t; };
    if (k >= transient) {
      const double turn = a != 0.0 ? std::clamp(-v / a, 0.0, of.h) : 0.0;
      low = std::min({low, y, at(turn)});
      high = std::max({high, y, at(turn)});
      motion.push_back(y);
    }
    y = at(of.h);
    v += a * of.h;
  }
  const double middle = 0.5 * (low + high);
  int rises = 0, first = 0, latest = 0;
  for (std::size_t k = 1; k < motion.size(); ++k) {
    if (!(motion[k - 1] < middle && motion[k] >= middle)) continue;
    if (rises++ == 0) first = static_cast<int>(k);
    latest = static_cast<int>(k);
  }
  return {0.5 * (high - low), rises > 1 ? of.h * (latest - first) / (rises - 1) : 0.0};
}

/// Every bounded motion that was found is one of the recursion, from some start.
void check_against_recursion(const FreeServo& of, const PredictReport& report) {
  INFO("h " << of.h << ", steps " << of.input_step << " and " << of.output_step << ", ki " << of.ki);
  std::vector<double> known;
  for (const double start : {0.37, 3.1, 30.3, 211.7}) known.push_back(swing_of(of, start * of.input_step).half_range);
  const auto check = [&](double half_range) {
    const auto nearest = std::ranges::min_element(known, {}, [&](double one) { return std::abs(one - half_range); });
    CHECK(half_range == Approx(*nearest).epsilon(0.1).margin(1e-6 * of.input_step));
  };
  REQUIRE_FALSE(report.outcomes.empty());
  for (const OutcomeOfStart& one : report.outcomes) {
    CAPTURE(one.start, one.why);
    if (one.outcome == Outcome::rest) check(0.0);
    if (one.outcome == Outcome::irregular) check(one.irregular.half_range);
    if (one.outcome != Outcome::cycle) continue;
    const Cycle& cycle = report.cycles.at(one.cycle.value());
    const double samples = cycle.period / of.h;
    CHECK(samples == Approx(std::round(samples)).epsilon(1e-9));
    check(cycle.amplitude);
  }
}

bool hunts_by_a_count(const PredictReport& report, double step) {
  return std::ranges::any_of(report.outcomes, [&](const OutcomeOfStart& one) {
    const double size = one.outcome == Outcome::irregular ? one.irregular.half_range
                        : one.outcome == Outcome::cycle   ? report.cycles.at(one.cycle.value()).amplitude
                                                          : 0.0;
    return size > 0.25 * step && size < 2.0 * step;
  });
}

}  // namespace

TEST_CASE("quanta alone: integral action makes a servo without friction hunt by a count, as its recursion does") {
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int k = 0; k < samples(3); ++k) {
    FreeServo of;
    of.input_step = std::pow(10.0, 4.0 * part(random) - 5.0);
    of.h = 0.04 + 0.03 * part(random);
    of.mass = 0.7 + 0.6 * part(random);
    of.ki = 2.0 + 3.0 * part(random);
    const PredictReport report = predict(build_loop(parts_of(of)), two_starts);
    check_against_recursion(of, report);
    CHECK(hunts_by_a_count(report, of.input_step));
    // Without integral action nothing pushes a count further; differences of counts may still keep it moving.
    of.ki = 0.0;
    check_against_recursion(of, predict(build_loop(parts_of(of)), two_starts));
  }
}

TEST_CASE("quanta alone: the same in any unit, and as a diagram") {
  FreeServo of;
  of.h = 0.05;
  const PredictReport here = predict(build_loop(parts_of(of)), two_starts),
                      drawn = predict(build_loop(diagram_of(of)), two_starts);
  REQUIRE(here.outcomes.size() == drawn.outcomes.size());
  for (std::size_t i = 0; i < here.outcomes.size(); ++i) {
    CHECK(here.outcomes[i].outcome == drawn.outcomes[i].outcome);
    CHECK(here.outcomes[i].irregular.half_range == Approx(drawn.outcomes[i].irregular.half_range).epsilon(1e-9));
  }
  of.input_step = 1.0;  // millimetres, in which every force is a thousandth
  of.mass *= 1e-3;
  of.kp *= 1e-3;
  of.ki *= 1e-3;
  of.kd *= 1e-3;
  const PredictReport scaled = predict(build_loop(parts_of(of)), two_starts);
  REQUIRE(here.outcomes.size() == scaled.outcomes.size());
  for (std::size_t i = 0; i < here.outcomes.size(); ++i) CHECK(scaled.outcomes[i].outcome == here.outcomes[i].outcome);
  CHECK(hunts_by_a_count(scaled, 1.0));
}

TEST_CASE("quanta alone: the describing function is that of a quantizer, behind the pulse transfer function") {
  FreeServo of;
  of.h = 0.05;
  const Loop counted = build_loop(parts_of(of));
  for (const double w : {0.3, 1.0, 5.0, 40.0}) {
    const std::complex<double> s(0.0, w), z = std::exp(s * of.h);
    const std::complex<double> law = of.kp + of.ki * of.h * z / (z - 1.0) + of.kd * (z - 1.0) / (z * of.h),
                               hold = (1.0 - 1.0 / z) / (s * of.h), plant = 1.0 / (of.mass * s * s);
    const auto response = counted.element_response(w)(0, 0);
    CHECK(std::abs(response + law * hold * plant) < 1e-10 * std::abs(response));
  }
}

TEST_CASE("quanta alone: they are the cause, and a loop without them is refused") {
  FreeServo of;
  const LoopParts parts = parts_of(of);
  CHECK_FALSE(validate(parts));
  of.input_step = 0.0;
  REQUIRE(validate(parts_of(of)));
  CHECK(validate(parts_of(of))->rule.find("needs a nonlinear element") != std::string::npos);
  CHECK(validate(diagram_of(of))->rule.find("needs a nonlinear element") != std::string::npos);
  of.output_step = 0.1;
  CHECK_FALSE(validate(parts_of(of)));
  CHECK_FALSE(validate(diagram_of(of)));
  const PredictReport report = predict(build_loop(parts), {});
  const Cause cause = cause_of(parts, {}, report.cycles);
  CHECK(cause.kind == CauseKind::quantization);
}

TEST_CASE("quanta alone: the note on them goes by what stands for them, not by the name of a block") {
  FreeServo of;
  const auto note = [](const LoopParts& parts) { return loop_in_time(build_loop(parts), 0.0).note; };
  CHECK_THAT(note(parts_of(of)), Catch::Contains("with its quanta as those of a quantizer"));
  LoopParts limited = diagram_of(of);
  auto& blocks = limited.diagram->blocks;
  std::get<Pid>(std::get<Controller>(blocks.back().what)).tf = 0.1;
  Saturation<double> sensor;
  sensor.limit = 2.0;
  blocks.back().inputs = {{{1.0, "r", ""}, {-1.0, "encoder", ""}}};
  blocks.push_back({"encoder", "diagram.encoder", Element(sensor), {{{1.0, "axis", "y"}}}});
  CHECK_THAT(note(limited), Catch::Contains("without its quanta"));
  of.output_step = 0.1;
  CHECK_THAT(note(parts_of(of)), Catch::Contains("but without those of its command"));
}

TEST_CASE("a limit of the command alone is a nonlinear element too") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  parts.controller = pid(3.0, 4.0, 6.0);
  CHECK(validate(parts));
  std::get<Pid>(parts.controller).saturation = 2.0;
  CHECK_FALSE(validate(parts));
  for (const OutcomeOfStart& one : predict(build_loop(parts), {}).outcomes) CHECK(one.outcome != Outcome::undecided);
}
