#include "limcycle/analysis/orbit/settle/watch/rest_watch.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "limcycle/analysis/orbit/simulate/ensemble.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

using Motion = std::function<std::pair<State, State>(double)>;  ///< state and rates at a time

/// Feeds a motion of states of size 1 and slowest time constant 1 s to a watch, in steps of 0.1 s.
RestWatch::Verdict watched(const Motion& motion, double rtol, double duration) {
  RestWatch watch({1.0, 1.0}, 1.0, rtol);
  for (int i = 0; 0.1 * i < duration; ++i) {
    const auto [x, dx] = motion(0.1 * i);
    const auto verdict = watch.look(0.1 * i, x, dx);
    if (verdict != RestWatch::Verdict::moving) return verdict;
  }
  return RestWatch::Verdict::moving;
}

/// PD servos at rest on a bristle, whose march trembles and creeps within the tolerances for ever.
std::vector<Loop> trembling() {
  std::vector<Loop> loops;
  auto law = lugre(1.146360027307916, 0.99481503776775049, 0.64878601089120735);
  law.vs = 0.055371739034407612;
  law.sigma0 = 190415.66558494631;
  law.sigma1 = 411.61834793667697;
  auto parts = servo_parts(law);
  parts.plant = Mass{1.84740154061881, 0.89889466687017472, 0.0};
  parts.controller = pid(4.5764749931482038, 0.0, 2.3624844406401788);
  loops.push_back(build_loop(parts));
  law = lugre(1.6503357112117851, 0.63953480683901986, 0.88782269972118411);
  law.vs = 0.089468354213222773;
  law.sigma0 = 122840.36086969241;
  law.sigma1 = 335.35937738676303;
  parts = servo_parts(law);
  parts.plant = Mass{0.61954226882429886, 0.089890017239544873, 0.0};
  parts.controller = pid(6.3422994385986424, 0.0, 6.8740877537050054);
  loops.push_back(build_loop(parts));
  return loops;
}

/// Friction with a different level in each direction.
LuGre<double> uneven(double sigma0) {
  auto law = lugre();
  law.sigma0 = sigma0;
  law.sigma1 = std::sqrt(sigma0);
  law.Fs_minus = 1.2;
  law.Fc_minus = 0.9;
  return law;
}

Loop slow_servo(const Element& friction, double ki, double kd) {
  auto parts = servo_parts(friction);
  parts.controller = pid(3.0, ki, kd);
  return build_loop(parts);
}

EnsembleResult in_ensemble(const Loop& loop, Isa isa = Isa::scalar) {
  const EnsembleMember member{&loop, displaced(loop, 0.5)};
  EnsembleOptions options;
  options.isa = isa;
  return run_ensemble(std::span(&member, 1), options).members[0];
}

}  // namespace

TEST_CASE("rest watch: a tremble is rest, whatever its rates, and so is one that creeps within the noise") {
  const double rtol = 1e-6;
  for (const double creep : {0.0, 0.5e-8})
    CHECK(watched(
              [creep](double t) {
                return std::pair<State, State>{{0.3 + creep * t + 1e-9 * std::sin(977.0 * t), 0.0},
                                               {creep + 977e-9 * std::cos(977.0 * t), 0.0}};
              },
              rtol, 1e4) == RestWatch::Verdict::at_rest);
}

TEST_CASE("rest watch: one state that winds up slowly while all others stay is not rest") {
  const auto winding = [](double rate) {
    return watched(
        [rate](double t) {
          return std::pair<State, State>{{0.3 + 1e-9 * std::sin(977.0 * t), rate * t},
                                         {977e-9 * std::cos(977.0 * t), rate}};
        },
        1e-6, 1e5);
  };
  CHECK(winding(1e-7) == RestWatch::Verdict::moving);
  CHECK(winding(2e-8) == RestWatch::Verdict::moving);  // twice the noise, 0.01 rtol
  CHECK(winding(1e-9) == RestWatch::Verdict::at_rest);
  const auto sliding = [](double t) { return std::pair<State, State>{{0.1 * t, 0.1}, {0.1, 0.0}}; };
  CHECK(watched(sliding, 1e-6, 1e4) == RestWatch::Verdict::steady);
}

