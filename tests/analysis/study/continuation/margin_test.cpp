#include "limcycle/analysis/study/continuation/margin.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <string_view>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double fold = 0.08187508078;  ///< dead zone of a relay of level 1 driving 1/(s+1)^3 (see continuation_test)

Loop relay_loop(double level, double dead_zone) {
  return forward(relay(level, 0.0, dead_zone), {1.0}, {1.0, 3.0, 3.0, 1.0});
}

std::vector<MarginParameter> relay_parameters(double level, double dead_zone) {
  return {{"loop.element.level", "1", level, false,
           [=](double p) -> std::optional<Loop> { return relay_loop(p, dead_zone); }},
          {"loop.element.dead_zone", "1", dead_zone, false,
           [=](double p) -> std::optional<Loop> { return relay_loop(level, p); }}};
}

const ParameterMargin& named(const MarginReport& report, std::string_view path) {
  const auto found =
      std::ranges::find_if(report.parameters, [&](const auto& one) { return one.parameter.path == path; });
  REQUIRE(found != report.parameters.end());
  return *found;
}

}  // namespace

TEST_CASE("margin: a loop that oscillates, to where its cycle folds (only the ratio of dead zone and level counts)") {
  const auto report = margin(relay_loop(1.0, 0.05), relay_parameters(1.0, 0.05), {});
  CHECK(report.status == Status::converged);
  CHECK(report.hunts);
  const auto& zone = named(report, "loop.element.dead_zone");
  CHECK(zone.up.what == MarginSide::What::ends);
  CHECK(zone.up.value == Approx(fold).epsilon(1e-6));
  CHECK(zone.down.what == MarginSide::What::none);
  CHECK(zone.nearest() == &zone.up);
  const auto& level = named(report, "loop.element.level");
  CHECK(level.down.what == MarginSide::What::ends);
  CHECK(level.down.value == Approx(0.05 / fold).epsilon(1e-6));
  CHECK(level.up.what == MarginSide::What::none);
  // Nearest first: -39 % of the level, +64 % of the dead zone.
  CHECK(report.parameters.front().parameter.path == "loop.element.level");
  CHECK(report.parameters.front().distance() < report.parameters.back().distance());
  REQUIRE(report.balance);
  CHECK(report.balance->distance < 1e-4);  // the describing function finds it too
}

TEST_CASE("margin: a loop that rests, to where a cycle appears") {
  const auto report = margin(relay_loop(1.0, 0.1), relay_parameters(1.0, 0.1), {});
  CHECK_FALSE(report.hunts);
  const auto& zone = named(report, "loop.element.dead_zone");
  CHECK(zone.down.what == MarginSide::What::begins);
  CHECK(zone.down.value == Approx(fold).epsilon(1e-6));
  CHECK(zone.up.what == MarginSide::What::none);
  const auto& level = named(report, "loop.element.level");
  CHECK(level.up.what == MarginSide::What::begins);
  CHECK(level.up.value == Approx(0.1 / fold).epsilon(1e-6));
}

TEST_CASE("margin: hunting begins where the last of the cycles that take over from each other appears") {
  // From 1 down the cycle folds at 0.5; just below, the dead zone falls again, and the cycle exists again down to 0.45.
  const LoopFamily family = [](double p) -> std::optional<Loop> {
    return relay_loop(1.0, fold * ((p > 0.4975 ? 1.5 : 1.45) - p));
  };
  const auto report = margin(*family(0.1), {{"p", "1", 0.1, false, family}}, {});
  CHECK_FALSE(report.hunts);
  const auto& up = named(report, "p").up;
  CHECK(up.what == MarginSide::What::begins);
  CHECK(up.value == Approx(0.45).epsilon(1e-6));
}

TEST_CASE("margin: stick-slip with ideal stiction lasts until break-away and sliding level are equal") {
  const LoopFamily of_Fs = [](double p) -> std::optional<Loop> {
    if (p < 1.0) return std::nullopt;
    return servo(coulomb(p, 1.0, 0.4));
  };
  const LoopFamily of_Fc = [](double p) -> std::optional<Loop> {
    if (p > 1.5) return std::nullopt;
    return servo(coulomb(1.5, p, 0.4));
  };
  const auto report =
      margin(servo(coulomb(1.5, 1.0, 0.4)),
             {{"loop.friction.Fs", "N", 1.5, true, of_Fs}, {"loop.friction.Fc", "N", 1.0, true, of_Fc}}, {});
  CHECK(report.hunts);
  const auto &Fs = named(report, "loop.friction.Fs"), &Fc = named(report, "loop.friction.Fc");
  CHECK(Fs.down.what == MarginSide::What::ends);
  CHECK(Fs.down.value == Approx(1.0).epsilon(1e-6));
  CHECK(Fs.up.what == MarginSide::What::none);
  CHECK(Fc.up.what == MarginSide::What::ends);
  CHECK(Fc.up.value == Approx(1.5).epsilon(1e-6));
  CHECK(Fc.down.what == MarginSide::What::none);
}

