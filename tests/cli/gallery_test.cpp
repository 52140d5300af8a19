// The numbers of docs/gallery.md: against closed forms, or against another method of the program. tools/gallery checks
// that the page quotes the program's own answers.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "limcycle/tests/cli/program.hpp"

using namespace limcycle::test;
using Json = nlohmann::ordered_json;
using std::numbers::pi;

namespace {

Json scene(const std::string& command, const std::string& name, const std::vector<std::string>& changes = {}) {
  std::vector<std::string> arguments = {command, shipped(name + ".toml"), "--json", "-"};
  for (const auto& change : changes) arguments.insert(arguments.end(), {"--set", change});
  const auto ran = run(arguments);
  INFO(name << ": " << ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(ran.out);
}

struct Swing {
  double period = 0.0, amplitude = 0.0;
};

void check_cycle(const Json& cycle, const Swing& expected, double tolerance) {
  CHECK(cycle["period"].get<double>() == Approx(expected.period).epsilon(tolerance).margin(0.0));
  CHECK(cycle["amplitude"].get<double>() == Approx(expected.amplitude).epsilon(tolerance).margin(0.0));
}

/// The only cycle of a prediction, which is stable.
Json only_cycle(const Json& document) {
  REQUIRE(document["cycles"].size() == 1);
  CHECK(document["cycles"][0]["stable"] == true);
  return document["cycles"][0];
}

Swing swing(const Json& cycle) { return {cycle["period"], cycle["amplitude"]}; }

int starts_with_outcome(const Json& document, const std::string& outcome) {
  int k = 0;
  for (const auto& one : document["outcomes"]) k += one["outcome"] == outcome;
  return k;
}

double root_between(const std::function<double(double)>& f, double low, double high) {
  const bool rises = f(high) > 0.0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    ((f(mid) > 0.0) == rises ? high : low) = mid;
  }
  return 0.5 * (low + high);
}

struct Pulled {
  double mass, stiffness, damping, speed, Fs, Fc;
};

/// A body on a belt with stiction. In slip it is a damped oscillator about Fc/k, which starts at the speed of the belt
/// where spring and damper pull with Fs, and sticks when it reaches that speed again; then the belt carries it back.
Swing stick_slip(const Pulled& p) {
  const double decay = 0.5 * p.damping / p.mass, w = std::sqrt(p.stiffness / p.mass - decay * decay);
  const double y0 = (p.Fs - p.damping * p.speed - p.Fc) / p.stiffness, b = (p.speed + decay * y0) / w;
  const auto y = [&](double t) { return std::exp(-decay * t) * (y0 * std::cos(w * t) + b * std::sin(w * t)); };
  const auto v = [&](double t) {
    return std::exp(-decay * t) * (w * (b * std::cos(w * t) - y0 * std::sin(w * t))) - decay * y(t);
  };
  // The speed falls through zero (y greatest), is least half a turn later, and rises to zero again (y least).
  const double turn = pi / w, greatest = root_between(v, 0.0, 0.5 * turn);
  const double least = root_between(v, greatest + 0.5 * turn, greatest + 1.5 * turn);
  const double end = root_between([&](double t) { return v(t) - p.speed; }, least, least + 0.5 * turn);
  return {end + (y0 - y(end)) / p.speed, 0.5 * (y(greatest) - y(least))};
}

/// Relay of +-level around sum r/(s - p): between two switches each mode goes from r level/p tanh(p h/2) to its
/// negative.
struct Modes {
  std::vector<double> poles, residues;

