#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// An external signal of time: value(t) = offset + ... by kind.
struct Signal {
  enum class Kind { constant, step, ramp, sine, zigzag, table } kind = Kind::constant;
  double value = 0.0;                     ///< constant: value; step: height; sine, zigzag: amplitude
  double start = 0.0;                     ///< s; zero before (step, ramp, sine, zigzag)
  double rate = 0.0;                      ///< ramp: slope, 1/s; zigzag: slope of its flanks
  double frequency = 0.0;                 ///< sine: rad/s
  std::vector<double> times{}, values{};  ///< table: piecewise linear, constant beyond its ends

  double at(double t) const;
  double slope(double t) const;                    ///< right-hand derivative; 0 at the jump of a step
  std::vector<double> breaks(double until) const;  ///< times at which value or slope jumps, in (0, until)
};

/// Options of a run in time: duration, initial states, signals, accuracy.
struct SimulateOptions {
  double duration = 0.0;                  ///< s, > 0
  std::map<std::string, double> initial;  ///< by state name; states not named start at 0
  std::optional<Signal> force;            ///< added to the load
  std::optional<Signal> reference;        ///< replaces the loop's reference
  std::string stepper = "auto";           ///< auto, rodas5p, dopri5, fehlberg78, cash-karp54
  double rtol = 1e-7;
  double sample = 0.0;  ///< output interval, s; 0: duration/1000
  /// A dead time that is not exact is approximated to 1e-9 up to this frequency times itself, rad.
  double delay_band = 20.0;
  std::function<bool()> stop;
  std::function<void(double)> progress;  ///< fraction done
  /// Called after every step, with the field as it is then, and the modes in which the step was made.
  std::function<void(LoopField&, March&, const std::vector<Mode>& modes)> watch;
};

/// A run in time: samples, events and outcome.
struct Simulation {
  std::vector<std::string>
      columns;  ///< "t", state names, then "y", "dy_dt", and per element "<path>.input", "<path>.output"
  std::vector<std::vector<double>> rows;
  struct Event {
    double t;
    std::string what;
  };
  std::vector<Event> events;  ///< located switches
  /// Outcome of the motion by the end of the run, recognised as in run_ensemble; undecided also under a force or
  /// reference that varies in time.
  Outcome outcome = Outcome::undecided;
  double period = 0.0, amplitude = 0.0;  ///< of a cycle: s, half the swing of y; else 0
  Trace trace;                           ///< t, y and rate after every step
  std::string stepper;                   ///< the one used
  Status status = Status::converged;
  std::string why;
  std::vector<std::string> notes;  ///< notes for the user, as sentences
  long steps = 0;
};

/// Share by which the swings and the period of a run's cycle may still change.
inline constexpr double cycle_accuracy = 1e-4;

/// Time-domain run with located events. Where a reference jumps by h, an ideal derivative (kd without a filter) makes
/// an impulse of it, which changes the states by h times the column of dr/dt; a limited command passes none of it on. A
/// dead time is exact behind a relay, else a Pade approximation (see in_time_domain); before t = 0 the loop stood as it
/// starts. Throws std::invalid_argument for an unknown state or stepper name.
Simulation simulate(const Loop& loop, const SimulateOptions& options);

/// Names of all states in the order of LoopState: linear states, then "z" of the friction law (z1, z2, ... if it has
/// several), and "z_element" of a forward element, "z_" and the last word of its path of any other. No two states have
/// one name.
std::vector<std::string> state_names(const Loop& loop);
/// The values of those states in a state of the loop (see Loop::own_states), and the state that has these values.
State own_values(const Loop& loop, State x);
State state_of(const Loop& loop, State values);

}  // namespace limcycle
