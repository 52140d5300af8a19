#pragma once
#include <Eigen/Core>
#include <optional>

#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// Energy of a mechanical plant, J, as quadratic forms of its state X: kinetic X'KX/2, of springs X'PX/2 (plus that of
/// a weight), loss in dampers per second X'RX.
struct PlantEnergy {
  Eigen::MatrixXd kinetic, springs, dampers;
};

/// Empty for a plant given by its input and output only.
std::optional<PlantEnergy> energy_of(const Plant& plant);

}  // namespace limcycle
