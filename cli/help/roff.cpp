#include "limcycle/cli/help/roff.hpp"

#include <fmt/format.h>

#include <sstream>

namespace limcycle::roff {
namespace {

/// One code point of valid UTF-8 at `i`, which is moved behind it.
unsigned long code_point(std::string_view text, std::size_t& i) {
  const auto lead = static_cast<unsigned char>(text[i]);
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  unsigned long code = lead & (0xFFu >> (length + 1));
  for (std::size_t k = 1; k < length && i + k < text.size(); ++k)
    code = (code << 6) | (static_cast<unsigned char>(text[i + k]) & 0x3Fu);
  i += length;
  return code;
}

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (static_cast<unsigned char>(c) >= 0x80) {
      out += fmt::format("\\[u{:04X}]", code_point(text, i));
      continue;
    }
    const bool at_begin = i == 0 || text[i - 1] == '\n';
    if (at_begin && (c == '.' || c == '\'')) out += "\\&";
    out += c == '\\'   ? "\\e"
           : c == '-'  ? "\\-"
           : c == '\'' ? "\\(aq"
           : c == '`'  ? "\\(ga"
           : c == '^'  ? "\\(ha"
           : c == '~'  ? "\\(ti"
           : c == '"'  ? "\\(dq"
                       : std::string(1, c);
    ++i;
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string header(std::string_view name, int section, std::string_view version) {
  return fmt::format(".TH {} {} \"\" \"limcycle {}\" \"{}\"\n", escaped(upper(name)), section, escaped(version),
                     section == 5 ? "File formats" : "User commands");
}

std::string section(std::string_view title) { return ".SH " + escaped(upper(title)) + "\n"; }
std::string subsection(std::string_view title) { return ".SS " + escaped(title) + "\n"; }

std::string paragraphs(std::string_view text) {
  std::string out;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) out += (out.empty() ? "" : ".PP\n") + escaped(line) + '\n';
  return out;
}

std::string tagged(const std::string& label, std::string_view text) {
  return ".TP\n" + label + '\n' + escaped(text) + '\n';
}

std::string verbatim(std::string_view text) {
  std::string out(text);
  if (!out.ends_with('\n')) out += '\n';
  return ".PP\n.RS 4\n.nf\n" + escaped(out) + ".fi\n.RE\n";
}

}  // namespace limcycle::roff
