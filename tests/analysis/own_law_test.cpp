#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/continuation/follow.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/own_law.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/own_laws.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

constexpr double pi = std::numbers::pi;

Dahl<double> dahl(double Fc, double sigma0) {
  Dahl<double> law;
  law.Fc = Fc;
  law.sigma0 = sigma0;
  return law;
}

Jenkins<double> jenkins(double k, double Fc) {
  Jenkins<double> law;
  law.k = k;
  law.Fc = Fc;
  return law;
}

/// v^3 with a stated size of v: the central difference is off by exactly h^2.
struct OwnCubic {
  double size = 1.0;
  double output(const Input<double>& in, Mode, std::span<const double>) const { return in.v * in.v * in.v; }
  Scales scales() const { return {.velocity = size, .output = 1.0}; }
};

/// Breaks above a speed that own_law() does not try.
template <class Breaks>
struct Fragile : NamedLuGre {
  double output(const Input<double>& in, Mode mode, std::span<const double> z) const {
    return std::abs(in.v) > 40.0 * vs ? Breaks::force() : NamedLuGre::output(in, mode, z);
  }
};
struct Fuse {};
struct Throws {
  static double force() { throw Fuse{}; }
};
struct NotANumber {
  static double force() { return std::numeric_limits<double>::quiet_NaN(); }
};

/// The cycle that a displaced loop reaches.
Cycle settled_cycle(const Loop& loop, double displacement) {
  const auto settled = settle(loop, displaced(loop, displacement), SettleOptions{});
  REQUIRE(settled.outcome == Outcome::cycle);
  REQUIRE(settled.shot);
  REQUIRE(settled.shot->status == Status::converged);
  return settled.shot->cycle;
}

void check_same(const Cycle& own, const Cycle& built_in) {
  CHECK(own.period == Approx(built_in.period).epsilon(1e-8));
  CHECK(own.amplitude == Approx(built_in.amplitude).epsilon(1e-7));
  CHECK(own.first_harmonic == Approx(built_in.first_harmonic).epsilon(1e-7));
  CHECK(own.stable == built_in.stable);
  CHECK(own.half_wave_symmetric == built_in.half_wave_symmetric);
  REQUIRE(own.multipliers.size() == built_in.multipliers.size());
  const double largest = std::abs(built_in.multipliers.at(0));
  for (std::size_t i = 0; i < own.multipliers.size(); ++i) {
    CAPTURE(i, own.multipliers[i], built_in.multipliers[i]);
    CHECK(std::abs(own.multipliers[i] - built_in.multipliers[i]) < 1e-5 * largest);
  }
}

void check_same(const PredictReport& own, const PredictReport& built_in) {
  CHECK(own.status == built_in.status);
  REQUIRE(own.cycles.size() == built_in.cycles.size());
  for (std::size_t i = 0; i < own.cycles.size(); ++i) check_same(own.cycles[i], built_in.cycles[i]);
  REQUIRE(own.predictions.size() == built_in.predictions.size());
  for (std::size_t i = 0; i < own.predictions.size(); ++i) {
    const Prediction &mine = own.predictions[i], &theirs = built_in.predictions[i];
    CHECK(mine.method == theirs.method);
    CHECK(mine.amplitude == Approx(theirs.amplitude).epsilon(1e-5));
    CHECK(mine.frequency == Approx(theirs.frequency).epsilon(1e-5));
    CHECK(mine.verdict == theirs.verdict);
    CHECK(mine.stable == theirs.stable);
  }
  CHECK(own.missed.size() == built_in.missed.size());
  REQUIRE(own.outcomes.size() == built_in.outcomes.size());
  for (std::size_t i = 0; i < own.outcomes.size(); ++i) CHECK(own.outcomes[i].outcome == built_in.outcomes[i].outcome);
}

bool says_differences(const auto& report, std::string_view law) {
  return std::ranges::any_of(report.notes, [&](const std::string& note) {
    return note.find("differences") != std::string::npos && note.find(law) != std::string::npos;
  });
}

