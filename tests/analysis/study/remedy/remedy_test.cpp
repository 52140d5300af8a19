#include "limcycle/analysis/study/remedy/remedy.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/study/remedy/remedy_order.hpp"
#include "limcycle/tests/analysis/study/remedy/over_compensated.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using limcycle::test::coulomb;
using limcycle::test::over_compensated;
using limcycle::test::servo_parts;
using limcycle::test::some_of;

namespace {

/// One number of the controller.
RemedyCandidate of_controller(const LoopParts& parts, double Pid::*number, Measure measure, RemedyCandidate::Way way) {
  return {"test",
          "loop.controller.test",
          "1",
          {},
          std::get<Pid>(parts.controller).*number,
          measure,
          way,
          [parts, number](double value) -> std::optional<LoopParts> {
            LoopParts with = parts;
            std::get<Pid>(with.controller).*number = value;
            return with;
          }};
}

RemedyCandidate leak_of(const LoopParts& parts) {
  return of_controller(parts, &Pid::leak, Measure::rate, RemedyCandidate::Way::up);
}

/// Units of length, in m. Searches take ten to twenty times as long under sanitizers: one unit there.
std::vector<double> units() { return some_of(std::vector{1.0, 1e-3}); }

RemedyOptions quick(int threads = 1) {
  RemedyOptions options;
  options.predict.methods = {false, false, false};
  options.threads = threads;
  return options;
}

}  // namespace

TEST_CASE("remedy: the leak of a servo, its edge where the slip no longer leads to the next break-away, in two units") {
  // At the edge the body waits for ever at y* = Fs/(kp + ki/leak), and slips from there to -y*: by an independent
  // integration of the slip. From the starts of predict() it comes to rest a little before that.
  constexpr double edge = 0.109872788;
  std::vector<double> leaks, errors;
  for (const double unit : units()) {  // of length, with the forces unchanged
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    parts.plant = Mass{1.0 / unit, 0.0, 0.0};
    parts.controller = test::pid(3.0 / unit, 4.0 / unit, 6.0 / unit);
    const auto candidate = leak_of(parts);
    const RemedyReport report = remedies(parts, {candidate}, quick());
    CHECK(report.hunts == Hunts::yes);
    CHECK(report.status == Status::converged);
    REQUIRE(report.remedies.size() == 1);
    const Remedy& remedy = report.remedies.front();
    REQUIRE(remedy.ends == true);
    REQUIRE(remedy.edges.size() == 1);
    CHECK(remedy.value == remedy.edges[0]);
    CHECK(remedy.edges[0] / remedy.beyond[0] > 1.0);
    CHECK(remedy.edges[0] / remedy.beyond[0] < 1.002);
    const auto has_cycle = [&](double value) {
      const auto found = predict(build_loop(*candidate.parts(value)));
      return std::ranges::any_of(found.cycles, [](const Cycle& one) { return one.stable == true; });
    };
    CHECK(remedy.edges[0] > edge);
    CHECK(remedy.beyond[0] < edge);
    CHECK_FALSE(has_cycle(remedy.edges[0]));
    CHECK(has_cycle(0.99 * remedy.beyond[0]));
    REQUIRE(remedy.costs.steady_state_error);  // Fs/(kp + ki/leak)
    CHECK(remedy.costs.steady_state_error->high == Approx(1.5 * unit / (3.0 + 4.0 / remedy.value)).epsilon(1e-9));
    CHECK(remedy.costs.settling_time.value() > 0.0);
    CHECK(remedy.best);
    CHECK_FALSE(report.now.settling_time);  // it hunts
    leaks.push_back(remedy.value);
    errors.push_back(remedy.costs.steady_state_error->high / unit);
  }
  CHECK(leaks.front() == Approx(leaks.back()).epsilon(3e-3));
  CHECK(errors.front() == Approx(errors.back()).epsilon(3e-3));
}

