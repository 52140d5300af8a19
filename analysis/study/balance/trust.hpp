#pragma once
#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/error_band.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

class FirstHarmonicBalance;

/// Rigorous: a theorem with all its conditions checked. Heuristic: an estimate of the same form; true cycles may lie
/// outside.
enum class BandKind { rigorous, heuristic };
std::string_view to_string(BandKind kind);

/// All z = 1/(1/G + e), |e| <= sigma: the image of the error disc about 1/G(jw) in the plane of G.
struct ErrorDisc {
  double frequency = 0.0;  ///< rad/s
  std::complex<double> centre;
  double radius = 0.0;
};

/// Range in which the oscillation predicted by a root may really lie. Ends that do not exist are 0 or infinite.
struct Band {
  BandKind kind = BandKind::heuristic;
  BandVerdict verdict = BandVerdict::undecided;  ///< proved (rigorous only): at least one cycle lies in the band
  Interval frequency;                            ///< rad/s
  Interval amplitude;                            ///< of y's first harmonic
  Interval input_amplitude;                      ///< of the first harmonic of the element's input
  std::vector<ErrorDisc> discs;                  ///< for the figure; none if they are not bounded
  std::string why;                               ///< one sentence
};

/// Accuracy at a root (A, w) of the describing function's assumption that only the first harmonic returns. W_n:
/// harmonics of the element's output for the sinusoidal input, G: response of the rest of the loop.
struct Trust {
  double filter_ratio = 0.0;       ///< |G(jnw) W_n| / |G(jw) W_1|, the largest for n = 3, 5 (and 2 if biased)
  int worst_harmonic = 3;          ///< the n of that largest ratio
  double harmonic_residual = 0.0;  ///< (sum over n = 2..7 of |G(jnw) W_n|^2)^(1/2) / |G(jw) W_1|
  /// Share of the period in which the predicted sinusoid has |v| < vs/100, for friction with a Stribeck velocity. 0 by
  /// construction for other friction (a sinusoid is never at rest for any time, however long the true cycle sticks) and
  /// if nothing rubs.
  double sticking_fraction = 0.0;
  Band band;
  std::string sentence;  ///< the same in words
};

/// Trust indicators of the root (input amplitude A, frequency w) of the loop's balance.
///
/// Band: by ErrorBand where it proves a cycle. Otherwise heuristic: the harmonics fed back, of relative size eta =
/// harmonic_residual/(1 - harmonic_residual), are taken to change N by up to eta (1 + |d ln N/d ln A|) of itself (the
/// part of them that N passes on, and their effect on the amplitude at N's input), that is, 1 + N G by as much; the
/// band is the image of that disc under the inverse of the derivative of 1 + N G with respect to (ln A, ln w),
/// unbounded where harmonic_residual >= 0.9, the derivative is singular or the band is wider than a factor of 10. Bands
/// are of first order: wide ones are rough. Cost: about ten evaluations of N and one of its harmonics, and for a proof
/// 1e4 of G.
Trust trust(const Loop& loop, const FirstHarmonicBalance& balance, double amplitude, double frequency);

/// For a loop with a slope-bounded element: proof that no half-wave symmetric oscillation has its fundamental in the
/// box (amplitude of the element's input). Empty if the theorem does not apply.
std::optional<Absence> absence(const Loop& loop, const SearchBox& box);

}  // namespace limcycle
