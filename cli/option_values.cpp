#include "limcycle/cli/option_values.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "limcycle/cases/loader/text/printable.hpp"

namespace limcycle {
namespace {

constexpr std::size_t longest_value = 40;  // in a message

std::string shown_value(const std::string& value) { return "'" + one_line(value, longest_value) + "'"; }

std::string file_name(std::string& value) {
  if (value == "/dev/stdout" || value == "/dev/fd/1" || value == "/proc/self/fd/1") value = "-";
  return value.empty() ? "needs the name of a file, got none" : "";
}

std::string not_empty(std::string& value) { return value.empty() ? "needs a value, got none" : ""; }

/// Removes leading zeros from the value, which the parser would take for octal notation.
std::string decimal(std::string& value) {
  const bool negative = value.starts_with('-');
  std::string digits = value.substr(negative || value.starts_with('+') ? 1 : 0);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.empty() ? 0 : digits.size() - 1));
  std::uint64_t number = 0;
  const auto end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, number);
  if (read.ec == std::errc::result_out_of_range && read.ptr == end)
    return shown_value(value) + " is too large: the largest number is 18446744073709551615";
  if (read.ec != std::errc() || read.ptr != end) return shown_value(value) + " is not a whole number";
  value = (negative ? "-" : "") + digits;
  return {};
}

std::string finite(std::string& value) {
  return finite_number(value) ? "" : shown_value(value) + " is not a finite number";
}

/// The description is the one from which help makes "LOW to HIGH" (command_facts.cpp).
CLI::Validator within(double low, double high, const std::string& from_to) {
  const auto check = [low, high, from_to](std::string& value) -> std::string {
    const auto number = finite_number(value);
    if (!number) return shown_value(value) + " is not a finite number";
    return *number >= low && *number <= high ? "" : "must lie in " + from_to + ", got " + shown_value(value);
  };
  return CLI::Validator(check, "in [" + from_to + "]");
}

CLI::Validator beyond(bool (*holds)(double), const std::string& rule) {
  const auto check = [holds, rule](std::string& value) -> std::string {
    const auto number = finite_number(value);
    if (!number) return shown_value(value) + " is not a finite number";
    return holds(*number) ? "" : "must be " + rule + ", got " + shown_value(value);
  };
  return CLI::Validator(check, "in (" + rule + ")");
}

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc() && read.ptr == end && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

CLI::Validator whole_in(long long low, long long high) {
  return within(static_cast<double>(low), static_cast<double>(high), fmt::format("{} to {}", low, high));
}

CLI::Validator number_in(double low, double high) { return within(low, high, fmt::format("{:g} to {:g}", low, high)); }

CLI::Validator more_than_zero() {
  return beyond([](double number) { return number > 0.0; }, "> 0");
}

CLI::Validator zero_or_more() {
  return beyond([](double number) { return number >= 0.0; }, ">= 0");
}

void check_option_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_positional()) continue;  // their errors are reported where they are read
    std::string type = option->get_type_name();
    type.resize(std::min(type.find_first_of(":|,"), type.size()));
    const auto add = [&](std::string (*check)(std::string&)) { option->transform(CLI::Validator(check, "")); };
    if (type.starts_with("FILE") || type == "PAGE.html")
      add(file_name);
    else if (type == "N")
      add(decimal);
    else if (type == "S" || type == "V" || type == "X")
      add(finite);
    else if (!type.empty())
      add(not_empty);
  }
}

}  // namespace limcycle
