#pragma once
#include <optional>
#include <string>

#include "limcycle/analysis/study/dissipativity.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// What dissipativity() is to use instead of the values of the case.
struct DissipativityWishes {
  double speed = 0.0, top_speed = 0.0;  ///< m/s; 0: of the case
  std::string path;                     ///< of a number of the element whose values are searched; empty: none
  double from = 0.0, to = 0.0;          ///< its range
  std::string argument = "parameter";   ///< name of path and range in errors
};

/// Flags of the program that wish the same.
std::string flags_of(const DissipativityWishes& wishes);

/// Boundedness and passivity of the case's element, and what follows for its loop. Throws InputError if there is no
/// such element or number, std::invalid_argument if the numbers are valid but too extreme for a method.
DissipativityReport ask_dissipativity(const Case& from, const DissipativityWishes& wishes, const Asking& asking);

}  // namespace limcycle
