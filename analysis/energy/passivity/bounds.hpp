#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Origin of a bound.
enum class BoundKind {
  exact,     ///< the least bound: computed over all reachable states
  analytic,  ///< follows from the law's equations; it need not be reached
  searched   ///< not a bound: the worst reached by random and adversarial inputs
};
std::string_view to_string(BoundKind kind);

/// Bound of one state, over all inputs up to the top speed.
struct StateBound {
  double low = 0.0, high = 0.0;  ///< infinite if there is none
  BoundKind kind = BoundKind::searched;
};

/// Bound of |F|, over all inputs up to a speed; at x = 0 for a law with a spring to that place.
struct ForceBound {
  double value = 0.0;        ///< N; infinite if it grows with the speed and that is not limited
  double up_to_speed = 0.0;  ///< m/s
  BoundKind kind = BoundKind::searched;
  double v = 0.0, z = 0.0;  ///< where it is reached (kind exact), m/s and in the unit of the state
};

/// The worst values found by a search.
struct WorstSeen {
  std::vector<double> low, high;    ///< of each state
  double force = 0.0;               ///< largest |F|, N
  long inputs = 0, unfinished = 0;  ///< inputs tried; those that reached the step limit or did not end otherwise
};

/// Bounds of every state and of the force.
struct Bounds {
  std::vector<StateBound> states;
  ForceBound force;
  WorstSeen seen;  ///< values reached by a search; the ratio to a bound shows how sharp the bound is
  Status status = Status::converged;
};

/// Motions over which bounds are computed.
struct BoundsOptions {
  double top_speed = infinite;  ///< |v| of inputs, m/s; of a search at most 1e3 velocity scales
  std::uint64_t seed = 0;
  int inputs = 60;  ///< of the search; 0: none (a law without an exact or analytic bound then has none)
  std::function<bool()> stop;
};

/// Bounds of state and force of a friction law without history, over all inputs up to the top speed.
///
/// One state with f(z, v), F(z, v) (OneStateLaw::fits): exact, by the range of z and the largest |F| over it. Several
/// states: analytic if the law's equations prove it (stop elements W_i/k_i, gms alpha_i Fs, xiong lambda_i Fs/K_i and
/// levels between Fc and Fs; forces from these), else searched. Laws whose states are displacements along branches
/// (iwan, two-state, non-drift) have searched bounds of the state, but analytic ones of the force (of iwan and
/// two-state as long as their memory of twelve return points is not full, see ReturnPoints).
///
/// Throws std::invalid_argument for an element that is not a friction law or a top speed that is not positive.
Bounds bounds(const Element& element, const BoundsOptions& options = {});

/// The search alone: constant velocities one after the other, log-distributed in speed and displacement, among them
/// slow loading followed by the top speed in either direction. The same for the same seed.
WorstSeen worst_seen(const Element& law, const BoundsOptions& options);

}  // namespace limcycle
