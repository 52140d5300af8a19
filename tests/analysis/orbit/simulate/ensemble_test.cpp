#include "limcycle/analysis/orbit/simulate/ensemble.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

/// Servos and belts with LuGre friction of all kinds, and some with Dahl's.
std::vector<Loop> random_loops(int count) {
  std::mt19937_64 bits(20);
  const auto pick = [&](double from, double to) {
    return from + (to - from) * std::uniform_real_distribution<double>()(bits);
  };
  std::vector<Loop> loops;
  for (int i = 0; i < count; ++i) {
    auto law = test::lugre(pick(1.0, 2.0), pick(0.5, 1.0), pick(0.0, 1.0));
    law.sigma0 = std::pow(10.0, pick(3.0, 6.0));
    law.sigma1 = std::sqrt(law.sigma0) * pick(0.3, 1.5);
    law.vs = std::pow(10.0, pick(-3.0, -1.0));
    if (i % 8 == 3) {
      law.delta = 1.3;
      law.Fc_minus *= 0.9;
      law.vd = 0.1;
    }
    if (i % 8 == 5) law.curve.index = 2;
    Element friction = law;
    if (i % 8 == 6) {
      Dahl<double> dahl;
      dahl.Fc = law.Fc;
      dahl.sigma0 = law.sigma0;
      friction = dahl;
    }
    LoopParts parts = test::servo_parts(friction);
    parts.plant = Mass{pick(0.5, 2.0), pick(0.0, 1.0), 0.0};
    parts.controller = test::pid(pick(1.0, 8.0), i % 2 == 0 ? pick(0.5, 6.0) : 0.0, pick(2.0, 10.0));
    if (i % 3 == 0) {
      parts.plant = Belt{pick(0.5, 2.0), pick(0.5, 5.0), pick(0.0, 2.0), pick(0.005, 0.5)};
      parts.controller = Controller{};
    }
    loops.push_back(build_loop(parts));
  }
  return loops;
}

std::vector<EnsembleMember> members_of(const std::vector<Loop>& loops) {
  std::vector<EnsembleMember> members;
  members.reserve(loops.size());
  for (const Loop& loop : loops) members.push_back({&loop, displaced(loop, 0.5)});
  return members;
}

bool same(const EnsembleResult& a, const EnsembleResult& b) {
  return a.outcome == b.outcome && a.status == b.status && a.period == b.period && a.amplitude == b.amplitude &&
         a.state.x == b.state.x && a.time == b.time && a.steps == b.steps && a.refused == b.refused;
}
bool same(const std::vector<EnsembleResult>& a, const std::vector<EnsembleResult>& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return same(x, y); });
}

EnsembleOptions options(double rtol, double duration = infinite) {
  EnsembleOptions result;
  result.rtol = rtol;
  result.duration = duration;
  result.until_decided = duration == infinite;
  return result;
}

/// Largest error of the states at the end, in their typical sizes, against March at a much tighter tolerance.
double error_against_march(const std::vector<EnsembleMember>& members, double rtol, double duration) {
  const auto run = run_ensemble(members, options(rtol, duration));
  double worst = 0.0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Loop& loop = *members[i].loop;
    LoopField field(loop);
    March march(field, StepperKind::rodas5p, loop_weights(loop, 1e-10));
    march.begin(members[i].start.x, 0.0);
    while (march.t() < duration) REQUIRE(march.step(duration) == Status::converged);
    CHECK(run.members[i].in_lanes);
    CHECK(run.members[i].status == Status::converged);
    CHECK(run.members[i].time == duration);
    const State sizes = typical_sizes(loop);
    for (std::size_t k = 0; k < sizes.size(); ++k)
      worst = std::max(worst, std::abs(run.members[i].state.x[k] - march.x()[k]) / sizes[k]);
  }
  return worst;
}

}  // namespace

