#include "limcycle/reports/case_files/typical_values.hpp"

#include <array>

namespace limcycle {
namespace {

struct TypicalRow {
  std::string_view group, kind, key;  // an empty group or kind matches any
  TypicalValue typical;
};

constexpr auto stops_k = "[1000.0, 1800.0, 2600.0, 3400.0, 4200.0, 5000.0, 5800.0, 6600.0]";
constexpr auto stops_w = "[0.18, 0.182, 0.184, 0.186, 0.188, 0.19, 0.192, 0.198]";
constexpr auto shares = "[0.12, 0.122, 0.124, 0.125, 0.125, 0.126, 0.128, 0.13]";

// The first row that matches counts: rows of one kind precede those of any.
constexpr std::array typical_rows{
    TypicalRow{"friction", "bouc-wen", "alpha", {"", "0 to 0.1: the share of a spring"}},
    TypicalRow{"friction", "bouc-wen", "k", {"1e5", "1e4 to 1e8"}},
    TypicalRow{"friction", "bouc-wen", "D", {"1.5e-5", "1e-6 to 1e-3: force over k"}},
    TypicalRow{"friction", "bouc-wen", "beta", {"0.5", "0 to 1"}},
    TypicalRow{"friction", "bouc-wen", "gamma", {"0.5", "0 to 1"}},
    TypicalRow{"friction", "iwan", "curve", {"\"koizumi-shibazaki\"", ""}},
    TypicalRow{"friction", "iwan", "Zb", {"1e-3", "1e-6 to 1e-2"}},
    TypicalRow{"friction", "jenkins", "k", {"1500.0", "1e3 to 1e8"}},
    TypicalRow{"friction", "jenkins", "Fc", {"1.5", "0.1 to 1000"}},
    TypicalRow{"friction", "dahl", "Fc", {"1.5", "0.1 to 1000"}},
    TypicalRow{"friction", "", "k", {stops_k, "1e3 to 1e8"}},
    TypicalRow{"friction", "", "W", {stops_w, "their sum is the break-away force"}},
    TypicalRow{"friction", "", "alpha", {shares, ""}},
    TypicalRow{"friction", "", "C", {"10.0", "0.1 to 1000"}},
    TypicalRow{"friction", "xiong", "K", {stops_k, "1e3 to 1e8"}},
    TypicalRow{"friction", "xiong", "sigma", {"[5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 22.5]", "1 to 1000"}},
    TypicalRow{"friction", "xiong", "lambda", {shares, ""}},
    TypicalRow{"friction", "kikuuwe", "K", {"1e5", "1e4 to 1e8"}},
    TypicalRow{"friction", "kikuuwe", "B", {"316.2", "sqrt(K mass)"}},
    TypicalRow{"friction", "non-drift", "sigma", {"316.2", "sqrt(stiffness mass)"}},
    TypicalRow{"friction", "non-drift", "Zb", {"1e-3", "1e-6 to 1e-2"}},
    TypicalRow{"friction", "two-state", "s", {"1e-3", "1e-6 to 1e-2"}},
    TypicalRow{"friction", "", "tau", {"0.002", "1e-4 to 0.1"}},
    TypicalRow{"friction", "", "Fs", {"1.5", "0.1 to 1000: the force at which it starts"}},
    TypicalRow{"friction", "", "Fc", {"1.0", "0.3 Fs to Fs: the force of slow sliding"}},
    TypicalRow{"friction", "", "vs", {"0.001", "1e-4 to 0.1"}},
    TypicalRow{"friction", "", "dv", {"1e-5", "vs/1000 to vs/10"}},
    TypicalRow{"friction", "", "ks", {"1e5", "1e4 to 1e8"}},
    TypicalRow{"friction", "", "sigma0", {"1e5", "Fs over the way before sliding: 1e4 to 1e8"}},
    TypicalRow{"friction", "lugre", "sigma1", {"316.22776601683796", "up to 2 sqrt(sigma0 mass)"}},
    TypicalRow{"friction", "lugre-table", "sigma1", {"316.22776601683796", "up to 2 sqrt(sigma0 mass)"}},
    TypicalRow{"friction", "lugre-spline", "sigma1", {"316.22776601683796", "up to 2 sqrt(sigma0 mass)"}},
    TypicalRow{"friction", "elasto-plastic", "sigma1", {"316.22776601683796", "up to 2 sqrt(sigma0 mass)"}},
    TypicalRow{"friction", "", "sigma2", {"0.4", "0 to 100"}},
    TypicalRow{
        "friction", "", "velocity", {"[0.0, 0.0005, 0.001, 0.0015, 0.003, 0.005]", "to the end of the Stribeck curve"}},
    TypicalRow{"friction", "", "velocities", {"[0.0005, 0.001, 0.0015, 0.003, 0.005]", "measured, ascending"}},
    TypicalRow{"friction", "", "forces", {"[1.39, 1.18, 1.05, 1.0, 1.0]", "friction at these speeds"}},
    TypicalRow{"friction", "", "coefficients", {"[1.5, 1.49, 1.4, 1.28, 1.1, 1.02, 1.0, 1.0]", "0.1 to 1000"}},

    TypicalRow{"element", "relay", "level", {"5.0", "the actuator's output when on"}},
    TypicalRow{"element", "saturation", "limit", {"5.0", "the actuator's largest output"}},
    TypicalRow{"element", "rate-limit", "limit", {"50.0", "the actuator's largest rate"}},
    TypicalRow{"element", "rate-limit", "tau", {"0.01", "the actuator's time constant"}},
    TypicalRow{"element", "dead-zone", "half_width", {"0.1", "0.1 to 10 % of the largest input"}},
    TypicalRow{"element", "hysteretic-dead-zone", "half_width", {"0.1", "0.1 to 10 % of the largest input"}},
    TypicalRow{"element", "hysteretic-dead-zone", "hysteresis", {"0.1", "half_width"}},
    TypicalRow{"element", "backlash", "half_gap", {"0.1", "0.1 to 10 % of the largest input"}},
    TypicalRow{"element", "valve-stiction", "S", {"0.1", "1 to 10 % of the travel"}},
    TypicalRow{"element", "valve-stiction", "J", {"0.05", "0 to S"}},
    TypicalRow{"element", "sine", "amplitude", {"1.0", "of the output"}},
    TypicalRow{"element", "sine", "period", {"6.283185307179586", "of the input: a turn"}},
    TypicalRow{"element", "lookup", "inputs", {"[0.0, 1.0, 3.0]", "ascending; from 0: odd"}},
    TypicalRow{"element", "lookup", "outputs", {"[0.0, 2.0, 3.0]", "at these inputs"}},
    TypicalRow{"element", "clamped-pi", "ki", {"1.0", ""}},
    TypicalRow{"element", "clamped-pi", "limit", {"5.0", "the largest output"}},
    TypicalRow{"element", "reset-integrator", "gain", {"1.0", ""}},
    TypicalRow{"element", "stop-reset-integrator", "gain", {"1.0", ""}},
    TypicalRow{"element", "stop-reset-integrator", "speed", {"0.001", "what the sensor can tell from rest"}},
    TypicalRow{"element", "impulses", "force", {"2.0", "above Fs"}},
    TypicalRow{"element", "impulses", "width", {"0.02", "a hundredth of the settling time"}},
    TypicalRow{"element", "impulses", "pause", {"0.5", "until the body has stopped again"}},
    TypicalRow{"element", "impulses", "band", {"0.01", "the error that may stay"}},
    TypicalRow{"element", "impulses", "speed", {"0.001", "what the sensor can tell from rest"}},
    TypicalRow{"element", "window", "half_width", {"1.0", "the largest input that passes"}},
    TypicalRow{"element", "cubic", "coefficient", {"1.0", ""}},
    TypicalRow{"error element", "quantizer", "step", {"0.001", "the resolution of the sensor"}},
    TypicalRow{"error element", "dead-zone", "half_width", {"0.001", "the error that may stay"}},
    TypicalRow{"error element", "saturation", "limit", {"1.0", ""}},

    TypicalRow{"lone plant", "mass", "damping", {"1.0", "0 to 100"}},
    TypicalRow{"lone plant", "mass", "stiffness", {"1.0", "0 to 1e6"}},
    TypicalRow{"lone plant", "transfer-function", "denominator", {"[1.0, 3.0, 3.0, 1.0]", "here 1/(s + 1)^3"}},
    TypicalRow{"lone plant", "zpk", "poles", {"[-1.0, -1.0, -1.0]", "here 1/(s + 1)^3"}},
    TypicalRow{"lone plant",
               "state-space",
               "A",
               {"[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, -3.0, -3.0]]", "here 1/(s + 1)^3"}},
    TypicalRow{"lone plant", "state-space", "B_friction", {"[[0.0], [0.0], [1.0]]", "", true}},
    TypicalRow{"lone plant", "state-space", "C_velocity", {"[[0.0, 1.0, 0.0]]", "", true}},
    TypicalRow{"lone plant", "state-space", "C_friction", {"[[1.0, 0.0, 0.0]]", "", true}},
    TypicalRow{"lone plant", "state-space", "B", {"[[0.0], [0.0], [1.0]]", ""}},
    TypicalRow{"lone plant", "state-space", "C", {"[[1.0, 0.0, 0.0]]", ""}},
    TypicalRow{"plant", "mass", "mass", {"1.0", "0.1 to 1000"}},
    TypicalRow{"plant", "two-mass", "motor_mass", {"0.5", "0.1 to 1000"}},
    TypicalRow{"plant", "two-mass", "load_mass", {"0.5", "0.1 to 1000"}},
    TypicalRow{"plant", "two-mass", "stiffness", {"200.0", "reduced mass times (resonance in rad/s)^2"}},
    TypicalRow{"plant", "two-mass", "damping", {"1.0", "0 to 2 sqrt(stiffness mass)"}},
    TypicalRow{"plant", "belt", "mass", {"1.0", "0.1 to 1000"}},
    TypicalRow{"plant", "belt", "stiffness", {"2.0", "1 to 1e6"}},
    TypicalRow{"plant", "belt", "speed", {"0.1", "0.001 to 10"}},
    TypicalRow{"plant", "servo-drive", "motor_inertia", {"1e-4", "1e-6 to 0.1"}},
    TypicalRow{"plant", "servo-drive", "load", {"10.0", "mass; where y is an angle, moment of inertia"}},
    TypicalRow{"plant", "servo-drive", "ratio", {"628.3", "2 pi/lead of a screw; here 10 mm"}},
    TypicalRow{"plant", "servo-drive", "torque_constant", {"0.1", "0.01 to 2"}},
    TypicalRow{"plant", "froude-pendulum", "mass", {"5.0", "0.1 to 10"}},
    TypicalRow{"plant", "froude-pendulum", "arm", {"0.2", "0.1 to 1"}},
    TypicalRow{"plant", "froude-pendulum", "inertia", {"0.25", "more than mass arm^2"}},
    TypicalRow{"plant", "froude-pendulum", "shaft_radius", {"0.02", "0.005 to 0.1"}},
    TypicalRow{"plant", "froude-pendulum", "shaft_speed", {"4.0", "0.1 to 100"}},
    TypicalRow{"plant", "first-order", "gain", {"1.0", ""}},
    TypicalRow{"plant", "first-order", "time_constant", {"1.0", ""}},
    TypicalRow{"plant", "first-order", "delay", {"0.5", "0.1 to 2 time constants"}},
    TypicalRow{"plant", "second-order", "gain", {"1.0", ""}},
    TypicalRow{"plant", "second-order", "time_constant", {"1.0", "1/(natural frequency in rad/s)"}},
    TypicalRow{"plant", "second-order", "damping_ratio", {"0.2", "1: two equal lags; below: a resonance"}},
    TypicalRow{"plant", "transfer-function", "numerator", {"[1.0]", ""}},
    TypicalRow{"plant", "transfer-function", "denominator", {"[1.0, 0.4, 0.0]", "here 1/(s (s + 0.4))"}},
    TypicalRow{"plant", "zpk", "zeros", {"[]", ""}},
    TypicalRow{"plant", "zpk", "poles", {"[0.0, -0.4]", "here 1/(s (s + 0.4))"}},
    TypicalRow{"plant", "zpk", "gain", {"1.0", ""}},
    TypicalRow{"plant", "state-space", "A", {"[[0.0, 1.0], [0.0, -0.4]]", "here 1/(s (s + 0.4))"}},
    TypicalRow{"plant", "state-space", "D", {"[[0.0]]", "", true}},
    TypicalRow{"plant", "state-space", "B_friction", {"[[0.0], [1.0]]", "", true}},
    TypicalRow{"plant", "state-space", "C_velocity", {"[[0.0, 1.0]]", "", true}},
    TypicalRow{"plant", "state-space", "C_friction", {"[[1.0, 0.0]]", "", true}},
    TypicalRow{"plant", "state-space", "B", {"[[0.0], [1.0]]", ""}},
    TypicalRow{"plant", "state-space", "C", {"[[1.0, 0.0]]", ""}},

    TypicalRow{"sampled controller", "", "sample_time", {"0.01", "a tenth of the shortest time that counts"}},
    TypicalRow{"sampled controller", "", "computation_delay", {"0.005", "0 to sample_time"}},
    TypicalRow{"sampled controller", "", "input_step", {"1e-6", "a count of the encoder"}},
    TypicalRow{"sampled controller", "cascade", "velocity_window", {"1.0", "1 to 10"}},
    TypicalRow{"sampled controller", "cascade", "position_every", {"4.0", "1 to 10"}},
    TypicalRow{"controller", "", "saturation", {"10.0", "", true}},
    TypicalRow{"guarded controller", "pid", "tf", {"0.01", "a tenth of the fastest time that counts"}},
    TypicalRow{"guarded controller", "", "lag", {"0.005", "what the actuator needs to follow"}},
    TypicalRow{"controller", "pid", "kp", {"3.0", "mass (bandwidth in rad/s)^2"}},
    TypicalRow{"controller", "pid", "ki", {"4.0", "0 to kp kd/mass"}},
    TypicalRow{"controller", "pid", "integral_limit", {"1.0", "below Fs", true}},
    TypicalRow{"controller", "pid", "integral_band", {"0.01", "", true}},
    TypicalRow{"controller", "pid", "integral_reset", {"1.0", "0 to 2", true}},
    TypicalRow{"controller", "pid", "kd", {"6.0", "2 sqrt(kp mass)"}},
    TypicalRow{"controller", "cascade", "position_kp", {"1.0", "a third of the velocity loop's bandwidth in rad/s"}},
    TypicalRow{"controller", "cascade", "velocity_kp", {"6.0", "mass (bandwidth in rad/s)"}},
    TypicalRow{"controller", "cascade", "velocity_ki", {"4.0", "0 to velocity_kp position_kp"}},
    TypicalRow{"controller", "cascade", "limit", {"10.0", "", true}},
    TypicalRow{"controller", "transfer-function", "numerator", {"[6.0, 3.0, 4.0]", "here the PID of 3, 4 and 6"}},
    TypicalRow{"controller", "transfer-function", "denominator", {"[0.01, 1.0, 0.0]", "here with a filter of 0.01 s"}},
    TypicalRow{"controller", "state-space", "A", {"[[0.0, 0.0], [0.0, -100.0]]", "here the PID of 3, 4 and 6"}},
    TypicalRow{"controller", "state-space", "B", {"[[1.0], [1.0]]", ""}},
    TypicalRow{"controller", "state-space", "C", {"[[4.0, -59704.0]]", ""}},
    TypicalRow{"controller", "state-space", "D", {"[[600.0]]", ""}},
};

}  // namespace

TypicalValue typical_value(std::string_view group, std::string_view kind, std::string_view key) {
  for (const TypicalRow& row : typical_rows)
    if (row.group == group && row.key == key && (row.kind.empty() || row.kind == kind)) return row.typical;
  if (group == "plant behind a valve") return key == "delay" ? TypicalValue{} : typical_value("lone plant", kind, key);
  if (group == "lone plant") return typical_value("plant", kind, key);
  const bool special = group == "guarded controller" || group == "sampled controller";
  return special ? typical_value("controller", kind, key) : TypicalValue{};
}

}  // namespace limcycle