TEST_CASE("margin: where a cycle lasts to the end of the range, hunting does not end there") {
  // Beyond an integral gain of 60400 the axis is unstable without friction; with it, it still hunts near the set-point.
  LoopParts parts;
  parts.plant = Mass{5.0, 2.0, 0.0};
  parts.friction = coulomb(12.0, 8.0);
  const auto with = [parts](double ki) mutable -> std::optional<Loop> {
    Pid controller = pid(2000.0, ki, 150.0);
    controller.tf = 1e-3;
    parts.controller = controller;
    return build_loop(parts);
  };
  MarginOptions options;
  options.predict.search = SearchBox{1e-6, 0.1, 0.01, 1000.0};
  const auto report =
      margin(*LoopFamily(with)(8000.0), {{"loop.controller.ki", "N/(m s)", 8000.0, false, with}}, options);
  const auto& up = named(report, "loop.controller.ki").up;
  CHECK(up.what == MarginSide::What::none);
  CHECK_FALSE(up.diverges);
}

TEST_CASE("margin: the end of a branch that its steps pass over, where a relay just fails to switch on") {
  // The pulse of the relay no longer carries y to its threshold, dead zone + hysteresis.
  constexpr double hysteresis = 2.70658e-5, dead_zone = 3.70288e-5, own = 5.33597;
  const auto loop = [](double level) {
    const double w2 = 28.518 * 28.518 + 37.3638 * 37.3638;
    return forward(relay(level, hysteresis, dead_zone), {0.815557}, {1.0, 2.0 * 28.518, w2});
  };
  const auto report =
      margin(loop(own),
             {{"loop.element.level", "1", own, false, [&](double p) -> std::optional<Loop> { return loop(p); }}}, {});
  const MarginSide& down = named(report, "loop.element.level").down;
  REQUIRE(down.what == MarginSide::What::ends);
  const auto hunts_at = [&](double level) { return !predict(loop(level)).cycles.empty(); };
  CHECK(hunts_at(1.004 * down.value));
  CHECK_FALSE(hunts_at(0.996 * down.value));
  CHECK(down.error < 2e-3);
}

TEST_CASE("margin: a relay oscillates until its loop no longer reaches the hysteresis, ever more slowly") {
  // In a half period y goes from -h towards the static gain 1, so that the cycle ends at h = 1 exactly, where the
  // period grows like a logarithm. The triple pole approaches 1 like t^2 exp(-t) instead.
  for (const bool triple : {false, true}) {
    const auto loop = [triple](double h) -> std::optional<Loop> {
      return triple ? forward(relay(1.0, h), {1.0}, {1.0, 3.0, 3.0, 1.0})
                    : forward(relay(1.0, h), {30.0}, {1.0, 31.0, 30.0});
    };
    const auto report = margin(*loop(0.2), {{"loop.element.hysteresis", "1", 0.2, false, loop}}, {});
    const MarginSide& up = named(report, "loop.element.hysteresis").up;
    CAPTURE(triple, up.value, up.error, up.why);
    CHECK(up.what == MarginSide::What::ends);
    CHECK(up.value == Approx(1.0).epsilon(1e-4));
  }
}

TEST_CASE("margin: hunting begins where simulations find it, not where two unstable cycles are born") {
  // Two unstable cycles merge at 0.2627; what is stable, without a period, ends at 0.2583 (bisected with predict).
  constexpr double own = 0.27;
  const auto loop = [](double sigma2) {
    LuGre<double> law;
    law.sigma0 = 10655.2;
    law.sigma1 = 0.0;
    law.sigma2 = sigma2;
    law.Fc = law.Fc_minus = 0.0628584;
    law.Fs = law.Fs_minus = 0.0811793;
    law.vs = 0.00476074;
    LoopParts parts;
    parts.plant = Belt{3.34728, 3.45017, 0.0, 0.0238899};
    parts.friction = law;
    return build_loop(parts);
  };
  MarginOptions options;
  options.factor = 1.12;
  const auto report =
      margin(loop(own),
             {{"loop.friction.sigma2", "N s/m", own, false, [&](double p) -> std::optional<Loop> { return loop(p); }}},
             options);
  const MarginSide& down = named(report, "loop.friction.sigma2").down;
  REQUIRE(down.what == MarginSide::What::begins);
  CHECK(down.value < 0.2590);
  CHECK(down.value > 0.2570);
  CHECK(down.error < 2e-3);
}

