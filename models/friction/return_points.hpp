#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// @file
/// Hysteresis with memory of its return points (Madelung 1905), on a bounded stack, for any scalar that moves back and
/// forth: from rest along a virgin curve, after each reversal along a new branch. A branch that returns to the point
/// where the previous branch began closes that loop, which is forgotten with its two return points.
///
/// The stack holds paths along branches, never positions: the path along the present branch, and the path of each
/// earlier branch up to its reversal. So a long slide loses no digits, closed loops return to the same numbers, and
/// reflecting the motion leaves the stack unchanged; the direction is part of the mode.
///
/// A branch is given by a Shape, with
///  - `masing`: true, the virgin curve doubled, f = f_r + d 2 f_v(path/2) (Masing 1926), the branch after the first
///    reversal leading to the mirror point and from there on along the virgin curve; false ("two-point"), the
///    curve `phi` stretched between the return point and its target, the first target being saturation on the other
///    side;
///  - `end`: path along the virgin curve at which it saturates, infinite if it never does;
///  - `virgin(path, direction)` >= 0: force there; `level(direction)` > 0: force of saturation in that direction;
///  - `phi(xi)`, phi(0) = 0, phi(1) = 1: only where `masing` may be false;
///  - `virgin_energy(path)` = int_0^path u f_v'(u) du: only where the energy is needed, see ReturnPoints::energy.

/// Contents of a mode for the stack, in its lowest six bits. Mode{} is the virgin state, about to move forwards.
struct ReturnMode {
  int depth = 0;           ///< return points kept
  int direction = 1;       ///< of the present branch: +1 or -1
  bool saturated = false;  ///< the scalar stays constant until it reverses

  static constexpr int bits = 6;
  static ReturnMode of(Mode mode) {
    return {static_cast<int>(mode.value & 15), (mode.value & 16) != 0 ? -1 : 1, (mode.value & 32) != 0};
  }
  /// The mode with these bits, its other bits unchanged.
  Mode in(Mode mode) const {
    return {(mode.value & ~std::int64_t{63}) | depth | (direction < 0 ? 16 : 0) | (saturated ? 32 : 0)};
  }
  /// Direction of the virgin curve, from which the branches alternate.
  int outermost() const { return depth % 2 == 0 ? direction : -direction; }
};

/// Stack of return points over `states` continuous states: the path along the present branch (m), the paths of the
/// branches before it, outermost first (m; 0 beyond the depth), and a force (N) that only a full stack uses.
///
/// A full stack forgets its innermost loop at the next reversal: force and position stay unchanged, and all results
/// stay exact as long as the motion stays within the branch just left. Beyond that the force is off by the forgotten
/// part (it may then exceed `level` by as much) until the innermost loop that is kept closes, where it jumps back to
/// the exact value.
///
/// Equality up to rounding: a path within `slack` (a share) of its target has arrived; one within as much of its own
/// beginning has not begun. In periodic motion every closing coincides with a reversal, and whichever is met first,
/// mode and states must come out the same. The first branch of a Masing hysteresis meets the virgin curve with the same
/// slope, so that its slack may be wider, `mirror_slack`, with an error of the order of its square.
template <class S, class Shape>
struct ReturnPoints {
  static constexpr int capacity = 12, states = capacity + 2;
  static constexpr double slack = 1e-12, mirror_slack = 1e-7;

  const Shape& shape;

  /// Size of a state for motions of size `displacement` (m) and forces of size `level` (N).
  static double state_scale(int state, double displacement, double level) {
    return state <= capacity ? displacement : level;
  }

  /// Hysteresis force, N.
  S force(ReturnMode at, std::span<const S> z) const {
    const double d = at.direction;
    if (at.saturated) return d * shape.level(d);
    if (at.depth == 0) return d * shape.virgin(z[0], d);
    const S inner = shape.masing ? masing(at, z) : two_point(at, z);
    return at.outermost() * (has_offset(at) ? inner + z[offset] : inner);
  }

