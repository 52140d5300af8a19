#pragma once
#include <Eigen/Core>

namespace limcycle {

/// Energy of a mechanical plant, J, as quadratic forms of its state X: kinetic X'KX/2, of springs X'PX/2 (plus that of
/// a weight), loss in dampers per second X'RX, power of a force that a state of the plant exerts X'MX (a motor's
/// current; empty: none).
struct PlantEnergy {
  Eigen::MatrixXd kinetic, springs, dampers, motor{};
};

}  // namespace limcycle
