#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/froude.hpp"

namespace limcycle {
namespace {

constexpr double shown = 0.1;  // s of the fast motion that are drawn

std::string label(double clearance) { return clearance == 0.0 ? "no play" : short_number(1e3 * clearance, 3) + " mm"; }

double largest_change(const FroudeSeries& series, double FroudeComparison::*what) {
  double worst = 0.0;
  for (const auto& c : series.clearances) worst = std::max(worst, std::abs(c.*what));
  return worst;
}

/// The rows of a trace in [from, to), as a curve.
Curve piece(const FroudeComparison& c, std::vector<double> FroudeTrace::*column, double from, double to) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < c.run.trace.t.size(); ++i) {
    const double t = c.run.trace.t[i];
    if (t < from || t >= to) continue;
    x.push_back(t);
    y.push_back((c.run.trace.*column)[i]);
  }
  return thinned(label(c.clearance), x, y, 1000);
}

ExperimentFigure figure(const FroudeResult& result, ExperimentFigure drawn, std::vector<double> FroudeTrace::*column,
                        bool magnified) {
  for (const auto& series : result.series) {
    FigurePanel panel{series.setting.name, {}};
    const double from = series.setting.left_out;
    const double to = magnified ? from + shown : series.setting.duration;
    for (const auto& c : series.clearances) panel.curves.push_back(piece(c, column, from, to));
    drawn.panels.push_back(std::move(panel));
  }
  return drawn;
}

void add_figures(Experiment& e, const FroudeResult& result) {
  e.figures.push_back(
      figure(result, {"angle", "angle of the pendulum", "time", "s", "angle", "rad"}, &FroudeTrace::angle, false));
  e.figures.push_back(figure(result, {"sliding-velocity", "sliding velocity", "time", "s", "velocity", "m/s"},
                             &FroudeTrace::rubbing, false));
  e.figures.push_back(figure(result,
                             {"sliding-velocity-detail", "sliding velocity, magnified", "time", "s", "velocity", "m/s"},
                             &FroudeTrace::rubbing, true));
  e.figures.push_back(figure(result, {"contact-force", "contact force, magnified", "time", "s", "force", "N"},
                             &FroudeTrace::normal, true));
  e.figures.push_back(figure(result,
                             {"eccentricity", "distance of the centres, magnified", "time", "s", "distance", "m"},
                             &FroudeTrace::eccentricity, true));
}

void add_rows(Experiment& e, const FroudeSeries& series) {
  for (const auto& c : series.clearances)
    e.rows.push_back({series.setting.name,
                      label(c.clearance),
                      {c.swing, c.swing_change, c.angle_change, c.rubbing_change, c.fast_angle, c.fast_rubbing,
                       c.fast_normal, static_cast<double>(c.run.losses), c.run.time_apart}});
  e.findings.push_back({series.setting.name, series.finding, Status::converged});
}

void add_claims(Experiment& e, const FroudeResult& result) {
  bool fast = true, some = false, all = true;
  std::string speeds;
  for (const auto& series : result.series) {
    const auto& c = series.clearances;
    fast = fast && c.back().fast_rubbing > 10.0 * c.front().fast_rubbing;
    const bool kept = largest_change(series, &FroudeComparison::swing_change) < unchanged_swing;
    some = some || kept;
    all = all && kept;
    speeds += (speeds.empty() ? "" : "; ") + series.setting.name + ": swing " +
              short_number(100.0 * largest_change(series, &FroudeComparison::swing_change), 2) +
              " %, sliding velocity " +
              short_number(100.0 * largest_change(series, &FroudeComparison::rubbing_change), 2) + " % rms";
  }
  const std::string source = "pendulum paper, abstract";
  e.claims.push_back({"radial play of up to 0.1 mm causes high-frequency oscillation", source,
                      fast ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed,
                      "the fast part of the sliding velocity at the widest play is " +
                          short_number(result.series.front().clearances.back().fast_rubbing, 2) + " to " +
                          short_number(result.series.back().clearances.back().fast_rubbing, 2) + " m/s rms"});
  e.claims.push_back({"that play does not substantially affect the trajectory and the sliding velocity", source,
                      all    ? ClaimOutcome::confirmed
                      : some ? ClaimOutcome::depends
                             : ClaimOutcome::not_confirmed,
                      "largest changes, " + speeds});
}

}  // namespace

Experiment froude_pendulum_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "froude-pendulum";
  e.title = "Froude pendulum with radial play";
  e.document = "pendulum paper, abstract (its figures of the pendulum were not seen)";
  e.input =
      "a shaft at 4 rad/s under a pendulum of 5 kg; three friction curves, the steepest in two contacts, play of 0, "
      "0.02, 0.05 and 0.1 mm. All "
      "numbers were chosen here, and the equations are a reconstruction: LuGre friction that goes with the contact "
      "force, Hunt-Crossley contact";
  e.quantities = {{"swing", "swing", "rad"},
                  {"swing_change", "change of swing", ""},
                  {"angle_change", "change of angle, rms", ""},
                  {"velocity_change", "change of sliding velocity, rms", ""},
                  {"fast_angle", "angle above 20 w0, rms", "rad"},
                  {"fast_velocity", "sliding velocity above 20 w0, rms", "m/s"},
                  {"fast_force", "contact force above 20 w0, rms", "N"},
                  {"losses", "losses of contact", ""},
                  {"apart", "time without contact", "s"}};
  const FroudeResult result = froude_experiment(froude_settings(), {2e-5, 5e-5, 1e-4}, options.threads, options.stop);
  e.status = result.status;
  if (result.status != Status::converged) {
    e.notes.emplace_back("a run ended with status " + std::string(to_string(result.status)));
    return e;
  }
  for (const auto& series : result.series) add_rows(e, series);
  add_claims(e, result);
  add_figures(e, result);
  e.notes.push_back(result.finding);
  e.notes.emplace_back(
      "where the sleeve rattles with impacts the motion is irregular: its numbers hold for this run, "
      "its kind does not depend on the tolerance");
  return e;
}

}  // namespace limcycle
