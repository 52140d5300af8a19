#pragma once
#include <string_view>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// True if an element has no periodic output under a prescribed motion whose speed falls to `least_speed` and whose
/// mean rate is `mean_rate`. Within its band (see drive_band) a law needs the applied force, which a prescribed motion
/// does not have; a mean rate stretches a spring in the law without end.
inline bool undefined_under(const Element& element, double least_speed, double mean_rate) {
  if (element.follows_position() && mean_rate != 0.0) return true;
  const double band = element.drive_band();
  return band > 0.0 && least_speed <= band;
}

/// Text of Status::undefined for a describing function.
inline constexpr std::string_view undefined_text =
    "none there: where the motion enters |v| < dv the law needs the applied force, and a mean velocity stretches a "
    "spring in the law without end";

}  // namespace limcycle
