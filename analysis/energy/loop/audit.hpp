#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Energy supplied, stored and dissipated in a run, J (for a plant that is not mechanical: unit of the friction force
/// times that of the rubbing displacement). Work and losses are integrals over the run, stored energy is that at its
/// end less that at its beginning.
struct EnergyBalance {
  bool of_plant = false;     ///< mechanical plant: everything is counted; otherwise the friction law alone
  bool of_friction = false;  ///< there is a friction law
  bool of_storage = false;   ///< the law gives its stored energy; otherwise that is counted as dissipated by it

  double command = 0.0;  ///< work of the controller's command on the plant
  double load = 0.0;     ///< work of the load and of an external force
  double drive = 0.0;    ///< work of the drive of the other surface (belt, shaft) against the friction
  double rubbing = 0.0;  ///< work done on the friction law, int F v dt with v the rubbing velocity

  double kinetic = 0.0, potential = 0.0;  ///< stored in masses, in springs and weight
  double in_friction = 0.0;               ///< stored in the friction law

  double viscous = 0.0;   ///< dissipated in the dampers of the plant
  double friction = 0.0;  ///< dissipated by the law, int (F v - dU/dt) dt
  double impulses = 0.0;  ///< dissipated at switches, where a law stops the body or lets go of stored energy

  double turnover = 0.0;  ///< stored at the beginning, plus all work in absolute value: reference size of the error
  double allowed = 0.0;   ///< error of the balance that the tolerances of the run, and rounding, permit

  double supplied() const { return of_plant ? command + load + drive : rubbing; }
  double stored() const { return kinetic + potential + in_friction; }
  double dissipated() const { return viscous + friction + impulses; }
  /// Defect of the balance, J; 0 if there is nothing to balance (a law alone that does not give its stored energy).
  double error() const { return checks() ? supplied() - stored() - dissipated() : 0.0; }
  double relative_error() const { return turnover > 0.0 ? error() / turnover : 0.0; }
  bool checks() const { return of_plant || of_storage; }
  bool balanced() const { return std::abs(error()) <= allowed; }
};

/// Balances the energy of a loop during a march: supplied = stored + dissipated. For a mechanical plant (mass,
/// two-mass, belt, froude-pendulum) the whole of it; for another one that of the friction law, with U its storage
/// function.
///
/// Stored energy is a function of the state, work and losses are integrals of powers from the field, so that the
/// balance checks the march itself: its steps, its events, and the equations of the law. The integrals are by Gauss's
/// formula of five points in each step, at states that are whole steps of the method (March::within), of order 10: the
/// remaining defect is the error of the march. dU/dt is exact (dual numbers). Cost: five steps a step.
///
/// `allowed` is 100 rtol of the turnover, or, if that is less, the sum over all steps of the error in stored energy
/// that their tolerances permit. Measured: a stiff stepper stays below rtol; an explicit one at its limit of stability,
/// which takes 1e5 steps, has reached 30 rtol.
class EnergyAudit {
 public:
  /// `parts` are those from which `loop` was built, rtol is that of the march. The loop must outlive the audit.
  EnergyAudit(const LoopParts& parts, const Loop& loop, double rtol);
  ~EnergyAudit();
  EnergyAudit(EnergyAudit&&) noexcept;

  /// Counts the last step of a march of this loop that was made with loop_weights(loop, rtol). `modes` are those in
  /// which the step was made; the field is in those after it.
  void step(LoopField& field, March& march, const std::vector<Mode>& modes);

  /// Up to the last step counted.
  const EnergyBalance& balance() const;

 private:
  class Count;
  std::unique_ptr<Count> count_;
};

/// True if there is anything to audit: a mechanical plant, or friction.
bool has_energy(const LoopParts& parts);

}  // namespace limcycle
