#include "limcycle/analysis/study/precision/precision.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// An ideal relay followed by 1/(s (s + 1)^2).
LoopParts relay_parts() {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 2.0, 1.0, 0.0}, 0.0};
  parts.element = relay(1.0);
  return parts;
}

/// Its exact half period, after Tsypkin: y = 0 where the relay switches, y being the response of 1/s - 1/(s + 1) -
/// 1/(s + 1)^2 to a square wave of half period h.
double exact_half_period() {
  const auto at_switch = [](double h) {
    const double e = std::exp(-h), lag = 1.0 - 2.0 / (1.0 + e);
    const double double_lag = 1.0 + (2.0 * h * e / (1.0 + e) - 2.0) / (1.0 + e);
    return -0.5 * h - lag - double_lag;
  };
  double low = 1.0, high = 6.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    ((at_switch(middle) > 0.0) == (at_switch(low) > 0.0) ? low : high) = middle;
  }
  return low;
}

PrecisionOptions quick() {
  PrecisionOptions options;
  options.cycle.tolerances = {1e-3, 1e-6, 1e-9};
  options.cycle.predict.starts = 1;
  options.stiffness = false;
  options.work.repeats = 1;
  return options;
}

const WorkPoint* find(const WorkChart& chart, const std::string& method, const std::string& setting) {
  for (const auto& point : chart.points)
    if (point.method == method && point.setting == setting) return &point;
  return nullptr;
}

WorkPoint made(double error, double seconds, Quality quality = Quality::right) {
  WorkPoint point;
  point.error = error;
  point.seconds = seconds;
  point.quality = quality;
  return point;
}

}  // namespace

TEST_CASE("precision: a relay loop whose exact period is known is the reference to its stated error") {
  const LoopParts parts = relay_parts();
  const auto report = precision(&parts, nullptr, {}, quick());
  REQUIRE(report.cycle_chart);
  REQUIRE(report.cycle_chart->answered);
  CHECK_FALSE(report.df_chart);
  const double period = 2.0 * exact_half_period();
  CHECK(period == Approx(6.4244612).epsilon(1e-8));
  CHECK(std::abs(report.cycle->cycle.period / period - 1.0) < 3.0 * report.cycle->error);
  CHECK(report.cycle->error < 1e-10);
  CHECK(report.cycle->independent);
  CHECK(report.cycle->agreement < 1e-10);

  const WorkChart& chart = *report.cycle_chart;
  for (const char* stepper : {"dopri5", "fehlberg78", "cash-karp54", "rodas5p"}) {
    INFO(stepper);
    const auto *loose = find(chart, stepper, "rtol 1e-03"), *tight = find(chart, stepper, "rtol 1e-09");
    REQUIRE(loose);
    REQUIRE(tight);
    CHECK(tight->error < 1e-7);
    CHECK(tight->error <= std::max(loose->error, 1e-11));
    CHECK(tight->evaluations >= loose->evaluations);
    CHECK(tight->seconds >= 0.0);
  }
  // More harmonics, less error; one harmonic is off.
  const auto *one = find(chart, "harmonic-balance", "H = 1"), *many = find(chart, "harmonic-balance", "H = 45");
  REQUIRE(one);
  REQUIRE(many);
  CHECK(one->quality == Quality::biased);
  CHECK(many->error < 0.1 * one->error);
  CHECK(find(chart, "describing-function", "one harmonic")->quality == Quality::biased);
}

TEST_CASE("precision: errors and counts are the same in every run, on any number of threads") {
  const LoopParts parts = relay_parts();
  PrecisionOptions together = quick();
  together.threads = 4;
  const auto a = precision(&parts, nullptr, {}, quick()), b = precision(&parts, nullptr, {}, together);
  REQUIRE(a.cycle_chart->points.size() == b.cycle_chart->points.size());
  for (std::size_t i = 0; i < a.cycle_chart->points.size(); ++i) {
    const auto &p = a.cycle_chart->points[i], &q = b.cycle_chart->points[i];
    CHECK(p.method == q.method);
    CHECK(p.setting == q.setting);
    CHECK(p.evaluations == q.evaluations);
    CHECK((p.error == q.error || (std::isnan(p.error) && std::isnan(q.error))));
    CHECK(p.quality == q.quality);
  }
}

