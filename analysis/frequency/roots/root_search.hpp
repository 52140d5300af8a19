/// @file
/// Finds all pairs (amplitude, frequency) in a box that satisfy the loop condition `f(A, w) = 1 + N(A, w) G(jw) = 0`.
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Left side of the loop condition, `f = 1 + N(A, w) G(jw)` (dimensionless). `amplitude` in the unit of the element's
/// input, `frequency` in rad/s, `accuracy` the requested relative accuracy of N (1e-5 .. 1e-12). NaN: the describing
/// function does not exist there. May be called up to one cell outside the box (while a root is polished).
using LoopEquation = std::function<std::complex<double>(double amplitude, double frequency, double accuracy)>;

/// Box of the root search; edges belong to it (with a relative margin of 1e-9). Both ranges positive, min < max.
struct SearchBox {
  double amplitude_min, amplitude_max;  ///< unit of the element's input
  double frequency_min, frequency_max;  ///< rad/s
};

/// Point at which the loop equation is evaluated.
struct SearchPoint {
  double amplitude;  ///< unit of the element's input
  double frequency;  ///< rad/s
};

/// Settings of find_roots().
struct RootSearchOptions {
  int initial_cells_amplitude = 24;  ///< cells over the range of ln A before refinement, 1..1000 (rounded up to even)
  int initial_cells_frequency = 24;  ///< cells over the range of ln w before refinement, 1..1000 (rounded up to even)
  int max_depth = 24;                ///< bisections of an initial pair of cells at most, 2..40
  int max_border_depth = 10;         ///< the same for cells that are partly undefined (NaN), 2..max_depth
  long max_evaluations = 200000;     ///< calls of the loop equation at most, > 0
  double residual = 1e-9;            ///< a root needs |f| below this (dimensionless), > 0
  double coarse_accuracy = 1e-5;     ///< relative accuracy of N requested first, fine_accuracy..0.01
  double fine_accuracy = 1e-12;      ///< relative accuracy of N for polishing and near-tangencies, >= 1e-15
  std::vector<double> amplitude_hints;  ///< kinks of N and ends of its domain; grid lines are placed there
  std::vector<double> frequency_hints;  ///< rad/s, lightly damped poles and zeros of G; grid lines are placed there
  /// Called with the points that are evaluated next, so that they can be computed together (default: none).
  std::function<void(const std::vector<SearchPoint>& points, double accuracy)> prepare;
  /// True if f is known to have no root in that part of the box, which is then not sampled (default: never known).
  std::function<bool(const SearchBox& part)> rootless;
  std::function<bool()> interrupted;  ///< called once per cell; true ends the search (default: never)
  /// Called before each evaluation, for equations that take long; true ends the search (default: never).
  std::function<bool()> stop;
};

/// A confirmed root of the loop condition.
struct Root {
  double amplitude;  ///< unit of the element's input
  double frequency;  ///< rad/s
  double residual;   ///< |f| at the root with N at fine_accuracy
  int index;         ///< sign of jacobian_determinant; +1: the predicted cycle is stable (Loeb), -1: unstable
  double jacobian_determinant;  ///< d(Re f, Im f)/d(ln A, ln w) at the root, dimensionless
};

/// A place where |f| is so small that no root, a double root and a very close pair cannot be distinguished, or where f
/// ceases to exist (NaN) too close to zero. Neighbouring cells each report one.
struct NearMiss {
  double amplitude;  ///< unit of the element's input
  double frequency;  ///< rad/s
  double residual;   ///< |f| / sqrt(1 + |f - 1|^2) there
};

/// Result of find_roots().
struct RootSearch {
  std::vector<Root> roots;            ///< sorted by frequency, then amplitude
  std::vector<NearMiss> near_misses;  ///< sorted likewise; not empty only if status is not an answer
  int winding_number = 0;             ///< turns of f about 0 along the border of the region where f is defined
  int index_sum = 0;                  ///< sum of the indices of the roots inside that border
  long evaluations = 0;               ///< calls of the loop equation
  Status status = Status::no_cycle;   ///< see find_roots()
};

/// Throws std::invalid_argument, quoting the value, if an option is out of its range.
void validate(const RootSearchOptions& options);

/// All roots of `f(A, w) = 0` in the box, by a tree of cells over (ln A, ln w), bisected along either or both.
///
/// Each cell is sampled at 3 x 3 points. It is discarded when the convex hull of the Bernstein points of its
/// biquadratic interpolant keeps away from zero by more than the neglected variation (half the second-order terms, or
/// half of what the model of the parent cell failed to predict); decided by Newton's method when its Jacobian varies so
/// little that it holds one root at most; subdivided otherwise. Hence pairs of opposite index (near folds), which no
/// winding number sees, are separated by subdivision: down to a relative distance of about 10 sqrt(fine_accuracy),
/// since |f| between them is about (distance/2)^2; closer pairs end as near misses. Polishing: Powell's hybrid method
/// (GSL multiroot hybridsj, after Powell, 1970, and More, Garbow and Hillstrom, MINPACK, 1980).
///
/// Check: the winding number of f along the border of every initial block, and of the whole box, must equal the sum of
/// the indices of the roots inside; a block that disagrees is searched again on a finer grid.
///
/// Loeb's criterion: with U + jV = f, the predicted cycle is stable if (dU/dA)(dV/dw) - (dU/dw)(dV/dA) > 0, that is, if
/// the index (taken with respect to (ln A, ln w), which has the same sign) is +1.
///
/// A jump of f (see root_jump.hpp) is passed over where both of its sides keep away from zero, and reported as near
/// misses where they do not: at the same limit of depth as a border of existence.
///
/// Status: `converged` at least one root and everything decided; `no_cycle` no root and everything decided;
/// `incomplete` near misses remain, or winding_number and index_sum disagree; `max_iterations` max_evaluations used up;
/// `not_finite` f is undefined at every sample; `interrupted`. The roots found are confirmed in every case.
///
/// Borders of existence at a constant amplitude (relay with hysteresis) are located first and get a grid line; along
/// others the search leaves a strip of 2^-max_border_depth of a block unseen, and reports a near miss if f is small
/// there.
///
/// Limits: a feature of f much narrower than an initial cell is found only with a hint, and roots closer than
/// 1e-7 (relative, both coordinates) with the same index count as one.
///
/// Cost: about 2500 evaluations for the default
/// grid (49 x 49 samples and the scan for borders), then about 50 to 200 a root, 500 to 1500 a near fold or lightly
/// damped resonance.
/// Throws std::invalid_argument for bad options or a bad box; what `f` throws is passed on.
RootSearch find_roots(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options = {});

}  // namespace limcycle
