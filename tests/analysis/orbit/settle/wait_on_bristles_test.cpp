#include "limcycle/analysis/orbit/settle/wait_on_bristles.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double rtol = 1e-7;

/// The servo that reads every 10 ms, in units in which lengths are `finer` times as large.
Loop sampled_servo(double finer, double sign) {
  LuGre<double> law = lugre();
  law.vs *= finer;
  law.sigma0 /= finer;
  law.sigma1 /= finer;
  law.sigma2 /= finer;
  LoopParts parts = servo_parts(law);
  parts.plant = Mass{1.0 / finer, 0.0, 0.0};
  Pid& controller = std::get<Pid>(parts.controller);
  for (double* gain : {&controller.kp, &controller.ki, &controller.kd}) *gain /= finer;
  controller.sample_time = 0.01;
  parts.reference = sign * 0.25 * finer;
  return in_time_domain(build_loop(parts), lowest_pade_order).loop;
}

/// So much later, sample by sample.
LoopState moved_on(const Loop& loop, const LoopState& from, double time) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, rtol));
  march.begin(from.x, 0.0);
  while (march.t() < time) REQUIRE(march.step(time) == Status::converged);
  return {march.x(), field.modes()};
}

}  // namespace

TEST_CASE("a wait on bristles: the state before it breaks away is that of all the samples, in any unit of length") {
  for (const auto& [finer, sign] : {std::pair{1.0, 1.0}, {1000.0, 1.0}, {1.0, -1.0}}) {
    CAPTURE(finer, sign);
    const Loop loop = sampled_servo(finer, sign);
    const std::size_t rubs = loop.elements.size() - 1;
    const LoopState stuck = moved_on(loop, displaced(loop, sign * 3e-3 * finer), 20.0);
    const auto waited = wait_on_bristles(loop, stuck, rubs, rtol, 60000, {});
    REQUIRE(waited);
    REQUIRE(waited->resume);
    CHECK(!waited->still);
    CHECK(waited->time > 50.0);
    CHECK(waited->steps < 2000);  // of more than 5,000 samples
    const LoopState all = moved_on(loop, stuck, waited->time);
    const auto bristle = LoopField(loop).first_state(rubs);
    CHECK(waited->resume->x[bristle] == Approx(all.x[bristle]).epsilon(2e-3));
    const Eigen::VectorXd X = continuous_state(loop, *waited->resume), Y = continuous_state(loop, all);
    const State sizes = typical_sizes(*loop.continuous);
    for (Eigen::Index i = 0; i < X.size(); ++i)
      CHECK(std::abs(X(i) - Y(i)) < 2e-3 * sizes[static_cast<std::size_t>(i)]);
  }
}

TEST_CASE("a wait on bristles: a body that creeps to its set-point comes to rest") {
  const Loop loop = sampled_servo(1.0, 1.0);
  const LoopState stuck = moved_on(loop, displaced(loop, 1e-5), 20.0);
  const auto waited = wait_on_bristles(loop, stuck, loop.elements.size() - 1, rtol, 60000, {});
  REQUIRE(waited);
  REQUIRE(waited->still);
  CHECK(waited->still->outcome == Outcome::rest);
}

TEST_CASE("states of the continuous controller are read back from those of the sampled one") {
  const Loop loop = sampled_servo(1.0, 1.0);
  Eigen::VectorXd X = Eigen::VectorXd::Zero(loop.continuous->states());
  for (Eigen::Index i = 0; i < X.size(); ++i) X(i) = 0.1 * static_cast<double>(i + 1);
  CHECK((continuous_state(loop, sampled_state(loop, X)) - X).norm() < 0.011 * X.norm());
}
