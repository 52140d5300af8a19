#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/orbit/continuation.hpp"
#include "limcycle/analysis/study/balance_distance.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// A parameter that may be changed.
struct MarginParameter {
  std::string path, unit;
  double value = 0.0;     ///< own value, not 0, finite
  bool friction = false;  ///< of the friction law, not of plant or controller
  LoopFamily family;
};

/// What happens on one side of a parameter's own value.
struct MarginSide {
  enum class What {
    ends,    ///< hunting ends at `value`
    begins,  ///< hunting begins at `value`
    none,    ///< neither within the range that was looked at
    unknown  ///< not decided; `why` says what is known
  } what = What::unknown;
  double value = 0.0;  ///< of the parameter, if hunting ends or begins
  double error = 0.0;  ///< of it, relative; NaN if only known as the last or first one that was seen
  std::string why;     ///< one sentence
  /// What happens to the branch of cycles there, and the cycle; if it was followed to a fold or a change of stability.
  std::optional<BranchEvent::Type> event = {};
  std::optional<Cycle> cycle = {};
  bool diverges = false;  ///< hunting ends there because the motion grows without bound beyond
  bool found() const { return what == What::ends || what == What::begins; }
};
std::string_view to_string(MarginSide::What what);

/// One parameter: what happens upwards and downwards of its own value.
struct ParameterMargin {
  MarginParameter parameter;
  MarginSide up, down;  ///< towards larger and smaller magnitude, the sign kept

  /// The nearer side where something happens, or null.
  const MarginSide* nearest() const;
  /// Its distance from the own value, relative to it (0.27 for 27 %); infinite if there is none.
  double distance() const;
};

/// How far margin() looks, and how cycles are found.
struct MarginOptions {
  double factor = 10.0;     ///< how far either way
  double accuracy = 1e-7;   ///< relative, of the cycles that are followed
  int scan_per_decade = 5;  ///< values at which a loop that rests is tried
  PredictOptions predict;   ///< how cycles are found at the own values; stop and progress are used throughout
};

/// What margin() answers for each parameter.
struct MarginReport {
  bool hunts = false;
  std::vector<Cycle> cycles;                ///< at the own values
  std::vector<ParameterMargin> parameters;  ///< nearest first
  std::optional<BalanceDistance> balance;   ///< of the describing function at the own values
  double factor = 10.0;
  std::vector<std::string> notes;
  std::string refused{};  ///< why the question was not answered for this loop, a clause; else empty
  Status status = Status::converged;
};

/// How far is each parameter from the value at which hunting begins or ends? If the loop has a stable cycle it is
/// continued in each parameter until it is lost (fold, change of stability, end), and what a simulation does just
/// beyond is looked at: where it still hunts, on another cycle, that one is followed in turn. If the loop rests,
/// simulations on a coarse logarithmic grid look outwards for the first value with a cycle, which is then followed back
/// to where it begins. Cost: about 30 points of a branch for each side of a parameter, or some ten simulations. Status:
/// incomplete where a side stayed unknown; interrupted (parameters done until then are kept).
MarginReport margin(const Loop& loop, const std::vector<MarginParameter>& parameters, const MarginOptions& options);

}  // namespace limcycle
