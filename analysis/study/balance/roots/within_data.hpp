#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The parts of a search box in whose frequencies every measured plant of the loop has data; the box itself if it has
/// no such plant. Beyond the data and in their gaps no method of the frequency domain predicts anything.
std::vector<SearchBox> within_data(const Loop& loop, const SearchBox& box);

/// For a box that is cut by this: where nothing was searched.
std::vector<std::string> data_limits(const Loop& loop, const SearchBox& box);

/// For every measured plant: what its results in frequency and in time rest on.
std::vector<std::string> measured_notes(const Loop& loop);

}  // namespace limcycle
