#pragma once

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace limcycle {

/// Keys in the order in which they were written.
using Json = nlohmann::ordered_json;

/// JSON has no infinity and no NaN: null.
inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

/// A number of a figure, rounded to seven digits, more than a screen can show.
inline Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 7).ptr;
  std::from_chars(text, end, value);
  return value;
}

/// On one line; bytes that are not UTF-8 are replaced, and characters that control a terminal (DEL, C1, separators,
/// directions) are written as equivalent escapes.
std::string json_text(const Json& document);

inline Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace limcycle
