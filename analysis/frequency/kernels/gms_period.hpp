#pragma once
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/kernels/linear_panel.hpp"
#include "limcycle/analysis/frequency/march/harmonic_sums.hpp"
#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/models/friction/sliders/gms_table.hpp"

namespace limcycle {

/// The half-wave symmetric periodic state of generalised Maxwell-slip friction (GmsElements) with equal levels in both
/// directions, element by element: under prescribed motion they are independent, and an element has at most one switch
/// between two reversals.
///
/// With r_i = F_i/alpha_i an element moves by r_i = r_i(0) + (k_i/alpha_i) (x - x(0)) from a reversal until |r_i| =
/// g(v), and then by dr/dt = C (sgn(v) - r/g(v)) until the next one. That equation is linear and the same for all
/// elements: one collocation of each panel, from its beginning and of what follows, serves them all; only the panel of
/// the switch is solved anew from there. The state at a reversal is the fixed point of one number each, found from the
/// virgin state by the map and by secants of it. Derived.
///
/// Accuracy: that of the collocation on this mesh (see QuadratureRoute, which compares two); the switch is located to
/// roundings. Cost: one level and S^3/3 multiplications a node, and about 20 levels an element and map, of which there
/// are 2 where the sliding forgets how it began.
class GmsPeriod {
 public:
  /// Empty if the element is no such law.
  static std::optional<GmsPeriod> of(const Element& element);

  /// The state at the reversal at which the mesh begins; integrals of the output over the half period into `sums`.
  /// Empty if an element has no such state that the map comes to, or if a number is not finite.
  std::optional<PeriodicState> find(const PrescribedMotion& motion, const PeriodMesh& mesh, int stages,
                                    HarmonicSums& sums);

  long evaluations() const { return evaluations_; }  ///< of the level, in the last call

 private:
  using Law = std::variant<Gms<double>, GmsTable<double>>;
  struct Node {
    MotionNode motion;
    double way = 0.0;     ///< from the beginning of the stretch, m
    double level = 0.0;   ///< g, N
    double weight = 0.0;  ///< of phase
    LinearPair pair;      ///< in slip, from the beginning of the panel

    /// Level left, in stick from r = start, before the slip; N.
    double left(double start, double stiffness) const { return level - std::abs(start + stiffness * way); }
  };
  /// From one reversal, or from the virgin state, to the next reversal.
  struct Stretch {
    std::span<const Panel> panels;
    double side = 1.0;  ///< of the motion
    std::vector<Node> nodes;
    std::vector<LinearPair> rest;  ///< in slip, from the beginning of each panel to the end of the stretch
  };
  /// One element on a stretch: the state r at its end, and where it switched to slip.
  struct Passage {
    double end = 0.0;
    std::size_t panel = 0;                  ///< of the switch; their number if the element sticks throughout
    double part = 0.0;                      ///< of that panel, before the switch
    double at_switch = 0.0, at_next = 0.0;  ///< r there, and at the end of that panel
  };
  struct Periodic {
    double start = 0.0, defect = 0.0;  ///< r at the reversal
  };

  template <class L>
  explicit GmsPeriod(const L& law)
      : law_(law),
        k_(law.k),
        alpha_(law.alpha),
        sigma1_(law.sigma1),
        C_(law.C),
        sigma2_(law.sigma2),
        Fs_(law.Fs),
        highest_(law.highest_level()) {
    sigma1_.resize(k_.size());
  }
  double level(double v) const;
  Node node_at(const Panel& panel, double t, double side) const;
  void prepare(Stretch& stretch, double side);
  std::vector<Node> slide(const Panel& panel, double from, double side) const;
  std::optional<Passage> switched(const Stretch& stretch, double start, double stiffness) const;
  Passage met(const Stretch& stretch, std::size_t panel, double from, double to, double start, double stiffness) const;
  Passage pass(const Stretch& stretch, double start, double stiffness) const;
  std::optional<Periodic> periodic(double stiffness) const;
  double integrate(std::size_t i, double start, HarmonicSums& sums);
  double output(std::size_t i, const Node& node, double r, bool slips) const;

  Law law_;
  std::vector<double> k_, alpha_, sigma1_;
  double C_, sigma2_, Fs_, highest_;
  const PrescribedMotion* motion_ = nullptr;
  const RadauIIA* table_ = nullptr;
  Stretch virgin_, half_;
  std::vector<double> outputs_;  ///< of all elements at the nodes of the half period
  mutable long evaluations_ = 0;
};

}  // namespace limcycle