TEST_CASE("precision: a method that fails, one that is wrong and one that is slow are kept as such") {
  const LoopParts parts = relay_parts();
  PrecisionOptions options = quick();
  options.cycle.tolerances = {1e-6};
  options.more.push_back({"broken", "steps", {"a", "b", "c"}, [](std::size_t i) {
                            Attempt attempt;
                            attempt.evaluations = 7;
                            attempt.status = i == 0 ? Status::not_finite : Status::converged;
                            attempt.answered = i == 1;
                            attempt.of_another_kind = i == 1;
                            attempt.gave_up = i == 2;
                            attempt.error = i == 0 ? 1e-12 : 0.5;  // without an answer it has no meaning
                            return attempt;
                          }});
  const auto report = precision(&parts, nullptr, {}, options);
  const WorkChart& chart = *report.cycle_chart;
  const auto *failed = find(chart, "broken", "a"), *wrong = find(chart, "broken", "b"),
             *slow = find(chart, "broken", "c");
  REQUIRE(failed);
  CHECK(failed->quality == Quality::failed);
  CHECK(failed->status == Status::not_finite);
  CHECK(std::isnan(failed->error));
  CHECK(failed->why.find("not_finite") != std::string::npos);
  REQUIRE(wrong);
  CHECK(wrong->quality == Quality::wrong);
  CHECK(wrong->error == 0.5);
  REQUIRE(slow);
  CHECK(slow->quality == Quality::too_slow);
  for (const std::size_t i : chart.front) CHECK(chart.points[i].method != "broken");
  CHECK(std::ranges::find(chart.never_best, "broken") != chart.never_best.end());
}

TEST_CASE("precision: the front is what no other point beats") {
  const std::vector<WorkPoint> points{
      made(1e-3, 1.0), made(1e-6, 2.0),  made(1e-5, 3.0), made(1e-9, 4.0), made(1e-12, 0.1, Quality::wrong),
      made(2e-9, 3.5), made(1e-14, 9.0), made(1e-13, 5.0)};
  CHECK(pareto_front(points, 0.0) == std::vector<std::size_t>{0, 1, 5, 3, 7, 6});
  // A smaller error than the uncertainty of the reference is no advantage.
  CHECK(pareto_front(points, 1e-12) == std::vector<std::size_t>{0, 1, 5, 3, 7});
  CHECK(cheapest(points, 1e-5) == 1);
  CHECK(cheapest(points, 1e-20) == points.size());

  const LoopParts parts = relay_parts();
  const auto report = precision(&parts, nullptr, {}, quick());
  const auto& chart = *report.cycle_chart;
  for (const std::size_t i : chart.front)
    for (const auto& other : chart.points)
      if (other.charted() && other.seconds < chart.points[i].seconds)
        CHECK(std::max(other.error, chart.floor) > std::max(chart.points[i].error, chart.floor));
}

TEST_CASE("precision: on the hunting servo the describing function is marked wrong and a budget ends in too slow") {
  const LoopParts parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  PrecisionOptions options = quick();
  options.cycle.predict.search = SearchBox{1e-4, 1.0, 0.05, 50.0};
  options.cycle.tolerances = {1e-6};
  options.cycle.max_steps = 100;
  const auto report = precision(&parts, nullptr, {}, options);
  REQUIRE(report.cycle_chart->answered);
  const auto* df = find(*report.cycle_chart, "describing-function", "one harmonic");
  REQUIRE(df);
  CHECK(df->quality == Quality::wrong);
  CHECK(df->why == "predicts no cycle");
  const auto* slow = find(*report.cycle_chart, "dopri5", "rtol 1e-06");
  REQUIRE(slow);
  CHECK(slow->quality == Quality::too_slow);
  CHECK(slow->evaluations == 100);
  CHECK(slow->why == "gave up after 100 steps");
}

TEST_CASE("precision: a loop that rests has no reference, and says what happens instead") {
  const LoopParts parts = servo_parts(coulomb(1.0, 1.0, 0.4));
  PrecisionOptions options = quick();
  options.cycle.predict.search = SearchBox{1e-3, 1.0, 0.05, 50.0};
  const auto report = precision(&parts, nullptr, {}, options);
  CHECK_FALSE(report.cycle);
  REQUIRE(report.cycle_chart);
  CHECK_FALSE(report.cycle_chart->answered);
  CHECK(report.cycle_chart->points.empty());
  CHECK(report.cycle_chart->why == "no stable limit cycle was found: the simulations end in rest");
}

