#include "limcycle/cli/option_values.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace limcycle {
namespace {

std::string not_empty(std::string& value) { return value.empty() ? "needs the name of a file, got none" : ""; }

/// Leaves the value without zeros in front, which the parser would take for a sign of octal digits.
std::string decimal(std::string& value) {
  const bool negative = value.starts_with('-');
  std::string digits = value.substr(negative || value.starts_with('+') ? 1 : 0);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.empty() ? 0 : digits.size() - 1));
  std::uint64_t number = 0;
  const auto end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, number);
  if (read.ec == std::errc::result_out_of_range && read.ptr == end)
    return "'" + value + "' is too large: the largest number is 18446744073709551615";
  if (read.ec != std::errc() || read.ptr != end) return "'" + value + "' is not a whole number";
  value = (negative ? "-" : "") + digits;
  return {};
}

std::string finite(std::string& value) {
  double number = 0.0;
  const std::string_view text = std::string_view(value).substr(value.starts_with('+') ? 1 : 0);
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(number);
  return is_number ? "" : "'" + value + "' is not a finite number";
}

}  // namespace

void check_option_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_positional()) continue;  // what is wrong with them is said where they are read
    std::string type = option->get_type_name();
    type.resize(std::min(type.find_first_of(":|,"), type.size()));
    const auto add = [&](std::string (*check)(std::string&)) { option->transform(CLI::Validator(check, "")); };
    if (type == "FILE" || type == "PAGE.html") add(not_empty);
    if (type == "N") add(decimal);
    if (type == "S" || type == "V" || type == "X") add(finite);
  }
}

}  // namespace limcycle
