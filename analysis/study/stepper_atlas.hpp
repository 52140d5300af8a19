#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/analysis/study/stability_families.hpp"
#include "limcycle/analysis/study/watched_run.hpp"
#include "limcycle/analysis/study/work_point.hpp"

namespace limcycle {

/// What one run turned out to be.
enum class RunClass {
  right,         ///< error within `atlas_right`
  rough,         ///< within `atlas_rough`
  creeps,        ///< intervals that differ from one another: it leaves stick too early, or drifts
  wrong_motion,  ///< regular, but another cycle, or a cycle where the truth comes to rest
  stops,         ///< rest where the truth hunts
  chatters,      ///< the velocity changes sign far more often than it should, or switches accumulate
  misses_event,  ///< the force never comes near its true peak: break-away was stepped over
  diverges,      ///< not finite, or no step is short enough
  too_slow       ///< the budget ran out
};
std::string_view to_string(RunClass kind);

inline constexpr double atlas_right = 1e-3, atlas_rough = 1e-2;

/// One run of the atlas.
struct AtlasPoint {
  std::string law;
  double stiffness = not_known;  ///< N/m; NaN: the law has none
  std::string stepper;
  double setting = 0.0;     ///< relative tolerance, or step, s
  bool fixed_step = false;  ///< the latter
  RunClass kind = RunClass::diverges;
  double error = not_known;  ///< relative, of the period; where the truth is rest, of the motion
  long steps = 0;
  std::string why;  ///< unless it is right: a few words
};

/// What the runs of one loop are measured by.
struct AtlasReference {
  std::string law;
  double stiffness = not_known;
  bool verified = false;      ///< by a second stepper; else there are no points of that loop
  bool hunts = false;         ///< else it comes to rest
  double period = not_known;  ///< s, if it hunts
  double agreement = not_known;
  std::string words;
};

/// Which runs an atlas is made of, and their budgets.
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

/// Every run, and what they are measured by.
struct StepperAtlas {
  std::vector<AtlasPoint> points;  ///< by loop, stepper, setting: in the order given, whatever the threads
  std::vector<AtlasReference> references;
  Status status = Status::converged;
};

/// Where does each stepper fail? Every stepper that applies, and for comparison two of them with one absolute tolerance
/// for all states ("rodas5p, one atol") and three fixed methods, at every setting, in every loop: one run each, which
/// begins on the verified cycle, or, where the loop comes to rest, from a displaced y. A stepper that has the motion at
/// the beginning and loses it is no stepper for that loop. Loops without a verified reference are left out, and say so.
StepperAtlas stepper_atlas(const std::vector<AtlasLoop>& loops, const AtlasOptions& options);

/// The largest tolerance from which on (and for all tighter ones that were answered) a stepper is right in all loops of
/// the atlas up to that stiffness; NaN: none. What was too slow counts neither way.
double loosest_right(const StepperAtlas& atlas, const std::string& stepper, double stiffness);

}  // namespace limcycle
