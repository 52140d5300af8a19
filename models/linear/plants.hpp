#pragma once
#include <memory>
#include <string>
#include <variant>

#include "limcycle/models/element/memoryless/gravity.hpp"
#include "limcycle/models/linear/plant_energy.hpp"
#include "limcycle/models/linear/plant_signals.hpp"
#include "limcycle/models/linear/state_space.hpp"
#include "limcycle/models/measured/measured_plant.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {

/// Linear part of a plant: dx/dt = A x + B_u u - B_F F, y = C_y x (delayed by `delay`), rubbing velocity
/// v = C_v x + v0, rubbing displacement C_x x. A plant without a friction port has empty B_F, C_v, C_x. A pendulum adds
/// - B_gravity gravity(C_gravity x) to dx/dt.
struct PlantModel {
  Eigen::MatrixXd A;
  Eigen::VectorXd B_u, B_F;
  Eigen::RowVectorXd C_y, C_v, C_x;
  double v0 = 0.0;
  double delay = 0.0;
  std::optional<Gravity<double>> gravity;
  Eigen::VectorXd B_gravity;
  Eigen::RowVectorXd C_gravity;
  std::vector<std::string> state_names;
  std::shared_ptr<const MeasuredResponse> measured{};  ///< whose fit this is; null: no plant known by measured data
};

/// Ports of a plant given by its input-output behaviour only: friction acts where u does, rubbing at y.
PlantModel input_output_plant(const StateSpace& g, double delay);

