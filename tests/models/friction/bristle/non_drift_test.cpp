// The non-drift law: its documented properties, its limits, and the one-element Xiong law, to which it reduces with a
// linear branch.
#include "limcycle/models/friction/bristle/non_drift.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "limcycle/models/friction/sliders/xiong.hpp"
#include "limcycle/tests/law_march.hpp"

using namespace limcycle;

namespace {

NonDrift<double> thesis(int branch = 0, int memory = 0, double tau = 2e-3) {
  NonDrift<double> law;
  law.Fs = law.Fs_minus = 1.5;
  law.Fc = law.Fc_minus = 1.0;
  law.vs = 1e-3;
  law.Zb = 1e-3;
  law.sigma = 316.22776601683796;
  law.tau = tau;
  law.branch.index = branch;
  law.memory.index = memory;
  return law;
}

using March = test::LawMarch<NonDrift<double>>;
const test::MarchSteps steps{.displacement = 2e-5, .velocity = 2e-4, .time = 5e-4};

/// A mass under a force u(t) with this friction law: Runge-Kutta of order 4, switches by bisection.
struct Body {
  NonDrift<double> law;
  double x = 0.0, v = 0.0, t = 0.0;
  Mode mode{};
  std::vector<double> z = std::vector<double>(static_cast<std::size_t>(law.states()), 0.0);

  explicit Body(NonDrift<double> made) : law(std::move(made)) { mode = law.start({0.0, 0.0, 1.0}, z); }
  static double force(double time) { return 0.55 + 0.35 * std::sin(time); }

  struct State {
    double x, v;
    std::vector<double> z;
  };
  State step(double h) const {
    State sum{x, v, z}, at = sum;
    std::vector<double> dz(z.size());
    const double part[] = {0.0, 0.5, 0.5, 1.0}, weight[] = {1.0, 2.0, 2.0, 1.0};
    double dx = 0.0, dv = 0.0;
    for (int k = 0; k < 4; ++k) {
      at.x = x + part[k] * h * dx;
      at.v = v + part[k] * h * dv;
      for (std::size_t i = 0; i < z.size(); ++i) at.z[i] = z[i] + part[k] * h * dz[i];
      const Input<double> in{at.x, at.v, 0.0};
      law.rate(in, mode, at.z, dz);
      dx = at.v;
      dv = force(t + part[k] * h) - law.output(in, mode, at.z);
      sum.x += weight[k] / 6.0 * h * dx;
      sum.v += weight[k] / 6.0 * h * dv;
      for (std::size_t i = 0; i < z.size(); ++i) sum.z[i] += weight[k] / 6.0 * h * dz[i];
    }
    return sum;
  }
  int negative(const State& s) const {
    double g[4];
    law.guard({s.x, s.v, 0.0}, mode, s.z, g);
    for (int k = 0; k < law.guards(mode); ++k)
      if (g[k] < 0.0) return k;
    return -1;
  }
  void accept(const State& s, double h) {
    x = s.x;
    v = s.v;
    z = s.z;
    t += h;
  }
  void run(double until, double h) {
    while (t < until - 1e-12) {
      const double full = std::min(h, until - t);
      State next = step(full);
      if (negative(next) < 0) {
        accept(next, full);
        continue;
      }
      double low = 0.0, high = full;
      for (int k = 0; k < 60; ++k) (negative(step(0.5 * (low + high))) < 0 ? low : high) = 0.5 * (low + high);
      next = step(high);
      const int guard = negative(next);
      accept(next, high);
      if (guard >= 0) mode = law.next({x, v, 0.0}, mode, z, guard);
    }
  }
};

}  // namespace

