#include "limcycle/cases/loader/text/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace limcycle {
namespace {

constexpr std::size_t longest_sentence = 1000;  ///< a list of all kinds of blocks fits

std::string place_of(const InputFault& fault) {
  if (!fault.override.empty()) return "--set " + one_line(fault.override, 120) + ": ";
  if (fault.file.empty()) return "";
  return fault.line > 0 ? fmt::format("{}:{}: ", one_line(fault.file), fault.line) : one_line(fault.file) + ": ";
}

std::string message_of(const InputFault& fault) {
  std::string text = place_of(fault);
  // An override already shows its key and value.
  const bool shown = !fault.override.empty() && fault.override.substr(0, fault.override.find('=')) == fault.key;
  if (!shown && !fault.key.empty()) {
    text += one_line(fault.key, 120);
    if (!fault.value.empty()) text += (fault.key.starts_with("--") ? " " : " = ") + one_line(fault.value, 120);
    text += ": ";
  }
  text += one_line(fault.rule, longest_sentence);
  if (!fault.suggestion.empty()) text += "; " + one_line(fault.suggestion, longest_sentence);
  return text;
}

char folded(char c) { return c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Damerau-Levenshtein distance (insert, delete, replace, swap of neighbours), the restricted form.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t differs = folded(a[i - 1]) == folded(b[j - 1]) ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + differs});
      if (i > 1 && j > 1 && folded(a[i - 1]) == folded(b[j - 2]) && folded(a[i - 2]) == folded(b[j - 1]))
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

}  // namespace

InputError::InputError(InputFault fault) : std::runtime_error(message_of(fault)), fault_(std::move(fault)) {}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  if (name.size() > 64) return {};
  std::string best;
  std::size_t smallest = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    // Any two names of one letter are a single step apart, which means nothing.
    const std::size_t d = distance(name, candidate);
    const bool nothing_in_common = d >= std::max(name.size(), candidate.size());
    if (d < smallest && !nothing_in_common) {
      smallest = d;
      best = candidate;
    }
  }
  return best;
}

std::string suggest(std::string_view name, std::span<const std::string> candidates) {
  if (const auto near = nearest_name(name, candidates); !near.empty()) return "did you mean " + near + "?";
  std::string text;
  for (const auto& candidate : candidates) text += (text.empty() ? "known: " : ", ") + candidate;
  return text;
}

}  // namespace limcycle
