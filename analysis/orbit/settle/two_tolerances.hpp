#pragma once
#include <algorithm>

/// @file
/// Errors of a periodic solution by comparison with that of a looser integration.

namespace limcycle {

/// Tolerance of the second integration: looser than the first, but not looser than `loosest`.
inline double loose_tolerance(double rtol, double loosest) { return std::max(rtol, std::min(100.0 * rtol, loosest)); }

/// Share of the difference of the two that is stated as the error of the tight one. Errors are roughly proportional to
/// the tolerance; six times as much is stated.
inline double stated_share(double rtol, double loose) { return std::min(1.0, 6.0 * rtol / loose); }

/// Factor by which to tighten the tolerance if `error` is more than `wanted`.
inline double tightening(double wanted, double error) { return std::clamp(0.5 * wanted / error, 0.03, 0.5); }

}  // namespace limcycle
