#pragma once
#include <string>
#include <variant>

#include "limcycle/models/linear/state_space.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {

/// Linear part of a controller: dx/dt = A x + B e, u = C x + D e + D_rate de/dt.
struct ControllerModel {
  StateSpace ss;
  double D_rate = 0.0;
  std::vector<std::string> state_names;
};

/// Optional parts between any controller and the plant, in this order; 0 or infinity: absent.
struct Actuator {
  double friction_compensation{0.0};  ///< its size times sgn(v) is added to the command, N
  double saturation{infinite};        ///< the command is limited to +-saturation
  double lag{0.0};                    ///< time constant of a first-order actuator, s

  template <class Owner>
  static void append_table(std::vector<Parameter<Owner, double>>& table) {
    table.push_back({"friction_compensation", "N", "adds this times sgn(v) to the command; needs friction",
                     &Owner::friction_compensation, not_negative, false});
    table.push_back(
        {"saturation", "N", "limit of the command", &Owner::saturation, {0.0, infinite, true, false}, false});
    table.push_back({"lag", "s", "time constant of the actuator", &Owner::lag, not_negative, false});
  }
};

/// A controller on a computer: it reads y every `sample_time`, its output is held in between and comes out
/// `computation_delay` after the reading. sample_time 0: it is continuous, and has none of the others. Its equations
/// become differences by d/dt -> (1 - z^-1)/sample_time (backward Euler), a derivative over `velocity_window` samples.
struct Sampling {
  double sample_time{0.0}, computation_delay{0.0};  ///< s
  double input_step{0.0};                           ///< y is read in multiples of it
  double output_step{0.0};                          ///< the command comes in multiples of it
  double velocity_window{0.0};  ///< samples; 0: a cascade measures v, another takes its derivative over one
  Choice hold{};
  static constexpr std::string_view holds[] = {"zero-order"};

  bool is_on() const { return sample_time > 0.0; }
  /// The dead time that hold and computation amount to on average, s.
  double mean_delay() const { return 0.5 * sample_time + computation_delay; }
  /// The rule that these numbers break together.
  std::optional<BrokenRule> broken_together() const;

  template <class Owner>
  static void append_clock(std::vector<Parameter<Owner, double>>& table) {
    table.push_back({"sample_time", "s", "time between two readings of y; 0: continuous", &Owner::sample_time,
                     not_negative, false});
    table.push_back(
        {"computation_delay", "s", "from a reading to its command", &Owner::computation_delay, not_negative, false});
    table.push_back(
        {"input_step", "m", "y is read in multiples of it; 0: exactly", &Owner::input_step, not_negative, false});
    table.push_back({"output_step", "N", "the command comes in multiples of it; 0: exactly", &Owner::output_step,
                     not_negative, false});
  }
  template <class Owner>
  static void append_table(std::vector<Parameter<Owner, double>>& table) {
    append_clock(table);
    const bool measures = Owner::kind == std::string_view("cascade");
    table.push_back({"velocity_window", "1",
                     measures ? "samples over which the velocity is differenced; 0: measured"
                              : "samples over which the velocity is differenced; 0: one",
                     &Owner::velocity_window, not_negative, false});
    table.push_back({"hold", "1", "the command between two readings", &Owner::hold, any_number, false, "", holds});
  }
};

