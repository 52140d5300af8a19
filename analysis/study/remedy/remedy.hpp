#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/remedy/cause.hpp"
#include "limcycle/analysis/study/remedy/loop_costs.hpp"

namespace limcycle {

/// What a number of a remedy measures: its size is taken from the motion of the loop that hunts where it has none.
enum class Measure { own, displacement, force, stiffness, damping, rate };

/// Sizes of the motion of a loop that hunts.
struct HuntingSizes {
  double displacement = 1.0;  ///< of y
  double frequency = 1.0;     ///< rad/s
  double force = 1.0;         ///< N, of the friction

  double of(Measure measure) const;
};

/// A remedy to try: one number of the loop, or of a part that is added to it.
struct RemedyCandidate {
  std::string name;       ///< "error-dead-zone"
  std::string parameter;  ///< path of its number, "loop.error.half_width"; may be empty if it does not apply
  std::string unit;
  std::string why_not;  ///< reason why it does not apply to this loop, a clause; empty: it does
  double own = 0.0;     ///< the present value; 0 or infinite: absent, it would begin there
  Measure measure = Measure::own;
  enum class Way { up, down, both } way = Way::up;
  std::function<std::optional<LoopParts>(double)> parts = {};  ///< the loop with that value; empty: not valid
  std::vector<std::string> with = {};                          ///< what a case needs beside it, "PATH=VALUE"
  /// What else changes with the value, likewise.
  std::function<std::vector<std::string>(double)> follows = {};
  std::string in_vain = {};  ///< proof that no value of its number ends the hunting, a clause; empty: one may
  double frequency = 0.0;  ///< rad/s, if its number is the amplitude of a dither, which is no part of the loop; else 0
  double band = 0.0;       ///< > 0: its number is the size of impulses that leave an error of at most this
  /// For a remedy whose other numbers depend on the hunting motion: the same with them.
  std::function<RemedyCandidate(const HuntingSizes&)> sized = {};

  bool is_absent() const { return own == 0.0 || std::isinf(own); }
};

/// The costs of RemedyCosts by which remedies are compared, the error as its largest size.
inline constexpr std::string_view cost_names[] = {"steady_state_error", "settling_time",   "overshoot",
                                                  "phase_margin",       "delay_margin",    "peak_sensitivity",
                                                  "noise_gain",         "actuator_travel", "robust_share"};
using CostWeights = std::array<double, std::size(cost_names)>;

/// What became of a remedy.
struct Remedy {
  RemedyCandidate candidate;
  std::optional<bool> ends = {};   ///< hunting ends at `value`; empty: not decided
  double value = 0.0;              ///< the one nearest to the present value at which hunting ends; valid if `ends`
  std::vector<double> edges = {};  ///< where hunting ends, then where it begins again; each on the side without hunting
  std::vector<double> beyond = {};  ///< for each edge, the nearest value at which it hunts, diverges or was not decided
  std::string why = {};             ///< one sentence
  RemedyCosts costs = {};           ///< at `value`
  Trace after = {};                 ///< at `value`: the run from the largest displacement of predict()
  bool best = false;                ///< no other remedy is at least as good in every cost and better in one

  /// Where hunting begins again; the only edge of impulses, since a loop without integral action rests under small
  /// ones.
  std::optional<double> again() const {
    const std::size_t at = candidate.band > 0.0 ? 0 : 1;
    return edges.size() > at ? std::optional(edges[at]) : std::nullopt;
  }
};

/// A sample of a spread: the loop with a value of the remedy's number, and the numbers of that sample.
using SampledParts = std::function<std::optional<LoopParts>(const RemedyCandidate&, double value, std::size_t sample)>;

/// Options of remedies().
struct RemedyOptions {
  PredictOptions predict;     ///< starts, search box, stop, progress; its methods confirm the edges
  SampledParts sampled = {};  ///< for the robust share
  std::size_t samples = 0;    ///< of the spread; 0: no robust share
  CostWeights weights{};      ///< all 0: those that are best in the sense of Pareto first
  int threads = 1;
};

/// Results of remedies().
struct RemedyReport {
  Hunts hunts = Hunts::undecided;  ///< as the loop stands
  std::string why;                 ///< of that, one clause
  Cause cause;
  std::vector<Remedy> remedies;  ///< those that end hunting first, the best first; then the others in their order
  RemedyCosts now;               ///< of the loop as it stands
  Trace before = {};             ///< its run from the largest displacement of predict()
  double step = 0.0;             ///< that displacement
  std::vector<std::string> notes = {};
  Status status = Status::converged;
};

/// For a loop that hunts: the cause, and for each remedy the value nearest to the present one at which the loop no
/// longer hunts. The stable cycles of the loop are followed over the remedy's number, up to a factor of 100 either way
/// (from a hundred-thousandth to a hundred times the size that the hunting motion suggests, if it is absent), until
/// they end; then predict() judges both sides of the edge in time, the edge being 1e-3 wide at most (the values have
/// four digits); where predict() decides no value so near to it, up to a factor of 2 on either side. Beyond it the next
/// change is sought at three values a decade and located likewise. Where cycles cannot be followed (dead times,
/// sampling, motions without a period) values at three a decade are judged from the present one on, and a range without
/// hunting that lies between two of them can be missed. Cost: a branch of cycles and some ten predict() in time for
/// each remedy. `parts`: of the loop as it stands.
RemedyReport remedies(const LoopParts& parts, const std::vector<RemedyCandidate>& candidates,
                      const RemedyOptions& options);

}  // namespace limcycle
