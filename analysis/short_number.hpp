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

}  // namespace limcycle