TEST_CASE("rest watch: a motion that fades after a long wait is looked at on its own scale") {
  const double wait = 1e9, rtol = 1e-6;
  const auto fading = [](double t) { return std::pair<State, State>{{std::exp(-t), 0.0}, {-std::exp(-t), 0.0}}; };
  RestWatch watch({1.0, 1.0}, 1.0, rtol);
  for (double t = 0.0; t < wait; t = watch.next())
    REQUIRE(watch.look(t, {1.0, 1e-3 * t}, {0.0, 1e-3}) != RestWatch::Verdict::at_rest);
  watch.switched(wait);
  double rested = 0.0;
  for (double t = 0.0; t < 100.0 && rested == 0.0; t += 0.1) {
    const auto [x, dx] = fading(t);
    if (watch.look(wait + t, x, dx) == RestWatch::Verdict::at_rest) rested = t;
  }
  CHECK(rested > 10.0);
  CHECK(rested < 100.0);
}

TEST_CASE("rest watch: a cycle with long stick, sampled each time as it breaks away, moves") {
  RestWatch watch({1.0, 1.0}, 1.0, 1e-6);
  const double period = 1.1, slip = 0.1;
  for (int k = 0; k < 1000; ++k) {
    const double sticks = period * k, breaks_away = period * (k + 1) - slip;
    watch.switched(sticks);
    // The integrator winds up from -0.5 to 0.5 in a single step.
    watch.look(sticks, {0.3, -0.5}, {0.0, 1.0});
    REQUIRE(watch.look(breaks_away, {0.3, 0.5}, {0.0, 1.0}) != RestWatch::Verdict::at_rest);
    watch.switched(breaks_away);
  }
}

TEST_CASE("a servo that trembles on its bristle has come to rest, alone and in lanes of every kind") {
  for (const Loop& loop : trembling()) {
    const auto settled = settle(loop, displaced(loop, 0.5), {});
    CHECK(settled.outcome == Outcome::rest);
    CHECK(settled.time < 60.0);
    for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) {
      if (!is_available(isa)) continue;
      const auto member = in_ensemble(loop, isa);
      CHECK(member.in_lanes);
      CHECK(member.outcome == Outcome::rest);
      CHECK(member.time < 60.0);
    }
  }
}

TEST_CASE("slow hunting is no rest: a weak integrator, also on friction that is uneven") {
  struct {
    Loop loop;
    double period;
  } const hunting[] = {{slow_servo(lugre(), 4e-2, 6.0), 1591.7514},
                       {slow_servo(uneven(1e4), 0.4, 6.0), 2124.3417},
                       {slow_servo(uneven(1e5), 0.4, 6.0), 855.98238}};
  for (const auto& [loop, period] : hunting) {
    const auto settled = settle(loop, displaced(loop, 0.5), {});
    REQUIRE(settled.outcome == Outcome::cycle);
    CHECK(settled.shot->cycle.period == Approx(period).epsilon(1e-5));
    const auto member = in_ensemble(loop);
    CHECK(member.outcome == Outcome::cycle);
    CHECK(member.period == Approx(period).epsilon(2e-4));
  }
}

TEST_CASE("slow hunting is no rest: an integrator 1000 and 10000 times weaker on ideal stiction") {
  for (const double ki : {4e-3, 4e-4})
    for (const bool even : {true, false}) {
      auto law = coulomb(1.5, 1.0, 0.4);
      if (!even) law.Fs_minus = 1.3;
      const Loop loop = slow_servo(law, ki, 1.0);
      SettleOptions options;
      options.max_steps = 4000;
      const auto settled = settle(loop, displaced(loop, 1.0), options);
      CAPTURE(ki, even, settled.time, settled.why);
      CHECK(settled.time > 1e4);
      CHECK((settled.outcome == Outcome::cycle || settled.outcome == Outcome::undecided));
    }
}
