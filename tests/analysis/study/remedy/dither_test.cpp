#include "limcycle/analysis/study/remedy/dither.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/models/friction/dry/dithered_coulomb.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using limcycle::test::coulomb;
using limcycle::test::servo_parts;
using std::numbers::pi;

namespace {

DitheredCoulomb<double> mean_law(double Fc, double Fc_minus, double speed, double sigma2) {
  DitheredCoulomb<double> law;
  law.Fc = Fc;
  law.Fc_minus = Fc_minus;
  law.speed = speed;
  law.sigma2 = sigma2;
  return law;
}

double force(const DitheredCoulomb<double>& law, double v) {
  const Input<double> in{0.0, v, 0.0};
  return law.output(in, {}, {});
}

/// A mass on Coulomb friction under a load, without a controller.
LoopParts pulled_mass(double mass, double load, double sigma2) {
  LoopParts parts;
  parts.plant = Mass{mass, 0.0, 0.0};
  parts.controller = NoController{};
  parts.friction = coulomb(1.5, 1.0, sigma2);
  parts.load = load;
  return parts;
}

/// The servo that hunts, with lengths in a unit.
LoopParts hunting_servo(double unit) {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.plant = Mass{1.0 / unit, 0.0, 0.0};
  parts.controller = test::pid(3.0 / unit, 4.0 / unit, 6.0 / unit);
  return parts;
}

}  // namespace

TEST_CASE("dithered Coulomb friction: the mean over a vibration, against a sum") {
  constexpr int instants = 200'000;
  for (const auto& law : {mean_law(1.0, 1.0, 0.2, 0.0), mean_law(2.0, 1.5, 3e-5, 4.0)})
    for (const double share : {-1.7, -0.999, -0.4, 0.0, 0.1, 0.9, 1.2}) {
      const double v = share * law.speed;
      double sum = 0.0;
      for (int i = 0; i < instants; ++i) {
        const double at = v + law.speed * std::sin(2.0 * pi * (i + 0.5) / instants);
        sum += at > 0.0 ? law.Fc : -law.Fc_minus;
      }
      CAPTURE(share);
      CHECK(force(law, v) == Approx(sum / instants + law.sigma2 * v).margin(2e-5 * law.Fc));
    }
  // About rest it is viscous, by 2 Fc/(pi speed).
  const auto law = mean_law(1.0, 1.0, 0.2, 0.0);
  CHECK(force(law, 1e-6) / 1e-6 == Approx(2.0 / (pi * 0.2)).epsilon(1e-9));
  const ElementOn<Dual<1>> dual = Element(law).on<Dual<1>>();
  const Dual<1> v = Dual<1>::variable(0.1, 0);
  CHECK(dual.output({Dual<1>(0.0), v, Dual<1>(0.0)}, {0}, {}).d[0] ==
        Approx(2.0 / pi / std::sqrt(0.2 * 0.2 - 0.1 * 0.1)).epsilon(1e-12));
}

TEST_CASE("dither: the speed of a free mass in closed form, and none below what keeps it moving") {
  // Without viscous friction: (m w a)^2 + (4 Fc/pi)^2 = amplitude^2.
  for (const double mass : {1.0, 50.0}) {
    const double w = 60.0, D = 3.0;
    const auto speed = dither_speed(pulled_mass(mass, 0.0, 0.0), {D, w});
    REQUIRE(speed);
    CHECK(*speed == Approx(std::sqrt(D * D - 16.0 / (pi * pi)) / (mass * w)).epsilon(1e-10));
  }
  CHECK_FALSE(dither_speed(pulled_mass(1.0, 0.0, 0.0), {1.49, 60.0}));  // below break-away
  CHECK_FALSE(averaged_over(pulled_mass(1.0, 0.0, 0.0), {1.2, 60.0}));
}