  /// Energy (J) in the springs of the equivalent stop elements, for `masing` and a concave virgin curve. Stop elements
  /// of yield y and stiffness k(y) dy make the virgin curve f_v(x) = int k min(x, y) dy; loading them to x stores
  /// int k min(x, y)^2/2 dy = int_0^x u f_v'(u) du. Along a branch of length L from the force F_r to F the work is
  /// F_r L + 4 Phi(L/2) and the dissipation 4 Phi(L/2) - L f_v(L/2), Phi being the integral of f_v, so that the energy
  /// changes by exactly L (F_r + F)/2, the trapezium under the ends of the branch. Derived. Closing a loop leaves it
  /// unchanged; a full stack that forgets a loop forgets its energy, too.
  S energy(ReturnMode at, std::span<const S> z) const {
    if (at.saturated) return shape.virgin_energy(shape.end);
    const double d0 = at.outermost();
    S last = shape.virgin(length_of(0, at.depth, z), d0), sum = shape.virgin_energy(length_of(0, at.depth, z));
    double side = -1.0;
    for (int k = 1; k <= at.depth; ++k, side = -side) {
      const S& way = length_of(k, at.depth, z);
      const S force = last + side * 2.0 * shape.virgin(0.5 * way, d0);
      sum = sum + side * 0.5 * way * (last + force);
      last = force;
    }
    return sum;
  }

  /// Path left to the target of the present branch, >= 0 until it is reached.
  S way_left(ReturnMode at, std::span<const S> z) const {
    if (at.saturated || (at.depth == 0 && value_of(shape.end) == infinite)) return S(infinite);
    return target(at, z) * (1.0 - slack_of(at)) - z[0];
  }

  /// End of the present branch: it saturates, or continues along the virgin curve or the branch before the last.
  ReturnMode arrive(ReturnMode at, std::span<S> z) const {
    if (at.depth == 0) {
      at.saturated = true;
      return at;
    }
    const std::size_t last = length(at.depth - 1);
    if (at.depth == 1) {
      z[0] = z[0] - z[last];
      z[last] = S(0.0);
      at.depth = 0;
      at.saturated = !shape.masing || z[0] >= shape.end;
      return at;
    }
    z[0] = z[last - 1] + (z[0] - z[last]);
    z[last] = z[last - 1] = S(0.0);
    at.depth -= 2;
    at.saturated = at.depth == 0 && at_end(z[0]);
    forget_offset(at, z);
    return at;
  }

  /// The motion reverses.
  ReturnMode reverse(ReturnMode at, std::span<S> z) const {
    while (!at.saturated && has_arrived(at, z)) at = arrive(at, z);
    if (at.saturated) {
      z[0] = shape.end;
      at.saturated = false;
    } else if (at.depth > 0 ? z[0] <= slack * z[length(at.depth - 1)] : !(z[0] > 0.0)) {
      return cancel(at, z);
    }
    if (at.depth == capacity) return forget_innermost(at, z);
    z[length(at.depth)] = z[0];
    z[0] = S(0.0);
    return {at.depth + 1, -at.direction, false};
  }

  /// The virgin state, about to move in the direction of v, or at rest in that of the drive.
  static ReturnMode start(const Input<double>& in, std::span<double> z) {
    std::fill_n(z.begin(), states, 0.0);
    return {0, in.v < 0.0 || (in.v == 0.0 && in.drive < 0.0) ? -1 : 1, false};
  }

  /// The places of return points beyond the depth, and the force of a stack that is not full: they are 0.
  static bool unused(Mode mode, int i) {
    const ReturnMode at = ReturnMode::of(mode);
    return i == capacity + 1 ? !has_offset(at) : i > at.depth && i <= capacity;
  }

  static Mode mirror(Mode mode) {
    ReturnMode at = ReturnMode::of(mode);
    at.direction = -at.direction;
    return at.in(mode);
  }

