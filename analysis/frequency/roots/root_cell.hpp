/// @file
/// Decides if a function sampled at 3 x 3 points of a cell can be zero in it. (Internal to the root search.)
#pragma once

#include <array>
#include <complex>

namespace limcycle {

/// Samples at (u, v) in {-1, 0, 1}^2, the cell being [-1, 1]^2: index 3 (v + 1) + (u + 1).
using CellSamples = std::array<std::complex<double>, 9>;

/// Data of a complex function in a cell.
struct CellKnowledge {
  CellSamples values;         ///< the function, scaled to be of order one
  CellSamples surprise;       ///< values minus what the model of the parent cell predicted (0 where it interpolated)
  bool has_surprise = false;  ///< false: there was no parent model
  double noise = 0.0;         ///< bound of the error of each value
  double caution = 1.0;       ///< >= 1: factor of the margins, for a cell in which a root is known to have been missed
};

/// Verdict on the zeros in a cell.
enum class CellVerdict {
  no_root,         ///< the function keeps away from zero
  at_most_one,     ///< the Jacobian is nearly constant: one root at most, near (u, v) of the assessment
  needs_accuracy,  ///< the noise of the samples hides the answer
  unclear          ///< subdivide
};

/// Result of assess().
struct CellAssessment {
  CellVerdict verdict = CellVerdict::unclear;
  double u = 0.0, v = 0.0;              ///< Newton's estimate of the root, for at_most_one
  double thickness = 0.0;               ///< extent of the values about zero in their thinnest direction, unless no_root
  bool split_u = true, split_v = true;  ///< the directions whose bisection helps, unless no_root
};

/// Decides a cell from its samples. With f = sum c_mn u^m v^n (m, n <= 2) the biquadratic interpolant:
/// - no_root: the convex hull of the Bernstein points (which contains the image of the interpolant) has a distance from
///   zero that exceeds the margin: half the second- and higher-order coefficients and half the surprise, both projected
///   on the direction to the hull (a long valley of small |f| is then excluded by large cells), plus the noise; plus,
///   in all directions, twice the surprise, or a fraction 4 r of that where the surprise is a small part r of the
///   variation; without a parent, or with caution, all coefficients in all directions;
/// - at_most_one: with J the Jacobian at the centre, |J^-1 (J(u,v) - J)| <= 1/2 in the maximum norm, and <= 0.9 with
///   the noise added, where less than 1 is enough for injectivity. The argument change along the samples of the border
///   must agree.
/// Both are estimates from samples, not proofs. Exact for biquadratic functions. Cost: no evaluation.
CellAssessment assess(const CellKnowledge& cell);

/// Point (u, v) of the cell at which the interpolant is smallest, by grids of 9 x 9 points that shrink about the best
/// one; for reports only (not a certified minimum).
std::array<double, 2> smallest_point(const CellSamples& values);

/// Point of the convex hull of the values nearest to zero; zero itself when the hull contains it.
std::complex<double> nearest_in_hull(const CellSamples& points);

/// Biquadratic interpolant of the samples at (u, v).
std::complex<double> interpolate(const CellSamples& values, double u, double v);

}  // namespace limcycle
