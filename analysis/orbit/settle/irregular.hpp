#pragma once
#include <optional>

#include "limcycle/analysis/cycle.hpp"

namespace limcycle {

/// Numbers of a permanent bounded motion that has no period.
struct IrregularMotion {
  double half_range = 0.0;   ///< half of the difference of largest and least y
  double mean_period = 0.0;  ///< mean time between upward crossings of the middle of that range, s
  double shortest_period = 0.0, longest_period = 0.0;  ///< of the times between two such crossings, s
  double observed = 0.0;                               ///< time of all of them, s
  double mean_amplitude = 0.0;  ///< mean of the halves of largest less least y between one crossing and the next
  double smallest_amplitude = 0.0, largest_amplitude = 0.0;
  double beat_frequency = 0.0;  ///< of a sampled loop: see beat_frequency()
};

/// The numbers of a recorded motion without its first third (half, if its swings were larger until then and are alike
/// since), if it looks permanent: over four equal parts of the rest
/// its range, its spread and its returns stay the same within the scatter of such numbers, its spread neither falls nor
/// rises from each part to the next (a slow decay, a slow approach), and the returns do not repeat themselves, unless
/// they may: those of a sampled loop differ by less than the resolution of a run if its samples are short. agree()
/// decides if the numbers belong to the loop or to the tolerance. `fewest_returns`: in each part.
std::optional<IrregularMotion> permanent_motion(const Trace& trace, bool may_repeat = false, long fewest_returns = 8);

/// Time after which the returns of the last two thirds of a recorded motion repeat themselves, to 1e-7 of their range
/// and mean time and at least twice over; 0 if they do not.
double repeat_time(const Trace& trace);

/// Frequency, rad/s, at which the returns of a motion move through the `repetition` of the samples of its loop:
/// 2 pi |1/repetition - N/mean_period|, N the whole number for which it is least. 0 if single periods differ by a
/// repetition or more, so that no return tells the next one, or if fewer than two beats were observed. Its error is at
/// most 2 pi (longest - shortest period)/(repetition observed).
double beat_frequency(const IrregularMotion& motion, double repetition);

/// True if two runs at different tolerances give the same numbers. Chaotic motions part after a while.
bool agree(const IrregularMotion& one, const IrregularMotion& other);

}  // namespace limcycle
