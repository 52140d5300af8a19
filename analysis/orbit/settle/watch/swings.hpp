#pragma once
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"

namespace limcycle {

/// Turning points of a signal, and the number of them at which a cycle is looked for next.
struct Swings {
  TurningPoints turning;
  std::size_t next_try = 5, leapt_at = 0;

  void try_later();
};

/// Largest relative change of the last swings from those one period (of `order` turning points) before.
double largest_change(const TurningPoints& turning, std::size_t order);

/// True if swings that shrink have no cycle ahead: their limit, by Aitken's extrapolation from the last three of one
/// period each, is a small part of the present one.
bool shrinks_to_nothing(const TurningPoints& turning, std::size_t order);

}  // namespace limcycle