TEST_CASE("steady sliding is on the Stribeck curve of its direction", "[non-drift]") {
  for (const int memory : {0, 1}) {
    for (const double speed : {5e-4, 2e-3, 0.1}) {
      NonDrift<double> law = thesis(0, memory);
      law.Fs_minus = 1.2;
      law.Fc_minus = 0.8;
      law.sigma2 = 0.4;
      CHECK_FALSE(law.odd());
      for (const double side : {1.0, -1.0}) {
        March march(law, {.displacement = 1e-3, .time = 1e-3});
        march.slide(side * 20.0 * speed, 20.0);
        INFO("memory " << memory << " v " << side * speed);
        CHECK(march.force() == Approx(side * (law.level(side * speed) + 0.4 * speed)).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("bounded, dissipative, and odd with its modes", "[non-drift]") {
  for (int branch = 0; branch < 4; ++branch) {
    for (const int memory : {0, 1}) {
      March there(thesis(branch, memory), steps), back(thesis(branch, memory), steps);
      double most = 0.0;
      there.watch = [&](const Input<double>& in, Mode mode, const std::vector<double>& z) {
        most = std::max(most, std::abs(there.law().output(in, mode, z)));
      };
      std::mt19937 random(5);
      for (int i = 0; i < 12; ++i) {
        const double to = std::normal_distribution<double>(0.0, i % 3 == 2 ? 4e-3 : 5e-4)(random);
        const double T = std::uniform_real_distribution<double>(0.1, 1.0)(random);
        there.glide(to, T);
        back.glide(-to, T);
        INFO("branch " << branch << " memory " << memory << " stroke " << i);
        CHECK(back.force() == Approx(-there.force()).margin(1e-12));
        CHECK(there.law().mirror(there.mode()) == back.mode());
      }
      CHECK(most <= 1.5 * (1.0 + 1e-9));
      if (memory == 0) CHECK(there.least_work() >= -1e-12);
    }
  }
}

TEST_CASE("with a linear branch it is the law of Xiong with one element", "[non-drift]") {
  Xiong<double> one;
  one.Fs = one.Fs_minus = 1.5;
  one.Fc = one.Fc_minus = 1.0;
  one.vs = 1e-3;
  one.K = {1500.0};
  one.sigma = {316.22776601683796};
  one.lambda = {1.0};
  one.tau = 2e-3;
  test::LawMarch<Xiong<double>> reference(one, steps);
  March masing(thesis(3, 0), steps), two_point(thesis(3, 1), steps);
  std::mt19937 random(9);
  for (int i = 0; i < 15; ++i) {
    const double to = std::normal_distribution<double>(0.0, i % 2 == 0 ? 5e-4 : 5e-3)(random);
    reference.glide(to, 0.5);
    masing.glide(to, 0.5);
    two_point.glide(to, 0.5);
    INFO("stroke " << i);
    CHECK(masing.force() == Approx(reference.force()).margin(1e-8));
    CHECK(two_point.force() == Approx(reference.force()).margin(1e-8));
  }
}

TEST_CASE("no drift under a periodic force below Fc", "[non-drift]") {
  const double T = 2.0 * std::numbers::pi;
  const auto progress = [&](NonDrift<double> law, int cycles) {
    Body body(std::move(law));
    body.run((cycles - 1) * T, 2e-3);
    const double x = body.x;
    CHECK(x > 1e-4);
    body.run(cycles * T, 2e-3);
    return std::abs(body.x - x);
  };
  CHECK(progress(thesis(0, 0), 20) < 1e-9 * 1e-3);
  CHECK(progress(thesis(3, 0), 3) < 1e-12 * 1e-3);
  CHECK(progress(thesis(3, 1), 3) < 1e-12 * 1e-3);
  // Nested stretched branches become stiffer: the body creeps to rest more slowly, also beyond a full stack.
  const double early = progress(thesis(0, 1), 10), late = progress(thesis(0, 1), 20);
  CHECK(early < 1e-4 * 1e-3);
  CHECK(late < 0.6 * early);
}

TEST_CASE("loops of the deflection close", "[non-drift]") {
  for (int branch = 0; branch < 4; ++branch) {
    for (const int memory : {0, 1}) {
      March march(thesis(branch, memory), {.displacement = 2e-6, .time = 3e-3});
      march.glide(2e-4, 2.0);
      march.glide(-1e-4, 2.0);
      const double force = march.force();
      march.glide(1e-4, 2.0);
      march.glide(0.0, 2.0);
      march.glide(1e-4, 2.0);
      march.glide(-1e-4, 2.0);
      INFO("branch " << branch << " memory " << memory);
      CHECK(march.force() == Approx(force).margin(1e-9));
      CHECK(ReturnMode::of(march.mode()).depth <= 3);
    }
  }
}

TEST_CASE("virgin curve and first branches, slowly", "[non-drift]") {
  const auto phi = [](double xi) { return xi * (1.0 - std::log(xi)); };
  for (const int memory : {0, 1}) {
    NonDrift<double> law = thesis(0, memory);
    law.sigma = 1e-9;
    law.Fc = law.Fc_minus = 1.5;
    March march(law, steps);
    march.glide(4e-4, 1.0);
    CHECK(march.force() == Approx(1.5 * phi(0.4)).epsilon(1e-6));
    march.glide(-1e-4, 1.0);
    const double masing = 1.5 * phi(0.4) - 3.0 * phi(0.25);
    const double stretched = 1.5 * phi(0.4) - 1.5 * (1.0 + phi(0.4)) * phi(5e-4 / 1.4e-3);
    CHECK(march.force() == Approx(memory == 0 ? masing : stretched).epsilon(1e-6));
  }
}

TEST_CASE("without lag the level follows at once, and a start at speed is at the cap", "[non-drift]") {
  const NonDrift<double> law = thesis(0, 0, 0.0);
  std::vector<double> z(static_cast<std::size_t>(law.states()));
  const Input<double> in{0.0, -0.1, -infinite};
  const Mode mode = law.start(in, z);
  CHECK(law.output(in, mode, z) == Approx(-1.0).epsilon(1e-12));
  CHECK(thesis().start({0.0, 1e-6, infinite}, z) == Mode{});
  NonDrift<double> wrong = thesis();
  wrong.Fs = 0.5;
  CHECK(wrong.validate()->key == "Fs");
}
