#pragma once
#include <string>
#include <vector>

#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/questions/asking/asking.hpp"
#include "limcycle/questions/asking/need_memory.hpp"
#include "limcycle/reports/map/map.hpp"

namespace limcycle {

/// The methods of these names, as a map judges them: the describing function alone if there are none, since with mass
/// and friction as one element a point takes ten times as long. Throws InputError (of `argument`) for an unknown name.
/// `no_methods` ask for a map of outcomes.
Methods map_methods(const std::string& argument, const std::vector<std::string>& names);

/// A map over two numbers of a case, with their units; its points are not computed yet. Throws InputError (of x or y,
/// with `dashes` before them) if the case has no such number, both are the same, or the map would not fit into memory.
MapReport map_over(const Case& from, const MapAxis& x, const MapAxis& y, const Methods& methods,
                   const std::string& dashes);

/// Rejects (InputError) a map that would not fit into memory, with these documents beside it.
void need_memory_for(const HuntingMap& map, const HeldDocuments& held, const std::string& dashes);

/// Flags of the program that ask for this map. `methods`: they were named; `starts`: 0: not given. A map without
/// methods is one of outcomes.
std::string flags_of(const HuntingMap& map, bool methods, int starts);

/// Options for predicting a point of a map: no more accurate than its verdict needs.
PredictOptions map_options(const Case& from, const Methods& methods, const std::function<bool()>& stop);

/// Point k; one without a loop (a number out of its range) contains the number of methods only.
MapPoint point_of(const HuntingMap& map, std::size_t k, const LoopVariation& variation, const PredictOptions& options);

/// Computes the points of a map; those of outcomes only on `isa`. `starts`: 0: as the case says. `design`: as of
/// SweepRunner.
Status ask_map(const Case& from, HuntingMap& map, const Methods& methods, int starts, const std::string& design,
               const Asking& asking, const SweepRunner& sweep);

}  // namespace limcycle
