#pragma once
#include <string>

namespace limcycle {

/// "PATH=FROM:TO" of a flag.
struct ParameterRange {
  std::string path;
  double from = 0.0, to = 0.0;
};

/// Throws InputError quoting the text if it is not of that form, a number is not finite, or the ends are equal.
ParameterRange parameter_range(const std::string& flag, const std::string& text);

}  // namespace limcycle
