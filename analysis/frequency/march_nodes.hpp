#pragma once
#include "limcycle/analysis/frequency/march_kernel.hpp"

namespace limcycle {

/// What polynomials through the nodes of a panel, 0 and c_1 .. c_S, are asked for.
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
  /// Where values that are positive at `left` and negative at `right` are 0, by Newton within these bounds; and their
  /// slope there.
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

/// Solves m x = b for two right-hand sides, in their place; without row exchange, as for the linear kernel.
template <class P, int S>
[[gnu::always_inline]] inline void eliminate(P (&m)[S][S], P (&x)[S], P (&y)[S]) {
#pragma GCC unroll 8
  for (int k = 0; k < S; ++k) {
    const P pivot = 1.0 / m[k][k];
    m[k][k] = pivot;
#pragma GCC unroll 8
    for (int i = k + 1; i < S; ++i) {
      const P factor = m[i][k] * pivot;
#pragma GCC unroll 8
      for (int j = k + 1; j < S; ++j) m[i][j] = m[i][j] - factor * m[k][j];
      x[i] = x[i] - factor * x[k];
      y[i] = y[i] - factor * y[k];
    }
  }
#pragma GCC unroll 8
  for (int i = S - 1; i >= 0; --i) {
#pragma GCC unroll 8
    for (int j = i + 1; j < S; ++j) {
      x[i] = x[i] - m[i][j] * x[j];
      y[i] = y[i] - m[i][j] * y[j];
    }
    x[i] = x[i] * m[i][i];
    y[i] = y[i] * m[i][i];
  }
}

}  // namespace limcycle
