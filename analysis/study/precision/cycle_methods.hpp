#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/precision/cycle_reference.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"

namespace limcycle {

/// Settings and limits of the methods that solve for a cycle.
struct CycleMethodsOptions {
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  int periods = 10;               ///< of a simulation
  long max_steps = 1000000;       ///< of a simulation
  long check_steps = 1000000;     ///< of a simulation that checks a reference
  long max_evaluations = 500000;  ///< of a harmonic balance
  PredictOptions predict;         ///< search box and stop
};

/// "rtol 1e-06" for a list of tolerances.
std::vector<std::string> tolerance_settings(const std::vector<double>& tolerances);

/// Every stepper that applies to the loop, as simulations that begin on the cycle; cost in steps.
std::vector<WorkMethod> stepper_methods(const Loop& loop, const CycleReference& reference,
                                        const CycleMethodsOptions& options);

/// Shooting from the cycle with its linear states 1 % off; cost in return maps.
WorkMethod shooting_method(const Loop& loop, const CycleReference& reference, const CycleMethodsOptions& options);

/// Harmonic balance with more and more harmonics, begun from the first nine of the cycle; cost in evaluations of the
/// elements. Its amplitude and frequency are compared with those of the cycle.
WorkMethod balance_method(const Loop& loop, const CycleReference& reference, const CycleMethodsOptions& options);

/// The describing function, all its roots in the box, and the same with mass and friction as one element, if they
/// apply. The root nearest to the cycle counts; its amplitude is compared with the first harmonic of the cycle. Their
/// error is that of omitted harmonics: no setting lowers it.
std::vector<WorkMethod> first_harmonic_methods(const Loop& loop, const CycleReference& reference,
                                               const CycleMethodsOptions& options);

}  // namespace limcycle
