#pragma once
#include <string_view>

namespace limcycle {

/// A value for a key of a new case, and its usual range.
struct TypicalValue {
  std::string_view value;    ///< in TOML; empty: none
  std::string_view usual;    ///< a range in the key's unit, with its reason if there is one; empty: not stated
  bool only_to_try = false;  ///< not part of the case unless requested
};

/// The value of `key` for an entry of the catalogue that works in a new case: of that kind, else of any kind. Numbers
/// of laws are those of a servo of 1 kg with 1.5 N of break-away force, the scale of Canudas de Wit et al. (1995), so
/// that all laws, plants and controllers fit together. Group "lone plant": a plant in a loop without friction; "guarded
/// controller": one with an element before or after it.
TypicalValue typical_value(std::string_view group, std::string_view kind, std::string_view key);

}  // namespace limcycle
