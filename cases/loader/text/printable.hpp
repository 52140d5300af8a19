#pragma once
#include <string>
#include <string_view>

namespace limcycle {

/// True if the text is UTF-8. `valid`: length of its valid beginning.
bool is_utf8(std::string_view text, std::size_t& valid);

/// Text made safe for a one-line message, at most `length` characters: what could control a terminal is shown as an
/// escape instead. These are control characters (C0, DEL and C1), separators of lines and paragraphs, and marks and
/// overrides of the writing direction; bytes that are not UTF-8 become `\xNN`, the others `\xNN` or `\uNNNN`.
std::string one_line(std::string_view text, std::size_t length = 300);

/// The same for a text of several lines, of any length: line feeds and tabs are kept.
std::string printable(std::string_view text);

}  // namespace limcycle
