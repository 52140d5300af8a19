#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"

namespace limcycle {
namespace {

/// 1e-5 to 0.1 m/s, ten per decade.
std::vector<double> speeds() {
  std::vector<double> list;
  for (int k = 0; k <= 40; ++k) list.push_back(std::pow(10.0, -5.0 + 0.1 * k));
  return list;
}

LawPart steady_force_of_law(const LawSetting& setting) {
  const Element law = make_law(setting);
  LawPart part;
  std::vector<double> v, F, g;
  double worst = 0.0, at = 0.0;
  for (const double speed : speeds()) {
    // Twenty break-away displacements, and the time of the slowest lag: 15 s for the printed gms.
    const VelocityRun run = run_constant_velocity(law, speed, 20.0 * setting.break_away / speed + 400.0);
    const double force = run.F.empty() || run.status != Status::converged ? NAN : run.F.back();
    const double level = steady_level(setting, speed);
    if (run.status != Status::converged) part.status = run.status;
    v.push_back(speed);
    F.push_back(force);
    g.push_back(level);
    if (std::isfinite(force - level) && std::abs(force - level) >= worst) {
      worst = std::abs(force - level);
      at = speed;
    }
  }
  part.add(0, {"steady force", v, F});
  if (std::isfinite(g.front())) part.add(0, {"Stribeck curve", v, g});
  const auto last = static_cast<std::size_t>(v.size() - 1);
  const bool known = std::isfinite(g.front());
  part.rows.push_back({"", "", {F.front(), F[20], F[last], known ? worst : NAN}});
  part.finding = "from " + quantity(F.front(), "N", 4) + " at 1e-5 m/s to " + quantity(F[last], "N", 4) + " at 0.1 m/s";
  if (known)
    part.finding += worst < 1e-6 ? ": the curve of its own levels, to " + quantity(worst, "N", 2)
                                 : "; off the curve of its own levels by up to " + quantity(worst, "N", 2) + ", at " +
                                       quantity(at, "m/s", 2);
  return part;
}

}  // namespace

Experiment steady_velocity_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "steady-velocity";
  e.title = "Friction at constant velocities";
  e.document = "thesis, figure 3.36b";
  e.input = "constant velocities of 1e-5 to 0.1 m/s, imposed from rest until the force is steady";
  e.quantities = {
      {"slow", "F at 1e-5", "N"}, {"at_vs", "F at 0.001", "N"}, {"fast", "F at 0.1", "N"}, {"off", "off g(v)", "N"}};
  e.figures = {{"force-velocity", "Steady friction force over velocity (figure 3.36b)", "v", "m/s", "F", "N", true}};
  run_by_law(e, options, steady_force_of_law);
  if (has_law(e, "wojewoda"))
    e.notes.emplace_back(
        "the force of wojewoda depends on the sign of the acceleration, which a constant velocity does not have: what "
        "is "
        "shown is one of its branches, g(v) or 2 Fc - g(v)");
  ExperimentClaim claim{"at constant velocities the proposed law falls from Fs to Fc: the Stribeck curve",
                        "thesis, section 3.6.2, figure 3.36b", ClaimOutcome::not_tested, ""};
  if (has_law(e, "non-drift")) {
    const double off = e.value("non-drift", "off");
    claim.outcome = off < 1e-4 ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure = "off the curve by at most " + quantity(off, "N", 2);
  }
  e.claims.push_back(std::move(claim));
  return e;
}

}  // namespace limcycle
