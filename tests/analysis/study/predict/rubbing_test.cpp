/// Friction on another coordinate than y: predictions of loops with a lag on one or the other side of the measured
/// position.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/tests/analysis/predictions.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

namespace {

constexpr SearchBox wide{1e-3, 100.0, 0.1, 100.0};

/// One loop in two forms: two masses, friction on one of them, a lag in the actuator (`as_actuator`), or in the sensor
/// of a state-space plant whose states are mixed at random (`as_sensor`).
struct Twins {
  LoopParts as_actuator, as_sensor;
  double lag = 0.0;
};

MatrixXd mixture(Eigen::Index n, std::mt19937_64& random) {
  std::normal_distribution<double> entry;
  const MatrixXd Q =
      MatrixXd(MatrixXd::NullaryExpr(n, n, [&] { return entry(random); })).householderQr().householderQ();
  const Eigen::VectorXd units = Eigen::VectorXd::NullaryExpr(n, [&] { return std::pow(10.0, entry(random)); });
  return Q * units.asDiagonal();
}

Twins random_twins(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  TwoMass masses{between(0.5, 2.0), between(0.5, 2.0), between(100.0, 400.0), between(1.0, 4.0)};
  masses.friction_on.index = between(0.0, 1.0) < 0.5 ? 0 : 1;
  masses.measured.index = between(0.0, 1.0) < 0.5 ? 0 : 1;
  Pid controller = pid(between(2.0, 8.0), 0.0, between(0.2, 1.0));
  controller.tf = 0.01;
  Twins twins;
  twins.lag = between(0.3, 0.8);
  twins.as_sensor.controller = controller;
  controller.lag = twins.lag;
  twins.as_actuator.controller = controller;
  twins.as_actuator.plant = masses;
  const PlantModel plant = model_of(Plant(masses));
  const Eigen::Index n = plant.A.rows();
  MatrixXd A = MatrixXd::Zero(n + 1, n + 1), B = MatrixXd::Zero(n + 1, 1), B_F = B;
  A.topLeftCorner(n, n) = plant.A;
  A.bottomLeftCorner(1, n) = plant.C_y / twins.lag;
  A(n, n) = -1.0 / twins.lag;
  B.topRows(n) = plant.B_u;
  B_F.topRows(n) = plant.B_F;
  RowVectorXd velocity = RowVectorXd::Zero(n + 1);
  velocity.head(n) = plant.C_v;
  const MatrixXd T = mixture(n + 1, random), back = T.inverse();
  StateSpacePlant mixed;
  mixed.A = back * A * T;
  mixed.B = back * B;
  mixed.B_friction = back * B_F;
  mixed.C = RowVectorXd(RowVectorXd::Unit(n + 1, n)) * T;
  mixed.C_velocity = velocity * T;
  twins.as_sensor.plant = mixed;
  twins.as_actuator.friction = twins.as_sensor.friction = coulomb(1.0, 1.0);
  return twins;
}

void check_equal(double one, double other) { CHECK(one == Approx(other).epsilon(1e-9).margin(0.0)); }

/// The balance with a fixed number of harmonics: its own stopping criterion depends on y, which differs.
HarmonicBalance nine_harmonics(const Loop& loop, const Prediction& from) {
  HarmonicBalanceOptions options;
  options.half_wave_symmetric = true;
  options.max_harmonics = 9;
  options.tail = 1e-30;
  HarmonicGuess guess{from.frequency, Eigen::VectorXcd::Zero(1), {}, {}};
  guess.first(0) = from.input_amplitude;
  return harmonic_balance(loop, guess, options);
}

}  // namespace

