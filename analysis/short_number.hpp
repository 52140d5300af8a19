#pragma once
#include <cstdio>
#include <string>

namespace limcycle {

/// A number in a sentence: four digits.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace limcycle
