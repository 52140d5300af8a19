#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_loop.hpp"

namespace limcycle {
namespace {

/// The stick-slip of the LuGre paper of 1995: a mass of 1 kg pulled by a spring of 2 N/m whose end moves with 0.1 m/s,
/// in coordinates of that end (a belt).
struct Pulled {
  double period = NAN, fastest = NAN;
  std::vector<double> t, spring;
  Status status = Status::converged;
};

Pulled pulled(const Element& law, const std::function<bool()>& stop) {
  Belt belt;
  belt.mass = 1.0;
  belt.stiffness = 2.0;
  belt.speed = 0.1;
  LoopParts parts;
  parts.plant = belt;
  parts.friction = law;
  SimulateOptions options;
  options.duration = 60.0;
  options.sample = 2.5e-3;
  options.stop = stop;
  const Simulation run = simulate(build_loop(parts), options);
  Pulled result;
  result.status = run.status;
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(run.columns, name) - run.columns.begin());
  };
  const std::size_t y = column("y"), rate = column("dy_dt");
  std::vector<double> crossings;
  double fastest = 0.0, slowest = infinite;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const double t = run.rows[i][0], a = run.rows[i - 1][y], b = run.rows[i][y];
    result.t.push_back(t);
    result.spring.push_back(2.0 * b);
    // The mass is carried along (y rises) until it slips back: y falls through the sliding level once a cycle.
    if (a > 0.5 && b <= 0.5) crossings.push_back(t - 2.5e-3 * (0.5 - b) / (a - b));
    if (t < 30.0) continue;
    fastest = std::max(fastest, 0.1 - run.rows[i][rate]);
    slowest = std::min(slowest, 0.1 - run.rows[i][rate]);
  }
  const bool moves = fastest - slowest > 1e-3;
  if (moves && crossings.size() >= 3) result.period = crossings.back() - crossings[crossings.size() - 2];
  result.fastest = fastest;
  return result;
}

LawPart stick_slip_of_law(const LawSetting& setting) {
  LawPart part = alternating_loops(setting);
  for (auto& row : part.rows) row.values.insert(row.values.end(), {NAN, NAN});
  const Pulled motion = pulled(make_law(setting), setting.stop);
  if (motion.status != Status::converged) part.status = motion.status;
  part.add(1, thinned("", motion.t, motion.spring));
  part.rows.push_back({"", "pulled", {NAN, NAN, NAN, NAN, motion.period, motion.fastest}});
  part.finding += std::isfinite(motion.period)
                      ? "; pulled by a spring it sticks and slips with a period of " + quantity(motion.period, "s", 5) +
                            ", at most " + quantity(motion.fastest, "m/s", 4)
                  : motion.status == Status::converged ? "; pulled by a spring it comes to slide steadily"
                                                       : "; pulled by a spring the run ended early";
  return part;
}

}  // namespace

Experiment stick_slip_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "stick-slip";
  e.title = "Stick-slip: a low velocity of alternating sense, and a mass pulled by a spring";
  e.document = "pendulum paper, figure 1d";
  e.input =
      "velocity 0.002 cos wt m/s, imposed, at the paper's w = 2, 10, 25 and 50 rad/s (its amplitude is not printed); "
      "and "
      "the stick-slip test of the LuGre paper of 1995: 1 kg pulled by 2 N/m whose end moves with 0.1 m/s";
  e.quantities = {{"lag", "F up - F down", "N"},  {"width", "widest", "N"},  {"peak", "peak force", "N"},
                  {"crossings", "crossings", ""}, {"period", "period", "s"}, {"fastest", "fastest", "m/s"}};
  e.figures = {{"force-velocity", "Friction force over velocity (figure 1d)", "v", "m/s", "F", "N"},
               {"spring-time", "Force of the spring that pulls, over time", "t", "s", "spring", "N"}};
  run_by_law(e, options, stick_slip_of_law);
  ExperimentClaim claim{"at low velocities of alternating sense LuGre sticks and slips", "pendulum paper, figure 1d",
                        ClaimOutcome::not_tested, ""};
  if (has_law(e, "lugre")) {
    const double period = e.value("lugre", "period", "pulled"), peak = e.value("lugre", "peak", "2 rad/s");
    claim.outcome = std::isfinite(period) && peak > 1.05 ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure =
        "peak " + quantity(peak, "N", 4) + " at 2 rad/s; pulled by the spring: period " + quantity(period, "s", 6);
  }
  e.claims.push_back(std::move(claim));
  return e;
}

}  // namespace limcycle
