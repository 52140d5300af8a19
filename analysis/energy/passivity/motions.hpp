#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "limcycle/analysis/energy/passivity/supply_march.hpp"

namespace limcycle {

/// Sizes that a periodic input must try, found from the element itself.
struct MotionScales {
  double signal = 1.0;    ///< over which the output changes with the signal (Stribeck velocity; input of a relay)
  double way = 1.0;       ///< m, displacement over which the states settle
  double shortest = 1.0;  ///< s, time constants of the states at creeping speed
  double longest = 1.0;   ///< s
  double damping = 0.0;   ///< m/s at which the damping of the states is as large as the output; 0: none
  double least = 0.0, most = 0.0;  ///< sizes of the signal to try
  double reach = 0.0;              ///< up to which a search may follow a gain
};
MotionScales motion_scales(const Element& element, double top_speed);

/// One piece of a periodic input in variables of a search: logarithms of its signal and of its length.
struct Stroke {
  int sign = 1;
  bool by_time = false;  ///< the length is a duration, s, not a displacement
  bool ramp = false;     ///< the signal changes linearly from that of the stroke before; otherwise it jumps
  double size = 0.0;     ///< log10 of the signal
  double length = 0.0;   ///< log10 of displacement or duration
};
using Strokes = std::vector<Stroke>;
std::vector<SignalPiece> pieces_of(const Strokes& strokes, DrivenBy port);

/// Strokes of 2 to 6 pieces with sizes and lengths drawn log-uniformly from the range of the scales. The same generator
/// gives the same strokes.
Strokes random_strokes(const MotionScales& scales, DrivenBy port, std::mt19937_64& random);

/// Inputs that are known to take energy out of some law: load fast, creep long, reverse fast, creep long (laws whose
/// force relaxes in time); slide slowly, then step to a high speed (laws with damped states); speed up at once, slow
/// down slowly (laws that distinguish the two); for elements: go there and back and stay.
std::vector<Strokes> known_strokes(const MotionScales& scales, DrivenBy port);

}  // namespace limcycle
