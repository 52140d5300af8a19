#pragma once
#include <string_view>
#include <vector>

namespace limcycle {

/// One key of a case file that is not in a parameter table of a model.
struct CaseKey {
  std::string_view key;
  std::string_view value;    ///< as an example, in TOML
  std::string_view meaning;  ///< with its unit
  std::string_view default_value = {};
  bool required = false;
};

/// One section of a case file other than those of the loop's parts.
struct CaseSection {
  std::string_view name;  ///< "search"; "" for the keys before any section
  std::string_view meaning;
  std::vector<CaseKey> keys;
};

/// The sections of a case file, except [loop.plant] and the like, whose keys are in catalogue(). The manual page of the
/// format and `limcycle new` are made from this list.
const std::vector<CaseSection>& case_sections();

}  // namespace limcycle