  double at_switch(double half) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < poles.size(); ++i) sum += residues[i] / poles[i] * std::tanh(0.5 * poles[i] * half);
    return sum;
  }
  double y(double t, double half) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < poles.size(); ++i) {
      const double all = residues[i] / poles[i], p = poles[i];
      sum += all * (std::exp(p * t) * std::tanh(0.5 * p * half) - std::expm1(p * t));
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("gallery: brake and telescope stick and slip as their closed form says") {
  const Swing brake = stick_slip({4.0, 1e6, 200.0, 0.03, 1200.0, 1000.0});
  check_cycle(only_cycle(scene("predict", "brake-groan")), brake, 1e-9);
  CHECK(1.0 / brake.period == Approx(51.3).margin(0.05));
  const Swing faster = stick_slip({4.0, 1e6, 200.0, 0.1, 1200.0, 1000.0});
  CHECK(1.0 / faster.period == Approx(77.0).margin(0.05));
  const auto fast = scene("predict", "brake-groan", {"loop.plant.speed=0.2"});
  CHECK(fast["cycles"].empty());
  CHECK(starts_with_outcome(fast, "sliding") == static_cast<int>(fast["outcomes"].size()));

  // In a frame that moves with the set-point the axis is such a body: kp its spring, kd its damper.
  const Swing telescope = stick_slip({400.0, 1.6e5, 4000.0, 7.292e-5, 30.0, 20.0});
  const auto cycle = only_cycle(scene("predict", "telescope-drive"));
  check_cycle(cycle, telescope, 1e-8);
  CHECK(cycle["sticking_fraction"].get<double>() == Approx(0.874).margin(0.001));
}

TEST_CASE("gallery: the squeal has the speed of the belt and the pitch of the spring") {
  const auto predicted = scene("predict", "belt-squeal");
  const auto cycle = only_cycle(predicted);
  const double w0 = std::sqrt(4e6 / 0.1);
  CHECK(cycle["period"].get<double>() == Approx(2.0 * pi / w0).epsilon(1e-3));
  CHECK(cycle["amplitude"].get<double>() > 0.5 / w0);
  CHECK(cycle["amplitude"].get<double>() < 1.02 * 0.5 / w0);
  CHECK(cycle["sticking_fraction"].get<double>() == Approx(0.071).margin(0.002));
  REQUIRE(predicted["predictions"].size() == 2);
  for (const auto& one : predicted["predictions"]) CHECK(one["verdict"] == "confirmed");
  const auto simulated = scene("simulate", "belt-squeal");
  CHECK(simulated["outcome"] == "cycle");
  check_cycle(simulated, swing(cycle), 1e-6);
  const auto changes = scene("dissipativity", "belt-squeal")["loop"]["sliding"]["changes"];
  REQUIRE(changes.size() == 1);
  CHECK(changes[0]["speed"].get<double>() == Approx(0.8 * std::log((60.0 - 40.0) / (0.8 * 10.0))).epsilon(1e-6));
  CHECK(changes[0]["stable_above"] == true);
}

TEST_CASE("gallery: the relay's oscillation of the oven, and the ultimate gain that follows") {
  Modes oven{{-0.01, -0.025, -0.05}, {}};
  for (const double p : oven.poles) {
    double residue = 500.0 * 2.5e-6;
    for (const double q : oven.poles)
      if (q != p) residue /= p - q;
    oven.residues.push_back(residue);
  }
  const double half = root_between([&](double h) { return oven.at_switch(h); }, 40.0, 120.0);
  double peak = 0.0;
  for (int i = 0; i <= 100000; ++i) peak = std::max(peak, std::abs(oven.y(1e-5 * half * i, half)));
  const auto cycle = only_cycle(scene("predict", "relay-autotuning"));
  check_cycle(cycle, {2.0 * half, peak}, 1e-9);
  CHECK(4.0 * 500.0 / (pi * cycle["amplitude"].get<double>()) == Approx(63.0).epsilon(0.03));
  CHECK(cycle["period"].get<double>() == Approx(2.0 * pi / std::sqrt(160.0 / 80000.0)).epsilon(0.02));
}

TEST_CASE("gallery: the weak motor hunts like a strong one, and runs away from 9 m") {
  const Swing known{23.36927229, 0.06724015};  // stick and slip phases of the servo without saturation
  const auto near = scene("predict", "saturated-servo", {"search.amplitude=[1e-4,8.0]"});
  check_cycle(only_cycle(near), known, 1e-7);
  CHECK(starts_with_outcome(near, "divergence") == 0);
  const auto from_9 = scene("predict", "saturated-servo", {"search.amplitude=[1e-4,9.0]"});
  REQUIRE(from_9["cycles"].size() == 2);  // and the unstable one between
  check_cycle(from_9["cycles"][0], known, 1e-7);
  CHECK(from_9["cycles"][1]["stable"] == false);
  CHECK(starts_with_outcome(from_9, "divergence") == 1);
  const auto strong =
      scene("predict", "saturated-servo", {"loop.controller.saturation=1000", "search.amplitude=[1e-4,9.0]"});
  CHECK(starts_with_outcome(strong, "divergence") == 0);
}

TEST_CASE("gallery: the drive hunts slowly, and friction keeps its shaft quiet") {
  const auto at_load = scene("predict", "two-mass-drive");
  const auto at_motor = scene("predict", "two-mass-drive", {"loop.plant.friction_on=\"motor\""});
  REQUIRE((at_load["cycles"].size() == 2 && at_motor["cycles"].size() == 2));
  for (const std::size_t i : {0u, 1u}) {
    // Equal masses: from either end the shaft is the same, and so is the loop that the friction closes.
    CHECK(at_motor["cycles"][i]["period"].get<double>() ==
          Approx(at_load["cycles"][i]["period"].get<double>()).epsilon(1e-9));
    CHECK(at_load["cycles"][i]["stable"] == (i == 0));
  }
  CHECK(at_load["cycles"][0]["period"].get<double>() == Approx(19.0783).epsilon(1e-5));
  for (const auto& one : at_load["predictions"])
    if (one["method"] == "harmonic-balance" || one["method"] == "describing-function") {
      CHECK(one["cycle"] == 1);
      CHECK(one["amplitude"].get<double>() ==
            Approx(at_load["cycles"][1]["first_harmonic"].get<double>()).epsilon(0.004));
      CHECK(one["frequency"].get<double>() == Approx(28.75).epsilon(1e-3));
    }
  const auto rigid = scene("predict", "two-mass-drive", {"loop.plant.stiffness=2e4", "loop.plant.damping=100"});
  check_cycle(only_cycle(rigid), {23.36927229, 0.06724015}, 1e-4);
}

TEST_CASE("gallery: the flow jumps by what the stem jumps, as long as the integrator needs to turn the force") {
  const auto document = scene("predict", "valve-stiction");
  const auto cycle = only_cycle(document);
  const double a = 0.5 * 5000.0 * (100.0 - 80.0) / 50e3;
  check_cycle(cycle, {2.0 * ((100.0 + 80.0 - 2.0 * 5.0 * a) / (5.0 * a) + 2.0 * 2.0), a}, 0.01);
  CHECK(starts_with_outcome(document, "cycle") == static_cast<int>(document["outcomes"].size()));
  // The rest of the loop is linear: twice the friction gives twice the amplitude.
  const auto twice = only_cycle(scene("predict", "valve-stiction", {"loop.friction.Fs=200", "loop.friction.Fc=160"}));
  check_cycle(twice, {cycle["period"], 2.0 * cycle["amplitude"].get<double>()}, 1e-8);
  const auto even = scene("predict", "valve-stiction", {"loop.friction.Fs=80"});
  CHECK(even["cycles"].empty());
  CHECK(starts_with_outcome(even, "rest") == static_cast<int>(even["outcomes"].size()));
}

TEST_CASE("gallery: the valve with dead time, and the valve by its records, as independent simulations have them") {
  const auto late = only_cycle(scene("predict", "valve-dead-time"));
  check_cycle(late, {38.209, 2.5847}, 2e-4);
  CHECK(late["error"].get<double>() > 1e-4);  // of the approximated dead time, stated and not too small
  CHECK(late["error"].get<double>() < 0.1);
  const auto records = scene("predict", "valve-records");
  CHECK(records["cause"]["kind"] == "integral-action-and-stiction");
  CHECK(records["cause"]["why"].get<std::string>().find("in which the valve sticks") != std::string::npos);
  const auto by_records = only_cycle(records);
  check_cycle(by_records, {98.653, 0.50286}, 3e-5);
  // The process is linear: half the band and half the jump give half the swing.
  const auto half = scene("predict", "valve-records", {"loop.element.S=0.5", "loop.element.J=0.15"});
  check_cycle(only_cycle(half), {by_records["period"], 0.5 * by_records["amplitude"].get<double>()}, 1e-8);
  // J = S, by the same independent simulation.
  check_cycle(only_cycle(scene("predict", "valve-records", {"loop.element.S=0.5", "loop.element.J=0.5"})),
              {42.3607, 0.553186}, 3e-5);
}

TEST_CASE("gallery: the older scenes") {
  check_cycle(only_cycle(scene("predict", "pid-lugre")), {24.43679, 0.063903}, 1e-5);

  const auto compensated = only_cycle(scene("predict", "over-compensated"));
  const auto twice = scene(
      "predict", "over-compensated",
      {"loop.friction.Fc=2", "loop.controller.friction_compensation=2.6", "predict.methods=[\"describing-function\"]"});
  check_cycle(only_cycle(twice), {compensated["period"], 2.0 * compensated["amplitude"].get<double>()}, 1e-8);

  const auto backlash = scene("predict", "backlash");
  const auto cycle = only_cycle(backlash);
  int confirmed = 0;
  for (const auto& one : backlash["predictions"]) {
    if (one["verdict"] != "confirmed") continue;
    ++confirmed;
    const double tolerance = one["method"] == "harmonic-balance" ? 1e-5 : 6e-3;
    CHECK(one["amplitude"].get<double>() == Approx(cycle["first_harmonic"].get<double>()).epsilon(tolerance));
  }
  CHECK(confirmed == 2);

  const auto zoned = scene("predict", "dead-zoned-error");
  const auto simulated = scene("simulate", "dead-zoned-error", {"simulate.duration=300"});
  CHECK(simulated["outcome"] == "cycle");
  check_cycle(simulated, swing(only_cycle(zoned)), 1e-5);
  CHECK(simulated["amplitude"].get<double>() == Approx(0.183).epsilon(0.005));
  CHECK((starts_with_outcome(zoned, "cycle") == 2 && starts_with_outcome(zoned, "rest") == 3));
}

TEST_CASE("gallery: the Froude pendulum, as simulated") {
  const auto cycle = only_cycle(scene("predict", "froude-pendulum", {"predict.methods=[\"harmonic-balance\"]"}));
  const auto simulated = scene("simulate", "froude-pendulum");
  CHECK(simulated["outcome"] == "cycle");
  check_cycle(simulated, swing(cycle), 1e-5);
}
