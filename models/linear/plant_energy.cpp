#include "limcycle/models/linear/plant_energy.hpp"

#include "limcycle/models/linear/plants.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Of one body, whose position and velocity are the first two states.
PlantEnergy of_body(double inertia, double stiffness, double damping, Index states = 2) {
  PlantEnergy energy{MatrixXd::Zero(states, states), MatrixXd::Zero(states, states), MatrixXd::Zero(states, states)};
  energy.kinetic(1, 1) = inertia;
  energy.springs(0, 0) = stiffness;
  energy.dampers(1, 1) = damping;
  return energy;
}

}  // namespace

PlantEnergy Mass::energy() const { return of_body(mass, stiffness, damping); }

PlantEnergy Belt::energy() const { return of_body(mass, stiffness, damping); }

PlantEnergy FroudePendulum::energy() const { return of_body(inertia, 0.0, damping); }

PlantEnergy TwoMass::energy() const {
  PlantEnergy energy = of_body(motor_mass, 0.0, 0.0, 4);
  energy.kinetic(3, 3) = load_mass;
  const Eigen::RowVector4d stretch(1.0, 0.0, -1.0, 0.0), rate(0.0, 1.0, 0.0, -1.0);
  energy.springs = stiffness * stretch.transpose() * stretch;
  energy.dampers = damping * rate.transpose() * rate;
  return energy;
}

PlantEnergy ServoDrive::energy() const {
  if (current_lag == 0.0) return of_body(moved(), 0.0, damping);
  PlantEnergy energy = of_body(moved(), 0.0, damping, 3);
  energy.motor = MatrixXd::Zero(3, 3);
  energy.motor(1, 2) = efficiency * ratio * torque_constant;
  return energy;
}

std::optional<PlantEnergy> energy_of(const Plant& plant) {
  return std::visit(
      []<class P>(const P& one) -> std::optional<PlantEnergy> {
        if constexpr (P::signals == PlantSignals::unknown)
          return std::nullopt;
        else
          return one.energy();
      },
      plant);
}

}  // namespace limcycle
