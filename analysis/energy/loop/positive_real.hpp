#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/energy/decision.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {

/// The real part of H(jw) = C (jw - A)^-1 B + D, one input and one output, at all frequencies, without a frequency
/// grid.
///
/// Re H(jw) = level where H(s) + H(-s) - 2 level has a zero on the imaginary axis: finitely many frequencies, the
/// eigenvalues of a Hamiltonian pencil (S. Boyd, V. Balakrishnan, P. Kabamba, Mathematics of Control, Signals and
/// Systems 2, 1989, 207-219), between which the sign is found by evaluation. A computed eigenvalue need not be
/// classified as on the axis or only near it: near ones only add points at which H is evaluated. Hidden modes are
/// omitted and lossless poles (at the origin) taken out first. Cost O(n^3) a level. A delay is not rational: not
/// treated here.
class RealPart {
 public:
  /// `A_size`, `D_size`: sizes of the terms of A and D, if larger than A and D (see transfer.hpp).
  explicit RealPart(const StateSpace& H, double A_size = 0.0, double D_size = 0.0);

  /// Re H(jw), w > 0.
  double at(double w) const;

  /// inf over w > 0 of Re H(jw).
  struct Least {
    double value = 0.0;      ///< -infinity where it is not bounded from below
    double frequency = 0.0;  ///< of the least value, rad/s; 0 or infinity: approached only in that limit
    double error = 0.0;      ///< estimated, of `value`; infinite if a pole near the origin may be a multiple one at it
  };
  /// Descends to the least value found and tests for a lower level that is reached (two-step iteration of Bruinsma and
  /// Steinbuch 1990). Relative accuracy 1e-9 of the size of Re H. Computed once.
  const Least& least() const { return least_; }

  /// yes if Re H(jw) > level at every w > 0. The limits at 0 and infinity may equal the level. undecided: equal to it,
  /// to rounding, somewhere between.
  Decision above(double level) const;

  /// The same at w = 0 itself, where H must have no pole.
  bool above_at_zero(double level) const { return limit_at_zero() > level + least_.error; }

  const Minimal& reduced() const { return reduced_; }
  const OriginPole& origin() const { return origin_; }  ///< pole of H at s = 0
  /// Frequencies w > 0 of poles on the imaginary axis (to 1e-10 of the size of the matrix), rad/s.
  const std::vector<double>& axis_poles() const { return axis_poles_; }
  /// True if the residues of all poles on the axis keep Re H finite there (real ones) and are positive.
  bool residues_real() const { return residues_real_; }
  bool residues_positive() const { return residues_positive_; }
  /// True if Re H(jw) is the same at every frequency.
  bool constant() const { return rest_.states() == 0; }
  /// Largest real part of the poles of H, 1/s; -infinity if it has none.
  double rightmost_pole() const { return rightmost_; }

 private:
  void take_out_axis_poles();
  void find_least();
  void descend();
  void scale_of_frequencies();
  std::optional<std::vector<double>> samples(double level) const;
  double limit_at_zero() const;
  std::optional<double> unbounded_at_zero() const;
  double noise(double w) const;
  void lower(std::vector<double> points);
  double golden(double low, double high) const;
  bool near_axis_pole(double w) const;

  Minimal reduced_;
  OriginPole origin_;
  StateSpace rest_;  ///< without the poles on the axis: its real part on the axis is that of H
  std::vector<double> axis_poles_, moduli_;
  bool unresolved_ = false;  ///< a pole that rounding does not distinguish from one at the origin
  bool residues_real_ = true, residues_positive_ = true;
  double rightmost_ = 0.0, slow_ = 1.0, fast_ = 1.0;  ///< frequencies beyond which nothing happens
  double size_ = 0.0;                                 ///< of Re H
  double A_size_ = 0.0;
  Least least_;
};

/// Positive realness of H: no pole in Re s > 0, those on the axis simple with positive residues, Re H(jw) >= 0. By the
/// lemma of Kalman (1963), Yakubovich (1962) and Popov that is equivalent to a storage x' P x from which no more can be
/// taken out than was supplied. H with a pole of relative degree -1 at infinity is given by its inverse.
struct PositiveReal {
  Answer answer;
  bool strictly = false;  ///< Re H(jw) > 0 at every w > 0
};
PositiveReal positive_real(const RealPart& H);

}  // namespace limcycle
