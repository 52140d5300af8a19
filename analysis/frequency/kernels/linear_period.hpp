#pragma once
#include <optional>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/march/harmonic_sums.hpp"
#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"
#include "limcycle/analysis/frequency/march/radau_iia.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// Periodic state of a law that is linear in its state (LuGre, Dahl with exponent 1; see LinearInState) under any
/// prescribed motion, biased or not, by one pass over the mesh of that motion: Radau IIA collocation of the particular
/// solution that begins with 0 and of the homogeneous one that begins with 1, of which the periodic state is a
/// combination. The same equations as PeriodicStateSearch solves by Newton, with one evaluation of the level a node.
class LinearPeriod {
 public:
  /// Empty if the element is no such law.
  static std::optional<LinearPeriod> of(const Element& element);

  /// Integrals of the output over the period (`half`: over the first half of a half-wave symmetric one) into `sums`,
  /// and the state at its origin. Empty if the state decays by less than 1e-12 in a period, so that rounding would
  /// decide; not_finite if a number overflowed. Cost: a level and about S^2 multiplications a node.
  std::optional<PeriodicState> find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages, bool half,
                                    HarmonicSums& sums);

  long evaluations() const { return std::ssize(nodes_); }  ///< of the level, in the last call

 private:
  using Law = std::variant<LuGre<double>, Dahl<double>>;
  /// What is known at a node of the mesh before the state is.
  struct Node {
    MotionNode motion;
    double weight = 0.0;  ///< of phase
    double width = 0.0;   ///< of the panel, rad
    LinearRate<double> rate;
    LinearOutput<double> output;
    double particular = 0.0, homogeneous = 0.0;
  };
  explicit LinearPeriod(const Law& law) : law_(law) {}
  void place(const PrescribedMotion& motion, const std::vector<Panel>& panels, const RadauIIA& table);
  void march(const RadauIIA& table, double frequency);
  template <int S>
  void solve(const RadauIIA& table, double frequency);

  Law law_;
  std::vector<Node> nodes_;
};

}  // namespace limcycle
