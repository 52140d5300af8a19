#pragma once
#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Typical output of an element of the loop: that of its Scales; of a cubic, which has no size of its own, the output
/// c A^3 at the input A for which c A^2 times the largest response |H(s)| of the loop, at s = (0.1 + j) w for its
/// frequencies w, is 1.
double output_level(const Loop& loop, std::size_t element);

/// Typical size of every state of the loop (linear states, then element states): the largest response of the linear
/// part, over the frequencies of its poles, to the element outputs; of a loop with a limited command no more than that
/// of the loop within the limit to the other elements. Position and velocity at a friction law are bounded
/// by the law's own displacement and velocity scales, which its switching from stick to slip requires.
State typical_sizes(const Loop& loop);

/// Typical rubbing velocity of the last element, from typical_sizes() and the speed of the other surface.
double typical_rubbing_velocity(const Loop& loop);

}  // namespace limcycle
