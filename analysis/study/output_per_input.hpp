#pragma once
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Amplitude of y for one of the main element's input where the two are the same motion in other units (the angle of a
/// Froude pendulum and the rubbing of its sleeve); else 1.
inline double output_per_input(const Loop& loop) {
  const Port& main = loop.ports.back();
  const double size = main.C.squaredNorm();
  if (!(size > 0.0)) return 1.0;
  const double factor = loop.C_y.dot(main.C) / size;
  const bool same = factor > 0.0 && (loop.C_y - factor * main.C).norm() <= 1e-12 * loop.C_y.norm();
  return same ? factor : 1.0;
}

}  // namespace limcycle
