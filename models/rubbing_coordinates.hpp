#pragma once
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// A plant in other states.
struct PlantCoordinates {
  PlantModel plant;
  Eigen::MatrixXd own_states;  ///< the states as the case writes them = own_states times those of `plant`; empty: same
};

/// The plant in states of which the first is the rubbing displacement, the second the rubbing velocity, on which alone
/// friction acts: x' = T x, with the rows C_x, C_v, then C_y and states of the plant from which what friction moves is
/// taken out, p - (p B_F)/(C_v B_F) C_v. A body that sticks then stands still to the last bit, however the case writes
/// the plant; in a mixture of states it would drift by the square root of the rounding. What is left of a zero after
/// the change of states is set to zero. States that are of this form up to their order and factors stay as they are, as
/// do plants on whose rubbing velocity friction does not act at once.
PlantCoordinates rubbing_coordinates(PlantModel plant);

}  // namespace limcycle
