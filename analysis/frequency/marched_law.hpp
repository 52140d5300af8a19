#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/march_kernel.hpp"
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// One state of a law, as march_kernel.hpp has it: for a motion of amplitude A and frequency w reach is A times what
/// stands here, speed and drag A w times, tempo and lag 1/w times that.
struct MarchedState {
  MarchLaw law = MarchLaw::dahl;
  MarchNumbers numbers;
  double reach = 0.0, speed = 0.0, tempo = 0.0, drag = 0.0, lag = 0.0;
  double force = 1.0, damping = 0.0;  ///< its part of the output: force u + damping du/dt
};

/// A law that consists of such states, which know nothing of each other.
struct MarchedLaw {
  std::vector<MarchedState> states;
  double spring = 0.0, viscous = 0.0;  ///< the rest of the output: spring x + viscous v
  double kink = 0.0;                   ///< the level changes like |v|^kink at rest; 0: it is smooth and even
  /// The error of a mesh is at most so many times its difference from the coarser one.
  double trust = 2.0;
  double least = 0.0;      ///< and not below this
  bool knows_rate = true;  ///< else a gain is that of its amplitude

  /// Without direction dependence elasto-plastic (constant damping), Xiong, and GMS with a level that is smooth at
  /// rest; Dahl with an exponent above 1; Bouc-Wen with beta >= 0 and n = 1 or n >= 2. Empty for the others.
  static std::optional<MarchedLaw> of(const Element<double>& element);
};

}  // namespace limcycle
