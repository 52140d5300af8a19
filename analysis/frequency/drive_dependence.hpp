#pragma once
#include <string_view>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// Whether an element has no periodic output under a prescribed motion whose speed falls to `least_speed` and whose
/// mean rate is `mean_rate`: within its band (see drive_band) a law needs the applied force, and a prescribed motion
/// has none; a spring in the law is stretched without end by a mean rate.
inline bool undefined_under(const Element<double>& element, double least_speed, double mean_rate) {
  return std::visit(
      [&](const auto& e) {
        if constexpr (requires { e.follows_position(); })
          if (e.follows_position() && mean_rate != 0.0) return true;
        const double band = drive_band(e);
        return band > 0.0 && least_speed <= band;
      },
      element);
}

/// What Status::undefined means for a describing function.
inline constexpr std::string_view undefined_text =
    "none there: where the motion enters |v| < dv the law needs the applied force, and a mean velocity stretches a "
    "spring in the law without end";

}  // namespace limcycle
