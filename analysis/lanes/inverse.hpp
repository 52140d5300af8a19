#pragma once

namespace limcycle {

/// Exchanges a and b in the lanes of the mask.
template <class P>
[[gnu::always_inline]] inline void exchange_if(const typename P::Mask& mask, P& a, P& b) {
  const P kept = a;
  a = select(mask, b, a);
  b = select(mask, kept, b);
}

/// Inverse in place by Gauss and Jordan, n at most 8. Every lane has its own pivots: the largest number left in the
/// column is brought up by exchanges in the lanes where it is larger.
template <class P, int n>
[[gnu::always_inline]] inline void invert(P (&m)[n][n]) {
  typename P::Mask exchanged[n][n];
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
#pragma GCC unroll 8
    for (int i = k + 1; i < n; ++i) {
      exchanged[k][i] = abs(m[i][k]) > abs(m[k][k]);
#pragma GCC unroll 8
      for (int j = 0; j < n; ++j) exchange_if(exchanged[k][i], m[k][j], m[i][j]);
    }
    const P pivot = 1.0 / m[k][k];
    m[k][k] = P(1.0);
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) m[k][j] *= pivot;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const P factor = m[i][k];
      m[i][k] = P(0.0);
#pragma GCC unroll 8
      for (int j = 0; j < n; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  // Rows of the matrix were exchanged: columns of its inverse.
#pragma GCC unroll 8
  for (int k = n - 1; k >= 0; --k)
#pragma GCC unroll 8
    for (int i = n - 1; i > k; --i)
#pragma GCC unroll 8
      for (int j = 0; j < n; ++j) exchange_if(exchanged[k][i], m[j][k], m[j][i]);
}

}  // namespace limcycle
