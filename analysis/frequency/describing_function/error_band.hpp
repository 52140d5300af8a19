#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/rational_response.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"

namespace limcycle {

enum class BandVerdict { proved, undecided };
std::string_view to_string(BandVerdict verdict);

/// Answer to the question whether an oscillation exists near a root of the describing function.
struct Existence {
  BandVerdict verdict = BandVerdict::undecided;
  Interval frequency, amplitude;  ///< if proved: at least one oscillation with its fundamental in this closed rectangle
  std::string why;                ///< one sentence
};

/// Answer to the question whether a box holds no oscillation.
struct Absence {
  BandVerdict verdict = BandVerdict::undecided;
  SearchBox box{};
  std::vector<Interval> undecided;  ///< frequencies within the box at which an oscillation is not excluded, ascending
  std::string why;                  ///< one sentence
};

/// Rigorous error bounds of the describing function (A. I. Mees, A. R. Bergen, IEEE TAC 20(4), 1975, 473-478) for
/// x = -G n(x): n odd, memoryless, single-valued with incremental slopes in [alpha, beta]; G real-rational and strictly
/// proper; half-wave symmetric solutions (odd harmonics only) with fundamental a sin wt. All of it is checked.
///
/// With c = (alpha + beta)/2 and gamma = (beta - alpha)/2 the loop reads (c + 1/G) x = -m(x), m = n - c having the
/// Lipschitz constant gamma in L2. Let rho(w) = inf over odd k >= 3 of |c + 1/G(jkw)|. Where rho > gamma (the filtered
/// frequencies) the harmonics x_h are a contraction's only fixed point for given (w, a), |x_h| <= gamma/(rho - gamma)
/// |x_1|, and the first-harmonic balance is 1/G(jw) + Psi(a) + e = 0 with Psi the describing function and
/// |e| <= sigma(w) = gamma^2/(rho - gamma). Hence
///  - an oscillation at a filtered w needs |1/G(jw) + Psi(a)| <= sigma(w) (its error disc meets -Psi);
///  - a rectangle of filtered w and a > 0 on whose border that fails, with Im 1/G of opposite signs at its two
///    frequencies and Psi on opposite sides of the band at its two amplitudes, holds at least one (degree +-1);
///  - none at any w with |c + 1/G(jkw)| > gamma for all odd k >= 1 (incremental circle criterion).
/// The theorem's condition that G has no pole at jkw is part of rho > gamma: there |c + 1/G| = |c|, which is at most
/// gamma since 0 must be among the slopes.
///
/// Bounds hold over whole intervals of w (see RationalResponse); the infimum over k stops at the k beyond which |1/G| -
/// |c| is proved to exceed the infimum so far. Roundings are not enclosed: "proved" means proved up to rounding.
class ErrorBand {
 public:
  /// Reason why the theorem does not apply to this loop, or nothing.
  static std::optional<std::string> not_applicable(const Loop& loop);
  /// Throws std::invalid_argument with that sentence if there is one.
  explicit ErrorBand(const Loop& loop);

  double alpha() const { return centre_ - gamma_; }
  double beta() const { return centre_ + gamma_; }
  /// rho(w), w > 0 in rad/s.
  double rho(double w) const { return rho(Interval{w, w}); }
  bool filtered(double w) const { return rho(w) > gamma_; }
  /// sigma(w); infinite where w is not filtered.
  double sigma(double w) const { return sigma(Interval{w, w}); }
  /// 1/G(jw).
  std::complex<double> inverse_response(double w) const { return response_.inverse(w); }
  /// Psi(a), a > 0.
  double gain(double amplitude) const;

  /// The band about a root (w, a) of 1/G(jw) + Psi(a) = 0. The rectangle is the smallest to 1e-7 of beta in Psi that
  /// holds the part of the band connected with the root. Cost: some 1e4 evaluations of the polynomials of G.
  Existence existence(double frequency, double amplitude) const;
  /// Excludes oscillations with their fundamental in the box, frequency interval by interval. An interval where that
  /// fails is bisected down to 2e-3 of its frequency, or to 1e-6 where only the interval, not its middle, fails.
  Absence absence(const SearchBox& box) const;

 private:
  double rho(Interval w) const;
  double sigma(Interval w) const;
  std::optional<double> edge_frequency(double inside, double direction) const;
  std::optional<Interval> gains(Interval frequency) const;
  std::optional<double> highest(Interval frequency, double sign) const;
  std::optional<double> edge_amplitude(double inside, double direction, Interval gains) const;
  Interval gains_between(double amplitude_min, double amplitude_max) const;
  double circle_from(double least) const;
  bool excluded(Interval w, Interval gains, double circle) const;

  Element element_;
  RationalResponse response_;
  double centre_ = 0.0, gamma_ = 0.0;
};

}  // namespace limcycle