TEST_CASE("margin: distance of -1/N from the Nyquist curve against a scan of the closed form") {
  // N of a relay with dead zone is real, at most 2 M/(pi d); G = 1/(1 + jw)^3: |1 + 1/(N G)| = |1 + (1 + jw)^3/N|.
  const double smallest = 0.5 * std::numbers::pi * 0.1;  // of 1/N
  double least = infinite;
  for (double c = smallest; c < 3.0 * smallest; c += 0.002 * smallest)
    for (double w = 0.5; w < 3.0; w += 0.0005)
      least = std::min(least, std::abs(1.0 + c * std::pow(std::complex<double>(1.0, w), 3)));
  const auto found = balance_distance(relay_loop(1.0, 0.1), default_search_box(relay_loop(1.0, 0.1)));
  REQUIRE(found);
  CHECK(found->distance == Approx(least).epsilon(1e-5));
  CHECK(found->amplitude == Approx(0.1 * std::sqrt(2.0)).epsilon(1e-2));  // where N is largest
  CHECK_FALSE(balance_distance(relay_loop(1.0, 0.1), default_search_box(relay_loop(1.0, 0.1)), [] { return true; }));
}

TEST_CASE("margin: a stop keeps the parameters that are done") {
  MarginOptions options;
  std::string seen;
  options.predict.progress = [&](double, std::string_view what) { seen = what; };
  options.predict.stop = [&seen] { return seen == "loop.element.dead_zone"; };
  const auto report = margin(relay_loop(1.0, 0.05), relay_parameters(1.0, 0.05), options);
  CHECK(report.status == Status::interrupted);
  REQUIRE(report.parameters.size() == 1);
  CHECK(report.parameters[0].down.value == Approx(0.05 / fold).epsilon(1e-6));
}

TEST_CASE("closest approach of -1/N: on a plane of equal distances it ends after a few thousand describing functions") {
  LoopParts parts;  // stiff bristles under a slow belt: the distance is 1 but for roundings where they only yield
  parts.plant = Belt{1236680.0, 3313400.0, 0.0, 0.000370623};
  LuGre<double> law;
  law.Fc = law.Fc_minus = 2723.84;
  law.Fs = law.Fs_minus = 5042.94;
  law.sigma2 = 113126.0;
  law.vs = 0.000319629;
  law.sigma0 = 326434000000.0;
  parts.friction = law;
  const Loop loop = build_loop(parts);
  long asked = 0;
  const auto found = balance_distance(loop, default_search_box(loop), [&] {
    ++asked;
    return false;
  });
  REQUIRE(found);
  CHECK(asked < 3000);
}

TEST_CASE("margin: a root of the describing function at a narrow resonance is not said to be none") {
  LoopParts parts;  // the balance needs sqrt(k/m) to a few ten-thousandths
  parts.plant = Belt{2.0, 800.0, 1.5, 0.02};
  parts.friction = stribeck(12.0, 8.0, 0.01);
  MarginOptions options;
  const auto report = margin(build_loop(parts), {}, options);
  REQUIRE(report.balance);
  CHECK(report.balance->distance < 1e-6);
  CHECK(report.balance->frequency == Approx(20.0).epsilon(1e-6));
}

TEST_CASE("margin: of a sampled servo by bisection of the outcome, towards that of the continuous one") {
  const auto leaking = [](double leak, double sample_time) -> std::optional<Loop> {
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    std::get<Pid>(parts.controller).leak = leak;
    std::get<Pid>(parts.controller).sample_time = sample_time;
    return build_loop(parts);
  };
  MarginOptions options;
  options.factor = 1.6;
  options.predict.starts = 2;
  const auto edge_at = [&](double sample_time) {
    const MarginParameter leak{"loop.controller.leak", "1/s", 0.08, false,
                               [&](double value) { return leaking(value, sample_time); }};
    const MarginReport report = margin(*leaking(0.08, sample_time), {leak}, options);
    CHECK(report.refused.empty());
    CHECK(report.hunts);
    CHECK(report.parameters.front().down.what == MarginSide::What::none);
    const MarginSide& up = report.parameters.front().up;
    REQUIRE(up.what == MarginSide::What::ends);
    CHECK(up.error < 0.04);
    return up.value;
  };
  constexpr double continuous = 0.109873;  // where the period of the continuous one, followed, grows without bound
  const double coarse = continuous - edge_at(0.08), fine = continuous - edge_at(0.04);
  CHECK(fine == Approx(0.0).margin(0.07 * continuous));
  CHECK(coarse / fine == Approx(2.0).margin(0.6));  // of first order, as far as an edge is one
}

