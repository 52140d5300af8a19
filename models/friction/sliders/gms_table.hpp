#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/measured_curve.hpp"
#include "limcycle/models/friction/sliders/gms_elements.hpp"

namespace limcycle {

/// Generalised Maxwell-slip friction over a curve as it was measured (see GmsElements, MeasuredCurve).
template <class S>
struct GmsTable : GmsElements<S, MeasuredCurve<S>> {
  static constexpr std::string_view kind = "gms-table";
  static constexpr std::string_view equation =
      "stick: dF_i/dt = k_i v until |F_i| = alpha_i g(v);  slip: dF_i/dt = C (sgn(v) alpha_i - F_i/g(v)) until v "
      "changes sign;  F = sum F_i + sum (sigma1_i/k_i) dF_i/dt + sigma2 v;  g through (0, Fs) and the points "
      "(velocities, forces), monotone between them, level beyond the last";
  static constexpr std::string_view source =
      "Lampaert, Al-Bender, Swevers (2003), PhysCon, 1170-1177, equations not confirmed; measured points, "
      "interpolation "
      "after Fritsch and Butland (1984), quoted from knowledge";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift = "none: while the strongest element sticks, a closed cycle of force is a closed path",
      .rate = "in pre-sliding only sigma1; in sliding the level g(v), followed with the lag g/C (s), and sigma2 v",
      .passivity = "no, where the level falls below Fs, as gms",
      .evidence =
          "the elements as of gms; what was measured between its points is assumed to be smooth and monotone, "
          "and nothing is known beyond the last point"};

  static std::vector<Parameter<GmsTable, S>> parameters() {
    auto table = MeasuredCurve<S>::template curve_table<GmsTable>();
    GmsTable::append_elements(table);
    return table;
  }
};

}  // namespace limcycle
