#include "limcycle/analysis/energy/loop/plant_energy.hpp"

namespace limcycle {
namespace {

using Eigen::MatrixXd;

PlantEnergy oscillator(double inertia, double stiffness, double damping) {
  PlantEnergy energy{MatrixXd::Zero(2, 2), MatrixXd::Zero(2, 2), MatrixXd::Zero(2, 2)};
  energy.kinetic(1, 1) = inertia;
  energy.springs(0, 0) = stiffness;
  energy.dampers(1, 1) = damping;
  return energy;
}

PlantEnergy joined(const TwoMass& plant) {
  PlantEnergy energy{MatrixXd::Zero(4, 4), MatrixXd::Zero(4, 4), MatrixXd::Zero(4, 4)};
  energy.kinetic(1, 1) = plant.motor_mass;
  energy.kinetic(3, 3) = plant.load_mass;
  const Eigen::RowVector4d stretch(1.0, 0.0, -1.0, 0.0), rate(0.0, 1.0, 0.0, -1.0);
  energy.springs = plant.stiffness * stretch.transpose() * stretch;
  energy.dampers = plant.damping * rate.transpose() * rate;
  return energy;
}

}  // namespace

std::optional<PlantEnergy> energy_of(const Plant& plant) {
  if (const auto* mass = std::get_if<Mass>(&plant)) return oscillator(mass->mass, mass->stiffness, mass->damping);
  if (const auto* belt = std::get_if<Belt>(&plant)) return oscillator(belt->mass, belt->stiffness, belt->damping);
  if (const auto* froude = std::get_if<FroudePendulum>(&plant))
    return oscillator(froude->inertia, 0.0, froude->damping);
  if (const auto* two = std::get_if<TwoMass>(&plant)) return joined(*two);
  return std::nullopt;
}

}  // namespace limcycle
