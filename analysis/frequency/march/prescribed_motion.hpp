#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// A piece of one period between two phases, measured from an anchor (a velocity reversal or the like).
struct Panel {
  int anchor = 0;
  double from = 0.0, to = 0.0;  ///< phase minus that of the anchor, rad; both on the same side of the anchor
  bool sample_at_end = false;   ///< a uniform sample is taken at `to`
};

/// Motion at one phase: signal and rate, sine and cosine of the phase. The drive in `in` is infinite with the sign of
/// the rate (see drive_on).
struct MotionNode {
  Input<double> in;
  double sine = 0.0, cosine = 0.0;
  double slope = 0.0;  ///< of the rate, by the phase: has the sign of the acceleration
};

/// Requirements on a periodic motion for the march: the motion at a phase given by its distance from an anchor (anchor
/// 0 is phase 0, where history begins), the frequency (rad/s), and the distance of a phase from the beginning of the
/// period.
template <class M>
concept Motion = requires(const M motion, int anchor, double local) {
  { motion.at(anchor, local) } -> std::same_as<MotionNode>;
  { motion.frequency() } -> std::convertible_to<double>;
  { motion.position(anchor, local) } -> std::convertible_to<double>;
};

/// The motion x = bias t + A sin wt (friction law) or x = bias + A sin wt (other element), as a function of the phase
/// theta = wt measured from anchors. Near a reversal the rate is formed from the distance to it, so that it is exact to
/// a few roundings even where it is 1e-12 of its amplitude: a narrow Stribeck layer is then resolved without noise.
///
/// Anchors: 0 phase 0, where history begins; 1 the reversal from forward to backward (without reversals: the phase of
/// least speed), where a period begins; 2 the reversal back; 3 the end of the period.
class PrescribedMotion {
 public:
  PrescribedMotion(double amplitude, double frequency, double bias, bool bias_is_rate);

  MotionNode at(int anchor, double local) const;

  bool reverses() const { return reverses_; }
  double amplitude() const { return amplitude_; }
  double least_speed() const { return std::max(0.0, std::abs(drift_) - amplitude_ * frequency_); }
  double frequency() const { return frequency_; }
  double mean_rate() const { return drift_; }
  double origin() const { return anchors_[1].phase; }      ///< phase at which a period begins
  double first_length() const { return first_length_; }    ///< from anchor 1 to 2; a whole period without reversals
  double second_length() const { return second_length_; }  ///< from anchor 2 to 3; 0 without reversals
  /// Distance of a phase of anchor `anchor` from the beginning of the period.
  double position(int anchor, double local) const { return anchors_[index(anchor)].phase + local - origin(); }
  /// Distances from the beginning of the period at which the rate has this value, within the next period.
  std::vector<double> positions_of_rate(double rate) const;
  /// Phase over which the motion leaves the neighbourhood of the anchor in which an element with these scales changes.
  double layer(int anchor, const Scales& scales) const;

 private:
  struct Anchor {
    double phase = 0.0, sine = 0.0, cosine = 1.0, rate = 0.0;
  };
  static std::size_t index(int anchor) { return static_cast<std::size_t>(anchor); }

  double amplitude_, frequency_, offset_, drift_;
  bool reverses_;
  double first_length_, second_length_;
  std::array<Anchor, 4> anchors_;
};

/// The panels of one period, and those of the way to its beginning from the virgin state at phase 0.
struct PeriodMesh {
  std::vector<Panel> virgin, first, second;
};

/// Fineness of a graded mesh.
struct MeshSettings {
  int stages = 5;       ///< of the collocation
  double growth = 0.7;  ///< ln of the ratio of successive panel ends; also the largest width, rad
  double cap = 0.02;    ///< first panel at a reversal, in units of PrescribedMotion::layer
  int harmonics = 1;    ///< highest order whose oscillation must be resolved
};

/// Appends panels over the stretch of `length` from anchor `left` to anchor `right`, graded towards both where the
/// layer there is thinner than the stretch: the first panel at an end is at most its cap (rad) wide.
void append_graded(std::vector<Panel>& panels, int left, int right, double length, double cap_left, double cap_right,
                   const MeshSettings& settings);

/// Panels that shrink geometrically towards both ends of each stretch between reversals, down to the cap. The count
/// grows with the logarithm of the layer only.
PeriodMesh graded_mesh(const PrescribedMotion& motion, const Scales& scales, const MeshSettings& settings);

/// Splits the panels where the motion has one of these speeds (m/s), in either direction: a friction curve through
/// measured points is not smooth there.
void split_at_speeds(PeriodMesh& mesh, const PrescribedMotion& motion, const std::vector<double>& speeds);

/// `samples` (a multiple of 4) equal steps per period, split at reversals.
PeriodMesh uniform_mesh(const PrescribedMotion& motion, int samples);

}  // namespace limcycle
