#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/loop.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// One line of a block: words, or the bar of a fraction.
struct BlockLine {
  std::string words;
  bool centred = false;  ///< of a fraction; else it begins at the left
  bool bar = false;
};

/// What stands in a block of the diagram of a loop.
struct BlockWords {
  std::string title;             ///< "controller: pid", as the case file names it
  std::vector<BlockLine> lines;  ///< numbers to six digits; what is long is shortened by an ellipsis
  std::string whole;             ///< kind and all numbers in full: "pid (kp = 3 N/m, kd = 6 N s/m)"
  std::string equation;          ///< as the list of laws has it
};

/// Numbers that are what they are by default are left out. Units stand where the loop has any; times and rates always
/// have theirs.
BlockWords plant_words(const Plant& plant, const Units& units);
/// The controller without what stands between it and the plant; empty for `none`.
std::optional<BlockWords> controller_words(const Controller& controller, const Units& units);
/// `role`: "friction", "element", "on the error".
BlockWords element_words(const std::string& role, const Element<double>& element, const Units& units);
BlockWords compensation_words(double level, const Units& units);
BlockWords limit_words(double limit, const Units& units);
BlockWords lag_words(double time_constant);

/// Signals from outside and between the blocks: "r = 0 m", "load = 2 N", "v = dy/dt − 0.1" (what the law rubs at).
std::string reference_words(const LoopParts& parts, const Units& units);
std::string load_words(const LoopParts& parts, const Units& units);
std::string rubbing_velocity(const Plant& plant);

/// A number to six digits with a true minus sign, "1e5" for 1e+05.
std::string diagram_number(double value);

/// Coefficients, highest power first: "s³ + 2 s² - 0.5".
std::string polynomial_in_s(const std::vector<double>& coefficients);

/// The terms of a sum put on lines of at most `columns`; of more than `most` lines the last one ends in an ellipsis.
std::vector<std::string> broken_sum(const std::string& sum, std::size_t columns, std::size_t most);

}  // namespace limcycle
