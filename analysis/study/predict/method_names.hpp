#pragma once

#include <string_view>

namespace limcycle {

/// Names of methods in case files, tables and JSON.
inline constexpr std::string_view df_name = "describing-function", composite_name = "composite-describing-function",
                                  balance_name = "harmonic-balance", simulation_name = "simulation",
                                  shooting_name = "shooting";

}  // namespace limcycle
