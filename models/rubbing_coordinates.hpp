#pragma once
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// A plant in other states.
struct PlantCoordinates {
  PlantModel plant;
  Eigen::MatrixXd own_states;  ///< states as written in the case = own_states times those of `plant`; empty: same
};

/// The plant in states of which the first is the rubbing displacement and the second the rubbing velocity, on which
/// alone friction acts: x' = T x, with the rows C_x, C_v, then C_y and states of the plant from which the part moved by
/// friction is removed, p - (p B_F)/(C_v B_F) C_v, combined into the modes of the plant with the others held. A body
/// that sticks is then exactly at rest, for any states in the case; in a mixture of states it would drift by the square
/// root of rounding. Entries of rounding size after the change of states are set to zero. States that have this form up
/// to order and factors stay unchanged, as do plants on whose rubbing velocity friction does not act directly.
PlantCoordinates rubbing_coordinates(PlantModel plant);

}  // namespace limcycle
