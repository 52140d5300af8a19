#pragma once
#include <string>

#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {

/// The data of a measured plant and their fit, over frequency, as one SVG: size and phase of both, and below them the
/// distance of the fit, relative to the data, with the standard deviation of these where it is known.
std::string fit_picture(const MeasuredPlantAt& plant);

}  // namespace limcycle
