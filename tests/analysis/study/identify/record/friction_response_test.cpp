#include "limcycle/analysis/study/identify/record/friction_response.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"
#include "limcycle/analysis/study/identify/parameter_space.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Positions, velocities and forces of an accelerated run of the marcher that simulations use, as a record.
FrictionRecord marched(const Element& law, std::size_t rows) {
  // Forward, back beyond the start, and forward again, in pre-sliding and in sliding.
  const Signal acceleration = signal_through({0.0, 0.02, 0.06, 0.1, 0.14}, {0.05, 0.05, -0.2, 0.3, 0.1});
  ForcedOptions options;
  options.duration = 0.14;
  options.rtol = 1e-11;
  for (std::size_t i = 0; i < rows; ++i)
    options.samples.push_back(options.duration * static_cast<double>(i) / static_cast<double>(rows - 1));
  const ForcedRun run = run_accelerated(law, acceleration, options);
  REQUIRE(run.status == Status::converged);
  FrictionRecord record{RecordKind::pre_sliding, "marched", {}, {}, {}, {}, 0.0};
  for (const double t : options.samples) {
    const std::size_t i = run.at(t * (1.0 + 1e-13));
    record.t.push_back(t);
    record.x.push_back(run.x[i]);
    record.v.push_back(run.v[i]);
    record.F.push_back(run.F[i]);
  }
  return record;
}

/// Largest difference between forces and those of the record, in N.
double largest_error(const Element& law, const PreparedRecord& record, double fineness) {
  std::vector<double> forces;
  REQUIRE(response_of(law, {})->run(law, record, forces, nullptr, fineness));
  double error = 0.0;
  for (std::size_t k = 0; k < forces.size(); ++k)
    error = std::max(error, std::abs(forces[k] - record.compared[k].measured));
  return error;
}

}  // namespace

TEST_CASE("friction response: the forces are those of the marcher of simulations") {
  for (const Element& law : {lugre_rig(), elasto_plastic_rig(), gms_rig()}) {
    INFO(law.kind());
    const PreparedRecord record = prepare(marched(law, 281), false);
    CHECK(record.largest_force > 1.0);
    CHECK(largest_error(law, record, 1.0) < 2e-4);
    CHECK(largest_error(law, record, 4.0) < 2e-5);
  }
}

TEST_CASE("friction response: of fourth order in the step") {
  const Element law = lugre_rig();
  const PreparedRecord record = prepare(marched(law, 15), false);
  std::vector<double> exact, coarse, fine;
  const auto response = response_of(law, {});
  REQUIRE(response->run(law, record, exact, nullptr, 32.0));
  REQUIRE(response->run(law, record, coarse, nullptr, 2.0));
  REQUIRE(response->run(law, record, fine, nullptr, 4.0));
  double error_coarse = 0.0, error_fine = 0.0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    error_coarse = std::max(error_coarse, std::abs(coarse[k] - exact[k]));
    error_fine = std::max(error_fine, std::abs(fine[k] - exact[k]));
  }
  const double order = std::log2(error_coarse / error_fine);
  CHECK(order > 3.3);
  CHECK(order < 5.0);
}

TEST_CASE("friction response: derivatives by the numbers are those of the forces") {
  for (const Element& law : {coulomb_rig(), stribeck_rig(), lugre_rig(), elasto_plastic_rig(), gms_rig()}) {
    INFO(law.kind());
    std::vector<PreparedRecord> records;
    for (const auto& record : synthesize(law, {}, 3)) records.push_back(prepare(record, law.may_stick()));
    const ParameterSpace space(law, records, {});
    const auto response = response_of(law, space.places(), space.own_rows());
    Eigen::VectorXd values(std::ssize(space.numbers()));
    for (std::size_t k = 0; k < space.numbers().size(); ++k)
      values(static_cast<Eigen::Index>(k)) = true_value(law, space.numbers()[k].name) * (1.0 + 0.013 * double(k));
    std::vector<double> forces, low, high;
    Eigen::MatrixXd slopes;
    for (const auto& record : records) {
      INFO(record.name);
      REQUIRE(response->run(space.law(values), record, forces, &slopes));
      for (Eigen::Index k = 0; k < values.size(); ++k) {
        INFO(space.numbers()[static_cast<std::size_t>(k)].name);
        const double step = 1e-5 * values(k);
        Eigen::VectorXd below = values, above = values;
        below(k) -= step;
        above(k) += step;
        REQUIRE(response->run(space.law(below), record, low, nullptr));
        REQUIRE(response->run(space.law(above), record, high, nullptr));
        double worst = 0.0, size = 1e-6 * record.largest_force / values(k);
        for (std::size_t i = 0; i < forces.size(); ++i) {
          const double difference = (high[i] - low[i]) / (2.0 * step);
          const double slope = slopes(static_cast<Eigen::Index>(i), k);
          // Steps change their number with the numbers of the law: the forces then jump by the error of a step.
          if (std::abs(difference - slope) > 1e-3 * size) worst = std::max(worst, std::abs(difference - slope));
          size = std::max(size, std::abs(slope));
        }
        CHECK(worst < 0.02 * size);
      }
    }
  }
}

