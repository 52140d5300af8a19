#pragma once
#include <optional>

#include "limcycle/models/measured/vector_fit.hpp"

namespace limcycle {

/// What is asked of a fit; empty: chosen from the data.
struct FitWish {
  std::optional<int> order, poles_at_zero, relative_degree;
  bool operator==(const FitWish&) const = default;
};

/// Largest order that is chosen, and that may be asked for.
inline constexpr int most_chosen_order = 16, most_fitted_order = 40;

/// The fit that was asked for. What is not asked for is chosen by Schwarz's criterion (Annals of Statistics 6, 1978):
/// 2 n ln(misfit) + p ln(2 n) is least, for n points and p numbers fitted, and a fit that agrees to 1e-9 is exact. A
/// pole at zero must show as a slope of the data at their lowest frequencies: k of them need a slope steeper than 1/2 -
/// k; where the data fall more steeply than -3/2 at their highest, the relative degree is 2. Orders are tried upwards
/// until four in a row are no better, and for each further number of poles at zero and relative degree within two of
/// the best. Empty if there are too few points, or no fit is finite.
std::optional<VectorFit> chosen_fit(const FrequencyData& data, const FitWish& wish);

/// Slopes d ln|G|/d ln w over the lowest and the highest third of a decade (or three points).
struct EndSlopes {
  double low = 0.0, high = 0.0;
};
EndSlopes end_slopes(const FrequencyData& data);

}  // namespace limcycle