/// m dv/dt = u - stiffness y - damping v - F(v).
struct Mass {
  double mass{}, damping{0.0}, stiffness{0.0};
  static constexpr std::string_view kind = "mass";
  static constexpr PlantSignals signals = PlantSignals::lengths_and_forces;
  static constexpr std::string_view equation = "mass dv/dt = u - damping v - stiffness y - F(v), dy/dt = v";
  static std::vector<Parameter<Mass, double>> parameters() {
    return {{"mass", "kg", "mass", &Mass::mass, positive},
            {"damping", "N s/m", "viscous damping", &Mass::damping, any_number, false},
            {"stiffness", "N/m", "spring to ground", &Mass::stiffness, any_number, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  PlantModel model() const;
  PlantEnergy energy() const;
};

/// Two masses joined by a spring and a damper; u acts on the motor, friction rubs at the motor or the load.
struct TwoMass {
  double motor_mass{}, load_mass{}, stiffness{}, damping{0.0};
  Choice friction_on{}, measured{1};
  static constexpr std::string_view kind = "two-mass";
  static constexpr PlantSignals signals = PlantSignals::lengths_and_forces;
  static constexpr std::string_view equation =
      "motor_mass dv_m/dt = u - stiffness (y_m - y_l) - damping (v_m - v_l) [- F], "
      "load_mass dv_l/dt = stiffness (y_m - y_l) + damping (v_m - v_l) [- F]";
  static constexpr std::string_view sides[] = {"motor", "load"};
  static std::vector<Parameter<TwoMass, double>> parameters() {
    return {{"motor_mass", "kg", "mass on which u acts", &TwoMass::motor_mass, positive},
            {"load_mass", "kg", "mass behind the spring", &TwoMass::load_mass, positive},
            {"stiffness", "N/m", "spring between the masses", &TwoMass::stiffness, positive},
            {"damping", "N s/m", "damper between the masses", &TwoMass::damping, any_number, false},
            {"friction_on", "1", "which mass rubs", &TwoMass::friction_on, any_number, false, "", sides},
            {"measured", "1", "whose position is y", &TwoMass::measured, any_number, false, "", sides}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  PlantModel model() const;
  PlantEnergy energy() const;
};

/// Axis of a servo drive, with y the travel of the load: an angle, rad, or a length, m. The controller commands a
/// current u, A, and the closed current loop follows it as a lag. `ratio` is the turning of the motor per travel of the
/// load, rad/rad of a gear, rad/m of a screw or belt (2 pi/lead; 1/radius); inertias and friction act at the load:
///   (load + efficiency ratio^2 motor_inertia) dv/dt = efficiency ratio torque_constant i - damping v - F(v),
///   current_lag di/dt = u - i  (i = u without a lag).
/// For y in rad, load is kg m^2 and F is N m; for y in m, kg and N. The efficiency counts as while the motor drives the
/// load; where the load drives the motor the gear would lose more, which a linear plant does not show.
struct ServoDrive {
  double motor_inertia{}, load{}, ratio{1.0}, efficiency{1.0}, torque_constant{1.0}, damping{0.0}, current_lag{0.0};
  static constexpr std::string_view kind = "servo-drive";
  static constexpr std::string_view input_unit = "A";  ///< of u, and of a load, which is added to it
  static constexpr PlantSignals signals = PlantSignals::lengths_and_forces;
  static constexpr std::string_view equation =
      "(load + efficiency ratio^2 motor_inertia) dv/dt = efficiency ratio torque_constant i - damping v - F(v), "
      "current_lag di/dt = u - i, dy/dt = v";
  static std::vector<Parameter<ServoDrive, double>> parameters() {
    return {
        {"motor_inertia", "kg m^2", "of the motor, about its own axis", &ServoDrive::motor_inertia, positive},
        {"load", "kg", "moved mass, or moment of inertia (kg m^2) where y is an angle", &ServoDrive::load, positive},
        {"ratio", "rad/m", "turning of the motor per travel of the load", &ServoDrive::ratio, positive, false},
        {"efficiency", "1", "of the gear or screw", &ServoDrive::efficiency, {0.0, 1.0, true}, false},
        {"torque_constant", "N m/A", "torque per current", &ServoDrive::torque_constant, positive, false},
        {"damping", "N s/m", "viscous damping at the load", &ServoDrive::damping, any_number, false},
        {"current_lag", "s", "time constant of the current loop; 0: none", &ServoDrive::current_lag, not_negative,
         false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  PlantModel model() const;
  PlantEnergy energy() const;
  /// Mass, or moment of inertia, that moves with the load.
  double moved() const { return load + efficiency * ratio * ratio * motor_inertia; }
};

/// Mass on a belt that runs at `speed`: m dv/dt = u - k y - c v - F(v - speed).
struct Belt {
  double mass{}, stiffness{}, damping{0.0}, speed{};
  static constexpr std::string_view kind = "belt";
  static constexpr PlantSignals signals = PlantSignals::lengths_and_forces;
  static constexpr std::string_view equation = "mass dv/dt = u - stiffness y - damping v - F(v - speed), dy/dt = v";
  static std::vector<Parameter<Belt, double>> parameters() {
    return {{"mass", "kg", "mass", &Belt::mass, positive},
            {"stiffness", "N/m", "spring to ground", &Belt::stiffness, positive},
            {"damping", "N s/m", "viscous damping", &Belt::damping, any_number, false},
            {"speed", "m/s", "velocity of the belt", &Belt::speed, any_number}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  PlantModel model() const;
  PlantEnergy energy() const;
  static constexpr std::string_view surface_speed_key = "speed";
  double& surface_speed() { return speed; }
};

/// Froude pendulum: a pendulum hung by a sleeve on a shaft that turns at `shaft_speed`. y is the angle from hanging,
/// rad; u and a load are torques about the axis, N m. The friction law is the force F(v), N, at the surface of the
/// shaft for the velocity v = shaft_radius (dy/dt - shaft_speed) of the sleeve over it, and opposes v:
///   inertia d2y/dt2 = u - damping dy/dt - mass gravity arm sin y - shaft_radius F(v).
/// For an odd law, - shaft_radius F(v) = + shaft_radius F(shaft_radius (shaft_speed - dy/dt)): the shaft drives.
/// `inertia` is the total about the axis of the shaft (that about the centre of mass is inertia - mass arm^2).
/// A standard form (friction-driven pendulum, after W. Froude); Piatkowski and Wolski (2018), Mechanism and Machine
/// Theory 119, 37-50, use it with a fitted friction curve. Their own equations of motion were not available.
struct FroudePendulum {
  double mass{}, arm{}, inertia{}, damping{0.0}, shaft_radius{}, shaft_speed{}, gravity{9.81}, clearance{0.0};
  static constexpr std::string_view kind = "froude-pendulum";
  static constexpr PlantSignals signals = PlantSignals::angles_and_torques;
  static constexpr std::string_view equation =
      "inertia d2y/dt2 = u - damping dy/dt - mass gravity arm sin(y) - shaft_radius F(v), "
      "v = shaft_radius (dy/dt - shaft_speed)";
  static std::vector<Parameter<FroudePendulum, double>> parameters() {
    return {
        {"mass", "kg", "mass of the pendulum", &FroudePendulum::mass, positive},
        {"arm", "m", "from the axis to the centre of mass", &FroudePendulum::arm, positive},
        {"inertia", "kg m^2", "about the axis of the shaft", &FroudePendulum::inertia, positive},
        {"damping", "N m s", "viscous damping", &FroudePendulum::damping, any_number, false},
        {"shaft_radius", "m", "radius of the shaft", &FroudePendulum::shaft_radius, positive},
        {"shaft_speed", "rad/s", "angular velocity of the shaft", &FroudePendulum::shaft_speed, any_number},
        {"gravity", "m/s^2", "acceleration of gravity", &FroudePendulum::gravity, not_negative, false},
        {"clearance", "m", "radial play of the sleeve; 0 in a loop", &FroudePendulum::clearance, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  PlantModel model() const;
  PlantEnergy energy() const;
  static constexpr std::string_view surface_speed_key = "shaft_speed";
  double& surface_speed() { return shaft_speed; }
};

/// A lag with dead time, the usual model of a process: y = gain/(time_constant s + 1) exp(-delay s) u. No friction: a
/// force would move y at once.
struct FirstOrder {
  double gain{}, time_constant{}, delay{0.0};
  static constexpr std::string_view kind = "first-order";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation = "time_constant dy/dt + y = gain u(t - delay)";
  static std::vector<Parameter<FirstOrder, double>> parameters() {
    return {{"gain", "1", "y at rest for u = 1", &FirstOrder::gain},
            {"time_constant", "s", "time to 63 % of a step", &FirstOrder::time_constant, positive},
            {"delay", "s", "dead time", &FirstOrder::delay, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;
};

/// Second order with dead time, two lags in series or a resonance, friction acting as a negative u:
///   y = gain/(T^2 s^2 + 2 damping_ratio T s + 1) exp(-delay s) (u - F), T = time_constant.
/// Lags of T1 and T2 are T = sqrt(T1 T2), damping_ratio = (T1 + T2)/(2 T).
struct SecondOrder {
  double gain{}, time_constant{}, damping_ratio{}, delay{0.0};
  static constexpr std::string_view kind = "second-order";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation =
      "time_constant^2 d2y/dt2 + 2 damping_ratio time_constant dy/dt + y = gain (u(t - delay) - F)";
  static std::vector<Parameter<SecondOrder, double>> parameters() {
    return {{"gain", "1", "y at rest for u = 1", &SecondOrder::gain},
            {"time_constant", "s", "inverse of the natural frequency", &SecondOrder::time_constant, positive},
            {"damping_ratio", "1", "1: two equal lags; below: a resonance", &SecondOrder::damping_ratio, any_number},
            {"delay", "s", "dead time", &SecondOrder::delay, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;
};

/// y = numerator(s)/denominator(s) exp(-delay s) u, friction acting as a negative u. Friction needs relative degree 2.
struct TransferFunction {
  std::vector<double> numerator, denominator;
  double delay{0.0};
  static constexpr std::string_view kind = "transfer-function";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation =
      "y = numerator(s)/denominator(s) exp(-delay s) (u - F), highest power first";
  static std::vector<Parameter<TransferFunction, double>> parameters() {
    return {{"numerator", "1", "coefficients, highest power first", &TransferFunction::numerator},
            {"denominator", "1", "coefficients, highest power first", &TransferFunction::denominator},
            {"delay", "s", "dead time", &TransferFunction::delay, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;
};

/// y = gain prod(s - zeros)/prod(s - poles) exp(-delay s) u.
struct ZeroPoleGain {
  std::vector<std::complex<double>> zeros, poles;
  double gain{}, delay{0.0};
  static constexpr std::string_view kind = "zpk";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation = "y = gain prod(s - zeros)/prod(s - poles) exp(-delay s) (u - F)";
  static std::vector<Parameter<ZeroPoleGain, double>> parameters() {
    return {{"zeros", "1/s", "numbers or [re, im] pairs", &ZeroPoleGain::zeros},
            {"poles", "1/s", "numbers or [re, im] pairs", &ZeroPoleGain::poles},
            {"gain", "1", "factor", &ZeroPoleGain::gain},
            {"delay", "s", "dead time", &ZeroPoleGain::delay, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;
};

/// dx/dt = A x + B u - B_friction F, y = C x. The friction sees the rubbing velocity v = C_velocity x, by default d/dt
/// of the rubbing displacement C_friction x, and that by default y. With C_velocity alone the rubbing displacement is
/// the row c with c A = C_velocity, c B = c B_friction = 0 (to rounding). Where there is none, no state holds the
/// integral of v: the row of the model is then zero, and the frequency domain takes v/(jw).
struct StateSpacePlant {
  Eigen::MatrixXd A, B, C, D{Eigen::MatrixXd(0, 0)}, B_friction{Eigen::MatrixXd(0, 0)},
      C_velocity{Eigen::MatrixXd(0, 0)}, C_friction{Eigen::MatrixXd(0, 0)};
  static constexpr std::string_view kind = "state-space";
  static constexpr PlantSignals signals = PlantSignals::unknown;
  static constexpr std::string_view equation = "dx/dt = A x + B u - B_friction F, y = C x, v = C_velocity x";
  static std::vector<Parameter<StateSpacePlant, double>> parameters() {
    return {{"A", "1", "rows as lists", &StateSpacePlant::A},
            {"B", "1", "rows as lists", &StateSpacePlant::B},
            {"C", "1", "rows as lists", &StateSpacePlant::C},
            {"D", "1", "must be zero in a loop", &StateSpacePlant::D, any_number, false},
            {"B_friction", "1", "force column, default B", &StateSpacePlant::B_friction, any_number, false},
            {"C_velocity", "1", "row of the rubbing velocity, default d/dt of the rubbing displacement",
             &StateSpacePlant::C_velocity, any_number, false},
            {"C_friction", "1", "row of the rubbing displacement, default the integral of the rubbing velocity, or y",
             &StateSpacePlant::C_friction, any_number, false}};
  }
  std::optional<BrokenRule> validate() const;
  PlantModel model() const;
};

using Plant = std::variant<Mass, TwoMass, ServoDrive, Belt, FroudePendulum, FirstOrder, SecondOrder, TransferFunction,
                           ZeroPoleGain, StateSpacePlant, MeasuredPlant>;

/// Empty for a plant known by its input and output only.
std::optional<PlantEnergy> energy_of(const Plant& plant);

/// Takes the dead time of a plant away; false if it has none.
bool end_delay(Plant& plant);

inline PlantModel model_of(const Plant& plant) {
  return std::visit([](const auto& p) { return p.model(); }, plant);
}

}  // namespace limcycle
