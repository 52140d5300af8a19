#include "limcycle/analysis/study/tune/tune.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <mutex>

#include "limcycle/tests/analysis/study/remedy/over_compensated.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using limcycle::test::coulomb;
using limcycle::test::over_compensated;
using limcycle::test::servo_parts;

namespace {

/// A number of the PID controller.
struct Varied {
  double Pid::*number;
  double low, high;
};

TuneReport tuned(const LoopParts& parts, const std::vector<Varied>& varied, const TuneOptions& options) {
  std::vector<TuneNumber> numbers;
  for (const auto& [number, low, high] : varied)
    numbers.push_back({"loop.controller.n" + std::to_string(numbers.size()), "1",
                       std::get<Pid>(parts.controller).*number, low, high});
  std::mutex checking;
  const LoopWith loop_with = [&](std::span<const double> values) {
    LoopParts with = parts;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::lock_guard lock(checking);
      CHECK((values[i] >= varied[i].low && values[i] <= varied[i].high));  // never beyond a bound
      std::get<Pid>(with.controller).*varied[i].number = values[i];
    }
    return std::optional(with);
  };
  return tune(parts, numbers, loop_with, options);
}

TuneOptions few(TuneCost minimised, std::size_t samples = 6) {
  TuneOptions options;
  options.minimised = minimised;
  options.samples = samples;
  options.horizon = 20.0;
  return options;
}

/// y = x, or y = -x, of a mass m with next to no friction, under PD control.
LoopParts nearly_linear(double sign, double m, double kp, double kd) {
  LoopParts parts;
  StateSpacePlant plant;
  plant.A = Eigen::MatrixXd{{0.0, 1.0}, {0.0, 0.0}};
  plant.B = Eigen::MatrixXd{{0.0}, {1.0 / m}};
  plant.C = Eigen::MatrixXd{{sign, 0.0}};
  plant.C_friction = Eigen::MatrixXd{{1.0, 0.0}};
  plant.C_velocity = Eigen::MatrixXd{{0.0, 1.0}};
  parts.plant = plant;
  parts.controller = test::pid(sign * m * kp, 0.0, sign * m * kd);
  parts.friction = coulomb(1e-6 * m, 1e-6 * m);
  return parts;
}

const std::vector<double>& values_of(const TuneReport& report) { return report.points[report.best.value()].values; }

bool hunts_by_predict(const LoopParts& parts) {
  const auto found = predict(build_loop(parts));
  return std::ranges::any_of(found.cycles, [](const Cycle& one) { return one.stable == true; }) ||
         std::ranges::any_of(found.outcomes, [](const auto& one) {
           return one.outcome != Outcome::rest && one.outcome != Outcome::sliding;
         });
}

}  // namespace

TEST_CASE("tune: least Ms of a mass under PD control in closed form, in a corner, in other units and mirrored") {
  // S = s^2/(s^2 + kd s + kp) has the peak 1/(2 z sqrt(1 - z^2)) for z = kd/(2 sqrt(kp)) below 0.707.
  for (const double m : {1.0, 1e-3})
    for (const double sign : {1.0, -1.0}) {
      const LoopParts parts = nearly_linear(sign, m, 2.0, 0.7);
      const double k = sign * m;
      const TuneReport report = tuned(parts,
                                      {{&Pid::kp, std::min(k, 4.0 * k), std::max(k, 4.0 * k)},
                                       {&Pid::kd, std::min(0.5 * k, k), std::max(0.5 * k, k)}},
                                      few(TuneCost::ms));
      REQUIRE(report.best);
      CHECK(values_of(report) == std::vector{k, k});
      CHECK(report.best_cost().value() == Approx(1.0 / std::sqrt(0.75)).epsilon(1e-6));
      CHECK(report.agreement == TuneAgreement::same_point);
      CHECK(report.hunts == Hunts::no);
      CHECK(report.status == Status::converged);
    }
}

