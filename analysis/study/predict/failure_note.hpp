#pragma once
#include <string>

namespace limcycle {

/// The note on a method that rejected an intermediate number: too large, too small or not a number.
inline std::string failure_note(const std::string& refusal) {
  return "solutions may be missing: a number went beyond what the method can take (" + refusal + ")";
}

}  // namespace limcycle
