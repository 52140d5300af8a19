#pragma once
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// Numbers that are changed together, in proportion: names, or paths, and the values that they would have.
using Toward = std::vector<std::pair<std::string, double>>;

/// What is wanted of margins. Names: how the arguments are called in messages.
struct MarginWishes {
  std::vector<std::string> paths;  ///< of single numbers; empty, and nothing in `toward`: all that a factor can change
  std::vector<Toward>
      toward;            ///< each as one parameter: 1 for the own numbers, 2 for those given, and the line through
  double factor = 10.0;  ///< up and down
  struct Names {
    std::string paths = "parameters", toward = "toward";
  } names{};
};

/// The numbers that are wanted. Throws InputError for one that is unknown, absent, or changed by no factor, and for a
/// line that changes nothing or leads to values that are not valid together. What is left out goes into `notes`.
std::vector<MarginParameter> margin_parameters(const Case& from, const MarginWishes& wishes,
                                               std::vector<std::string>& notes);

/// How far they are, up to the factor up and down, from where hunting begins or ends. A note gives the numbers at the
/// nearest change along each line. Throws as margin_parameters(), and std::invalid_argument if the numbers are valid
/// but too extreme for a method.
MarginReport ask_margin(const Case& from, const MarginWishes& wishes, const Asking& asking);

}  // namespace limcycle
