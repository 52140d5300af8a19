#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/precision/instrumented_run.hpp"
#include "limcycle/analysis/study/precision/stability_families.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Classification of one run.
enum class RunClass {
  right,         ///< error within `atlas_right`
  rough,         ///< within `atlas_rough`
  creeps,        ///< intervals that differ from one another: stick ends too early, or the motion drifts
  wrong_motion,  ///< regular, but another cycle, or a cycle although the reference comes to rest
  stops,         ///< rest, although the reference hunts
  chatters,      ///< the velocity changes sign far too often, or switches accumulate
  misses_event,  ///< the force never comes near its true peak: break-away was skipped
  diverges,      ///< not finite, or no step is short enough
  too_slow       ///< the limit of evaluations was reached
};
std::string_view to_string(RunClass kind);

inline constexpr double atlas_right = 1e-3, atlas_rough = 1e-2;

/// One run of the atlas.
struct AtlasPoint {
  std::string law;
  double stiffness = not_known;  ///< N/m; NaN: the law has none
  std::string stepper;
  double setting = 0.0;     ///< relative tolerance, or step, s
  bool fixed_step = false;  ///< true: `setting` is the step
  RunClass kind = RunClass::diverges;
  double error = not_known;  ///< relative, of the period; if the reference rests, of the motion
  long steps = 0;
  std::string why;  ///< unless it is right: a short reason
};

/// Reference for the runs of one loop.
struct AtlasReference {
  std::string law;
  double stiffness = not_known;
  bool verified = false;      ///< by a second stepper; otherwise there are no points of that loop
  bool hunts = false;         ///< else it comes to rest
  double period = not_known;  ///< s, if it hunts
  double agreement = not_known;
  std::string words;
};

/// Runs of an atlas, and their limits.
struct AtlasOptions {
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12};
  std::vector<double> steps{1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5};  ///< s, of the fixed methods
  int periods = 5;                                                ///< >= 4, of a run that begins on the cycle
  double evaluations = 2e6;                                       ///< of a run
  long check_steps = 1000000;                                     ///< of the run that checks a reference
  int threads = 1;
  std::vector<std::string> steppers;  ///< by name; empty: all
  PredictOptions predict;             ///< of the references
  std::function<bool()> stop;
  std::function<void(double, std::string_view)> progress;
};

/// Every run, with its reference.
struct StepperAtlas {
  std::vector<AtlasPoint> points;  ///< by loop, stepper, setting: in the order given, for any number of threads
  std::vector<AtlasReference> references;
  Status status = Status::converged;
};

/// Limits of each stepper: every stepper that applies, and for comparison two of them with one absolute tolerance for
/// all states ("rodas5p, one atol") and three fixed methods, at every setting, in every loop. One run each, which
/// begins on the verified cycle or, if the loop comes to rest, from a displaced y. A stepper that has the motion at the
/// beginning and loses it fails on that loop. Loops without a verified reference are omitted, with a note.
StepperAtlas stepper_atlas(const std::vector<AtlasLoop>& loops, const AtlasOptions& options);

/// The largest tolerance at which (and at all tighter ones with a result) a stepper is right in all loops of the atlas
/// up to that stiffness; NaN: none. Runs that were too slow do not count.
double loosest_right(const StepperAtlas& atlas, const std::string& stepper, double stiffness);

}  // namespace limcycle