TEST_CASE("tune: least squared error of a mass under PD control in closed form, inside the bounds") {
  // The integral of y^2 from y = 1 is (kp + kd^2)/(2 kp kd), least for kd = sqrt(kp), where it is 1/sqrt(kp).
  TuneOptions options = few(TuneCost::ise);
  options.predict.search = SearchBox{1e-3, 2.0, 0.01, 100.0};
  const TuneReport report = tuned(nearly_linear(1.0, 1.0, 4.0, 9.0), {{&Pid::kd, 0.5, 20.0}}, options);
  REQUIRE(report.best);
  CHECK(report.step == 2.0);
  CHECK(values_of(report)[0] == Approx(2.0).epsilon(0.03));  // costs that differ by 1e-4 count as equal
  CHECK(report.best_cost().value() == Approx(4.0 * 0.5).epsilon(3e-4));
  CHECK(report.cost_error < 1e-6);
  CHECK(report.cost_now.value() == Approx(4.0 * (4.0 + 81.0) / 72.0).epsilon(1e-4));
  const auto& [below, above] = report.surroundings.at(0);
  CHECK(below == TuneOutcome::feasible);
  CHECK(above == TuneOutcome::feasible);
}

TEST_CASE("tune: a limit of another cost holds, and binds") {
  TuneOptions options = few(TuneCost::ise);
  options.predict.search = SearchBox{1e-3, 2.0, 0.01, 100.0};
  options.limits[static_cast<std::size_t>(TuneCost::ms)] = 1.05;  // at z = 0.6006, beyond the optimum of 0.5
  const TuneReport report = tuned(nearly_linear(1.0, 1.0, 4.0, 9.0), {{&Pid::kd, 0.5, 20.0}}, options);
  REQUIRE(report.best);
  const auto peak = [](double kd) {
    const double z = kd / 4.0;
    return 1.0 / (2.0 * z * std::sqrt(1.0 - z * z));
  };
  const double kd = values_of(report)[0];
  CHECK(peak(kd) <= 1.05);
  CHECK(peak(0.98 * kd) > 1.05);
  CHECK(report.surroundings.at(0).below == TuneOutcome::above_limit);
}

TEST_CASE("tune: bounds within which everything hunts have no result") {
  const TuneReport report =
      tuned(servo_parts(coulomb(1.5, 1.0)), {{&Pid::kp, 2.0, 4.0}, {&Pid::ki, 3.0, 5.0}}, few(TuneCost::ms, 4));
  CHECK_FALSE(report.best);
  CHECK(report.hunts == Hunts::yes);
  CHECK(report.searches.empty());
  CHECK(report.points.size() == 5);  // the present numbers too
  for (const TunePoint& point : report.points) CHECK(point.outcome == TuneOutcome::hunts);
  CHECK(report.status == Status::converged);
}

TEST_CASE("tune: an optimum at the edge of hunting, confirmed by predict, the same for any number of threads") {
  const LoopParts parts = over_compensated();
  std::vector<TuneReport> reports;
  for (const int threads : {1, 3}) {
    TuneOptions options = few(TuneCost::settling);
    options.predict.search = SearchBox{1e-4, 1.0, 0.1, 100.0};
    options.threads = threads;
    reports.push_back(tuned(parts, {{&Pid::kp, 1.0, 100.0}}, options));
  }
  const TuneReport& report = reports[0];
  REQUIRE(report.best);
  CHECK(report.hunts == Hunts::yes);
  CHECK(std::ranges::any_of(report.surroundings, [](const auto& one) {
    return one.below == TuneOutcome::hunts || one.above == TuneOutcome::hunts;
  }));
  const auto with = [&](double kp) {
    LoopParts other = parts;
    std::get<Pid>(other.controller).kp = kp;
    return other;
  };
  CHECK_FALSE(hunts_by_predict(with(values_of(report)[0])));
  for (const TunePoint& point : report.points) {
    if (point.part == TunePoint::Part::neighbour && point.outcome == TuneOutcome::hunts)
      CHECK(hunts_by_predict(with(point.values[0])));
    for (const double value : point.values) CHECK(value == with_four_digits(value));
  }
  REQUIRE(reports[1].points.size() == report.points.size());
  CHECK(reports[1].best == report.best);
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    CHECK(reports[1].points[i].values == report.points[i].values);
    CHECK(reports[1].points[i].outcome == report.points[i].outcome);
    CHECK(reports[1].points[i].costs == report.points[i].costs);
    CHECK(reports[1].points[i].why == report.points[i].why);
  }
}

