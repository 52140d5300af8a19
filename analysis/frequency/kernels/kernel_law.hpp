#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/kernels/march_kernel.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// One state of a law, as in march_kernel.hpp, with values for A = 1 and w = 1: for a motion of amplitude A and
/// frequency w, multiply reach by A, speed and drag by A w, tempo and lag by 1/w.
struct KernelState {
  MarchLaw law = MarchLaw::dahl;
  MarchNumbers numbers;
  double reach = 0.0, speed = 0.0, tempo = 0.0, drag = 0.0, lag = 0.0;
  double force = 1.0, damping = 0.0;  ///< contribution to the output: force u + damping du/dt
};

/// A law that consists of such states, independent of each other.
struct KernelLaw {
  std::vector<KernelState> states;
  double spring = 0.0, viscous = 0.0;  ///< remaining part of the output: spring x + viscous v
  double kink = 0.0;                   ///< the level changes like |v|^kink at rest; 0: it is smooth and even
  /// The error of a mesh is at most this factor times its difference from the coarser one.
  double trust = 2.0;
  double least = 0.0;      ///< lower bound of that error
  bool knows_rate = true;  ///< false: the gain depends on the amplitude only

  /// Laws without direction dependence: elasto-plastic (constant damping), Xiong; Dahl with an exponent above 1;
  /// Bouc-Wen with beta >= 0 and n = 1 or n >= 2. Empty for the others.
  static std::optional<KernelLaw> of(const Element& element);
};

}  // namespace limcycle