TEST_CASE("An ensemble in lanes marches as March does, the better the tighter the tolerance") {
  const auto loops = random_loops(24);
  const auto members = members_of(loops);
  const double loose = error_against_march(members, 1e-5, 3.0), tight = error_against_march(members, 1e-8, 3.0);
  INFO("errors " << loose << ", " << tight);
  CHECK(loose < 1e-2);
  CHECK(tight < 1e-5);
  CHECK(tight < 0.02 * loose);
}

TEST_CASE("Ensemble verdicts and numbers are the same to the last bit for every instruction set") {
  const auto loops = random_loops(240);
  const auto members = members_of(loops);
  auto how = options(1e-6);
  how.max_steps = 8000;
  how.isa = Isa::scalar;
  const auto scalar = run_ensemble(members, how);
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(scalar.members, outcome, &EnsembleResult::outcome);
  };
  CHECK(count(Outcome::cycle) > 30);
  CHECK(count(Outcome::rest) > 30);
  CHECK(count(Outcome::sliding) > 30);
  for (const Isa isa : {Isa::avx2, Isa::avx512}) {
    if (!is_available(isa)) continue;
    how.isa = isa;
    const auto wide = run_ensemble(members, how);
    CHECK(same(wide.members, scalar.members));
    CHECK(wide.occupancy > 0.3);
    CHECK(wide.occupancy <= 1.0);
  }
}

TEST_CASE("An ensemble member does not depend on its neighbours, their order or number, or on threads") {
  const auto loops = random_loops(40);
  const auto members = members_of(loops);
  auto how = options(1e-6);
  how.max_steps = 4000;
  const auto together = run_ensemble(members, how).members;
  for (const std::size_t i : {0U, 3U, 5U, 6U, 11U, 39U})  // alone: the other lanes stay empty
    CHECK(same(run_ensemble(std::span(&members[i], 1), how).members[0], together[i]));
  auto reversed = members;
  std::ranges::reverse(reversed);
  auto backwards = run_ensemble(reversed, how).members;
  std::ranges::reverse(backwards);
  CHECK(same(backwards, together));
  how.threads = 3;
  CHECK(same(run_ensemble(members, how).members, together));
  how.threads = 1;
  how.lanes = 1;
  CHECK(same(run_ensemble(members, how).members, together));
}

TEST_CASE("A lane that leaves the range of numbers does not disturb its neighbours and is used again") {
  auto loops = random_loops(24);
  const auto calm = run_ensemble(members_of(loops), options(1e-6, 5.0)).members;
  std::vector<Loop> mixed;
  for (const Loop& loop : loops) {
    mixed.push_back(loop);
    mixed.push_back(loop);
    mixed.back().A(0, 0) += 400.0;  // e^(400 t)
  }
  auto how = options(1e-6, 5.0);
  how.amplitude_ceiling = 1e308;
  const auto run = run_ensemble(members_of(mixed), how).members;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    CHECK(same(run[2 * i], calm[i]));
    CHECK(run[2 * i + 1].outcome == Outcome::divergence);
    CHECK(run[2 * i + 1].time < 5.0);
  }
}

TEST_CASE("Ensemble verdicts are those of settle, periods and amplitudes to the stated accuracy") {
  const auto loops = random_loops(24);
  const auto members = members_of(loops);
  auto how = options(1e-7);
  how.max_steps = 20000;
  const auto run = run_ensemble(members, how).members;
  int cycles = 0, compared = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    SettleOptions by_shooting;
    by_shooting.rtol = how.rtol;
    by_shooting.max_steps = how.max_steps;
    const auto settled = settle(loops[i], members[i].start, by_shooting);
    if (settled.outcome == Outcome::undecided || run[i].outcome == Outcome::undecided) continue;
    ++compared;
    CAPTURE(i);
    CHECK(run[i].outcome == settled.outcome);
    if (settled.outcome != Outcome::cycle || run[i].outcome != Outcome::cycle) continue;
    ++cycles;
    CHECK(run[i].period == Approx(settled.shot->cycle.period).epsilon(2.0 * how.accuracy));
    CHECK(run[i].amplitude == Approx(settled.shot->cycle.amplitude).epsilon(2.0 * how.accuracy));
  }
  CHECK(compared >= 21);
  CHECK(cycles >= 4);
}

