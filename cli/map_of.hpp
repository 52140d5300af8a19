#pragma once
#include <string>

#include "limcycle/cases/case.hpp"
#include "limcycle/cases/loop_variation.hpp"
#include "limcycle/reports/map.hpp"

namespace limcycle {

/// A map of a case over what --x and --y say, its units and methods; its points are not known yet. Throws InputError or
/// std::invalid_argument if a side is not of the form of map_axis(), the case has no such number, or both are the same.
MapReport map_of(const Case& from, const std::string& x, const std::string& y, const Methods& methods);

/// How a point of a map is predicted: no more accurately than its verdict needs.
PredictOptions map_options(const Case& from, const Methods& methods);

/// Point k; one without a loop (a number out of its range) holds no more than the number of methods.
MapPoint point_of(const HuntingMap& map, std::size_t k, const LoopVariation& variation, const PredictOptions& options);

}  // namespace limcycle
