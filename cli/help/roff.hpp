#pragma once
#include <string>
#include <string_view>

namespace limcycle::roff {

/// Text as roff prints it unchanged: backslashes and hyphens escaped, no line that begins with a control character,
/// other than ASCII as \[uXXXX].
std::string escaped(std::string_view text);

std::string bold(std::string_view text);
std::string italic(std::string_view text);

std::string header(std::string_view name, int section, std::string_view version);
std::string section(std::string_view title);
std::string subsection(std::string_view title);

/// Paragraphs, one a line of `text`.
std::string paragraphs(std::string_view text);

/// An indented item: `label` (already escaped) and its text.
std::string tagged(const std::string& label, std::string_view text);

/// Lines that are printed unchanged.
std::string verbatim(std::string_view text);

}  // namespace limcycle::roff
