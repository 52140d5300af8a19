#include "limcycle/analysis/study/identify/free/free_march.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/identify/parameter_space.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A motion of this plant through these instants, whose rows were not measured.
FreeMotion motion_through(const Plant& plant, const std::vector<double>& t, const std::function<double(double)>& u,
                          const Eigen::Vector2d& sizes) {
  FreeMotion motion;
  motion.rig = {model_of(plant), 0.0};
  for (std::size_t i = 0; i < t.size(); ++i) motion.stops.push_back({t[i], u(t[i]), static_cast<std::ptrdiff_t>(i)});
  motion.state_sizes = sizes;
  motion.rubbing_speed = std::abs(motion.rig.plant.C_v.dot(sizes));
  return motion;
}

FreeRun marched_freely(const FreeMotion& motion, const Element& law, const Eigen::Vector2d& start,
                       double fineness = 1.0, NumberSlopes* slopes = nullptr, bool sliding = false) {
  FreeRun run;
  REQUIRE(FreeMarch(motion, law, slopes, fineness).run({0, motion.stops.size() - 1, start, sliding}, start, run));
  return run;
}

std::vector<double> equal_times(double duration, std::size_t count) {
  std::vector<double> t;
  for (std::size_t i = 0; i < count; ++i)
    t.push_back(duration * static_cast<double>(i) / static_cast<double>(count - 1));
  return t;
}

double no_force(double) { return 0.0; }

/// Under a force that sticks and slides both ways: laws of tests/.../rigs.hpp on a mass of 1 kg.
double growing_force(double t) { return 1.5 * (0.5 + 8.0 * t) * std::sin(60.0 * t); }
FreeMotion driven_motion(std::size_t count) {
  return motion_through(Mass{.mass = 1.0, .stiffness = 200.0}, equal_times(0.3, count), growing_force, {1e-3, 0.05});
}

/// Positions at the instants by the marcher of simulations.
std::vector<double> simulated(const Plant& plant, const Element& law, const FreeMotion& motion, double y0) {
  LoopParts parts{plant, NoController{}, {}, law, {}};
  SimulateOptions options;
  options.duration = motion.stops.back().t;
  options.rtol = 1e-10;
  options.sample = motion.stops[1].t;
  options.initial = {{state_names(build_loop(parts)).front(), y0}};
  options.force = Signal{};
  options.force->kind = Signal::Kind::table;
  for (const auto& stop : motion.stops) {
    options.force->times.push_back(stop.t);
    options.force->values.push_back(stop.u);
  }
  const Simulation run = simulate(build_loop(parts), options);
  const auto column = std::ranges::find(run.columns, "y") - run.columns.begin();
  std::vector<double> y;
  for (const auto& row : run.rows)
    if (y.size() < motion.stops.size() && row[0] > motion.stops[y.size()].t - 1e-9)
      y.push_back(row[static_cast<std::size_t>(column)]);
  REQUIRE(y.size() == motion.stops.size());
  return y;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

}  // namespace

TEST_CASE("free march: Coulomb friction takes 4 Fc/k from the swing of a mass on a spring in each cycle") {
  const double m = 2.0, k = 50.0, Fc = 1.0, half_period = std::numbers::pi / std::sqrt(k / m), y0 = 0.21;
  std::vector<double> turns;
  for (int i = 0; i < 8; ++i) turns.push_back(half_period * i);
  const auto motion = motion_through(Mass{.mass = m, .stiffness = k}, turns, no_force, {0.4, 2.0});
  const auto run = marched_freely(motion, law_with("coulomb", {{"Fc", Fc}, {"Fs", Fc}}), {y0, 0.0});
  for (std::size_t i = 0; i < turns.size(); ++i) {
    // At rest once the spring is no stronger than the friction: |y| <= Fc/k.
    const double left = y0 - 2.0 * Fc / k * std::min<double>(static_cast<double>(i), 5.0);
    const double expected = std::min<std::size_t>(i, 5) % 2 == 0 ? left : -left;
    CHECK(run.y[i] == Approx(expected).margin(1e-12));
    if (i > 5) CHECK(run.rate[i] == 0.0);
  }
}

