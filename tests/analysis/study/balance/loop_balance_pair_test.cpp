#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/tests/analysis/predictions.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr SearchBox wide{1e-4, 100.0, 0.01, 100.0};

/// m = 1 kg under PID (3, 4, 6) whose command ends at 4 N, with Coulomb friction.
Loop weak_servo(double Fs, double Fc) {
  LoopParts parts = servo_parts(coulomb(Fs, Fc));
  Pid limited = pid(3.0, 4.0, 6.0);
  limited.saturation = 4.0;
  parts.controller = limited;
  return build_loop(parts);
}

/// N of a saturation of slope 1 and limit 4.
double limited_gain(double a) {
  const double b = 4.0 / a;
  return b >= 1.0 ? 1.0 : 2.0 / std::numbers::pi * (std::asin(b) + b * std::sqrt(1.0 - b * b));
}

/// -w^2 A + N(|C| A) C A + j 4 Fc/pi = 0 with C = 3 + j (6 w - 4/w): the real part gives N = w^2/3, the imaginary part
/// A, and one equation for w below sqrt(2/3) remains.
std::pair<double, double> by_hand(double Fc) {
  const auto amplitude = [&](double w) { return 12.0 * Fc / (std::numbers::pi * w * w * (4.0 / w - 6.0 * w)); };
  const auto defect = [&](double w) {
    return limited_gain(std::hypot(3.0, 4.0 / w - 6.0 * w) * amplitude(w)) - w * w / 3.0;
  };
  double low = 0.6, high = std::sqrt(2.0 / 3.0) - 1e-12;
  REQUIRE(defect(low) * defect(high) < 0.0);
  for (int i = 0; i < 80; ++i) {
    const double mid = 0.5 * (low + high);
    (defect(low) * defect(mid) < 0.0 ? high : low) = mid;
  }
  return {amplitude(low), low};
}

}  // namespace

TEST_CASE("a weak motor beside friction: the oscillation at which it loses the servo is found, whatever the friction") {
  // Without friction N C = w^2: w^2 = 2/3, N = 2/9.
  for (const double Fc : {1.0, 0.1, 1e-3, 1e-6}) {
    INFO("Fc " << Fc);
    const Loop loop = weak_servo(Fc, Fc);
    const FirstHarmonicBalance balance(loop);
    const auto [A, w] = by_hand(Fc);
    const auto found = find_df_roots(loop, balance, wide, {});
    REQUIRE(found.roots.size() == 1);
    CHECK(found.status == Status::converged);
    CHECK(found.roots[0].amplitude == Approx(A).epsilon(1e-6));
    CHECK(found.roots[0].frequency == Approx(w).epsilon(1e-7));
    CHECK(std::abs(balance(found.roots[0].amplitude, found.roots[0].frequency, 1e-12)) <
          1e-4);  // the second amplitude is sharp there
    CHECK(balance.stable(found.roots[0].amplitude, found.roots[0].frequency, found.roots[0].index) == false);
    CHECK(balance.output_amplitude(found.roots[0].amplitude, found.roots[0].frequency) == Approx(A).epsilon(1e-5));
  }
}

TEST_CASE("the roots of two elements are the same from either side") {
  const Loop loop = weak_servo(1.0, 1.0);
  const FirstHarmonicBalance balance(loop);
  const auto [A, w] = by_hand(1.0);
  const double second = std::hypot(3.0, 4.0 / w - 6.0 * w) * A;
  bool seen = false;
  for (int branch = 0; branch < AmplitudeBranches::most; ++branch) {
    const auto point = balance.from_second(branch, second, w, 1e-9);
    if (!(std::abs(point.left) < 1e-8)) continue;
    CHECK(point.amplitude == Approx(A).epsilon(1e-9));
    seen = true;
  }
  CHECK(seen);
}

