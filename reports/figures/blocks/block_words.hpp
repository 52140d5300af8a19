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

/// Texts of a block in the diagram of a loop.
struct BlockWords {
  std::string title;             ///< "controller: pid", as in the case file
  std::vector<BlockLine> lines;  ///< numbers to six digits; long ones are shortened by an ellipsis
  std::string whole;             ///< kind and all numbers in full: "pid (kp = 3 N/m, kd = 6 N s/m)"
  std::string equation;          ///< as in the list of laws
};

/// Default values are left out. Units are shown if the loop has any; times and rates always have theirs.
BlockWords plant_words(const Plant& plant, const Units& units);
/// The controller without the parts between it and the plant; empty for `none`.
std::optional<BlockWords> controller_words(const Controller& controller, const Units& units);
/// `role`: "friction", "element", "on the error".
BlockWords element_words(const std::string& role, const Element& element, const Units& units);
/// Any block of a diagram; its title is its name and its kind.
BlockWords words_of_block(const Block& block, const Units& units);
BlockWords compensation_words(double level, const Units& units);
BlockWords limit_words(double limit, const Units& units);
BlockWords lag_words(double time_constant);

/// External signals and those between the blocks: "r = 0 m", "load = 2 N", "v = dy/dt − 0.1" (rubbing velocity).
std::string reference_words(const LoopParts& parts, const Units& units);
std::string load_words(const LoopParts& parts, const Units& units);
std::string rubbing_velocity(const Plant& plant);

/// A number to six digits with a true minus sign, "1e5" for 1e+05.
std::string diagram_number(double value);

/// Coefficients, highest power first: "s³ + 2 s² - 0.5".
std::string polynomial_in_s(const std::vector<double>& coefficients);

/// The terms of a sum on lines of at most `columns`; with more than `most` lines the last one ends in an ellipsis.
std::vector<std::string> broken_sum(const std::string& sum, std::size_t columns, std::size_t most);

}  // namespace limcycle
