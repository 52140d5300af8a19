#pragma once
#include <string>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/map/map.hpp"

namespace limcycle {

/// A map of a case over the ranges of --x and --y, its units and methods; its points are not computed yet. Throws
/// InputError or std::invalid_argument if a side is not of the form of map_axis(), the case has no such number, or both
/// are the same.
MapReport map_of(const Case& from, const std::string& x, const std::string& y, const Methods& methods);

}  // namespace limcycle