TEST_CASE("Loops of other kinds are marched one by one in the same ensemble") {
  std::vector<Loop> loops{test::servo(test::lugre()), test::forward(test::relay(1.0), {1.0}, {1.0, 3.0, 2.0, 0.0}),
                          test::servo(test::coulomb(1.5, 1.0))};
  std::vector<EnsembleMember> members;
  members.reserve(loops.size());
  for (const Loop& loop : loops) members.push_back({&loop, displaced(loop, 0.5)});
  const auto run = run_ensemble(members, options(1e-8)).members;
  CHECK(run[0].in_lanes);
  CHECK(run[0].outcome == Outcome::cycle);
  CHECK(run[0].period == Approx(24.436786456).epsilon(1e-4));
  CHECK_FALSE(run[1].in_lanes);
  CHECK(run[1].outcome == Outcome::cycle);
  CHECK(run[1].period == Approx(2.0 * M_PI / std::sqrt(2.0)).epsilon(0.05));  // describing function
  CHECK_FALSE(run[2].in_lanes);
  const auto settled = settle(loops[2], members[2].start, {});
  CHECK(run[2].outcome == settled.outcome);
}

TEST_CASE("An ensemble member that was not decided says why") {
  const std::vector<Loop> loops{test::servo(test::lugre())};
  const auto members = members_of(loops);
  auto how = options(1e-6);
  how.duration = 10.0;
  CHECK(run_ensemble(members, how).members[0].status == Status::incomplete);
  how.duration = infinite;
  how.max_steps = 20;
  const auto few = run_ensemble(members, how).members[0];
  CHECK(few.status == Status::max_iterations);
  CHECK(few.outcome == Outcome::undecided);
  CHECK(few.steps == 20);
  how = options(1e-6, 1e5);
  how.max_steps = 100000000;
  std::atomic<int> asked = 0;
  how.stop = [&asked] { return ++asked > 3; };
  const auto stopped = run_ensemble(members, how).members[0];
  CHECK(stopped.status == Status::interrupted);
  CHECK(stopped.time < 1e5);
  CHECK(stopped.state.x.size() == 4);
}

TEST_CASE("An ensemble refuses bad input") {
  const std::vector<Loop> loops{test::servo(test::lugre())};
  const auto good = members_of(loops);
  const auto refuses = [](std::vector<EnsembleMember> members, const EnsembleOptions& how, const char* what) {
    CHECK_THROWS_WITH(run_ensemble(members, how), Contains(what));
  };
  refuses(good, options(0.0), "rtol must be in (0, 0.1], got 0");
  refuses(good, options(NAN), "rtol");
  refuses(good, options(1e-6, -1.0), "duration must be more than 0, got -1");
  auto how = options(1e-6);
  how.until_decided = false;
  refuses(good, how, "duration must be finite");
  how = options(1e-6);
  how.threads = -1;
  refuses(good, how, "threads must lie in 0..1024, got -1");
  how = options(1e-6);
  how.max_steps = 0;
  refuses(good, how, "max_steps");
  how = options(1e-6);
  refuses({{nullptr, {}}}, how, "member 0 has no loop");
  auto bad = good;
  bad[0].start.x.pop_back();
  refuses(bad, how, "must start with 4 states, got 3");
  bad = good;
  bad[0].start.x[1] = NAN;
  refuses(bad, how, "finite");
  bad = good;
  bad[0].start.modes.clear();
  refuses(bad, how, "modes");
  CHECK(run_ensemble({}, how).members.empty());
}
