#include "limcycle/cli/output/colour.hpp"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

#include "limcycle/cli/ranks/ranks.hpp"

namespace limcycle {
namespace {

constexpr std::string_view bold = "\x1b[1m", faint = "\x1b[2m", red = "\x1b[31m", green = "\x1b[32m",
                           yellow = "\x1b[33m", plain = "\x1b[0m";

// Stability is a yes or no in the column of that name, see colour_of_cell().
constexpr std::array<std::pair<std::string_view, std::string_view>, 10> verdicts{{{"confirmed", green},
                                                                                  {"holds", green},
                                                                                  {"proved", green},
                                                                                  {"valid", green},
                                                                                  {"biased", yellow},
                                                                                  {"undecided", yellow},
                                                                                  {"interrupted", yellow},
                                                                                  {"false", red},
                                                                                  {"fails", red},
                                                                                  {"missed", red}}};

std::string painted(std::string_view colour, std::string_view text) {
  return std::string(colour) + std::string(text) + std::string(plain);
}

bool is_rule(std::string_view line) { return line.size() > 3 && line.find_first_not_of('-') == std::string_view::npos; }

/// True for a heading: it follows an empty line, precedes a non-empty one, begins with a capital and is no sentence.
bool is_heading(std::string_view before, std::string_view line, std::string_view after) {
  if (!before.empty() || line.empty() || after.empty() || line.size() > 60) return false;
  return line.front() >= 'A' && line.front() <= 'Z' && line.back() != '.' && line.back() != ';' &&
         line.find("  ") == std::string_view::npos;
}

/// End of the cell that begins at `from`: two spaces, or the end of the line.
std::size_t end_of_cell(std::string_view line, std::size_t from) {
  return std::min(line.find("  ", from), line.size());
}

/// Colour of a cell that ends at column `end`; `stable_end`: end of the heading "stable".
std::string_view colour_of_cell(std::string_view cell, std::size_t end, std::size_t stable_end) {
  for (const auto& [word, colour] : verdicts)
    if (cell == word) return colour;
  if (end != stable_end) return {};
  return cell == "yes" ? green : cell == "no" ? red : std::string_view();
}

std::string coloured_cells(std::string_view line, std::size_t stable_end) {
  std::string out;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t end = end_of_cell(line, i);
    const std::string_view cell = line.substr(i, end - i);
    // A line with one cell only is prose.
    const auto colour = cell.size() == line.size() ? std::string_view() : colour_of_cell(cell, end, stable_end);
    out += colour.empty() ? std::string(cell) : painted(colour, cell);
    for (i = end; i < line.size() && line[i] == ' '; ++i) out += ' ';
  }
  return out;
}

}  // namespace

bool colours_wanted(std::string_view when, int descriptor) {
  if (when != "auto") return when == "always";
  const char* const refused = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  if (refused != nullptr && *refused != '\0') return false;
  if (was_launched()) return false;  // mpirun gives its processes terminals and forwards their output
  return terminal != nullptr && *terminal != '\0' && std::string_view(terminal) != "dumb" && isatty(descriptor) == 1;
}

std::string_view colour_flag(int argc, char** argv) {
  std::string_view when = "auto";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word.starts_with("--color=")) when = word.substr(8);
    if (word == "--color" && i + 1 < argc) when = argv[i + 1];
  }
  return when;
}

std::string coloured(std::string_view text) {
  std::string out;
  std::string_view before;  // nothing before the first line
  std::size_t stable_end = std::string_view::npos, heading_end = stable_end;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string_view line = text.substr(from, end - from), rest = text.substr(std::min(end + 1, text.size()));
    const std::string_view after = rest.substr(0, rest.find('\n'));
    if (line.empty()) stable_end = heading_end = std::string_view::npos;
    if (const auto at = line.find("  stable"); at != std::string_view::npos) heading_end = at + 8;
    if (is_rule(line)) stable_end = heading_end;
    const bool title = from == 0 && after.empty() && line.find("  ") == std::string_view::npos;
    out += title || is_heading(before, line, after) ? painted(bold, line)
           : is_rule(line)                          ? painted(faint, line)
                                                    : coloured_cells(line, stable_end);
    if (end < text.size()) out += '\n';
    before = line;
    from = end + 1;
  }
  return out;
}

std::string coloured_complaint(std::string_view line) {
  constexpr std::string_view name = "limcycle:";
  if (!line.starts_with(name)) return std::string(line);
  return painted(red, name) + std::string(line.substr(name.size()));
}

}  // namespace limcycle
