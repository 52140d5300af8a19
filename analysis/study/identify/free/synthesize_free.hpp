#pragma once
#include <cstdint>
#include <vector>

#include "limcycle/analysis/study/identify/free/free_motion.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"

namespace limcycle {

/// Free motions of a rig with a known law: under a force that swings with growing amplitude, from rest until it slides
/// both ways, and a free decay: let go where the spring or gravity pulls with ten times the friction (a pendulum: at
/// 1 rad at most) or, without either, pushed. Sizes follow from the scales of the law, see synthesize(). `noise` is a
/// share of the largest displacement and of the largest speed; of the other faults `quantum` applies. The same seed
/// gives the same records, of `rows` rows each. Throws std::invalid_argument for a motion that cannot be computed, or a
/// rig that its friction holds wherever it is let go.
std::vector<FrictionRecord> synthesize_free(const Element& law, const FreeRig& rig, const RigFaults& faults,
                                            std::uint64_t seed, std::size_t rows = 601);

}  // namespace limcycle