TEST_CASE("friction response: steady sliding is g(v) sgn v + sigma2 v for every law with a curve") {
  FrictionRecord record{RecordKind::steady_velocity, "sweep", {}, {}, {1e-4, -5e-4, 2e-3, -0.02}, {1, -2, 3, -4}, 0.0};
  const PreparedRecord prepared = prepare(record, false);
  std::vector<double> forces;
  for (const Element& law : {stribeck_rig(), lugre_rig(), elasto_plastic_rig(), gms_rig()}) {
    INFO(law.kind());
    REQUIRE(response_of(law, {})->run(law, prepared, forces, nullptr));
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const double v = record.v[i], g = 1.0 + 0.5 * std::exp(-std::pow(v / 1e-3, 2));
      CHECK(forces[i] == Approx(std::copysign(g, v) + 20.0 * v).epsilon(1e-9));
    }
  }
}

TEST_CASE("friction response: steady sliding of a synthesized rig that differs from side to side") {
  const Element law = law_with("lugre", {{"Fs", 1.5},
                                         {"Fc", 1.0},
                                         {"vs", 1e-3},
                                         {"sigma0", 1e5},
                                         {"sigma1", 300.0},
                                         {"sigma2", 20.0},
                                         {"Fs_minus", 1.2},
                                         {"Fc_minus", 0.7}});
  const auto records = synthesize(law, {.noise = 0.0}, 0, {});
  const FrictionRecord& steady = records.front();
  for (std::size_t i = 0; i < steady.v.size(); ++i) {
    const double v = steady.v[i], bump = std::exp(-std::pow(v / 1e-3, 2));
    const double level = v > 0.0 ? 1.0 + 0.5 * bump : -0.7 - 0.5 * bump;
    CHECK(steady.F[i] == Approx(level + 20.0 * v).epsilon(1e-9));
  }
}

TEST_CASE("friction response: a bristle far shorter than the way between two rows") {
  Element law = lugre_rig().with("sigma0", 1e10);
  FrictionRecord record{RecordKind::lag, "fast", {}, {}, {}, {}, 0.0};
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    record.t.push_back(t);
    record.v.push_back(2e-3 + 1e-3 * std::sin(5.0 * t));
    record.F.push_back(1.0 + 0.01 * i);
  }
  std::vector<double> forces;
  REQUIRE(response_of(law, {})->run(law, prepare(record, false), forces, nullptr));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double v = record.v[i], g = 1.0 + 0.5 * std::exp(-std::pow(v / 1e-3, 2));
    CHECK(forces[i] == Approx(g + 20.0 * v).epsilon(1e-4));
  }
}

TEST_CASE("friction response: a reversal behind steady sliding is that of small exponential steps") {
  for (const double sigma0 : {1e6, 1e7, 1e8, 1e10}) {
    INFO(sigma0);
    FrictionRecord record{RecordKind::lag, "turning", {}, {}, {}, {}, 0.0};
    for (int i = 0; i <= 60; ++i) {
      record.t.push_back(0.01 * i);
      record.v.push_back(i == 30 ? 0.0 : 3e-3 * std::cos(std::numbers::pi * i / 20.0));  // a rounding error in row 11
      record.F.push_back(1.0);
    }
    const Element law = lugre_rig().with("sigma0", sigma0);
    std::vector<double> forces;
    REQUIRE(response_of(law, {})->run(law, prepare(record, false), forces, nullptr));
    const auto g = [](double v) { return 1.0 + 0.5 * std::exp(-std::pow(v / 1e-3, 2)); };
    double z = g(record.v[0]) / sigma0, worst = 0.0;
    for (std::size_t i = 1; i < record.v.size(); ++i) {
      constexpr int steps = 4000;
      const double h = 0.01 / steps;
      for (int k = 0; k < steps; ++k) {
        const double v = std::lerp(record.v[i - 1], record.v[i], (k + 0.5) / steps);
        const double sliding = std::copysign(g(v) / sigma0, v);
        z = sliding + (z - sliding) * std::exp(-std::abs(v) * h / std::abs(sliding));
      }
      const double v = record.v[i], F = sigma0 * z + 300.0 * (v - sigma0 * std::abs(v) * z / g(v)) + 20.0 * v;
      worst = std::max(worst, std::abs(forces[i] - F));
    }
    CHECK(worst < 2e-3);
  }
}

TEST_CASE("friction response: other laws are refused") {
  CHECK_THROWS_AS(response_of(kind_named("bouc-wen"), {}), std::invalid_argument);
}
