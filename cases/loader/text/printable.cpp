#include "limcycle/cases/loader/text/printable.hpp"

#include <fmt/format.h>

#include <limits>

namespace limcycle {
namespace {

/// Length in bytes of the UTF-8 sequence at the start of `text`; 0 if there is none. Overlong forms, surrogates and
/// code points beyond U+10FFFF are not UTF-8.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool beyond = (first == 0xED && byte(1) >= 0xA0) || (first == 0xF4 && byte(1) >= 0x90);
  return overlong || beyond ? 0 : length;
}

/// The code point of a sequence of UTF-8.
unsigned code_point(std::string_view sequence) {
  const auto first = static_cast<unsigned char>(sequence.front());
  if (sequence.size() == 1) return first;
  unsigned code = first & (0xFFU >> (sequence.size() + 1));
  for (const char next : sequence.substr(1)) code = code << 6 | (static_cast<unsigned char>(next) & 0x3FU);
  return code;
}

/// True if a terminal would not simply show it. Directions after Unicode Standard Annex 9.
bool steers(unsigned code) {
  const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
  const bool separator = code == 0x2028 || code == 0x2029;
  const bool direction = code == 0x061C || code == 0x200E || code == 0x200F || (code >= 0x202A && code <= 0x202E) ||
                         (code >= 0x2066 && code <= 0x2069);
  return control || separator || direction;
}

std::string shown(std::string_view text, std::size_t length, bool keep_lines) {
  std::string out;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++characters) {
    if (characters == length) return out + "...";
    const std::size_t step = utf8_length(text.substr(i));
    if (step == 0) {
      out += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[i++]));
      continue;
    }
    const std::string_view sequence = text.substr(i, step);
    const unsigned code = code_point(sequence);
    const bool kept = keep_lines && (code == '\n' || code == '\t');
    if (kept || !steers(code))
      out += sequence;
    else
      out += code < 0x100 ? fmt::format("\\x{:02X}", code) : fmt::format("\\u{:04X}", code);
    i += step;
  }
  return out;
}

}  // namespace

bool is_utf8(std::string_view text, std::size_t& valid) {
  for (valid = 0; valid < text.size();) {
    const std::size_t length = utf8_length(text.substr(valid));
    if (length == 0) return false;
    valid += length;
  }
  return true;
}

std::string one_line(std::string_view text, std::size_t length) { return shown(text, length, false); }

std::string printable(std::string_view text) { return shown(text, std::numeric_limits<std::size_t>::max(), true); }

}  // namespace limcycle
