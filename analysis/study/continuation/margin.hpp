#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/orbit/branch/continuation.hpp"
#include "limcycle/analysis/study/balance/balance_distance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// A parameter that may be changed.
struct MarginParameter {
  std::string path, unit;
  double value = 0.0;     ///< own value, not 0, finite
  bool friction = false;  ///< of the friction law, not of plant or controller
  LoopFamily family;
};

/// Change of the behaviour on one side of a parameter's own value.
struct MarginSide {
  enum class What {
    ends,    ///< hunting ends at `value`
    begins,  ///< hunting begins at `value`
    none,    ///< neither within the range examined
    unknown  ///< not decided; `why` gives what is known
  } what = What::unknown;
  /// Of the parameter, if hunting ends or begins, or if the motion diverges before it begins; if none, the last one
  /// that was examined; if unknown, the last one at which it was seen to hunt, or 0.
  double value = 0.0;
  double error = 0.0;  ///< relative error; NaN if only the last or first value with hunting is known
  std::string why;     ///< one sentence
  /// Event of the branch of cycles there, and the cycle; if it was followed to a fold or a change of stability.
  std::optional<BranchEvent::Type> event = {};
  std::optional<Cycle> cycle = {};
  bool diverges = false;     ///< the motion grows without bound beyond: hunting ends there, or does not begin before
  double diverges_at = 0.0;  ///< the value beyond at which that was seen; 0: at `value`
  bool found() const { return what == What::ends || what == What::begins; }
};
std::string_view to_string(MarginSide::What what);

/// One parameter: changes upwards and downwards of its own value.
struct ParameterMargin {
  MarginParameter parameter;
  MarginSide up, down;  ///< towards larger and smaller magnitude, the sign kept

  /// The nearer side with a change, or null.
  const MarginSide* nearest() const;
  /// Its distance from the own value, relative to it (0.27 for 27 %); infinite if there is none.
  double distance() const;
};

/// Range of margin(), and options of the search for cycles.
struct MarginOptions {
  double factor = 10.0;              ///< range of the factor either way
  double accuracy = 1e-7;            ///< relative, of the cycles that are followed
  int scan_per_decade = 5;           ///< values at which a loop that rests is simulated
  long steps_a_branch = 10'000'000;  ///< of the integrator; some minutes at most, if each map takes long
  int threads = 1;                   ///< sides of parameters at once; the numbers do not depend on it. 0: one a core
  PredictOptions predict;            ///< search for cycles at the own values; stop and progress are used throughout
};

/// Results of margin().
struct MarginReport {
  bool hunts = false;
  std::vector<Cycle> cycles;                ///< at the own values
  std::vector<ParameterMargin> parameters;  ///< nearest first
  std::optional<BalanceDistance> balance;   ///< of the describing function at the own values
  double factor = 10.0;
  std::vector<std::string> notes;
  std::string refused{};  ///< reason why there is no result for this loop, a clause; else empty
  Status status = Status::converged;
};

/// Distance of each parameter from the value at which hunting begins or ends. If the loop has a stable cycle it is
/// continued in each parameter until it is lost (fold, change of stability, end), and simulated just beyond: if it
/// still hunts there, on another cycle, that one is followed in turn. If the loop rests, simulations on a coarse
/// logarithmic grid search outwards for the first value with a cycle, which is then followed back to its beginning.
/// The cycles of a loop with a sampled controller cannot be followed: outcomes of simulations are bisected instead.
/// Cost: about 30 points of a branch for each side of a parameter, or some ten simulations. Status: incomplete if a
/// side stayed unknown; interrupted (parameters done until then are kept).
MarginReport margin(const Loop& loop, const std::vector<MarginParameter>& parameters, const MarginOptions& options);

}  // namespace limcycle