TEST_CASE("precision: the describing function of a saturation, FFT and quadrature against the closed form") {
  const Element element = saturation(1.0);
  DfPrecisionOptions options;
  options.accuracies = {1e-3, 1e-9};
  options.largest_fft = 4096;
  options.work.repeats = 1;
  const auto found = df_precision(element, {{2.0, 1.0, 0.0}, {5.0, 3.0, 0.0}}, options);
  CHECK(found.made_by.starts_with("closed-form"));
  CHECK(found.agreement < 1e-6);
  CHECK(found.agreement > 0.0);
  double before = 1.0;
  for (const auto& point : found.results) {
    if (point.method != "fft") continue;
    CHECK(point.error < before);  // converges with the samples
    before = point.error;
  }
  CHECK(before < 1e-5);
  for (const auto& point : found.results)
    if (point.method == "quadrature") CHECK(point.error < 1e-6);
}

TEST_CASE("precision: points that stand for an element span its own scales") {
  const auto points = representative_points(lugre());
  CHECK(points.front().amplitude == Approx(0.1 * 1.5 / 1e5));
  CHECK(points.back().amplitude == Approx(1000.0 * 1.5 / 1e5));
  const auto few = representative_points({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0}, {1.0, 2.0});
  CHECK(few.size() == 10);
  CHECK(few.front().amplitude == 1.0);
  CHECK(few.back().amplitude == 9.0);
}

TEST_CASE("precision: over stiffness an explicit stepper gives up where the stiff one is right") {
  const auto ladder = stiffness_ladder(servo_parts(lugre()));
  REQUIRE(ladder.size() == 6);
  CHECK(ladder.front().sigma0 == Approx(1e3));
  CHECK(ladder.back().sigma0 == Approx(1e8));
  CHECK(law_of<LuGre<double>>(ladder.back().loop.elements.back()).sigma1 == Approx(1e4));
  CHECK(stiffness_ladder(servo_parts(coulomb(1.5, 1.0))).empty());

  CycleMethodsOptions options;
  options.tolerances = {1e-6};
  options.periods = 4;
  options.max_steps = 4000;
  options.check_steps = 40000;
  options.predict.starts = 1;
  options.predict.search = SearchBox{1e-6, 1.0, 0.01, 1000.0};
  WorkOptions work;
  work.repeats = 1;
  const auto study = stiffness_study({ladder[2]}, options, work);
  REQUIRE(study.points.size() == 4);
  for (const auto& point : study.points)
    CHECK(point.result.quality == (point.result.method == "rodas5p" ? Quality::right : Quality::too_slow));
  // Only the same stepper could follow the cycle within so few steps.
  REQUIRE(study.notes.size() == 1);
  CHECK(study.notes.front().find("weaker check") != std::string::npos);
}

TEST_CASE("precision: a run that will not fit into its budget is given up after the first periods") {
  const Loop loop = build_loop(servo_parts(lugre()));
  PredictOptions predict;
  predict.starts = 1;
  predict.search = SearchBox{1e-4, 1.0, 0.05, 50.0};
  std::string why;
  const auto reference = cycle_reference(loop, predict, 1000, why);
  REQUIRE(reference);
  IntegratorCheckOptions run{StepperKind::dopri5, 1e-6, 10, 10'000'000, {}};
  const IntegratorCheck whole = check_integrator(loop, reference->cycle, reference->sizes, run);
  REQUIRE(whole.status == Status::converged);
  REQUIRE(whole.steps > 60'000);
  run.max_steps = whole.steps + 1;  // just enough
  CHECK_FALSE(check_integrator(loop, reference->cycle, reference->sizes, run).gave_up);
  run.max_steps = whole.steps / 3;
  const IntegratorCheck cut = check_integrator(loop, reference->cycle, reference->sizes, run);
  CHECK(cut.gave_up);
  CHECK(cut.steps < whole.steps / 4);
}

TEST_CASE("precision: work that is stopped keeps what was run") {
  const LoopParts parts = relay_parts();
  PrecisionOptions options = quick();
  int settings = 0;
  options.work.done = [&] { ++settings; };
  options.work.stop = [&] { return settings >= 3; };
  const auto report = precision(&parts, nullptr, {}, options);
  CHECK(report.status == Status::interrupted);
  CHECK(report.cycle_chart->points.size() == 3);
}
