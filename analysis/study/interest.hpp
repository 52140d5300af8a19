#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/root_search.hpp"

namespace limcycle {

/// Whether a cycle is one that a search box asks for: the amplitude of the element's input is not below the least of
/// the box (a larger one than the largest is the worse for the user, not the less), the frequency is within it.
bool is_of_interest(const SearchBox& box, const Cycle& cycle);

/// Compares the cycles that were found with the search box. A box that the user gave stays: a cycle outside is told in
/// a note. A default box is widened until it holds them, which a note tells too.
std::vector<std::string> compare_with_interest(const std::vector<Cycle>& cycles, bool given, SearchBox& box);

}  // namespace limcycle
