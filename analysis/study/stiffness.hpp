#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/cycle_methods.hpp"

namespace limcycle {

/// A loop with another bristle stiffness.
struct StiffLoop {
  double sigma0 = 0.0;  ///< N/m
  Loop loop;
};

/// The loop with sigma0 from a hundredth to a thousand times its own, a decade apart, sigma1 following as
/// sqrt(sigma0) so that the bristles of the mass stay as well damped. Empty unless the friction law has a sigma0.
std::vector<StiffLoop> stiffness_ladder(const LoopParts& parts);

/// What one stepper does at one stiffness.
struct StiffPoint {
  double sigma0 = 0.0;
  double period = 0.0;  ///< of the reference there
  WorkPoint result;     ///< method: stepper; setting: tolerance
};

/// What every stepper does over the stiffness of the bristles.
struct StiffnessStudy {
  std::vector<StiffPoint> points;
  std::vector<std::string> notes;  ///< where no verified reference exists, and how good those are that do
};

/// Every stepper at some tolerances, at every stiffness, each against a reference of its own.
StiffnessStudy stiffness_study(const std::vector<StiffLoop>& ladder, const CycleMethodsOptions& options,
                               const WorkOptions& work);

}  // namespace limcycle
