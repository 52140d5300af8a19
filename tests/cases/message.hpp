#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle::test {

/// A case of a friction law alone.
inline const std::string lone_law = "[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n";

/// Message of the loader about a text; empty if it accepts it.
inline std::string message(std::string_view text, const std::vector<std::string>& overrides = {}) {
  try {
    read_case(text, "a.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Lines 1 to 19 of a valid case: the PID servo with LuGre friction.
inline constexpr std::string_view servo = R"([loop.plant]
kind = "mass"
mass = 1.0
[loop.controller]
kind = "pid"
kp = 3.0
ki = 4.0
kd = 6.0
[loop.friction]
kind = "lugre"
Fs = 1.5
Fc = 1.0
vs = 0.001
sigma0 = 1e5
sigma1 = 316.2
sigma2 = 0.4
[search]
amplitude = [1e-6, 1.0]
frequency = [0.01, 1000.0]
)";

/// The same servo with Coulomb friction; ki, and the levels of the other direction, are not written.
inline constexpr std::string_view coulomb_servo = R"(
[loop.plant]
kind = "mass"
mass = 2.0
[loop.controller]
kind = "pid"
kp = 3.0
kd = 6.0
[loop.friction]
kind = "coulomb"
Fs = 1.5
Fc = 1.0
)";

/// The text with its first `from` replaced.
inline std::string with(std::string_view text, std::string_view from, std::string_view to) {
  std::string changed(text);
  return changed.replace(changed.find(from), from.size(), to);
}

}  // namespace limcycle::test