TEST_CASE("margin: hunting does not end where a number of asymmetric friction may go no farther") {
  const auto with = [](double Fs_minus) -> std::optional<Loop> {
    if (Fs_minus < 7.5) return std::nullopt;
    Coulomb<double> law;
    law.Fs = 12.0;
    law.Fc = 8.0;
    law.Fs_minus = Fs_minus;
    law.Fc_minus = 7.5;
    LoopParts parts;
    parts.plant = Mass{3.0, 4.0, 0.0};
    parts.controller = pid(1500.0, 9000.0, 100.0);
    parts.friction = law;
    parts.load = 2.0;
    return build_loop(parts);
  };
  MarginOptions options;
  options.factor = 2.0;
  options.predict.search = SearchBox{1e-6, 0.1, 0.01, 1000.0};
  const MarginReport report = margin(*with(9.0), {{"loop.friction.Fs_minus", "N", 9.0, false, with}}, options);
  REQUIRE(report.hunts);
  const MarginSide& down = named(report, "loop.friction.Fs_minus").down;
  CHECK(down.what == MarginSide::What::none);
  CHECK(down.value == Approx(7.5));
  // Of a simulation of its own: there it still hunts, with a period of 69.2 s.
  PredictOptions there;
  there.search = options.predict.search;
  there.methods = {false, false, false};
  const auto found = predict(*with(7.5), there);
  REQUIRE_FALSE(found.cycles.empty());
  CHECK(found.cycles.front().period == Approx(69.2).epsilon(2e-3));
}

TEST_CASE("margin: of a sampled servo to the last value at which the case is valid") {
  const auto with = [](double Fs) -> std::optional<Loop> {
    if (Fs < 1.0) return std::nullopt;
    LoopParts parts = servo_parts(coulomb(Fs, 1.0));
    std::get<Pid>(parts.controller).sample_time = 0.05;
    return build_loop(parts);
  };
  MarginOptions options;
  options.factor = 4.0;
  options.predict.starts = 2;
  const MarginReport report = margin(*with(1.5), {{"loop.friction.Fs", "N", 1.5, false, with}}, options);
  REQUIRE(report.hunts);
  const MarginSide& down = named(report, "loop.friction.Fs").down;
  CAPTURE(down.why);
  REQUIRE(down.what == MarginSide::What::ends);  // at Fs = Fc, which is that value
  CHECK(down.value >= 1.0);
  CHECK(down.value < 1.005);
}

TEST_CASE("margin: a sampled servo that rests, with the range that was tried") {
  const auto gained = [](double kp) -> std::optional<Loop> {
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    Pid& controller = std::get<Pid>(parts.controller);
    controller.ki = 0.0;
    controller.kp = kp;
    controller.sample_time = 0.05;
    return build_loop(parts);
  };
  MarginOptions options;
  options.factor = 2.0;
  options.predict.starts = 2;
  const MarginReport report = margin(*gained(3.0), {{"loop.controller.kp", "N/m", 3.0, false, gained}}, options);
  CHECK_FALSE(report.hunts);
  CHECK(report.parameters.front().up.what == MarginSide::What::none);
  CHECK(report.parameters.front().up.value == Approx(6.0));
  CHECK(report.parameters.front().down.what == MarginSide::What::none);
}

TEST_CASE("margin: a branch that takes over with a range of attraction that no start falls into is followed too") {
  const auto at = [](double Fc) -> std::optional<Loop> {
    LuGre<double> law = with_levels<LuGre<double>>(128.797, Fc);
    law.vs = 0.0280015;
    law.sigma0 = 251495.0;
    law.sigma1 = 89.1456;
    Pid controller = pid(887.4, 1545.69, 44.4569);
    controller.tf = 0.000846174;
    controller.saturation = 303.676;
    return loop_of(Mass{1.64457, 0.0, 0.0}, controller, law);
  };
  MarginOptions options;
  options.factor = 1.09;
  const MarginReport report = margin(*at(115.0), {{"loop.friction.Fc", "N", 115.0, true, at}}, options);
  REQUIRE(report.hunts);
  const MarginSide& up = report.parameters.front().up;
  CAPTURE(up.value, up.why);
  REQUIRE(up.what == MarginSide::What::ends);
  CHECK(up.event == BranchEvent::Type::fold);
  CHECK(up.value == Approx(119.5827).epsilon(1e-5));  // at 119.55 predict still finds the cycle, by its stops
}
