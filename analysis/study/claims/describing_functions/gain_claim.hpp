#pragma once
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/study/claims/claim_points.hpp"

namespace limcycle {

/// Point of a describing function: the numbers of the element in the order of GainFormula::names, and the motion.
struct GainPoint {
  std::vector<double> p;
  double amplitude = 1.0, frequency = 1.0;
};

/// A value that a source prints, to one unit of its last digit.
struct PrintedGain {
  GainPoint at;
  std::complex<double> gain;
  double last_digit;
};

/// A describing function in closed form and the data needed to test it.
struct GainFormula {
  std::string unit;                                        ///< of the gain
  std::vector<std::pair<std::string, std::string>> names;  ///< of the numbers p, and their units
  std::string amplitude_unit;
  std::function<Element(const std::vector<double>&)> element;
  std::function<std::complex<double>(const GainPoint&)> gain;
  std::vector<PrintedGain> printed;
  std::function<GainPoint(RandomPoints&)> draw;
  /// Further claims at a point, compared with the value computed there.
  std::function<void(ClaimChecks&, const std::string& where, const GainPoint&, const DescribingFunction&)> more{};
  /// Further claims that do not depend on a point.
  std::function<void(ClaimChecks&, const ClaimOptions&)> once{};
  double accuracy = 1e-10;  ///< of the computation at random points
};

/// A claim about a describing function. A test of the claim changes the formula, to see the claim fail.
struct GainClaim {
  Claim text;
  GainFormula formula;
};

/// Formula and computation at the printed points (FFT of samples; the printed digits by quadrature) and at random ones
/// (quadrature), never by a closed form of the law.
ClaimResult test_gain(const GainFormula& formula, const ClaimOptions& options);

/// The claim with its computation.
Claim as_claim(GainClaim claim);

/// Computed without any closed form. `by_fft`: by FFT, otherwise by quadrature.
DescribingFunction computed_gain(const Element& element, const DfPoint& point, bool by_fft, double accuracy,
                                 int harmonics = 7);

/// Both parts of a gain, compared within the error estimate of the computation and `slack`, relative to the gain.
void check_gain(ClaimChecks& checks, const std::string& where, const std::string& unit, std::complex<double> claimed,
                const DescribingFunction& computed, double slack = 1e-13);

/// Permitted error of a computed describing function: its error estimate and a few roundings.
inline double stated_error(const DescribingFunction& df) { return df.error + 1e-13; }

/// f(u) = (2/pi)(asin u + u sqrt(1 - u^2)); -1 and 1 beyond |u| = 1.
double share_inside(double u);

std::vector<GainClaim> memoryless_gain_claims();  ///< A1, A4 to A7, A10
std::vector<GainClaim> coulomb_gain_claims();     ///< A2, A3
std::vector<GainClaim> stop_gain_claims();        ///< A8, A9
std::vector<GainClaim> masing_gain_claims();      ///< A11, A11a to A11c
std::vector<GainClaim> dahl_gain_claims();        ///< A12

// Claims of more than one formula.
std::vector<Claim> gain_relation_claims();  ///< limits and relations of A2, A7, A8, A12; A13
std::vector<Claim> friction_gain_claims();  ///< A14 to A16
Claim passive_gain_claim();                 ///< A16

}  // namespace limcycle