 private:
  static constexpr std::size_t offset = capacity + 1;
  static std::size_t length(int branch) { return static_cast<std::size_t>(branch) + 1; }
  static const S& length_of(int branch, int depth, std::span<const S> z) {
    return branch == depth ? z[0] : z[length(branch)];
  }

  /// Masing force; the virgin curve is that of the outermost direction.
  S masing(ReturnMode at, std::span<const S> z) const {
    const double d0 = at.outermost();
    S sum = shape.virgin(z[length(0)], d0);
    double side = -2.0;
    for (int k = 1; k <= at.depth; ++k, side = -side)
      sum = sum + side * shape.virgin(0.5 * length_of(k, at.depth, z), d0);
    return sum;
  }

  S two_point(ReturnMode at, std::span<const S> z) const {
    if constexpr (requires(const S xi) { shape.phi(xi); }) return stretched(at, z);
    return S(0.0);
  }

  S stretched(ReturnMode at, std::span<const S> z) const {
    const double d0 = at.outermost();
    S from = shape.virgin(z[length(0)], d0), to = -shape.level(-d0), span = z[length(0)] + shape.end;
    for (int k = 1;; ++k) {
      const S& gone = length_of(k, at.depth, z);
      const S here = from + (to - from) * shape.phi(gone / span);
      if (k == at.depth) return here;
      to = from;
      from = here;
      span = gone;
    }
  }

  S target(ReturnMode at, std::span<const S> z) const {
    if (at.depth == 0) return shape.end;
    const S& last = z[length(at.depth - 1)];
    if (at.depth > 1) return last;
    return shape.masing ? 2.0 * last : last + shape.end;
  }
  double slack_of(ReturnMode at) const {
    return at.depth == 0 ? 0.0 : at.depth == 1 && shape.masing ? mirror_slack : slack;
  }
  bool at_end(const S& gone) const { return gone >= shape.end * (1.0 - 10.0 * slack); }

  /// True within the slack before the target, or within rounding beyond it. Not farther beyond: then differences are
  /// being taken for derivatives, and the stack must change in the same way.
  bool has_arrived(ReturnMode at, std::span<const S> z) const {
    if (at.depth == 0 && value_of(shape.end) == infinite) return false;
    const double goal = value_of(target(at, z)), missing = goal - value_of(z[0]);
    return missing <= (slack_of(at) + 0.1 * slack) * goal && missing >= -10.0 * slack * goal;
  }

  /// Reversed where it had just reversed: the previous branch continues.
  ReturnMode cancel(ReturnMode at, std::span<S> z) const {
    at.direction = -at.direction;
    if (at.depth == 0) {
      z[0] = -z[0];
      return at;
    }
    const std::size_t last = length(at.depth - 1);
    z[0] = z[last] - z[0];
    z[last] = S(0.0);
    --at.depth;
    at.saturated = at.depth == 0 && at_end(z[0]);
    forget_offset(at, z);
    return at;
  }

  /// Merges the last two branches and the present one into one that ends here.
  ReturnMode forget_innermost(ReturnMode at, std::span<S> z) const {
    const double d0 = at.outermost();
    const S before = force(at, z);
    z[length(capacity - 2)] = z[length(capacity - 2)] - z[length(capacity - 1)] + z[0];
    z[length(capacity - 1)] = S(0.0);
    z[0] = S(0.0);
    at.depth = capacity - 1;
    at.direction = -at.direction;
    z[offset] = z[offset] + d0 * (before - force(at, z));
    return at;
  }

  /// The offset belongs to branches that begin at the innermost two return points of a full stack.
  static bool has_offset(ReturnMode at) { return at.depth >= capacity - 2; }
  static void forget_offset(ReturnMode at, std::span<S> z) {
    if (!has_offset(at)) z[offset] = S(0.0);
  }
};

}  // namespace limcycle
