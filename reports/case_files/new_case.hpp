#pragma once
#include <string>

namespace limcycle {

/// What a new case file is to hold: kinds as catalogue() names them.
struct NewCase {
  std::string plant = "mass", controller = "pid";
  std::string friction = "lugre";  ///< empty: none
  std::string element{}, error{};  ///< empty: none
  bool all = false;                ///< the optional sections as they are, not as comments
};

/// A case file that can be run as it is: every key with its unit, its meaning, its default and what is usual, the
/// optional ones as comments. At most 80 columns, but for long lists. Throws std::invalid_argument for a kind that
/// there is not; whether the parts fit together is for the reader of cases to say.
std::string new_case(const NewCase& wanted);

}  // namespace limcycle
