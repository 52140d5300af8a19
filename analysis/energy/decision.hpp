#pragma once
#include <string>
#include <string_view>

namespace limcycle {

/// Answer to a question that a computation may leave open.
enum class Decision { yes, no, undecided, not_applicable };

constexpr std::string_view to_string(Decision decision) {
  switch (decision) {
    case Decision::yes:
      return "yes";
    case Decision::no:
      return "no";
    case Decision::undecided:
      return "undecided";
    case Decision::not_applicable:
      return "not applicable";
  }
  return "unknown";
}

/// An answer with its reason, one sentence.
struct Answer {
  Decision decision = Decision::undecided;
  std::string why;
};

}  // namespace limcycle
