#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"

namespace limcycle {

/// True if a cycle is of interest for a search box: the amplitude of the element's input is not below the least of the
/// box (one above the largest is worse for the user, not less relevant), the frequency is within it.
bool is_of_interest(const SearchBox& box, const Cycle& cycle);

/// Compares the cycles found with the search box. A box given by the user stays: a note lists cycles outside. A default
/// box is widened until it holds them, and a note reports that too.
std::vector<std::string> compare_with_interest(const std::vector<Cycle>& cycles, bool given, SearchBox& box);

}  // namespace limcycle
