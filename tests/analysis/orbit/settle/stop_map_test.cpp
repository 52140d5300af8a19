#include "limcycle/analysis/orbit/settle/stop_map.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("map of stops: its fixed point is the amplitude of the servo's cycle, and swings grow just below it") {
  const double mass = GENERATE(1.0, 1e-6);  // the same servo in another unit of force
  LoopParts parts;
  parts.plant = Mass{mass, 0.0, 0.0};
  parts.controller = pid(3.0 * mass, 4.0 * mass, 6.0 * mass);
  parts.friction = coulomb(1.5 * mass, 1.0 * mass);
  const Loop loop = build_loop(parts);
  const Settled settled = settle(loop, displaced(loop, 0.5), SettleOptions{});
  REQUIRE(settled.shot);
  const double amplitude = settled.shot->cycle.amplitude;

  auto map = StopMap::of(loop, 1e-10, {});
  REQUIRE(map);
  CHECK(map->ratio(amplitude).value() == Approx(1.0).epsilon(1e-7));
  CHECK(map->ratio(0.8 * amplitude).value() > 1.0);
  CHECK(map->ratio(1.2 * amplitude).value() < 1.0);
  const auto growing = map->growing(1e-4, 10.0);
  REQUIRE(growing.size() == 2);
  CHECK(growing.front() < amplitude);
  CHECK(growing.front() > amplitude / 1.3);
  CHECK(growing.back() > amplitude);
  CHECK(growing.back() < 1.01 * amplitude);
  CHECK(map->steps() > 0);
}

TEST_CASE("map of stops: without stiction no swing grows, and a loop without integral action has no such map") {
  const Loop loop = servo(coulomb(1.0, 1.0));
  auto map = StopMap::of(loop, 1e-8, {});
  REQUIRE(map);
  CHECK(map->growing(1e-3, 10.0).empty());
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(3.0, 0.0, 6.0);
  LoopParts zoned = servo_parts(coulomb(1.5, 1.0));
  DeadZone<double> zone;
  zone.half_width = 0.1;
  zoned.error = zone;
  const Loop waits = build_loop(zoned);
  auto within = StopMap::of(waits, 1e-8, {});
  REQUIRE(within);
  CHECK_FALSE(within->ratio(0.05));  // held for ever within the dead zone
  const Loop unable = build_loop(parts);
  CHECK_FALSE(StopMap::of(unable, 1e-8, {}));
}

TEST_CASE("map of stops: on bristles that yield it tends to that of stiction the stiffer they are") {
  Stribeck<double> dry;
  dry.Fs = dry.Fs_minus = 1.5;
  dry.Fc = dry.Fc_minus = 1.0;
  dry.vs = 0.01;
  const Loop stuck = servo(dry);
  auto held = StopMap::of(stuck, 1e-8, {});
  REQUIRE(held);
  const double p = GENERATE(0.1, 0.5, 2.0);
  const auto off = [&](double sigma0) {
    LuGre<double> law;
    law.Fs = law.Fs_minus = dry.Fs;
    law.Fc = law.Fc_minus = dry.Fc;
    law.vs = dry.vs;
    law.sigma0 = sigma0;
    law.sigma1 = std::sqrt(sigma0);
    const Loop loop = servo(law);
    auto map = StopMap::of(loop, 1e-8, {});
    REQUIRE(map);
    return std::abs(map->ratio(p).value() / held->ratio(p).value() - 1.0);
  };
  const double soft = off(1e5), stiff = off(1e6);
  CAPTURE(p, soft, stiff);
  CHECK(soft < 0.02);
  CHECK(stiff < 0.5 * soft);
}

TEST_CASE("map of stops: a command with a lag is that of a long hold, and tends to the one without at first order") {
  const Loop direct = servo(coulomb(1.5, 1.0));
  auto at_once = StopMap::of(direct, 1e-10, {});
  REQUIRE(at_once);
  const auto off = [&](double lag) {
    Pid late = pid(3.0, 4.0, 6.0);
    late.lag = lag;
    const Loop loop = loop_of(Mass{1.0, 0.0, 0.0}, late, coulomb(1.5, 1.0));
    auto map = StopMap::of(loop, 1e-10, {});
    REQUIRE(map);
    // The command falls by ki p a second while held, so that the integral is ahead of the lag by ki p lag.
    const LoopState held = map->held_at(0.2);
    const Eigen::Map<const Eigen::VectorXd> x(held.x.data(), loop.states());
    CHECK(loop.C_y.dot(x.transpose()) == Approx(0.2));
    const Eigen::VectorXd rate = loop.A * x;
    const Eigen::RowVectorXd force = loop.ports.back().C_v * loop.A;
    CHECK(std::abs(force.dot(x.transpose())) < 1e-9);
    CHECK(force.dot(rate.transpose()) == Approx(-4.0 * 0.2).epsilon(1e-6));
    return std::abs(map->ratio(0.2).value() - at_once->ratio(0.2).value());
  };
  const double coarse = off(1e-2), fine = off(1e-3);
  CHECK(fine > 0.0);
  CHECK(fine == Approx(0.1 * coarse).epsilon(0.1));
}

