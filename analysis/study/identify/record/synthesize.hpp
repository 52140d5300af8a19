#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "limcycle/analysis/study/identify/record/record.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Faults of the measurement; 0: none.
struct RigFaults {
  double noise = 0.01;  ///< standard deviation of the force, as a share of the largest force of the record
  double drift = 0.0;   ///< of the force sensor from the first row to the last, as such a share
  double ripple = 0.0;  ///< amplitude of a force that repeats with the position (20 times in a record), as such a share
  double quantum = 0.0;  ///< step of the encoder, m; > 0: the position only is recorded, without the velocity
  double jitter = 0.0;   ///< standard deviation of the times at which rows are taken, as a share of the sample time
};

/// Records of a rig with a known law, one of each kind, in sizes that the law's own scales give: 60 steady velocities
/// both ways, sliding with a velocity that varies around the Stribeck velocity, a growing oscillation in pre-sliding,
/// and a ramp of force on a mass until it slides. For a law without a velocity scale or a displacement scale that scale
/// is 1 mm/s or 10 um in SI units. The same seed gives the same records; none if `stop` becomes true. Each is named
/// after its kind. Throws std::invalid_argument for a kind that cannot be identified, or a run that cannot be computed.
std::vector<FrictionRecord> synthesize(const Element& law, const RigFaults& faults, std::uint64_t seed,
                                       const std::function<bool()>& stop = {});

}  // namespace limcycle