TEST_CASE("remedy: too strong a compensation is cured at the level of the friction, and weights decide the order") {
  const LoopParts parts = over_compensated();
  const auto candidates = some_of(
      std::vector{of_controller(parts, &Pid::kp, Measure::stiffness, RemedyCandidate::Way::down),
                  of_controller(parts, &Pid::friction_compensation, Measure::force, RemedyCandidate::Way::both)});
  RemedyReport report = remedies(parts, candidates, quick(2));
  REQUIRE(report.remedies.size() == candidates.size());
  for (const Remedy& one : report.remedies) {
    REQUIRE(one.ends == true);
    if (one.candidate.own == 1.3) CHECK(one.value == Approx(1.0).epsilon(2e-3));  // Fc
  }
  if (candidates.size() < 2) return;
  for (const auto& [cost, by_error] : {std::pair(0, true), {6, false}}) {  // error; noise
    CostWeights weights{};
    weights[static_cast<std::size_t>(cost)] = 1.0;
    order_remedies(report.remedies, weights);
    const auto& best = report.remedies[0].costs;
    const auto& other = report.remedies[1].costs;
    if (by_error)
      CHECK(best.steady_state_error->high < other.steady_state_error->high);
    else
      CHECK(best.noise_gain.value() < other.noise_gain.value());
  }
}

TEST_CASE("remedy: the same for any number of threads, and what does not apply comes last with its reason") {
  const LoopParts parts = over_compensated();
  auto candidates =
      some_of(std::vector{of_controller(parts, &Pid::kd, Measure::damping, RemedyCandidate::Way::up),
                          of_controller(parts, &Pid::kp, Measure::stiffness, RemedyCandidate::Way::down)});
  candidates.insert(candidates.begin(), {"dither", "", "", "there is none here"});
  const RemedyReport one = remedies(parts, candidates, quick(1)), two = remedies(parts, candidates, quick(2));
  REQUIRE(one.remedies.size() == candidates.size());
  CHECK(one.remedies.back().candidate.name == "dither");
  CHECK(one.remedies.back().why == "there is none here");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    CHECK(one.remedies[i].value == two.remedies[i].value);
    CHECK(one.remedies[i].costs.settling_time == two.remedies[i].costs.settling_time);
    CHECK(one.remedies[i].why == two.remedies[i].why);
  }
}

TEST_CASE("remedy: what makes a start diverge that hunted is no cure, what diverged before may") {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  std::get<Pid>(parts.controller).saturation = 4.0;  // from afar it diverges already
  Judging judging;
  judging.predict.search = SearchBox{1e-4, 100.0, 0.01, 100.0};
  const HuntsAnswer before = hunts(build_loop(parts), judging);
  CHECK(before.hunts == Hunts::yes);
  judging.may_diverge = judging_of_variants({}, before.found).may_diverge;
  REQUIRE_FALSE(judging.may_diverge.empty());
  CHECK(judging.may_diverge.size() < 5);
  parts.friction = coulomb(1.0, 1.0);
  CHECK(hunts(build_loop(parts), judging).hunts == Hunts::no);
  std::get<Pid>(parts.controller).kd = 0.1;  // the linear part is unstable: more starts diverge
  CHECK(hunts(build_loop(parts), judging).hunts == Hunts::diverges);
}

TEST_CASE("remedy: mirrored gains have the mirrored edge") {
  std::vector<double> edges;
  for (const double sign : {1.0, -1.0}) {  // y = -x, and all gains negative
    LoopParts parts;
    StateSpacePlant plant;
    plant.A = Eigen::MatrixXd{{0.0, 1.0}, {0.0, 0.0}};
    plant.B = Eigen::MatrixXd{{0.0}, {1.0}};
    plant.C = Eigen::MatrixXd{{sign, 0.0}};
    plant.C_friction = Eigen::MatrixXd{{1.0, 0.0}};
    plant.C_velocity = Eigen::MatrixXd{{0.0, 1.0}};
    parts.plant = plant;
    parts.controller = test::pid(sign * 3.0, sign * 4.0, sign * 6.0);
    parts.friction = coulomb(1.05, 1.0);
    const RemedyReport report =
        remedies(parts, {of_controller(parts, &Pid::ki, Measure::own, RemedyCandidate::Way::both)}, quick());
    REQUIRE(report.remedies.size() == 1);
    REQUIRE(report.remedies[0].ends == true);
    edges.push_back(report.remedies[0].value);
  }
  CHECK(edges[0] == Approx(-edges[1]).epsilon(1e-3));
}

