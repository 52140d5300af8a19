#pragma once

#include <sstream>
#include <stdexcept>
#include <string_view>

namespace limcycle {

/// Throws std::invalid_argument: "who: what = value rule".
[[noreturn]] inline void refuse(std::string_view who, std::string_view what, double value, std::string_view rule) {
  std::ostringstream text;
  text.precision(17);
  text << who << ": " << what << " = " << value << " " << rule;
  throw std::invalid_argument(text.str());
}

}  // namespace limcycle
