#pragma once
#include <string>

namespace limcycle {

/// Contents of a new case file: kinds as catalogue() names them.
struct NewCase {
  std::string plant = "mass", controller = "pid";
  std::string friction = "lugre";  ///< empty: none
  std::string element{}, error{};  ///< empty: none
  bool all = false;                ///< optional sections are active, not comments
  bool brief = false;              ///< optional keys and sections that are not active are left out
  bool sampled = false;            ///< the controller is sampled
};

/// A case file that can be run unchanged: every key with its unit, meaning, default and usual values, the optional ones
/// as comments. At most 80 columns, except for long lists. Throws std::invalid_argument for an unknown kind; the reader
/// of cases decides whether the parts fit together.
std::string new_case(const NewCase& wanted);

/// A commented case of a cascade as a diagram.
std::string new_diagram();

}  // namespace limcycle
