#pragma once
#include "limcycle/analysis/frequency/kernels/march_kernel.hpp"

namespace limcycle {

/// Operations on polynomials through the nodes of a panel, 0 and c_1 .. c_S.
template <class P, int S>
struct MarchPolynomial {
  const MarchCollocation& collocation;

  /// Values at the nodes become divided differences.
  void divide(P (&c)[S + 1]) const {
    for (int k = 1; k <= S; ++k)
      for (int i = S; i >= k; --i) c[i] = (c[i] - c[i - 1]) * collocation.apart[i][i - k];
  }
  /// At t, of divided differences.
  P at(const P& t, const P (&c)[S + 1]) const {
    P value = c[S];
    for (int i = S - 1; i >= 0; --i) value = value * (t - collocation.nodes[i]) + c[i];
    return value;
  }
  /// Derivatives at both ends, of values. Bounds that are never met cancel only in differences.
  P slope_at_start(const P (&values)[S + 1]) const {
    P sum = P(0.0);
    for (int i = 1; i <= S; ++i) sum += collocation.start_slope[i] * (values[i] - values[0]);
    return sum;
  }
  P slope_at_end(const P (&values)[S + 1]) const {
    P sum = P(0.0);
    for (int i = 0; i < S; ++i) sum += collocation.end_slope[i] * (values[i] - values[S]);
    return sum;
  }
  /// Zero of values that are positive at `left` and negative at `right`, by Newton within these bounds, and the slope
  /// there.
  P root(P (&c)[S + 1], P left, P right, P& slope) const {
    divide(c);
    P t = 0.5 * (left + right);
    for (int pass = 0; pass < 7; ++pass) {
      P value = c[S];
      slope = P(0.0);
      for (int i = S - 1; i >= 0; --i) {
        const P step = t - collocation.nodes[i];
        slope = slope * step + value;
        value = value * step + c[i];
      }
      const typename P::Mask inside = value > 0.0;
      left = select(inside, t, left);
      right = select(inside, right, t);
      const P guess = t - value / slope;
      t = select((guess >= left) & (guess <= right), guess, 0.5 * (left + right));
    }
    return t;
  }
};

}  // namespace limcycle
