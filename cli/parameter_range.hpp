#pragma once
#include <string>

#include "limcycle/analysis/study/map/hunting_map.hpp"

namespace limcycle {

/// "PATH=FROM:TO" of a flag.
struct ParameterRange {
  std::string path;
  double from = 0.0, to = 0.0;
};

/// Throws InputError quoting the text if it is not of that form, a number is not finite, or the ends are equal.
ParameterRange parameter_range(const std::string& flag, const std::string& text);

/// "PATH=FROM:TO:N" or "PATH=FROM:TO:N:log" of a flag: one side of a map. Throws InputError likewise; N is 2 to 10000,
/// and both ends of a logarithmic side have the same sign.
MapAxis map_axis(const std::string& flag, const std::string& text);

}  // namespace limcycle