TEST_CASE("dither: a mass under a load below break-away creeps at the speed of the averaged law") {
  // 2 Fc/pi asin(V/a) + sigma2 V = load, with sigma2 = 0: V = a sin(pi load/(2 Fc)). Simulated as it is.
  for (const double load : {0.2, 0.6}) {
    const LoopParts parts = pulled_mass(1.0, load, 0.0);
    const double w = 60.0, D = 8.0, period = 2.0 * pi / w;
    SimulateOptions options;
    options.duration = 400.0 * period;
    options.sample = period;
    Signal sine;
    sine.kind = Signal::Kind::sine;
    sine.value = D;
    sine.frequency = w;
    options.force = sine;
    const Simulation run = simulate(build_loop(parts), options);
    REQUIRE(run.status == Status::converged);
    const auto y = static_cast<std::size_t>(std::ranges::find(run.columns, "y") - run.columns.begin());
    const double mean = (run.rows.back()[y] - run.rows[run.rows.size() - 101][y]) / (100.0 * period);
    const double expected = *dither_speed(parts, {D, w}) * std::sin(0.5 * pi * load);
    CHECK(mean == Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("dither: it ends the hunting of a servo from an amplitude on, simulated as it is") {
  const LoopParts parts = hunting_servo(1.0);
  CHECK(why_no_dither(parts).empty());
  RemedyCandidate candidate{"dither", "simulate.force.amplitude", "N", {}, 0.0, Measure::force};
  candidate.frequency = frequency_of_dither(parts).value();
  CHECK(candidate.frequency == Approx(60.0).epsilon(0.1));  // |L| = 6/w near its crossover
  candidate.parts = [parts](double) { return parts; };
  RemedyOptions options;
  options.predict.methods = {false, false, false};
  const RemedyReport report = remedies(parts, {candidate}, options);
  REQUIRE(report.remedies.size() == 1);
  const Remedy& remedy = report.remedies.front();
  INFO(remedy.why);
  REQUIRE(remedy.ends == true);
  REQUIRE(remedy.edges.size() == 1);
  CHECK(remedy.edges[0] == remedy.value);
  CHECK(remedy.value < 2.0);  // the break-away force is 1.5 N
  CHECK(remedy.edges[0] / remedy.beyond.at(0) < 1.11);
  CHECK(remedy.why.find("hunts at 0.") == 0);
  CHECK(remedy.why.find("does not hunt either") != std::string::npos);
  CHECK(report.notes == std::vector<std::string>{"dither: " + remedy.why});
  CHECK_FALSE(remedy.costs.steady_state_error);
  CHECK(remedy.costs.phase_margin);
}

TEST_CASE("dither: the loop hunts under a weak one and not under a strong one, in two units of length") {
  for (const double unit : {1.0, 1e-3}) {
    const LoopParts parts = hunting_servo(unit);
    const double w = frequency_of_dither(parts).value();
    const Loop loop = build_loop(parts);
    const HuntsAnswer still = hunts(loop, {});
    const auto cycle = std::ranges::find(still.found.cycles, std::optional<bool>(true), &Cycle::stable);
    REQUIRE(cycle != still.found.cycles.end());
    CHECK(hunts_under(loop, cycle->start, {0.1, w}, *cycle, {}) == Hunts::yes);
    CHECK(hunts_under(loop, cycle->start, {4.0, w}, *cycle, {}) == Hunts::no);
    CHECK(hunts_under(loop, cycle->start, {4.0, w}, *cycle, [] { return true; }) == Hunts::undecided);
    CHECK(hunts(build_loop(averaged_over(parts, {4.0, w}).value()), {}).hunts == Hunts::no);
    CHECK(dither_speed(parts, {4.0, w}).value() == Approx(0.0617 * unit).epsilon(1e-2));
  }
}

TEST_CASE("dither: loops that have none, with the reason") {
  LoopParts parts = hunting_servo(1.0);
  parts.friction = test::lugre();
  std::get<Pid>(parts.controller).saturation = 5.0;
  CHECK(why_no_dither(parts).empty());  // simulated as it is, without a mean law
  parts = hunting_servo(1.0);
  std::get<Pid>(parts.controller).sample_time = 0.01;
  CHECK(why_no_dither(parts).find("sampling") != std::string::npos);
  CHECK(why_no_dither(pulled_mass(1.0, 0.0, 0.0)).find("no controller") != std::string::npos);
}