TEST_CASE("a weak motor beside friction: there is an unstable cycle between hunting and running away") {
  PredictOptions options;
  options.search = wide;
  const auto report = predict(weak_servo(1.5, 1.0), options);
  REQUIRE(report.cycles.size() == 2);
  const auto unstable = std::ranges::find(report.cycles, std::optional(false), &Cycle::stable);
  REQUIRE(unstable != report.cycles.end());
  CHECK(unstable->amplitude > 8.0);  // from 8 m it returns, from 10 m it does not
  CHECK(unstable->amplitude < 10.0);
  REQUIRE_FALSE(unstable->multipliers.empty());
  CHECK(std::abs(unstable->multipliers.front()) > 1.0);
  const auto seen = predictions_of(report, "describing-function");
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].stable == false);
  CHECK(seen[0].cycle == std::size_t(unstable - report.cycles.begin()));
}

TEST_CASE("a limited integrator holds a load: the body has no mean velocity, and the roots are those without load") {
  const auto loaded = [](double load) {
    LoopParts parts = servo_parts(lugre());
    Pid limited = pid(3.0, 4.0, 6.0);
    limited.saturation = 40.0;
    parts.controller = limited;
    parts.load = load;
    return build_loop(parts);
  };
  const Loop with = loaded(-7.7), without = loaded(0.0);
  const FirstHarmonicBalance balance(with), free(without);
  CHECK(balance.mean_velocity() == 0.0);
  for (const double A : {1e-3, 0.1, 10.0})
    for (const double w : {0.1, 1.0, 10.0})
      CHECK(std::abs(balance(A, w, 1e-9) - free(A, w, 1e-9)) < 1e-8 * std::abs(free(A, w, 1e-9)));
  // A motion that begins in a predicted oscillation carries the load in its integrator.
  const Eigen::VectorXd swing = balance.linear_state(1e-3, 1.0, 0.0) - free.linear_state(1e-3, 1.0, 0.0);
  const Eigen::VectorXd rate = working_loop(with) * swing + with.E * with.external;
  CHECK(rate.norm() < 1e-9 * 7.7);
}

TEST_CASE("branches of an amplitude are the monotone pieces of what drives it") {
  const auto s = [](double a) { return a - 1.5 * std::sin(a); };  // turns where cos a = 2/3
  AmplitudeBranches branches;
  const double turn = std::acos(2.0 / 3.0);
  const auto at = [&](double wanted) { return branches.answers(s, {0.1, 20.0}, wanted, 1.0, 1e-6); };
  const auto low = at(0.5);
  REQUIRE(low.size() == 1);
  CHECK(s(low[0].amplitude) == Approx(0.5).epsilon(1e-12));
  const double crest = 2.0 * std::numbers::pi - turn, between = 0.5 * (s(crest) + s(crest + 2.0 * turn));
  const auto three = at(between);
  REQUIRE(three.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(three[k].branch == static_cast<int>(k) + 1);
    CHECK(s(three[k].amplitude) == Approx(between).epsilon(1e-12));
  }
  CHECK(three[0].amplitude < crest);
  CHECK(three[1].amplitude > crest);
  CHECK(three[2].amplitude > crest + 2.0 * turn);
}

TEST_CASE("loop balance: a belt that runs the other way starts from the mirrored state") {
  const auto at_speed = [](double speed) {
    LoopParts parts;
    parts.plant = Belt{1.0, 2.0, 0.1, speed};
    parts.friction = stribeck(1.5, 1.0, 0.1);
    return build_loop(parts);
  };
  const Loop one = at_speed(0.2), other = at_speed(-0.2);
  const LoopState a = FirstHarmonicBalance(one).state(0.3, 1.4), b = FirstHarmonicBalance(other).state(0.3, 1.4);
  REQUIRE(a.x.size() == b.x.size());
  for (std::size_t i = 0; i < a.x.size(); ++i) CHECK(b.x[i] == Approx(-a.x[i]).epsilon(1e-9).margin(1e-12));
}