TEST_CASE("remedy: a loop that rests needs none, and a stop keeps what is known") {
  const LoopParts parts = servo_parts(coulomb(1.0, 1.0));
  const RemedyReport report = remedies(parts, {leak_of(parts)}, quick());
  CHECK(report.hunts == Hunts::no);
  CHECK(report.remedies.empty());
  RemedyOptions stopped = quick();
  stopped.predict.stop = [] { return true; };
  CHECK(remedies(servo_parts(coulomb(1.5, 1.0)), {}, stopped).status == Status::interrupted);
}

TEST_CASE("remedy: a limit and a band of the integral, from infinity down, in two units of length") {
  for (const auto& [number, measure] : some_of(std::vector{std::pair(&Pid::integral_limit, Measure::force),
                                                           std::pair(&Pid::integral_band, Measure::displacement)})) {
    std::vector<double> values;
    for (const double unit : units()) {
      LoopParts parts = servo_parts(coulomb(1.5, 1.0));
      parts.plant = Mass{1.0 / unit, 0.0, 0.0};
      parts.controller = test::pid(3.0 / unit, 4.0 / unit, 6.0 / unit);
      const auto candidate = of_controller(parts, number, measure, RemedyCandidate::Way::down);
      REQUIRE(candidate.is_absent());
      const RemedyReport report = remedies(parts, {candidate}, quick());
      const Remedy& remedy = report.remedies.front();
      INFO(remedy.why);
      REQUIRE(remedy.ends == true);
      CHECK(remedy.beyond.at(0) > remedy.value);
      CHECK(remedy.beyond.at(0) / remedy.value - 1.0 < 2e-3);
      const Judging judging = judging_of_variants(quick().predict, hunts(build_loop(parts), {}).found);
      CHECK(hunts(build_loop(*candidate.parts(remedy.value)), judging).hunts == Hunts::no);
      // Just above the edge the cycle attracts from nearby only; well above it from the starts of predict() too.
      CHECK(hunts(build_loop(*candidate.parts(1.3 * remedy.value)), judging).hunts == Hunts::yes);
      values.push_back(measure == Measure::force ? remedy.value : remedy.value / unit);
    }
    CHECK(values.back() == Approx(values.front()).epsilon(2e-3));
  }
}

TEST_CASE("a reset of the integral ends hunting, from a share on to a change of its sign, in two units of length") {
  // Beerens et al. (2021): hunting on stiction ends where the integral is reset at zeros of the error.
  for (const double unit : units()) {
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    parts.plant = Mass{1.0 / unit, 0.0, 0.0};
    const auto hunts_at = [&](double share, double interval) {
      Pid controller = test::pid(3.0 / unit, 4.0 / unit, 6.0 / unit);
      controller.integral_reset = share;
      controller.reset_interval = interval;
      parts.controller = controller;
      return hunts(build_loop(parts), {}).hunts;
    };
    CHECK(hunts_at(0.45, 0.0) == Hunts::yes);
    CHECK(hunts_at(1.0, 0.0) == Hunts::no);
    CHECK(hunts_at(1.0, 0.1) == Hunts::no);
    CHECK(hunts_at(2.0, 0.1) == Hunts::no);  // without an interval the resets accumulate
  }
}

TEST_CASE("remedy: a cycle that shrinks to nothing is followed to its edge, farther than starts find it") {
  LoopParts parts = servo_parts(coulomb(1.05, 1.0));
  const auto candidate = of_controller(parts, &Pid::integral_reset, Measure::own, RemedyCandidate::Way::up);
  const Remedy remedy = remedies(parts, {candidate}, quick()).remedies.front();
  INFO(remedy.why);
  REQUIRE(remedy.ends == true);
  const double ratio = remedy.value / remedy.beyond.at(0);
  CHECK(ratio > 1.0);
  CHECK(ratio < 1.2);
  const Judging judging = judging_of_variants(quick().predict, hunts(build_loop(parts), {}).found);
  CHECK(hunts(build_loop(*candidate.parts(remedy.value)), judging).hunts == Hunts::no);
  // Nearest to the edge no start falls into the cycle, which is followed up to there: predict finds it a tenth before.
  CHECK(hunts(build_loop(*candidate.parts(0.9 * remedy.beyond[0])), judging).hunts == Hunts::yes);
  REQUIRE(remedy.costs.steady_state_error);  // at rest the error is zero, as with a linear integral
  CHECK(remedy.costs.steady_state_error->high == Approx(0.0).margin(1e-9));
  CHECK(remedy.costs.steady_state_error->low == Approx(0.0).margin(1e-9));
}