/// The sampling of a block of a diagram that is no controller by its kind.
struct BlockSampling : Sampling {
  static std::vector<Parameter<BlockSampling, double>> parameters() {
    std::vector<Parameter<BlockSampling, double>> table;
    append_clock(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return broken_together(); }
};

/// What any controller may have besides its equation.
struct ControllerParts : Sampling, Actuator {
  template <class Owner>
  static void append_table(std::vector<Parameter<Owner, double>>& table) {
    Sampling::append_table(table);
    Actuator::append_table(table);
  }
};

/// No controller: u = 0 with friction; u = e before a forward element.
struct NoController : ControllerParts {
  static constexpr std::string_view kind = "none";
  static constexpr std::string_view equation = "u = 0 with friction alone; u = e before an element";
  static std::vector<Parameter<NoController, double>> parameters() {
    std::vector<Parameter<NoController, double>> table;
    append_table(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  ControllerModel model() const;
};

/// u = kp e + ki I + kd de/dt, dI/dt = e - leak I, the derivative filtered by 1/(tf s + 1) when tf > 0. A leak bounds
/// what the integral can reach: ki/leak times a constant error. Three other ways to hold the integral back, one at a
/// time: ki I stops at +-integral_limit (see ClampedPi), or I grows only while |e| is within integral_band (see
/// Window), or only by what of e is beyond integral_dead_zone (see DeadZone), with integral_hysteresis by all of e,
/// once |e| has exceeded the sum of both, until it is within integral_dead_zone (see HystereticDeadZone), or the share
/// integral_reset of I is taken off where e changes sign, at the earliest reset_interval after the last time (see
/// ResetIntegrator), or with reset_speed where y stops beyond the set-point (see StopResetIntegrator). With `impulse`,
/// a body that has stopped with an error is pushed on (see Impulses).
struct Pid : ControllerParts {
  double kp{}, ki{0.0}, kd{0.0}, tf{0.0}, leak{0.0}, integral_limit{infinite}, integral_band{infinite},
      integral_dead_zone{0.0}, integral_hysteresis{0.0}, integral_reset{0.0}, reset_interval{0.0}, reset_speed{0.0},
      impulse{0.0}, impulse_width{0.0}, impulse_pause{0.0}, impulse_band{0.0}, impulse_speed{0.0};
  static constexpr std::string_view kind = "pid";
  static constexpr std::string_view equation =
      "u = kp e + ki I + kd de/dt, dI/dt = e - leak I; tf > 0: derivative filtered by 1/(tf s + 1)";
  static std::vector<Parameter<Pid, double>> parameters() {
    std::vector<Parameter<Pid, double>> table{
        {"kp", "N/m", "proportional gain", &Pid::kp, any_number},
        {"ki", "N/(m s)", "integral gain", &Pid::ki, any_number, false},
        {"kd", "N s/m", "derivative gain", &Pid::kd, any_number, false},
        {"tf", "s", "time constant of the derivative filter", &Pid::tf, not_negative, false},
        {"leak", "1/s", "rate at which the integral forgets", &Pid::leak, not_negative, false},
        {"integral_limit", "N", "where ki I stops", &Pid::integral_limit, {0.0, infinite, true, false}, false},
        {"integral_band",
         "m",
         "largest |e| at which I grows",
         &Pid::integral_band,
         {0.0, infinite, true, false},
         false},
        {"integral_dead_zone", "m", "largest |e| at which I holds", &Pid::integral_dead_zone, not_negative, false},
        {"integral_hysteresis", "m", "by which |e| must then exceed it for I to go on", &Pid::integral_hysteresis,
         not_negative, false},
        {"integral_reset",
         "1",
         "share of I that is taken off where e changes sign",
         &Pid::integral_reset,
         {0.0, 2.0},
         false},
        {"reset_interval", "s", "least time between two resets", &Pid::reset_interval, not_negative, false},
        {"reset_speed", "m/s", "resets where |dy/dt| falls to it beyond r, not where e changes sign", &Pid::reset_speed,
         not_negative, false},
        {"impulse", "N", "size of the impulses that push on a body stopped with an error", &Pid::impulse, not_negative,
         false},
        {"impulse_width", "s", "duration of an impulse", &Pid::impulse_width, not_negative, false},
        {"impulse_pause", "s", "least time between two impulses", &Pid::impulse_pause, not_negative, false},
        {"impulse_band", "m", "largest |e| without impulses", &Pid::impulse_band, not_negative, false},
        {"impulse_speed", "m/s", "|dy/dt| below which the body counts as stopped", &Pid::impulse_speed, not_negative,
         false}};
    append_table(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  /// True if the integral is no linear part: then the blocks of through_controller() make it.
  bool holds_integral_back() const { return !held_back_by().empty(); }
  /// The key that does it, the first of several; empty: none.
  std::string_view held_back_by() const;
  /// The rule that these numbers break together.
  std::optional<BrokenRule> broken_together() const;
  /// With the integral never held back, and without impulses.
  ControllerModel model() const;

 private:
  std::optional<BrokenRule> broken_impulses() const;
};

/// u = numerator(s)/denominator(s) e, proper.
struct TransferFunctionController : ControllerParts {
  std::vector<double> numerator, denominator;
  static constexpr std::string_view kind = "transfer-function";
  static constexpr std::string_view equation = "u = numerator(s)/denominator(s) e, highest power first";
  static std::vector<Parameter<TransferFunctionController, double>> parameters() {
    using Self = TransferFunctionController;
    std::vector<Parameter<Self, double>> table{
        {"numerator", "1", "coefficients, highest power first", &Self::numerator},
        {"denominator", "1", "coefficients, highest power first", &Self::denominator}};
    append_table(table);
    return table;
  }
  std::optional<BrokenRule> validate() const;
  ControllerModel model() const;
};

/// dx/dt = A x + B e, u = C x + D e.
struct StateSpaceController : ControllerParts {
  Eigen::MatrixXd A, B, C, D{Eigen::MatrixXd(0, 0)};
  static constexpr std::string_view kind = "state-space";
  static constexpr std::string_view equation = "dx/dt = A x + B e, u = C x + D e";
  static std::vector<Parameter<StateSpaceController, double>> parameters() {
    using Self = StateSpaceController;
    std::vector<Parameter<Self, double>> table{{"A", "1", "rows as lists", &Self::A},
                                               {"B", "1", "rows as lists", &Self::B},
                                               {"C", "1", "rows as lists", &Self::C},
                                               {"D", "1", "feed-through", &Self::D, any_number, false}};
    append_table(table);
    return table;
  }
  std::optional<BrokenRule> validate() const;
  ControllerModel model() const;
};

/// Cascade of a P or PI position loop around a PI velocity loop, with the derivative on the measured velocity v =
/// dy/dt:
///   w = position_kp e + position_ki int(e) + velocity_feedforward dr/dt   (the velocity commanded),
///   u = velocity_kp (w - v) + velocity_ki x,  limited to +-limit,
///   dx/dt = w - v + anti-windup;  back-calculation: (limited u - u)/velocity_kp, time constant
///   velocity_kp/velocity_ki;  clamp: dx/dt = 0 while u is beyond the limit and w - v has its sign (see ClampedPi).
/// On a computer the velocity loop runs at every sample, the position loop at each `position_every`th.
/// acceleration_feedforward multiplies d2r/dt2, which is zero for a constant reference and for a ramp.
/// Back-calculation: Astrom and Hagglund (1995), PID Controllers, ch. 3.5.
struct Cascade : ControllerParts {
  double position_kp{}, position_ki{0.0}, velocity_kp{}, velocity_ki{0.0}, velocity_feedforward{0.0},
      acceleration_feedforward{0.0}, limit{infinite}, position_every{1.0};
  Choice anti_windup{};
  static constexpr std::string_view kind = "cascade";
  static constexpr std::string_view equation =
      "w = position_kp e + position_ki int(e) + velocity_feedforward dr/dt;  u = velocity_kp (w - v) + velocity_ki x, "
      "limited to +-limit;  dx/dt = w - v, with back-calculation + (limited u - u)/velocity_kp, with clamp 0 where it "
      "would push further beyond the limit;  v = dy/dt";
  static constexpr std::string_view ways[] = {"none", "clamp", "back-calculation"};
  static constexpr int clamp = 1, back_calculation = 2;
  static std::vector<Parameter<Cascade, double>> parameters() {
    std::vector<Parameter<Cascade, double>> table{
        {"position_kp", "1/s", "proportional gain of the position loop", &Cascade::position_kp, any_number},
        {"position_ki", "1/s^2", "integral gain of the position loop", &Cascade::position_ki, any_number, false},
        {"velocity_kp", "N s/m", "proportional gain of the velocity loop", &Cascade::velocity_kp, any_number},
        {"velocity_ki", "N/m", "integral gain of the velocity loop", &Cascade::velocity_ki, any_number, false},
        {"velocity_feedforward", "1", "share of dr/dt in the velocity commanded", &Cascade::velocity_feedforward,
         any_number, false},
        {"acceleration_feedforward", "N s^2/m", "force for d2r/dt2", &Cascade::acceleration_feedforward, any_number,
         false},
        {"limit", "N", "limit of the command", &Cascade::limit, {0.0, infinite, true, false}, false},
        {"position_every",
         "1",
         "samples from one run of the position loop to the next",
         &Cascade::position_every,
         {1.0, infinite},
         false},
        {"anti_windup", "1", "what the integral does at the limit", &Cascade::anti_windup, any_number, false, "",
         ways}};
    append_table(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  /// The rule that the way against wind-up breaks with the other numbers.
  std::optional<BrokenRule> broken_together() const;
  /// The position loop, from e to w; the velocity loop reads v too: see through_cascade().
  ControllerModel model() const;
  int states() const { return (position_ki != 0.0 ? 1 : 0) + (velocity_ki != 0.0 ? 1 : 0); }
};

using Controller = std::variant<NoController, Pid, TransferFunctionController, StateSpaceController, Cascade>;

inline ControllerModel model_of(const Controller& controller) {
  return std::visit([](const auto& c) { return c.model(); }, controller);
}
inline const ControllerParts& parts_of(const Controller& controller) {
  return std::visit([](const auto& c) -> const ControllerParts& { return c; }, controller);
}
inline const Actuator& actuator_of(const Controller& controller) { return parts_of(controller); }
inline const Sampling& sampling_of(const Controller& controller) { return parts_of(controller); }

}  // namespace limcycle