void check_same_gains(const Element& own, const Element& built_in, double amplitude_of_turn) {
  for (const double amplitude : {0.3, 1.0, 7.0, 300.0})
    for (const double frequency : {0.2, 20.0})
      for (const double bias : {0.0, 0.4}) {
        const double A = amplitude * amplitude_of_turn;
        const DfPoint point{A, frequency, bias * A * frequency};
        CAPTURE(A, frequency, bias);
        DfOptions options;
        options.accuracy = 1e-7;
        const auto mine = describing_function(own, point, options),
                   theirs = describing_function(built_in, point, options);
        REQUIRE(theirs.status == Status::converged);
        REQUIRE(mine.status == Status::converged);
        CHECK(std::abs(mine.gain - theirs.gain) < 3e-7 * std::abs(theirs.gain));
        CHECK(mine.mean == Approx(theirs.mean).epsilon(1e-6).margin(1e-9));
        CHECK(mine.dissipation == Approx(theirs.dissipation).epsilon(1e-6).margin(1e-9 * A));
        CHECK(mine.error < 1e-6);
      }
}

}  // namespace

TEST_CASE("derivatives of an own law are central differences: off by h^2, h as stated") {
  for (const double size : {1e2, 1e3, 1e4}) {
    const auto law = own_law(OwnCubic{size}).on<Dual<1>>();
    const double h = std::cbrt(std::numeric_limits<double>::epsilon()) * size;
    const Dual<1> force = law.output({0.0, Dual<1>::variable(1.0, 0), 0.0}, {}, {});
    CHECK(force.value == 1.0);
    CHECK(force.d[0] - 3.0 == Approx(h * h).epsilon(1e-4).margin(1e-10));
  }
}

TEST_CASE("derivatives of a smooth own law are right to 1e-9, over all speeds") {
  const RoundStribeck smooth;
  const auto law = own_law(smooth).on<Dual<1>>();
  for (double v = 1e-4; v < 1.0; v *= 1.1) {
    const double exact = smooth.slope(v), found = law.output({0.0, Dual<1>::variable(v, 0), 0.0}, {}, {}).d[0];
    CAPTURE(v, exact);
    CHECK(std::abs(found - exact) < 1e-9 * std::max(std::abs(exact), 1.0));
  }
}

TEST_CASE("derivatives of an own law by several variables at a time, against exact ones of the same law") {
  using D = Dual<4>;
  const auto own = own_law(PlainLuGre{}).on<D>();
  const auto exact = recast<LuGre, D>(lugre());
  for (const double v : {-0.3, -2e-3, -4e-4, 1e-5, 1e-3, 0.02, 5.0})
    for (const double share : {-0.9, 0.0, 0.4}) {
      CAPTURE(v, share);
      // A direction in which both vary, as in the chain rule, in addition to the variables themselves.
      Input<D> in{D(0.7), D::variable(v, 0), D(infinite)};
      std::vector<D> z{D::variable(share * 1.5e-5, 1)};
      in.v.d[2] = 3.0, z[0].d[2] = -2e-3;
      std::vector<D> mine(1), theirs(1);
      own.rate(in, {}, z, mine);
      exact.rate(in, {}, z, theirs);
      const D force = own.output(in, {}, z), expected = exact.output(in, {}, z);
      CHECK(mine[0].value == Approx(theirs[0].value).epsilon(1e-12).margin(1e-15));
      CHECK(force.value == Approx(expected.value).epsilon(1e-12));
      for (std::size_t k = 0; k < 4; ++k) {
        CAPTURE(k);
        CHECK(mine[0].d[k] == Approx(theirs[0].d[k]).epsilon(1e-8).margin(1e-7));
        CHECK(force.d[k] == Approx(expected.d[k]).epsilon(1e-8).margin(1e-5));
      }
      CHECK(force.d[3] == 0.0);
    }
}

