#pragma once
#include <string>
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// All elements that a case can name, with default values of their parameters.
struct Catalogue {
  std::vector<Element> friction_laws;
  std::vector<Element> forward_elements;  ///< in series after the controller; friction laws are allowed there too
  std::vector<Element> series_elements;   ///< everything allowed in series: friction laws and forward elements
  std::vector<Element> error_elements;    ///< on the error, before the controller
};
const Catalogue& catalogue_of_elements();

/// Finds the element of a kind in a list; null if there is none.
const Element* find_kind(const std::vector<Element>& list, std::string_view kind);

/// Kinds in a list, in its order.
std::vector<std::string> kinds_of(const std::vector<Element>& list);

}  // namespace limcycle
