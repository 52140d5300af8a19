#pragma once
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/kernels/linear_panel.hpp"
#include "limcycle/analysis/frequency/march/harmonic_sums.hpp"
#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"
#include "limcycle/analysis/frequency/march/radau_iia.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// Periodic state of a law that is linear in its state (LuGre, Dahl with exponent 1, see LinearInState; and any element
/// of one state without modes whose rate is found to be so) under any prescribed motion, biased or not, by one pass
/// over the mesh of that motion: Radau IIA collocation of the particular solution that begins with 0 and of the
/// homogeneous one that begins with 1, of which the periodic state is a combination. The same equations as
/// PeriodicStateSearch solves by Newton, with one evaluation of the level a node.
class LinearPeriod {
 public:
  /// Empty if the element cannot be such a law.
  static std::optional<LinearPeriod> of(const Element& element);

  /// Integrals of the output over the period (`half`: over the first half of a half-wave symmetric one) into `sums`,
  /// and the state at its origin. Empty if the state decays by less than 1e-12 in a period, so that rounding would
  /// decide, and if the rate turns out not to be linear in the state, at any node, now or in an earlier call;
  /// not_finite if a number overflowed. Cost: a level (of an element that does not state it: three rates and an output)
  /// and about S^2 multiplications a node.
  std::optional<PeriodicState> find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages, bool half,
                                    HarmonicSums& sums);

  long evaluations() const { return std::ssize(nodes_); }  ///< of the level, in the last call

 private:
  /// An element that is taken to be linear in its state, by its rates at two of them, until a third disagrees.
  class Supposed {
   public:
    explicit Supposed(Element element) : element_(std::move(element)), scale_(element_.state_scale(0)) {}
    LinearRate<double> linear_rate(const Input<double>& in) const;
    bool agrees(const Input<double>& in, const LinearRate<double>& linear, double z) const;
    double output(const Input<double>& in, double z) const { return element_.output(in, Mode{}, {&z, 1}); }
    double state_scale(int i) const { return element_.state_scale(i); }

   private:
    double rate(const Input<double>& in, double z) const;
    Element element_;
    double scale_;
  };
  using Law = std::variant<LuGre<double>, Dahl<double>, Supposed>;
  /// What is known at a node of the mesh before the state is.
  struct Node {
    MotionNode motion;
    double weight = 0.0;  ///< of phase
    double width = 0.0;   ///< of the panel, rad
    LinearRate<double> rate;
    LinearPair pair;
  };
  explicit LinearPeriod(Law law) : law_(std::move(law)) {}
  void place(const PrescribedMotion& motion, const std::vector<Panel>& panels, const RadauIIA& table);
  void march(const RadauIIA& table, double frequency);
  std::optional<double> integrate(double start, HarmonicSums& sums) const;

  Law law_;
  bool is_linear_ = true;  ///< as far as is known
  std::vector<Node> nodes_;
};

}  // namespace limcycle
