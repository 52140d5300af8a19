#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Limits of steppers with friction, as measured by the atlas (analysis/study/precision/stepper_atlas.hpp,
/// docs/numerical-stability.md).

/// The loosest relative tolerance at which a stiff stepper still follows the stick phases of a loop; infinite if no law
/// has bristles.
///
/// While it sticks, a body creeps at |dF/dt|/k, with k the pre-sliding stiffness. A step whose absolute tolerance on
/// the rubbing velocity is larger than that may miss the creep, breaks stiction early and settles on a false, irregular
/// hunting. dF/dt is taken as a fifth of Fs times the slowest pole w of the loop, so that with loop_weights()
///   atol(v) = rtol vs <= 0.2 w displacement     (Scales of the law; w = pole_moduli().front()),
/// where vs is the substitute of loop_weights() for a law without a Stribeck velocity. Never more than 5e-4: looser
/// steps pass over the events of laws of several sliders. On the servo of the atlas: 2.5e-5 at 1e7 N/m, 2.5e-6 at 1e8.
double loosest_stiff_tolerance(const Loop& loop);

/// Estimated number of steps that an explicit stepper takes per turn 2 pi/w of the slowest pole, because it must follow
/// the bristles while the body slides: 2 pi/w |v|/displacement/3.3, with v the typical rubbing velocity. 0 if no law
/// has bristles.
double explicit_steps(const Loop& loop);

/// Notes for a march of this loop with this stepper at this tolerance: sentences on limitations, each with a remedy.
/// Empty if none is known.
std::vector<std::string> stepper_notes(const Loop& loop, StepperKind stepper, double rtol);

}  // namespace limcycle
