#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"
#include "limcycle/models/friction/sliders/gms_elements.hpp"

namespace limcycle {

/// Generalised Maxwell-slip friction (Lampaert, Al-Bender, Swevers 2003; Al-Bender, Lampaert, Swevers 2005, IEEE TAC
/// 50(11), 1883-1887) over a Stribeck curve: see GmsElements. Rate-dependent in sliding; non-local memory and no drift
/// in pre-sliding; not passive for Fs > Fc.
template <class S>
struct Gms : GmsElements<S, StribeckCurve<S>> {
  static constexpr std::string_view kind = "gms";
  static constexpr std::string_view equation =
      "stick: dF_i/dt = k_i v until |F_i| = alpha_i g(v);  slip: dF_i/dt = C (sgn(v) alpha_i - F_i/g(v)) until v "
      "changes "
      "sign;  F = sum F_i + sum (sigma1_i/k_i) dF_i/dt + sigma2 v;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Lampaert, Al-Bender, Swevers (2003), PhysCon, 1170-1177; Al-Bender, Lampaert, Swevers (2005), IEEE TAC 50(11), "
      "1883-1887; equations not confirmed";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift = "none: while the strongest element sticks, a closed cycle of force is a closed path",
      .rate = "in pre-sliding only sigma1; in sliding the level g(v), followed with the lag g/C (s), and sigma2 v",
      .passivity =
          "no, when Fs > Fc: slipping elements gain force in time, not along the path: load fast, creep for much "
          "longer than g/C, let go slowly and reverse: up to alpha_i^2 (Fs^2 - Fc^2)/k_i per element and cycle; far "
          "more, "
          "in proportion to the speed, if it turns back at once, an element that then slips pulling on for g/C; yes "
          "for "
          "Fs = Fc, storage sum F_i^2/(2 k_i)",
      .evidence =
          "citations confirmed; equations quoted from knowledge, consistent with public code up to scaling; read "
          "with g even in v, so that slip settles at sgn(v) alpha_i g(v)"};

  static std::vector<Parameter<Gms, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Gms>();
    Gms::append_elements(table);
    return table;
  }
};

}  // namespace limcycle
