#include "limcycle/reports/format/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace limcycle {
namespace {

constexpr int least_digits = 2;
constexpr int most_digits = 12;
constexpr int digits_of_unknown = 4;

/// Decimal exponent of the leading digit after rounding to `digits`: 9.996 with 3 digits has 1.
int leading_place(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

/// Decimal place of the last digit that an absolute error permits: 10^place is at most twice the error.
int last_place(double error) { return static_cast<int>(std::floor(std::log10(2.0 * error))); }

/// `whole`: an integer part is printed in full even if it has more digits than requested.
std::string printed(double value, int digits, bool whole) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  digits = std::clamp(digits, 1, 17);
  const int place = leading_place(value, digits);
  const bool plain = place >= -4 && place < 7 && (whole || digits > place);
  return plain ? fmt::format("{:.{}f}", value, std::max(digits - 1 - place, 0))
               : fmt::format("{:.{}e}", value, digits - 1);
}

}  // namespace

std::string shortest(double value) {
  std::string text;
  append_shortest(text, value);
  return text;
}

void append_shortest(std::string& out, double value) {
  if (!std::isfinite(value)) return;
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string with_digits(double value, int digits) { return printed(value, digits, true); }

std::string with_error(double value, double relative_error) {
  if (!std::isfinite(value) || value == 0.0) return with_digits(value, 1);
  if (!std::isfinite(relative_error)) return with_digits(value, digits_of_unknown);
  const double error = std::abs(value) * relative_error;
  if (!(error > 0.0)) return printed(value, most_digits, false);
  if (!std::isfinite(error)) return printed(value, least_digits, false);
  const auto digits_of = [&](int guess) {
    return std::clamp(leading_place(value, guess) - last_place(error) + 1, least_digits, most_digits);
  };
  return printed(value, digits_of(digits_of(most_digits)), false);  // twice: 9.9996 may become 10.000
}

std::string with_absolute_error(double value, double error) {
  if (std::isfinite(value) && std::isfinite(error) && std::abs(value) <= error) return "0";
  return with_error(value, value == 0.0 ? 0.0 : error / std::abs(value));
}

std::string as_error(double value) {
  if (!std::isfinite(value)) return "-";
  return value == 0.0 ? "0" : fmt::format("{:.1e}", value);
}

std::string as_percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double percent = 100.0 * share;
  if (percent > 0.0 && percent < 0.1) return "<0.1 %";
  if (percent < 100.0 && percent > 99.9) return ">99.9 %";
  return fmt::format("{:.{}f} %", percent, percent == std::round(percent) ? 0 : 1);
}

std::string as_waiting_time(double seconds) {
  if (!(seconds >= 0.0 && seconds < 3.15e9)) return "?";  // a century
  const auto s = static_cast<long>(std::ceil(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  return fmt::format("{} d {:02} h", s / 86400, s / 3600 % 24);
}

}  // namespace limcycle