TEST_CASE("friction anywhere: a lag in the sensor or in the actuator gives the same predictions") {
  std::mt19937_64 random(17);
  int predictions = 0, composites = 0;
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    const Twins twins = random_twins(random);
    const Loop actuator = build_loop(twins.as_actuator), sensor = build_loop(twins.as_sensor);
    const auto wanted = predictions_of(predict(actuator, roots_only(wide)), "describing-function");
    const auto found = predictions_of(predict(sensor, roots_only(wide)), "describing-function");
    REQUIRE(found.size() == wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ++predictions;
      check_equal(found[k].frequency, wanted[k].frequency);
      check_equal(found[k].input_amplitude, wanted[k].input_amplitude);
      check_equal(found[k].amplitude * std::abs(std::complex<double>(1.0, twins.lag * wanted[k].frequency)),
                  wanted[k].amplitude);
      CHECK(found[k].stable == wanted[k].stable);
      const auto one = nine_harmonics(sensor, found[k]), other = nine_harmonics(actuator, wanted[k]);
      CHECK(one.harmonics == other.harmonics);
      check_equal(one.frequency, other.frequency);
    }
    if (found.empty()) continue;
    CompositeSearchOptions search;
    search.frequency_min = 0.3 * wanted.front().frequency;
    search.frequency_max = 3.0 * wanted.front().frequency;
    const auto of_sensor = CompositeBalance(sensor).find(search), of_actuator = CompositeBalance(actuator).find(search);
    REQUIRE(of_sensor.roots.size() == of_actuator.roots.size());
    for (std::size_t k = 0; k < of_sensor.roots.size(); ++k) {
      ++composites;
      CHECK(of_sensor.roots[k].frequency == Approx(of_actuator.roots[k].frequency).epsilon(1e-7));
      CHECK(of_sensor.roots[k].stable == of_actuator.roots[k].stable);
    }
  }
  CHECK(predictions >= 4);
  CHECK(composites >= 2);
}

TEST_CASE("friction anywhere: harmonic balance agrees with the exact cycle, which has no port for the displacement") {
  std::mt19937_64 random(29);
  int compared = 0;
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i);
    PredictOptions options;
    options.methods.composite = false;
    options.search = wide;
    const auto report = predict(build_loop(random_twins(random).as_sensor), options);
    for (const Prediction& p : predictions_of(report, "harmonic-balance")) {
      if (!p.cycle || report.cycles[*p.cycle].sticking_fraction > 1e-3) continue;
      ++compared;
      CHECK(p.frequency == Approx(report.cycles[*p.cycle].frequency()).epsilon(1e-3));
      CHECK(p.amplitude == Approx(report.cycles[*p.cycle].first_harmonic).epsilon(1e-3));
    }
  }
  CHECK(compared >= 1);
}

TEST_CASE("the search box, which is of what rubs, is brought to y by the response to slow forces") {
  const auto of = [](double per_stroke, double stiffness) {
    StateSpacePlant valve;
    valve.A.resize(3, 3);
    valve.A << 0.0, 1.0, 0.0, -stiffness / 5.0, -400.0, 0.0, 0.5 * per_stroke, 0.0, -0.5;
    valve.B = valve.B_friction = Eigen::Vector3d(0.0, 0.2, 0.0);
    valve.C = Eigen::RowVector3d(0.0, 0.0, 1.0);
    valve.C_velocity = Eigen::RowVector3d(0.0, 1.0, 0.0);
    LoopParts parts;
    parts.plant = valve;
    parts.controller = pid(5.0, 5.0, 0.0);
    parts.friction = coulomb(100.0, 80.0);
    return output_per_input(build_loop(parts));
  };
  CHECK(of(5000.0, 50e3) == Approx(5000.0).epsilon(1e-12));
  CHECK(of(-7.5, 50e3) == Approx(7.5).epsilon(1e-12));
  CHECK(of(0.02, 0.0) == Approx(0.02).epsilon(1e-12));
  LoopParts parts;
  parts.plant = TwoMass{0.5, 0.5, 200.0, 1.0};
  parts.controller = pid(3.0, 4.0, 6.0);
  parts.friction = coulomb(1.5, 1.0);
  CHECK(output_per_input(build_loop(parts)) == 1.0);
}
