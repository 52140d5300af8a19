#pragma once

#include <string_view>

namespace limcycle {

/// Methods as case files, tables and JSON name them.
inline constexpr std::string_view df_name = "describing-function", composite_name = "composite-describing-function",
                                  balance_name = "harmonic-balance", simulation_name = "simulation",
                                  shooting_name = "shooting";

}  // namespace limcycle
