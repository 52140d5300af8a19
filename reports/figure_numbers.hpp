#pragma once
#include <fmt/format.h>

#include "limcycle/reports/figures.hpp"
#include "limcycle/reports/json_values.hpp"

namespace limcycle {

/// A number of a figure: seven digits are more than a screen can show.
inline Json rounded(double value) {
  return std::isfinite(value) ? Json(std::stod(fmt::format("{:.7g}", value))) : Json(nullptr);
}

/// The data of a figure as text.
inline std::string figure_text(const Json& data) {
  return figure_data(data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace limcycle
