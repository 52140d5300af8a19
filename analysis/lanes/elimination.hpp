#pragma once

namespace limcycle {

/// Solves m x = b in place for each right-hand side, n at most 8. Without row exchange: for matrices like those of
/// L-stable collocation, whose pivots do not vanish.
template <class P, int n, class... Right>
[[gnu::always_inline]] inline void eliminate(P (&m)[n][n], Right (&... right)[n]) {
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
    const P pivot = 1.0 / m[k][k];
    m[k][k] = pivot;
#pragma GCC unroll 8
    for (int i = k + 1; i < n; ++i) {
      const P factor = m[i][k] * pivot;
#pragma GCC unroll 8
      for (int j = k + 1; j < n; ++j) m[i][j] = m[i][j] - factor * m[k][j];
      ((right[i] = right[i] - factor * right[k]), ...);
    }
  }
#pragma GCC unroll 8
  for (int i = n - 1; i >= 0; --i) {
#pragma GCC unroll 8
    for (int j = i + 1; j < n; ++j) ((right[i] = right[i] - m[i][j] * right[j]), ...);
    ((right[i] = right[i] * m[i][i]), ...);
  }
}

}  // namespace limcycle
