#include "limcycle/analysis/study/experiments/catalogue.hpp"

namespace limcycle {

const std::vector<ExperimentEntry>& experiments() {
  static const std::vector<ExperimentEntry> all{
      {"non-drift", "does a force below the Coulomb level move the body on?", non_drift_experiment},
      {"non-local-memory", "are inner loops of pre-sliding wiped out?", non_local_memory_experiment},
      {"stick-slip-transition", "from stick to slip and back at a sinusoidal velocity",
       stick_slip_transition_experiment},
      {"steady-velocity", "friction at constant velocities", steady_velocity_experiment},
      {"breakaway-rate", "break-away at three force rates", breakaway_rate_experiment},
      {"breakaway-parameters", "break-away as parameters are halved and doubled", breakaway_parameters_experiment},
      {"sensitivity", "what each parameter of a law changes", sensitivity_experiment},
      {"drift-against-zba", "drift of the elasto-plastic law over its break-away ratio", drift_against_zba_experiment},
      {"same-servo", "one PID servo, every law: which hunt, and which methods predict it", same_servo_experiment},
      {"robustness", "how much the force changes when parameters are wrong", robustness_experiment},
      {"efficiency", "what each law costs at equal accuracy", efficiency_experiment},
      {"pre-sliding", "friction over displacement before sliding", pre_sliding_experiment},
      {"breakaway-force", "break-away force over force rate", breakaway_force_experiment},
      {"frictional-lag", "friction over a velocity that varies without changing sign", frictional_lag_experiment},
      {"stick-slip", "alternating velocity, and a mass pulled by a spring", stick_slip_experiment},
      {"asymmetric-stick-slip", "an asymmetric sinusoidal velocity, with its detail", asymmetric_stick_slip_experiment},
      {"froude-pendulum", "self-excited swing on a turning shaft, with and without radial clearance",
       froude_pendulum_experiment}};
  return all;
}

}  // namespace limcycle
