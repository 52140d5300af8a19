#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/precision/cycle_methods.hpp"

namespace limcycle {

/// A loop with another bristle stiffness.
struct StiffLoop {
  double sigma0 = 0.0;  ///< N/m
  Loop loop;
  bool own = false;  ///< true for the stiffness of the case
};

/// The loop with sigma0 from a hundredth to a thousand times its own, a decade apart, with sigma1 proportional to
/// sqrt(sigma0), which keeps the damping ratio of the mass on its bristles. Empty unless the friction law has a sigma0.
std::vector<StiffLoop> stiffness_ladder(const LoopParts& parts);

/// Result of one stepper at one stiffness.
struct StiffPoint {
  double sigma0 = 0.0;
  double period = 0.0;  ///< of the reference at that stiffness
  WorkPoint result;     ///< method: stepper; setting: tolerance
};

/// Results of every stepper over the stiffness of the bristles.
struct StiffnessStudy {
  std::vector<StiffPoint> points;
  std::vector<std::string> notes;  ///< missing references, and the accuracy of the others
};

/// Every stepper at some tolerances, at every stiffness, each against a reference of its own. `own`: that of the case's
/// own stiffness, if known.
StiffnessStudy stiffness_study(const std::vector<StiffLoop>& ladder, const CycleMethodsOptions& options,
                               const WorkOptions& work, const std::optional<CycleReference>& own = {});

}  // namespace limcycle
