#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_loop.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"

namespace limcycle {
namespace {

constexpr std::array frequencies{2.0, 10.0, 25.0, 50.0};  // rad/s, as in the pendulum paper's figure 1

std::string frequency_in_words(double frequency) { return quantity(frequency, "rad/s"); }

std::string unanswered(const VelocityRun& run) {
  return "has no periodic answer (" + std::string(to_string(run.status)) + ")";
}

bool answered(const VelocityRun& run) { return run.status == Status::converged || run.status == Status::incomplete; }

/// Curve of the samples at speeds within the limit (`within` infinite: of all).
Curve loop_curve(const std::string& name, const VelocityRun& run, double within) {
  if (!std::isfinite(within)) return thinned(name, run.v, run.F, 250);
  std::vector<double> v, F;
  for (std::size_t i = 0; i < run.v.size(); ++i) {
    const bool inside = std::abs(run.v[i]) <= within;
    if (!inside && !v.empty() && std::isfinite(v.back())) {
      v.push_back(NAN);
      F.push_back(NAN);
    }
    if (!inside) continue;
    v.push_back(run.v[i]);
    F.push_back(run.F[i]);
  }
  return thinned(name, v, F, 250);
}

/// Loops at the paper's four frequencies about a mean velocity.
LawPart loops(const LawSetting& setting, double mean, double amplitude, double at, double detail) {
  LawPart part;
  const Element law = make_law(setting);
  std::string widths;
  bool any = false;
  for (const double w : frequencies) {
    const VelocityRun run = run_velocity(law, mean, amplitude, w, 40);
    if (!answered(run)) {
      part.status = run.status;
      part.rows.push_back({"", frequency_in_words(w), {NAN, NAN, NAN, NAN}});
      continue;
    }
    any = true;
    const LoopShape shape = loop_shape(run, mean, amplitude);
    const double lag = run.force_at(at, true) - run.force_at(at, false);
    part.rows.push_back(
        {"", frequency_in_words(w), {lag, shape.width, shape.peak, static_cast<double>(shape.crossings)}});
    part.add(0, loop_curve(frequency_in_words(w), run, infinite));
    if (std::isfinite(detail)) part.add(1, loop_curve(frequency_in_words(w), run, detail));
    widths += (widths.empty() ? "" : ", ") + quantity(shape.width, "");
  }
  if (!any)
    part.finding = "no periodic answer was found";
  else
    part.finding = "width of the loop at " + std::string("2, 10, 25, 50 rad/s: ") + widths + " N";
  const double band = law.drive_band();
  if (band > 0.0)
    part.finding += "; it needs the applied force where |v| < " + quantity(band, "m/s") + ": not shown there";
  return part;
}

const std::vector<Quantity> loop_quantities{{"lag", "F up - F down", "N"},
                                            {"width", "widest", "N"},
                                            {"peak", "peak force", "N"},
                                            {"crossings", "crossings", ""}};

/// LuGre's loops open further with every frequency.
ExperimentClaim lag_claim(const Experiment& e, const std::string& statement, const std::string& source) {
  ExperimentClaim claim{statement, source, ClaimOutcome::not_tested, ""};
  if (!has_law(e, "lugre")) return claim;
  bool grows = true, opens = true;
  double before = 0.0;
  for (const double w : frequencies) {
    const double width = e.value("lugre", "width", frequency_in_words(w));
    opens = opens && width > 1e-4;
    grows = grows && width > before;
    before = width;
    claim.measure += (claim.measure.empty() ? "width " : ", ") + quantity(width, "");
  }
  claim.measure +=
      std::string(" N at 2, 10, 25, 50 rad/s: ") + (grows ? "wider with every frequency" : "not monotonic");
  claim.outcome = opens ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
  return claim;
}

constexpr double transition_amplitude = 0.02, transition_frequency = 1.0;

LawPart transition(const LawSetting& setting) {
  const Element law = make_law(setting);
  const VelocityRun run = run_velocity(law, 0.0, transition_amplitude, transition_frequency);
  LawPart part;
  part.status = run.status;
  if (!answered(run)) {
    part.finding = unanswered(run);
    return part;
  }
  std::vector<double> near_v, near_F;
  for (std::size_t i = 0; i < run.v.size(); ++i)
    if (std::abs(run.v[i]) < 0.004) {
      near_v.push_back(run.v[i]);
      near_F.push_back(run.F[i]);
    } else if (!near_v.empty() && std::isfinite(near_v.back())) {
      near_v.push_back(NAN);
      near_F.push_back(NAN);
    }
  part.add(0, thinned("", near_v, near_F));
  part.add(1, thinned("", run.t, run.F));
  const double turn = turning_distance(run), jump = largest_jump(run);
  double peak = 0.0;
  for (const double F : run.F)
    if (std::isfinite(F)) peak = std::max(peak, std::abs(F));
  const double up = run.force_at(2e-3, true), down = run.force_at(2e-3, false);
  part.rows.push_back({"", "", {peak, jump, turn, up, down}});
  part.finding = jump > 0.5 ? "jumps by " + quantity(jump, "N") + " at a reversal"
                 : std::isfinite(turn)
                     ? "passes reversals continuously: the force changes sign " + quantity(turn, "m") + " after them"
                     : "passes reversals without a jump that is seen; where the force changes sign after them is not";
  part.finding += "; peak " + quantity(peak, "N", 4);
  const double band = law.drive_band();
  if (band > 0.0)
    part.finding += "; it needs the applied force where |v| < " + quantity(band, "m/s") + ": not shown there";
  return part;
}

}  // namespace

Experiment stick_slip_transition_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "stick-slip-transition";
  e.title = "From stick to slip and back: a sinusoidal velocity";
  e.document = "thesis, figure 3.36a";
  e.input =
      "velocity 0.02 cos(t) m/s, imposed; steady state. The thesis says a sinusoidal velocity only: size and frequency "
      "are "
      "chosen here, so that even the softest law breaks away within the travel of 0.04 m";
  e.quantities = {{"peak", "peak force", "N"},
                  {"jump", "jump", "N"},
                  {"turn", "x to F = 0", "m"},
                  {"up", "F at 2 vs, up", "N"},
                  {"down", "F at 2 vs, down", "N"}};
  e.figures = {{"force-velocity", "Friction force over velocity about zero (figure 3.36a)", "v", "m/s", "F", "N"},
               {"force-time", "Friction force over one period", "t", "s", "F", "N"}};
  run_by_law(e, options, transition);
  ExperimentClaim claim{
      "the proposed law goes from stick to slip and back, through velocity zero, without a jump and "
      "within Fs",
      "thesis, section 3.6.2, figure 3.36a", ClaimOutcome::not_tested, ""};
  if (has_law(e, "non-drift")) {
    const double peak = e.value("non-drift", "peak"), jump = e.value("non-drift", "jump");
    claim.outcome = peak <= 1.5 * (1.0 + 1e-9) && jump < 0.5 ? ClaimOutcome::confirmed : ClaimOutcome::not_confirmed;
    claim.measure =
        "peak " + quantity(peak, "N", 4) + ", largest change between neighbouring samples " + quantity(jump, "N");
  }
  e.claims.push_back(std::move(claim));
  return e;
}

