#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/precision/work_precision.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A loop of the atlas: the law's name, its pre-sliding stiffness (N/m, NaN if it has none), and the loop.
struct AtlasLoop {
  std::string law;
  double stiffness = not_known;
  Loop loop;
};

/// The stiffnesses of the atlas, 1e3 to 1e8 N/m, a decade apart.
std::vector<double> atlas_stiffnesses();

/// The loop with its own law, as in stiffness_ladder (from a hundredth to a thousand times its own stiffness), or
/// unchanged if the law has no sigma0.
std::vector<AtlasLoop> own_law(const LoopParts& parts);

/// The loop with each family of laws in the place of its friction: coulomb, lugre, elasto-plastic, gms (four sliders),
/// non-drift and dahl, with the levels Fs, Fc, vs, sigma2 of the case's law (1.5, 1, 1e-3, 0 if it has none) and the
/// pre-sliding stiffness s = atlas_stiffnesses(). Micro-damping sqrt(s m), with m the mass at the friction: half of the
/// critical damping. Throws std::invalid_argument for a loop without friction.
std::vector<AtlasLoop> law_families(const LoopParts& parts);

}  // namespace limcycle