TEST_CASE("free march: a sliding body stops after m v^2/(2 Fc), and nothing of it drifts then") {
  const double m = 3.0, Fc = 2.0, v = 0.8, stop = m * v / Fc;
  const auto motion = motion_through(Mass{.mass = m}, {0.0, 0.5 * stop, 1.5 * stop, 9.0 * stop}, no_force, {0.5, v});
  const auto run = marched_freely(motion, law_with("coulomb", {{"Fc", Fc}, {"Fs", Fc}}), {0.0, v});
  CHECK(run.y[1] == Approx(0.75 * m * v * v / (2.0 * Fc)).epsilon(1e-12));
  CHECK(run.y[2] == Approx(m * v * v / (2.0 * Fc)).epsilon(1e-12));
  CHECK(run.y[3] == run.y[2]);
  CHECK(run.rate[3] == 0.0);
  // Derivatives: d(way)/dFc = -way/Fc, d(way)/dv = m v/Fc.
  const Element law = law_with("coulomb", {{"Fc", Fc}, {"Fs", Fc}});
  const auto slopes = number_slopes_of(law, {{0, 0}}, {0, 1});
  slopes->take(law);
  const auto with = marched_freely(motion, law, {0.0, v}, 1.0, slopes.get());
  CHECK(with.y_slopes(0, 3) == Approx(-m * v * v / (2.0 * Fc * Fc)).epsilon(1e-9));
  CHECK(with.y_slopes(1, 3) == Approx(1.0));
  CHECK(with.y_slopes(2, 3) == Approx(m * v / Fc).epsilon(1e-9));
  CHECK(with.rate_slopes.col(3).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("free march: the motions are those of the marcher of simulations") {
  for (const Element& law : {coulomb_rig(), stribeck_rig(), lugre_rig(), elasto_plastic_rig(), gms_rig()}) {
    INFO(law.kind());
    const auto motion = driven_motion(151);
    const auto y = simulated(Mass{.mass = 1.0, .stiffness = 200.0}, law, motion, 0.0);
    const auto run = marched_freely(motion, law, {0.0, 0.0});
    const double range = *std::ranges::max_element(y) - *std::ranges::min_element(y);
    CHECK(range > 1e-3);
    CHECK(largest_difference(run.y, y) < 2e-6 * range);
    CHECK(largest_difference(marched_freely(motion, law, {0.0, 0.0}, 4.0).y, y) < 5e-7 * range);
  }
}

TEST_CASE("free march: a pendulum falls under gravity") {
  const FroudePendulum pendulum{
      .mass = 5.0, .arm = 0.2, .inertia = 0.25, .damping = 0.005, .shaft_radius = 0.02, .shaft_speed = 0.0};
  const Element law = law_with("stribeck", {{"Fs", 17.0}, {"Fc", 7.4}, {"vs", 0.1}, {"sigma2", 1.0}});
  const auto motion = motion_through(pendulum, equal_times(8.0, 201), no_force, {2.0, 12.0});
  const auto y = simulated(pendulum, law, motion, 1.2);
  CHECK(largest_difference(marched_freely(motion, law, {1.2, 0.0}).y, y) < 2e-6);
  CHECK(std::abs(y.back()) < 0.2);
}

TEST_CASE("free march: derivatives by numbers and start are those of the motion, by Richardson's differences") {
  for (const Element& law : {coulomb_rig(), stribeck_rig(), lugre_rig(), elasto_plastic_rig(), gms_rig()}) {
    INFO(law.kind());
    const auto motion = driven_motion(41);
    std::vector<LawNumber> numbers;
    std::vector<std::size_t> own;
    for (const char* key : {"Fc", "Fs", "vs", "sigma0", "sigma1", "sigma2", "zba_ratio", "C"})
      for (std::size_t i = 0; i < law.parameters().size(); ++i)
        if (law.parameters()[i].key == key && law.number(key).value_or(0.0) > 0.0) {
          numbers.push_back({i, 0});
          own.push_back(i);
        }
    const auto slopes = number_slopes_of(law, numbers, own);
    slopes->take(law);
    const Eigen::Vector2d start(1e-4, 2e-3);
    const auto run = marched_freely(motion, law, start, 4.0, slopes.get(), true);
    const auto changed = [&](Eigen::Index column, double share) {
      const auto k = static_cast<std::size_t>(column);
      if (k >= numbers.size()) {
        Eigen::Vector2d other = start;
        other(column - std::ssize(numbers)) += share * 1e-2 * (column == std::ssize(numbers) ? 1e-2 : 1.0);
        return marched_freely(motion, law, other, 4.0, nullptr, true).y;
      }
      auto values = law.values();
      auto& number = std::get<double>(values[numbers[k].row]);
      number *= 1.0 + share;
      follow_defaults(law.parameters(), values, [&](std::string_view key) { return !key.ends_with("_minus"); });
      return marched_freely(motion, law.with(values), start, 4.0, nullptr, true).y;
    };
    for (Eigen::Index column = 0; column < run.y_slopes.rows(); ++column) {
      INFO(column);
      const auto k = static_cast<std::size_t>(column);
      const double unit = k < numbers.size() ? std::get<double>(law.values()[numbers[k].row])
                                             : (column == std::ssize(numbers) ? 1e-4 : 1e-2);
      constexpr double h = 2e-4;
      const auto a = changed(column, h), b = changed(column, -h), c = changed(column, 0.5 * h),
                 d = changed(column, -0.5 * h);
      double worst = 0.0, size = 0.0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double wide = (a[i] - b[i]) / (2.0 * h), narrow = (c[i] - d[i]) / h;
        const double slope = run.y_slopes(column, static_cast<Eigen::Index>(i)) * unit;
        worst = std::max(worst, std::abs((4.0 * narrow - wide) / 3.0 - slope));
        size = std::max(size, std::abs(slope));
      }
      CHECK(worst < 1e-3 * size);
    }
  }
}

TEST_CASE("free march: the error falls with the fourth power of the fineness") {
  const auto motion = driven_motion(16);
  const Element law = lugre_rig();
  const auto exact = marched_freely(motion, law, {0.0, 0.0}, 16.0).y;
  const double coarse = largest_difference(marched_freely(motion, law, {0.0, 0.0}, 1.0).y, exact);
  const double fine = largest_difference(marched_freely(motion, law, {0.0, 0.0}, 3.0).y, exact);
  const double order = std::log(coarse / fine) / std::log(3.0);
  INFO(coarse << " " << fine);
  CHECK(order > 3.0);
  CHECK(order < 7.0);
}
