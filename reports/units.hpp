#pragma once
#include <string>

namespace limcycle {

/// Units to print. They follow the case: metres and newtons for a servo or a belt, rad and N m where that is stated,
/// none for a loop of bare transfer functions.
struct Units {
  std::string y = "m";          ///< of the measured output; empty: none
  std::string force = "N";      ///< of the element's output
  std::string input = y;        ///< of the element's input: metres of rubbing on a pendulum, whose y is an angle
  std::string command = force;  ///< of the plant's input and of a load on it: A for a drive
  double y_per_si = 1.0;        ///< what y is multiplied by to be in its unit: see in_units()

  /// "0.0639 m", or the bare number where there is no unit.
  static std::string attach(const std::string& number, const std::string& unit) {
    return unit.empty() ? number : number + " " + unit;
  }
};

}  // namespace limcycle
