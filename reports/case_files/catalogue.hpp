#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {

/// One parameter of a kind, from its parameter table, without the type of its owner.
struct ParameterEntry {
  std::string key, unit, meaning;
  std::string type;  ///< "number", "list", "choice", "matrix", "complex list", "text"
  Range range;       ///< of a number, or of each entry of a list
  bool required = true;
  std::optional<double> default_value;  ///< of an optional number; infinite: absent unless given
  std::string default_name;             ///< of a choice
  std::string default_from;             ///< key whose value is the default; empty: none
  std::vector<std::string> choices;
};

/// One law, element, plant or controller.
struct CatalogueEntry {
  std::string group;  ///< "friction", "element", "error element", "plant" or "controller"
  std::string kind, equation, source;
  std::optional<int> states, most_states;  ///< continuous states, least and most; empty: the lists decide
  std::optional<int> states_per_entry;     ///< of a law of parallel elements: states per entry of its lists ...
  int states_beside = 0;                   ///< ... and other states
  std::optional<Features> features;        ///< of a friction law
  std::vector<ParameterEntry> parameters;
};

/// All kinds of this version, from the parameter tables of the models: friction laws, elements, plants, controllers.
std::vector<CatalogueEntry> catalogue();

/// Kinds that are allowed in a section of a case, such as "loop.error"; none for a section that is not a part of the
/// loop. (Of the laws in "loop.element", those that need the applied force are rejected with the case.)
std::vector<std::string> kinds_for(std::string_view section);

}  // namespace limcycle
