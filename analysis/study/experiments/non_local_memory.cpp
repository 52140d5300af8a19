#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/study/experiments/by_law.hpp"
#include "limcycle/analysis/study/experiments/catalogue.hpp"
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"

namespace limcycle {
namespace {

/// Turning points of the force, in units of its largest value. Number 5 closes the inner loop begun at 3, number 6 the
/// middle one begun at 2, number 7 the outer one begun at 1.
constexpr std::array<double, 8> turns{0.0, 1.0, -2.0 / 3.0, 5.0 / 9.0, -2.0 / 9.0, 5.0 / 9.0, -2.0 / 3.0, 1.0};
constexpr double memory_loop_rate = 0.1, memory_loop_rest = 4.0;  // N/s, s
constexpr std::array tops{0.9, 1.2};                              // N

struct Programme {
  Signal force;
  std::array<double, turns.size()> rested{};  ///< end of each rest, s
};

Programme programme(double top) {
  Programme made;
  std::vector<double> t{0.0}, u{0.0};
  for (std::size_t i = 1; i < turns.size(); ++i) {
    t.push_back(t.back() + top * std::abs(turns[i] - turns[i - 1]) / memory_loop_rate);
    u.push_back(top * turns[i]);
    t.push_back(t.back() + memory_loop_rest);
    u.push_back(top * turns[i]);
    made.rested[i] = t.back();
  }
  made.force = signal_through(std::move(t), std::move(u));
  return made;
}

std::string top_in_words(double top) { return "to " + quantity(top, "N"); }

/// A loop that misses its beginning by less than this share of the outer loop's width is closed.
constexpr double closed_gap = 5e-3;
/// Loops that fill less than this share of their box are no hysteresis.
constexpr double elastic_fill = 1e-3;

/// The runs of the law at one size of the force: a row, the curves, a finding.
void one_size(const LawSetting& setting, std::size_t size, LawPart& part) {
  const double top = tops[size];
  const Programme made = programme(top);
  ForcedOptions options;
  options.duration = made.rested.back();
  options.rtol = 1e-8;
  options.until_displacement = 20.0 * setting.break_away;
  options.stop = setting.stop;
  const ForcedRun run = run_forced(make_law(setting), made.force, options);
  part.add(size, thinned("", run.x, run.F, 300));
  part.finding += (size == 0 ? "" : "; ") + top_in_words(top) + " ";
  const double unknown = NAN;
  if (run.status != Status::converged) {
    part.status = run.status;
    part.finding += "the run ended early at t = " + quantity(run.t.back(), "s");
    return;
  }
  if (run.t.back() < options.duration) {
    part.rows.push_back({"", top_in_words(top), {unknown, unknown, unknown, unknown, unknown, unknown}});
    part.finding += "it slides away at t = " + quantity(run.t.back(), "s");
    return;
  }
  std::array<double, turns.size()> x{};
  for (std::size_t i = 1; i < turns.size(); ++i)
    x[i] = run.mean_displacement(made.rested[i] - 0.5 * memory_loop_rest, made.rested[i]);
  const double width = std::abs(x[1] - x[2]), inner = x[5] - x[3], middle = x[6] - x[2], outer = x[7] - x[1];
  const double worst = std::max({std::abs(inner), std::abs(middle), std::abs(outer)}) / width;
  const bool moves = width > 1e-12;
  const double loop = area(run.x, run.F, run.at(made.rested[1]), run.x.size() - 1);
  const double fill = loop / (width * top * (turns[1] - turns[2]));
  part.rows.push_back(
      {"", top_in_words(top), {width, inner, middle, outer, moves ? worst : unknown, moves ? fill : unknown}});
  if (!moves)
    part.finding += "it does not move: no loop";
  else if (worst < closed_gap && fill < elastic_fill)
    part.finding += "it is elastic: no loop to be wiped out";
  else if (worst < closed_gap)
    part.finding += "non-local memory: every loop closes, to " + quantity(worst, "", 2) + " of the outer width of " +
                    quantity(width, "m");
  else
    part.finding += std::string(worst < 0.02 ? "loops nearly close: " : "loops do not close: ") +
                    "the largest gap is " + quantity(100.0 * worst, "%", 2) + " of the outer width of " +
                    quantity(width, "m");
}

LawPart memory_of_law(const LawSetting& printed) {
  const LawSetting setting = printed.kind == "gms"     ? printed.with("vs", 1e-5)
                             : printed.kind == "xiong" ? printed.with("vs", 1e-4)
                                                       : printed;
  LawPart part;
  for (std::size_t size = 0; size < tops.size(); ++size) one_size(setting, size, part);
  return part;
}

/// Claim that the loops of a law close, or not, at the smaller and the larger force.
ExperimentClaim memory_claim(const Experiment& e, const std::string& law, bool closes, const std::string& statement,
                             const std::string& source) {
  ExperimentClaim claim{statement, source, ClaimOutcome::not_tested, ""};
  if (!has_law(e, law)) return claim;
  int right = 0;
  for (const double top : tops) {
    const double worst = e.value(law, "worst", top_in_words(top)), fill = e.value(law, "fill", top_in_words(top));
    const bool loops = fill >= elastic_fill;
    if (loops && (worst < closed_gap) == closes) ++right;
    claim.measure += (claim.measure.empty() ? "" : "; ") + top_in_words(top) + " ";
    claim.measure += std::isnan(worst) ? "it slides away"
                     : loops           ? "largest gap " + quantity(100.0 * worst, "%", 2) + " of the outer width"
                                       : "it is elastic, without a loop";
  }
  claim.outcome = right == 2   ? ClaimOutcome::confirmed
                  : right == 1 ? ClaimOutcome::depends
                               : ClaimOutcome::not_confirmed;
  return claim;
}

}  // namespace

Experiment non_local_memory_experiment(const ExperimentOptions& options) {
  Experiment e;
  e.name = "non-local-memory";
  e.title = "Are inner loops of pre-sliding wiped out?";
  e.document = "thesis, figures 3.33 to 3.35 (section 3.6.2)";
  e.input =
      "a mass of 1 kg under a force that turns at 1, -2/3, 5/9, -2/9, 5/9, -2/3 and 1 times its largest value, 0.1 N/s "
      "between them and 4 s of rest at each, so that gaps are measured at rest (mean over 2 s); largest value 0.9 N, "
      "below the Coulomb level, and 1.2 N, below stiction. The thesis shows the force as a figure only (3.33): the "
      "values "
      "are chosen here. vs as printed: 0.00001 for gms, 0.0001 for xiong, else 0.001";
  e.quantities = {{"width", "outer width", "m"}, {"inner", "inner gap", "m"},  {"middle", "middle gap", "m"},
                  {"outer", "outer gap", "m"},   {"worst", "worst/width", ""}, {"fill", "area/box", ""}};
  e.figures = {{"force-displacement", "Friction force over displacement, force to 0.9 N (figures 3.33 to 3.35)", "x",
                "m", "F", "N"},
               {"force-displacement-high", "Friction force over displacement, force to 1.2 N", "x", "m", "F", "N"}};
  run_by_law(e, options, memory_of_law);
  e.claims = {
      memory_claim(e, "non-drift", true, "the proposed law has non-local memory in pre-sliding",
                   "thesis, section 3.6.2"),
      memory_claim(e, "lugre", false, "LuGre's loops do not show non-local memory",
                   "thesis, section 3.6.2, figure 3.35a"),
      memory_claim(e, "elasto-plastic", false, "the elasto-plastic law's loops are like LuGre's: they do not close",
                   "thesis, section 3.6.2, figure 3.35b"),
      memory_claim(e, "xiong", true, "Xiong's law has non-local memory as the proposed one",
                   "thesis, section 3.6.2, figure 3.35c"),
      memory_claim(e, "gms", true, "GMS has non-local memory as the proposed one",
                   "thesis, section 3.6.2, figure 3.35d")};
  return e;
}

}  // namespace limcycle
