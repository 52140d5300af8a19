#pragma once
#include "limcycle/analysis/study/experiments/experiment.hpp"

namespace limcycle {

// The experiments, one file each. A new one needs its file, a line here and a line in catalogue.cpp.
Experiment non_drift_experiment(const ExperimentOptions& options);
Experiment non_local_memory_experiment(const ExperimentOptions& options);
Experiment stick_slip_transition_experiment(const ExperimentOptions& options);
Experiment steady_velocity_experiment(const ExperimentOptions& options);
Experiment breakaway_rate_experiment(const ExperimentOptions& options);
Experiment breakaway_parameters_experiment(const ExperimentOptions& options);
Experiment sensitivity_experiment(const ExperimentOptions& options);
Experiment robustness_experiment(const ExperimentOptions& options);
Experiment drift_against_zba_experiment(const ExperimentOptions& options);
Experiment same_servo_experiment(const ExperimentOptions& options);
Experiment efficiency_experiment(const ExperimentOptions& options);
Experiment pre_sliding_experiment(const ExperimentOptions& options);
Experiment breakaway_force_experiment(const ExperimentOptions& options);
Experiment frictional_lag_experiment(const ExperimentOptions& options);
Experiment stick_slip_experiment(const ExperimentOptions& options);
Experiment asymmetric_stick_slip_experiment(const ExperimentOptions& options);
Experiment froude_pendulum_experiment(const ExperimentOptions& options);

}  // namespace limcycle
