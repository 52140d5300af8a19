#include "limcycle/models/linear/plants.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "limcycle/models/linear/rubbing.hpp"

namespace limcycle {
namespace {

PlantModel oscillator(double mass, double damping, double stiffness) {
  PlantModel plant;
  plant.A.resize(2, 2);
  plant.A << 0.0, 1.0, -stiffness / mass, -damping / mass;
  plant.B_u = plant.B_F = Eigen::Vector2d(0.0, 1.0 / mass);
  plant.C_y = plant.C_x = Eigen::RowVector2d(1.0, 0.0);
  plant.C_v = Eigen::RowVector2d(0.0, 1.0);
  plant.state_names = {"y", "v"};
  return plant;
}

constexpr double typed = 1e-6;  ///< numbers in a case file are often rounded to six digits

/// The columns through which u and the friction act.
Eigen::MatrixXd both_forces(const Eigen::MatrixXd& B, const Eigen::MatrixXd& B_friction) {
  Eigen::MatrixXd forces(B.rows(), 2);
  forces << B, (B_friction.size() != 0 ? B_friction : B);
  return forces;
}

std::optional<BrokenRule> not_zero(const std::string& key, double value) {
  if (value == 0.0) return BrokenRule{key, "must not be zero"};
  return std::nullopt;
}

std::optional<BrokenRule> strictly_proper(const std::string& key, const auto& realisation) {
  try {
    const StateSpace g = realisation();
    if (g.states() == 0 || g.D(0, 0) != 0.0)
      return BrokenRule{key, "must have a lower degree than the denominator: the plant must be strictly proper"};
  } catch (const std::invalid_argument& error) {
    return BrokenRule{key, error.what()};
  }
  return std::nullopt;
}

}  // namespace

PlantModel input_output_plant(const StateSpace& g, double delay) {
  PlantModel plant;
  plant.A = g.A;
  plant.B_u = plant.B_F = g.B.col(0);
  plant.C_y = g.C.row(0);
  plant.delay = delay;
  plant.C_v = plant.C_y * plant.A;
  plant.C_x = plant.C_y;
  for (Eigen::Index i = 0; i < g.states(); ++i) plant.state_names.push_back("x" + std::to_string(i + 1));
  return plant;
}

PlantModel Mass::model() const { return oscillator(mass, damping, stiffness); }

PlantModel Belt::model() const {
  PlantModel plant = oscillator(mass, damping, stiffness);
  plant.v0 = -speed;
  return plant;
}

PlantModel FroudePendulum::model() const {
  PlantModel plant = oscillator(inertia, damping, 0.0);
  plant.B_F *= shaft_radius;
  plant.C_x *= shaft_radius;
  plant.C_v *= shaft_radius;
  plant.v0 = -shaft_radius * shaft_speed;
  if (gravity == 0.0) return plant;
  plant.gravity.emplace();
  plant.gravity->mass = mass;
  plant.gravity->gravity = gravity;
  plant.gravity->arm = arm;
  plant.B_gravity = Eigen::Vector2d(0.0, 1.0 / inertia);
  plant.C_gravity = plant.C_y;
  return plant;
}

PlantModel TwoMass::model() const {
  PlantModel plant;
  plant.A = Eigen::MatrixXd::Zero(4, 4);
  plant.A.row(0) << 0.0, 1.0, 0.0, 0.0;
  plant.A.row(1) << -stiffness / motor_mass, -damping / motor_mass, stiffness / motor_mass, damping / motor_mass;
  plant.A.row(2) << 0.0, 0.0, 0.0, 1.0;
  plant.A.row(3) << stiffness / load_mass, damping / load_mass, -stiffness / load_mass, -damping / load_mass;
  plant.B_u = Eigen::Vector4d(0.0, 1.0 / motor_mass, 0.0, 0.0);
  plant.B_F = plant.B_u;
  if (friction_on.index == 1) plant.B_F = Eigen::Vector4d(0.0, 0.0, 0.0, 1.0 / load_mass);
  const Eigen::Index rub = friction_on.index == 0 ? 0 : 2;
  plant.C_x = Eigen::RowVectorXd::Unit(4, rub);
  plant.C_v = Eigen::RowVectorXd::Unit(4, rub + 1);
  plant.C_y = Eigen::RowVectorXd::Unit(4, measured.index == 0 ? 0 : 2);
  plant.state_names = {"y_motor", "v_motor", "y_load", "v_load"};
  return plant;
}

PlantModel ServoDrive::model() const {
  PlantModel plant = oscillator(moved(), damping, 0.0);
  plant.B_u *= efficiency * ratio * torque_constant;
  if (current_lag == 0.0) return plant;
  plant.A.conservativeResizeLike(Eigen::MatrixXd::Zero(3, 3));
  plant.A.block(0, 2, 2, 1) = plant.B_u;
  plant.A(2, 2) = -1.0 / current_lag;
  plant.B_u = Eigen::Vector3d(0.0, 0.0, 1.0 / current_lag);
  for (Eigen::RowVectorXd* row : {&plant.C_y, &plant.C_v, &plant.C_x})
    row->conservativeResizeLike(Eigen::RowVectorXd::Zero(3));
  plant.B_F.conservativeResizeLike(Eigen::VectorXd::Zero(3));
  plant.state_names.emplace_back("i");
  return plant;
}

std::optional<BrokenRule> FirstOrder::validate() const { return not_zero("gain", gain); }

PlantModel FirstOrder::model() const { return TransferFunction{{gain}, {time_constant, 1.0}, delay}.model(); }

std::optional<BrokenRule> SecondOrder::validate() const { return not_zero("gain", gain); }

PlantModel SecondOrder::model() const {
  const double T = time_constant;
  return TransferFunction{{gain}, {T * T, 2.0 * damping_ratio * T, 1.0}, delay}.model();
}

std::optional<BrokenRule> TransferFunction::validate() const {
  if (std::ranges::all_of(denominator, [](double c) { return c == 0.0; }))
    return BrokenRule{"denominator", "must not be empty or zero"};
  if (std::ranges::all_of(numerator, [](double c) { return c == 0.0; }))
    return BrokenRule{"numerator", "must not be empty or zero"};
  return strictly_proper("numerator", [this] { return realise(numerator, denominator); });
}

PlantModel TransferFunction::model() const { return input_output_plant(realise(numerator, denominator), delay); }

std::optional<BrokenRule> ZeroPoleGain::validate() const {
  if (poles.empty()) return BrokenRule{"poles", "must not be empty"};
  if (auto broken = not_zero("gain", gain)) return broken;
  // Poles without a partner are an error of the poles, not of the zeros.
  try {
    realise_zpk({}, poles, gain);
  } catch (const std::invalid_argument& error) {
    return BrokenRule{"poles", error.what()};
  }
  return strictly_proper("zeros", [this] { return realise_zpk(zeros, poles, gain); });
}

PlantModel ZeroPoleGain::model() const { return input_output_plant(realise_zpk(zeros, poles, gain), delay); }

std::optional<BrokenRule> StateSpacePlant::validate() const {
  const auto n = A.rows();
  if (n == 0 || A.cols() != n) return BrokenRule{"A", "must be square and not empty"};
  if (B.rows() != n || B.cols() != 1) return BrokenRule{"B", "must be one column with as many rows as A"};
  if (C.cols() != n || C.rows() != 1) return BrokenRule{"C", "must be one row with as many columns as A"};
  if (D.size() > 1 || (D.size() == 1 && D(0, 0) != 0.0))
    return BrokenRule{"D", "must be zero: the plant must be strictly proper"};
  if (B_friction.size() != 0 && (B_friction.rows() != n || B_friction.cols() != 1))
    return BrokenRule{"B_friction", "must be one column with as many rows as A"};
  if (C_velocity.size() != 0 && (C_velocity.cols() != n || C_velocity.rows() != 1))
    return BrokenRule{"C_velocity", "must be one row with as many columns as A"};
  if (C_friction.size() == 0) return std::nullopt;
  if (C_friction.cols() != n || C_friction.rows() != 1)
    return BrokenRule{"C_friction", "must be one row with as many columns as A"};
  const Eigen::MatrixXd forces = both_forces(B, B_friction);
  const Eigen::RowVectorXd displacement = C_friction.row(0);
  if (C_velocity.size() == 0 && !is_rate_of(displacement * A, displacement, A, forces, typed))
    return BrokenRule{"C_friction", "must not be moved by a force at once: C_friction B and C_friction B_friction = 0"};
  if (C_velocity.size() != 0 && !is_rate_of(C_velocity.row(0), displacement, A, forces, typed))
    return BrokenRule{"C_friction",
                      "must have C_velocity as its rate: C_friction A = C_velocity, C_friction B and "
                      "C_friction B_friction = 0"};
  return std::nullopt;
}

PlantModel StateSpacePlant::model() const {
  PlantModel plant = input_output_plant({A, B, C, D}, 0.0);
  if (B_friction.size() != 0) plant.B_F = B_friction.col(0);
  if (C_friction.size() != 0) {
    plant.C_x = C_friction.row(0);
    plant.C_v = plant.C_x * A;
  }
  if (C_velocity.size() == 0) return plant;
  plant.C_v = C_velocity.row(0);
  if (C_friction.size() != 0) return plant;
  const Eigen::MatrixXd forces = both_forces(B, B_friction);
  if (!is_rate_of(plant.C_v, plant.C_y, A, forces, typed)) plant.C_x = integral_of(plant.C_v, A, forces);
  return plant;
}

bool end_delay(Plant& plant) {
  return std::visit(
      []<class P>(P& one) {
        if constexpr (requires { one.delay; })
          return std::exchange(one.delay, 0.0) != 0.0;
        else
          return false;
      },
      plant);
}

}  // namespace limcycle