TEST_CASE("impulses in the place of integral action bring a servo within their band, in two units of length") {
  std::vector<double> sizes, edges;
  for (const double unit : units()) {
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    parts.plant = Mass{1.0 / unit, 0.0, 0.0};
    parts.controller = test::pid(3.0 / unit, 4.0 / unit, 6.0 / unit);
    RemedyCandidate candidate{"test",         "loop.controller.impulse", "N", {}, 0.0,
                              Measure::force, RemedyCandidate::Way::up};
    candidate.sized = [parts, candidate](const HuntingSizes& of) {
      RemedyCandidate with = candidate;
      with.sized = {};
      with.band = 0.1 * of.displacement;
      with.parts = [parts, of](double force) -> std::optional<LoopParts> {
        LoopParts pushed = parts;
        auto& pid = std::get<Pid>(pushed.controller);
        pid.ki = 0.0;
        pid.impulse = force;
        pid.impulse_width = 0.01;
        pid.impulse_pause = 0.5;
        pid.impulse_band = 0.1 * of.displacement;
        pid.impulse_speed = 0.01 * of.displacement * of.frequency;
        return pushed;
      };
      return with;
    };
    const RemedyReport report = remedies(parts, {candidate}, quick());
    REQUIRE(report.remedies.size() == 1);
    const Remedy& remedy = report.remedies.front();
    REQUIRE(remedy.ends == true);
    const double band = remedy.candidate.band;
    CHECK(remedy.costs.steady_state_error->high == Approx(band).epsilon(1e-6));
    CHECK(remedy.costs.actuator_travel.value() > 2.0 * remedy.value);
    const auto ends_at = [&](double force) {
      const auto found = predict(build_loop(*remedy.candidate.parts(force)));
      double most = 0.0;
      for (const auto& one : found.outcomes) {
        CHECK(one.outcome == Outcome::rest);
        most = std::max(most, std::abs(one.trace.y.back()));
      }
      return most;
    };
    CHECK(ends_at(remedy.value) <= 1.01 * band);
    CHECK(ends_at(0.98 * remedy.value) > band);
    if (!remedy.edges.empty()) {
      CHECK(remedy.beyond.front() / remedy.edges.front() < 1.002);
      // Just beyond there is a stable cycle that no start of predict() reaches.
      const auto beyond = predict(build_loop(*remedy.candidate.parts(1.5 * remedy.beyond.front())));
      CHECK(std::ranges::any_of(beyond.cycles, [](const Cycle& one) { return one.stable == true; }));
    }
    sizes.push_back(remedy.value);
    edges.push_back(remedy.edges.empty() ? 0.0 : remedy.edges.front());
  }
  for (const double size : sizes) CHECK(size == Approx(sizes.front()).epsilon(0.02));
  for (const double edge : edges) CHECK(edge == Approx(edges.front()).epsilon(0.02));
}

TEST_CASE("remedy: an integral dead zone need only hide half of what a slip is long, in closed form") {
  // While the integral is slow and the slip overdamped, a slip leads from Fs to Fc = kp e + I at the same I: over
  // (Fs - Fc)/kp. It begins where |e| just exceeds the half-width h, and ends within the dead zone for good if it is
  // not longer than 2 h. Derived. A slip without damping would be twice as long, so that h = (Fs - Fc)/kp is always
  // enough.
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.plant = Mass{0.01, 0.0, 0.0};
  parts.controller = test::pid(3.0, 0.5, 6.0);
  const RemedyReport report =
      remedies(parts, {of_controller(parts, &Pid::integral_dead_zone, Measure::displacement, RemedyCandidate::Way::up)},
               quick());
  REQUIRE(report.remedies.front().ends == true);
  CHECK(report.remedies.front().value == Approx(0.5 * (1.5 - 1.0) / 3.0).epsilon(0.01));
}
