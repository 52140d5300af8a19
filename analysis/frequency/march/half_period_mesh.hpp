#pragma once
#include <memory>
#include <vector>

#include "limcycle/analysis/frequency/kernels/linear_kernel.hpp"
#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Fineness of the mesh of the half period between two reversals, and its error bound.
struct HalfPeriodSettings {
  int stages = 4;        ///< of the collocation: 4, 5, 6 or 8
  double width = 0.6;    ///< of a panel in tau = ln tan(phi/2)
  double cap = 0.3;      ///< panels at the reversals, in units of the layer there
  double ignored = 0.0;  ///< share of a layer, deep within a wider one, that need not be resolved
  double bound = 1e-6;   ///< of the relative error of the state's first harmonic, see DfKernel: where g is constant
  double slope = 0.0;    ///< addition for a peak of g: slope r + cubic r^3, r = Fs/Fc - 1
  double cubic = 0.0;
};

/// All panels that meshes of one width may consist of. In tau = ln tan(phi/2), where sin(phi) = sech(tau) and dphi =
/// sech(tau) dtau, panels of equal width shrink geometrically towards both reversals; panel j begins at tau = j width.
/// The remainder at the ends are caps, in phi itself: [0, phi(j width)] and [phi(j width), pi]. Hence nodes and weights
/// depend only on the settings and are computed once.
class HalfPeriodPanels {
 public:
  /// Cost: about 0.1 ms a stage.
  HalfPeriodPanels(int stages, double width, int orders);

  /// The same from a cache; safe from any thread.
  static std::shared_ptr<const HalfPeriodPanels> of(int stages, double width, int orders);

  /// A mesh: numbers of the inner panels at which its caps end, and of its first panels, after which the initial state
  /// has decayed.
  struct Range {
    int from = 0, to = 0, remembered = 0;
    bool operator==(const Range&) const = default;
  };
  /// The mesh with caps of about the phases e^after and e^before (rad), less than 1, in which the initial state has
  /// decayed after the panel that holds tau = `forgotten`.
  Range range(double after, double before, double forgotten) const;
  /// The panels of a range: see PanelGeometry.
  void select(Range range, std::vector<const double*>& panels) const;
  const CollocationNumbers& collocation() const { return collocation_; }

 private:
  struct Quadrature;
  enum class Part { inner, left_cap, right_cap };
  const double* block(Part part, int j) const;
  void fill(Part part, int j, const Quadrature& fine, double* block) const;
  int index_of(double cap) const;

  int stages_, orders_, reach_;
  double width_;
  CollocationNumbers collocation_{};
  std::vector<double> blocks_;
};

/// Properties of a law whose state relaxes towards a level g(v), as the mesh needs them.
struct LevelShape {
  double displacement = infinite;  ///< displacement over which the state settles (m)
  double velocity = infinite;      ///< over which the level changes (m/s)
  double kink = 0.0;               ///< g changes like |v|^kink at rest; 0: g is smooth and even
  bool seen = false;               ///< true if the output itself changes over `velocity`, so that no layer is ignored
};

/// Caps that such a law needs, for motions A sin wt. Uses logarithms of phases, which turns products into sums.
class Layers {
 public:
  Layers(const LevelShape& shape, const HalfPeriodSettings& settings);

  HalfPeriodPanels::Range range(const HalfPeriodPanels& panels, double amplitude, double frequency);

 private:
  double displacement_, velocity_, cap_, ignored_, widest_;
  bool even_;
  // Values of the last amplitude, which a table repeats many times.
  double amplitude_ = 0.0, amplitude_log_ = 0.0, forgotten_ = 0.0;
};

}  // namespace limcycle