TEST_CASE("predict: a hunting cycle on bristles into which no displaced start falls is found from its break-away") {
  ElastoPlastic<double> law;
  law.Fc = law.Fc_minus = 247.997;
  law.Fs = law.Fs_minus = 426.197;
  law.vs = 0.0070504922;
  law.sigma0 = 483203.0;
  law.sigma1 = 15764.2;
  const PredictReport report = predict(loop_of(Mass{13363.8, 205.78, 0.0}, pid(1270.36, 37.0563, 8209.67), law));
  REQUIRE_FALSE(report.cycles.empty());
  CHECK(report.cycles.front().stable == true);
  CHECK(report.cycles.front().period == Approx(718.2).epsilon(1e-3));  // along a branch, from vs where it hunts
}

TEST_CASE("predict: a hunting cycle into which no displaced start falls is found from where its body breaks away") {
  Karnopp<double> law;
  law.Fs = law.Fs_minus = 2117.405053850017;
  law.Fc = law.Fc_minus = 1561.17;
  law.vs = 72.2398;
  law.dv = 0.879203;
  const PredictReport report = predict(loop_of(Mass{0.108679, 0.0, 0.0}, pid(29.8999, 46.2654, 2.20988), law));
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles.front().stable == true);
  CHECK(report.cycles.front().period == Approx(18.3754788).epsilon(1e-6));  // along a branch, from Fs where it hunts
  CHECK(report.cycles.front().amplitude == Approx(9.228709).epsilon(1e-6));
}

TEST_CASE(
    "predict: hunting under an integral that leaks, or acts in a band, is found from its break-away, in any unit") {
  const double finer = GENERATE(1.0, 1000.0);  // of lengths
  const auto found_with = [&](double leak, double band) {
    LoopParts parts;
    parts.plant = Mass{5.0 / finer, 2.0 / finer, 0.0};
    Pid controller = pid(2000.0 / finer, 8000.0 / finer, 150.0 / finer);
    controller.tf = 0.001;
    controller.leak = leak;
    controller.integral_band = band * finer;
    parts.controller = controller;
    parts.friction = coulomb(12.0, 8.0);
    PredictOptions options;
    options.search = SearchBox{1e-6 * finer, 0.1 * finer, 0.01, 1000.0};
    options.methods = {false, false, false};
    return predict(build_loop(parts), options);
  };
  const auto stable = [](const PredictReport& report) {
    const auto one = std::ranges::find(report.cycles, std::optional<bool>(true), &Cycle::stable);
    return one == report.cycles.end() ? std::optional<Cycle>() : *one;
  };
  // Of simulations in steps of 0.5 ms from break-away, to their digits.
  for (const auto& [leak, period, amplitude] : {std::tuple{0.63, 11.34, 0.8587e-3}, {0.65, 14.2, 0.854e-3}}) {
    CAPTURE(finer, leak);
    const auto cycle = stable(found_with(leak, infinite));
    REQUIRE(cycle);
    CHECK(cycle->period == Approx(period).epsilon(2e-3));
    CHECK(cycle->amplitude == Approx(amplitude * finer).epsilon(1e-3));
  }
  CHECK_FALSE(stable(found_with(0.67, infinite)));
  // A cycle that lies within the band does not notice it.
  const auto everywhere = stable(found_with(0.0, infinite)), within = stable(found_with(0.0, 1.05e-3));
  REQUIRE(everywhere);
  REQUIRE(within);
  CHECK(within->period == Approx(everywhere->period).epsilon(1e-7));
  CHECK(within->amplitude == Approx(everywhere->amplitude).epsilon(1e-7));
  CHECK_FALSE(stable(found_with(0.0, 1.03e-3)));
}

TEST_CASE("predict: a hunting cycle just above a jump of the map from stop to stop is found, behind a lagging drive") {
  Karnopp<double> law;
  law.Fs = law.Fs_minus = 0.763766;
  law.Fc = law.Fc_minus = 0.408388;
  law.vs = 0.0123187;
  law.dv = 0.000627915;
  Pid late = pid(1150.41, 8940.50375382706, 4.89913);
  late.lag = 4.38052e-05;
  const PredictReport report = predict(loop_of(Mass{0.00912517, 0.0, 0.0}, late, law));
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles.front().stable == true);
  CHECK(report.cycles.front().period == Approx(1.8196089667).epsilon(1e-6));  // along a branch, from ki where it hunts
  CHECK(report.cycles.front().amplitude == Approx(1.5059603e-4).epsilon(1e-6));
}

TEST_CASE("map of stops: a flight that waits until no step can be told from none ends") {
  auto law = stribeck(149.13887521989727, 149.13887521989727, 0.016989244554288064);
  law.delta = 1.0;
  Pid controller = pid(27289.065109563155, 87734.41624008738, 891.9918385924402);
  controller.saturation = 736.5400488263477;
  const Loop loop = loop_of(Mass{5.988762394979704, 0.0, 0.0}, controller, law);
  auto map = StopMap::of(loop, 1e-8, {});
  REQUIRE(map);
  for (double p = 27.0; p > 5.0; p /= 1.25) map->ratio(p);
  CHECK(map->steps() < 8 * 3000);
}

TEST_CASE("map of stops: a body that trembles on its bristles is given up after some hundred switches") {
  auto law = with_levels<NonDrift<double>>(1.5, 1.0);
  law.vs = 1e-3;
  law.Zb = 1e-3;
  law.sigma = 316.2;
  law.tau = 0.002;
  law.sigma2 = 0.4;
  const Loop loop = servo(law);
  auto map = StopMap::of(loop, 1e-7, {});
  REQUIRE(map);
  CHECK(map->ratio(0.1));
  for (const double p : {1e-4, 1e-5}) {
    const long before = map->steps();
    CHECK_FALSE(map->ratio(p));
    CHECK(map->steps() - before < 800);
  }
}
