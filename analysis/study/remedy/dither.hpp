#pragma once
#include <functional>
#include <optional>

#include "limcycle/analysis/study/remedy/hunting_edge.hpp"
#include "limcycle/analysis/study/remedy/remedy.hpp"

namespace limcycle {

/// A sinusoidal force on the plant's input.
struct Dither {
  double amplitude = 0.0;  ///< N
  double frequency = 0.0;  ///< rad/s
};

/// Amplitude a of the rubbing velocity, m/s, under dither in a loop whose only element is Coulomb friction, about rest:
/// with g and h the responses of that velocity to the force and to the friction (without it), and the friction's first
/// harmonic 4 Fc/pi in phase with the velocity,  |(1 - h sigma2) a - h 4 Fc/pi| = |g| amplitude,  the larger root.
/// Empty if there is no positive one or the amplitude is below Fs: the dither does not keep the body moving. Its error
/// is that of the higher harmonics, some per cent for an amplitude of 2 Fc and less beyond.
std::optional<double> dither_speed(const LoopParts& parts, const Dither& dither);

/// The loop with the mean of its friction over the dither (see DitheredCoulomb) in place of both; empty without a
/// dither_speed().
std::optional<LoopParts> averaged_over(const LoopParts& parts, const Dither& dither);

/// Why a loop has no dither as remedy, a clause; empty: it has. It must be one of five slots with friction and a
/// controller, without dead time, sampling or ramp.
std::string why_no_dither(const LoopParts& parts);

/// Ten times highest_crossover(), rad/s: the controller hardly answers to it.
std::optional<double> frequency_of_dither(const LoopParts& parts);

/// Whether the loop under dither, simulated as it is from this state, still swings with periods like that of `hunting`,
/// a cycle of the loop without dither: `no` once the means of the states over one period of the dither change by less
/// than a thousandth of their typical sizes, and that of y by less than a hundredth of the cycle's amplitude, in a time
/// as long as the cycle; `yes` if the swing of the mean of y does not shrink from the second quarter of at least 24
/// such times to their second half; else `undecided`. Cost: at most 300 such times and 400 000 steps.
Hunts hunts_under(const Loop& loop, const LoopState& from, const Dither& dither, const Cycle& hunting,
                  const std::function<bool()>& stop);

/// The least amplitude of a dither of the candidate's frequency that ends hunting: values at four a decade, from a
/// tenth of the friction force up to 100 times that, then bisection to 1 %, or to 10 % beside values that are not
/// decided. Both sides of the edge are simulated as they are, from the largest cycle of the loop and from a
/// displacement of y by `step`; of a loop with Coulomb friction alone `why` also has the verdict of the averaged
/// friction. Amplitudes below break-away can be enough: the body then creeps at the peaks of the dither.
Remedy dither_remedy(const RemedyCandidate& candidate, const LoopParts& parts, const HuntingLoop& loop, double step,
                     const std::function<void(double)>& progress);

}  // namespace limcycle