TEST_CASE("tune: a step that friction holds far from the set-point has not settled") {
  LoopParts parts = servo_parts(coulomb(1.0, 1.0));
  std::get<Pid>(parts.controller).ki = 0.0;
  TuneOptions options = few(TuneCost::settling, 16);
  options.predict.search = SearchBox{1e-3, 1.0, 0.01, 100.0};
  const TuneReport report = tuned(parts, {{&Pid::kp, 0.5, 50.0}}, options);  // below 1 N/m it does not even start
  REQUIRE(report.best);
  CHECK(report.best_cost().value() > 0.0);
  CHECK(std::abs(report.after.y.back()) <= 0.1);
  for (const TunePoint& point : report.points)
    if (point.values[0] < 1.0) CHECK(point.outcome == TuneOutcome::above_limit);
}

TEST_CASE("tune: with a margin the loop does not hunt beside the result either") {
  const LoopParts parts = over_compensated();
  TuneOptions options = few(TuneCost::settling);
  options.predict.search = SearchBox{1e-4, 1.0, 0.1, 100.0};
  options.margin = 0.05;
  const TuneReport report = tuned(parts, {{&Pid::kp, 1.0, 100.0}}, options);
  REQUIRE(report.best);
  const auto hunts_with = [&](double kp) {
    LoopParts other = parts;
    std::get<Pid>(other.controller).kp = kp;
    return hunts_by_predict(other);
  };
  const double kp = values_of(report)[0];
  CHECK_FALSE(hunts_with(kp));
  CHECK_FALSE(hunts_with(with_four_digits(0.95 * kp)));
  CHECK_FALSE(hunts_with(with_four_digits(1.05 * kp)));
  CHECK(report.aside == Approx(0.06));
  CHECK(report.surroundings.at(0).above == TuneOutcome::hunts);
  CHECK(hunts_with(with_four_digits(1.06 * kp)));
  CHECK(std::ranges::any_of(report.points, [](const TunePoint& one) { return one.outcome == TuneOutcome::fragile; }));
}

TEST_CASE("tune: other units of length give the same optimum") {
  std::vector<double> costs, values;
  for (const double unit : {1.0, 1e-3}) {
    LoopParts parts = over_compensated();
    parts.plant = Mass{1.0 / unit, 0.0, 0.0};
    Pid pd = std::get<Pid>(parts.controller);
    pd.kp /= unit;
    pd.kd /= unit;
    parts.controller = pd;
    TuneOptions options = few(TuneCost::settling);
    options.predict.search = SearchBox{1e-4 * unit, unit, 0.1, 100.0};
    const TuneReport report = tuned(parts, {{&Pid::kp, 1.0 / unit, 100.0 / unit}}, options);
    REQUIRE(report.best);
    costs.push_back(report.best_cost().value());
    values.push_back(values_of(report)[0] * unit);
  }
  CHECK(costs[1] == Approx(costs[0]).epsilon(1e-3));
  CHECK(values[1] == Approx(values[0]).epsilon(2e-3));
}

TEST_CASE("tune: a stop keeps what is known, and wrong bounds are refused") {
  TuneOptions options = few(TuneCost::ms);
  int calls = 0;
  options.predict.stop = [&] { return ++calls > 3000; };
  const TuneReport report = tuned(over_compensated(), {{&Pid::kp, 1.0, 100.0}}, options);
  CHECK(report.status == Status::interrupted);
  CHECK_FALSE(report.points.empty());
  options.predict.stop = {};
  CHECK_THROWS_AS(tuned(over_compensated(), {}, options), std::invalid_argument);
  CHECK_THROWS_AS(tuned(over_compensated(), {{&Pid::kp, 2.0, 1.0}}, options), std::invalid_argument);
}