Experiment frictional_lag_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "frictional-lag";
  e.title = "Friction over a velocity that varies without changing sign";
  e.document = "pendulum paper, figure 1c";
  e.input =
      "velocity 0.001 (1.5 + cos wt) m/s, imposed, at the paper's w = 2, 10, 25 and 50 rad/s; steady state. Mean and "
      "amplitude are those of the LuGre paper of 1995, the pendulum paper does not print its own";
  e.quantities = loop_quantities;
  e.figures = {{"force-velocity", "Friction force over velocity (figure 1c)", "v", "m/s", "F", "N"}};
  run_by_law(e, options, [](const LawSetting& s) { return loops(s, 1.5e-3, 1e-3, 1.5e-3, infinite); });
  e.claims = {lag_claim(e, "at low velocities of constant sense friction lags behind velocity (LuGre)",
                        "pendulum paper, figure 1c and text")};
  return e;
}

Experiment asymmetric_stick_slip_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "asymmetric-stick-slip";
  e.title = "Stick-slip at an asymmetric sinusoidal velocity";
  e.document = "pendulum paper, figures 1e and 1f";
  e.input =
      "velocity 0.001 (0.5 + 1.5 cos wt) m/s, imposed, at the paper's w = 2, 10, 25 and 50 rad/s; steady state. Mean "
      "and "
      "amplitude are chosen here: the paper says asymmetric only";
  e.quantities = loop_quantities;
  e.figures = {{"force-velocity", "Friction force over velocity (figure 1e)", "v", "m/s", "F", "N"},
               {"detail", "The same for |v| < 0.0003 m/s (figure 1f)", "v", "m/s", "F", "N"}};
  run_by_law(e, options, [](const LawSetting& s) { return loops(s, 5e-4, 1.5e-3, 1e-3, 3e-4); });
  e.claims = {lag_claim(e,
                        "at an asymmetric velocity the force runs through a loop of its own at each frequency (LuGre)",
                        "pendulum paper, figures 1e and 1f")};
  return e;
}

LawPart alternating_loops(const LawSetting& setting) { return loops(setting, 0.0, 2e-3, 1e-3, infinite); }

}  // namespace limcycle