TEST_CASE("derivatives of guards and of the state after a switch of an own law") {
  using D = Dual<4>;
  const auto law = own_law(OwnJenkins{}).on<D>();
  std::vector<D> z{D::variable(0.5e-4, 1)}, g(2);
  const Input<D> in{D(0.0), D::variable(0.1, 0), D(0.0)};
  law.guard(in, {0}, z, g);
  CHECK(g[0].value == Approx(0.5));
  CHECK(g[0].d[1] == Approx(-1e4).epsilon(1e-8));
  CHECK(g[1].d[1] == Approx(1e4).epsilon(1e-8));
  CHECK(g[0].d[0] == 0.0);
  CHECK(law.next(in, {0}, z, 1) == Mode{-1});
  CHECK(z[0].value == Approx(-1e-4));
  CHECK(z[0].d[1] == 0.0);  // where it was is forgotten
  z[0] = D::variable(0.5e-4, 1);
  CHECK(law.next(in, {1}, z, 0) == Mode{0});
  CHECK(z[0].d[1] == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("describing functions of LuGre, Dahl and Jenkins written as own laws are those of the library") {
  check_same_gains(own_law(PlainLuGre{}), lugre(), 1.5e-5);
  check_same_gains(own_law(NamedLuGre{}), lugre(), 1.5e-5);
  check_same_gains(own_law(OwnDahl{}), dahl(1.0, 1e4), 1e-4);
  check_same_gains(own_law(OwnJenkins{}), jenkins(1e4, 1.0), 1e-4);
}

TEST_CASE("describing function of a rounded Stribeck curve against its integral") {
  const RoundStribeck law;
  for (const double amplitude : {1e-3, 0.02, 0.5})
    for (const double frequency : {0.5, 3.0}) {
      const auto df = describing_function(own_law(law), {amplitude, frequency, 0.0});
      REQUIRE(df.status == Status::converged);
      constexpr int count = 200'000;  // periodic and smooth: the sum converges geometrically
      double cosine = 0.0;
      for (int k = 0; k < count; ++k) {
        const double c = std::cos(2.0 * pi * k / count);
        cosine += law.output({0.0, amplitude * frequency * c, 0.0}, {}, {}) * c * 2.0 / count;
      }
      CHECK(df.gain.imag() == Approx(cosine / amplitude).epsilon(1e-6));
      CHECK(std::abs(df.gain.real()) < 1e-6 * df.gain.imag());
    }
}

TEST_CASE(
    "the hunting servo with LuGre friction as an own law: predicted as with the library's, differences labelled") {
  PredictOptions options;
  options.search = SearchBox{1e-6, 1.0, 0.01, 1000.0};
  const auto own = predict(servo(own_law(NamedLuGre{})), options), built_in = predict(servo(lugre()), options);
  REQUIRE(built_in.cycles.size() == 1);
  check_same(own, built_in);
  CHECK(says_differences(own, "my-lugre"));
  CHECK_FALSE(says_differences(built_in, "lugre"));
}

TEST_CASE("the servo with Dahl's law as an own law: predicted as with the library's") {
  PredictOptions options;
  options.search = SearchBox{1e-6, 1.0, 0.01, 1000.0};
  check_same(predict(servo(own_law(OwnDahl{})), options), predict(servo(dahl(1.0, 1e4)), options));
}

TEST_CASE("an own law holds its body at rest: the servo hunts as with the library's dry friction") {
  const auto mine = predict(servo(own_law(OwnStiction{}))), theirs = predict(servo(coulomb(1.5, 1.0, 0.4)));
  REQUIRE(theirs.cycles.size() == 1);
  CHECK(theirs.cycles[0].sticking_fraction > 0.1);
  REQUIRE(mine.cycles.size() == 1);
  CHECK(mine.cycles[0].period == Approx(theirs.cycles[0].period).epsilon(1e-9));
  CHECK(mine.cycles[0].amplitude == Approx(theirs.cycles[0].amplitude).epsilon(1e-9));
  CHECK(mine.cycles[0].stable == theirs.cycles[0].stable);
  REQUIRE(mine.cycles[0].multipliers.size() == theirs.cycles[0].multipliers.size());
  const auto largest = std::abs(theirs.cycles[0].multipliers.at(0));
  CHECK(std::abs(mine.cycles[0].multipliers.at(0) - theirs.cycles[0].multipliers.at(0)) < 1e-6 * (1.0 + largest));
  CHECK(says_differences(mine, "my-stiction"));
}

TEST_CASE("derivatives of an own law that is templated on its scalar are exact, and no note says otherwise") {
  using D = Dual<4>;
  const auto law = own_law(TemplatedDahl<double>{});
  for (const Element& one : {law, own_law(RemadeDahl<double>{})}) {
    CHECK_FALSE(one.facts().by_differences);
    std::vector<D> z{D::variable(3e-5, 1)}, dz(1);
    one.on<D>().rate({D(0.0), D::variable(0.02, 0), D(0.0)}, {}, z, dz);
    CHECK(dz[0].d[0] == 1.0 - 1e4 * 3e-5);
    CHECK(dz[0].d[1] == -1e4 * 0.02);
  }
  CHECK(law.with("Fc", 2.0).number("Fc") == 2.0);
  CHECK_THROWS_WITH(law.with("fc", 2.0), Contains("templated-dahl") && Contains("fc"));
  PredictOptions options;
  options.search = SearchBox{1e-6, 1.0, 0.01, 1000.0};
  const auto mine = predict(servo(law), options);
  check_same(mine, predict(servo(dahl(1.0, 1e4)), options));
  CHECK_FALSE(says_differences(mine, "templated-dahl"));
}

TEST_CASE("an own law that claims no symmetry has the same cycle, over the whole period") {
  const Cycle whole = settled_cycle(servo(own_law(PlainLuGre{})), 1.0), built_in = settled_cycle(servo(lugre()), 1.0);
  CHECK_FALSE(whole.half_wave_symmetric);
  CHECK(whole.period == Approx(built_in.period).epsilon(1e-8));
  CHECK(whole.amplitude == Approx(built_in.amplitude).epsilon(1e-7));
  CHECK(std::abs(whole.multipliers.at(0) - built_in.multipliers.at(0)) < 1e-5 * std::abs(built_in.multipliers.at(0)));
}

TEST_CASE("a branch of cycles with an own law: followed as with the library's, differences labelled") {
  FollowOptions options;
  options.continuation.from = 6.0;
  options.continuation.to = 7.0;
  options.own = 6.0;
  options.predict.starts = 1;
  options.predict.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
  const auto over_kd = [&](const Element& law) {
    return follow(
        [&](double kd) -> std::optional<Loop> {
          LoopParts parts = servo_parts(law);
          std::get<Pid>(parts.controller).kd = kd;
          return build_loop(parts);
        },
        options);
  };
  const auto own = over_kd(own_law(NamedLuGre{})), built_in = over_kd(lugre());
  CHECK(says_differences(own, "my-lugre"));
  CHECK_FALSE(says_differences(built_in, "lugre"));
  REQUIRE(built_in.branches.size() == 1);
  REQUIRE(own.branches.size() == 1);
  const BranchPoint &mine = own.branches[0].points.back(), &theirs = built_in.branches[0].points.back();
  CHECK(theirs.parameter != built_in.start);
  CHECK(mine.parameter == Approx(theirs.parameter).epsilon(1e-9));
  CHECK(mine.cycle.period == Approx(theirs.cycle.period).epsilon(1e-7));
  CHECK(mine.cycle.amplitude == Approx(theirs.cycle.amplitude).epsilon(1e-6));
}

TEST_CASE("an own law in series with the plant, in place of an element") {
  PredictOptions options;
  options.methods.composite = false;
  const auto in_series = [&](const Element& law) {
    return predict(forward(law, {8.0}, {1.0, 3.0, 3.0, 1.0}), options);
  };
  const auto own = in_series(own_law(OwnDahl{1.0, 4.0})), built_in = in_series(dahl(1.0, 4.0));
  REQUIRE_FALSE(built_in.cycles.empty());
  check_same(own, built_in);
}

TEST_CASE("stick-slip on a belt with a rounded Stribeck curve: its multiplier is Liouville's") {
  const RoundStribeck law{1.5, 1.0, 0.3, 0.03};  // mild enough that sums over the trace are right to 0.1 %
  const Loop loop = belt(own_law(law));
  const Cycle cycle = settled_cycle(loop, 1.0);
  CHECK(cycle.stable == true);
  // m = 1 kg, no other damping: the product of both multipliers, of which one is 1, is exp of the mean divergence.
  double divergence = 0.0;
  for (std::size_t i = 1; i < cycle.trace.t.size(); ++i)
    divergence -= 0.5 * (law.slope(cycle.trace.velocity[i]) + law.slope(cycle.trace.velocity[i - 1])) *
                  (cycle.trace.t[i] - cycle.trace.t[i - 1]);
  REQUIRE(cycle.multipliers.size() == 1);
  CHECK(std::log(std::abs(cycle.multipliers[0])) == Approx(divergence).epsilon(1e-3));
}

TEST_CASE("a belt with Jenkins' slider as an own law with modes: the same motion as with the library's") {
  SimulateOptions options;
  options.duration = 20.0;
  options.rtol = 1e-9;
  options.initial = {{"y", 0.3}};
  const auto own = simulate(servo(own_law(OwnJenkins{})), options),
             built_in = simulate(servo(jenkins(1e4, 1.0)), options);
  REQUIRE(own.status == Status::converged);
  REQUIRE(own.rows.size() == built_in.rows.size());
  CHECK(own.events.size() == built_in.events.size());
  CHECK(own.events.size() > 2);
  for (std::size_t i = 0; i < own.rows.size(); i += 50)
    for (std::size_t k = 0; k < 4; ++k) CHECK(own.rows[i][k] == Approx(built_in.rows[i][k]).epsilon(1e-5).margin(1e-6));
}

TEST_CASE("dissipativity: the storage function of an own law proves it passive") {
  const auto passive = passivity(own_law(OwnDahl{}));
  CHECK(passive.passive == Passive::yes);
  const auto not_passive = passivity(own_law(NamedLuGre{}));
  CHECK(not_passive.passive != Passive::yes);
}

TEST_CASE("a law that returns NaN ends every method with a Status, never with an answer") {
  const auto law = own_law(Fragile<NotANumber>{});
  const auto df = describing_function(law, {1.0, 1.0, 0.0});
  CHECK(df.status == Status::not_finite);
  CHECK(df.gain == 0.0);
  SimulateOptions options;
  options.duration = 20.0;
  options.initial = {{"y", 1.0}};
  const auto run = simulate(servo(law), options);
  CHECK((run.status == Status::not_finite || run.status == Status::stalled));
  CHECK_FALSE(run.why.empty());
  for (const auto& row : run.rows)
    for (const double value : row) CHECK(std::isfinite(value));
  PredictOptions few;
  few.starts = 2;
  few.search = SearchBox{0.1, 1.0, 1.0, 3.0};
  const auto report = predict(servo(law), few);
  CHECK(report.cycles.empty());
  CHECK(std::ranges::any_of(report.outcomes, [](const auto& one) { return one.outcome == Outcome::undecided; }));
  for (const auto& one : report.outcomes) CHECK((one.outcome == Outcome::rest || one.outcome == Outcome::undecided));
  for (const auto& one : report.predictions) CHECK(one.verdict != Verdict::confirmed);
}

TEST_CASE("what an own law throws passes through the methods to their caller") {
  const auto law = own_law(Fragile<Throws>{});
  CHECK_THROWS_AS(describing_function(law, {1.0, 1.0, 0.0}), Fuse);
  DfOptions threaded;
  threaded.threads = 2;
  CHECK_THROWS_AS(describing_function_table(law, {{1.0, 1.0, 0.0}, {2.0, 1.0, 0.0}, {3.0, 1.0, 0.0}}, threaded), Fuse);
  SimulateOptions options;
  options.duration = 20.0;
  options.initial = {{"y", 1.0}};
  CHECK_THROWS_AS(simulate(servo(law), options), Fuse);
  CHECK_THROWS_AS(predict(servo(law)), Fuse);
}
