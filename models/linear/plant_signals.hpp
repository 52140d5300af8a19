#pragma once

namespace limcycle {

/// What the signals of a plant are. Every kind of plant states it as `signals`; one whose signals are known offers
/// energy() too.
enum class PlantSignals {
  lengths_and_forces,
  angles_and_torques,  ///< but the rubbing is a force over a length
  unknown              ///< known by input and output
};

}  // namespace limcycle
