#pragma once
#include <cstdio>
#include <string>

namespace limcycle {

/// A number in a sentence, with `digits` (up to 17) significant ones.
inline std::string short_number(double value, int digits = 4) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// The value with that many significant digits, as a person would set it.
inline double rounded_to(double value, int digits) { return std::stod(short_number(value, digits)); }

}  // namespace limcycle
