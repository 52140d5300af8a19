#pragma once
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace limcycle {

/// Solves in place an m x m system with `right` right-hand sides, stored row-major as m rows of m + right numbers; the
/// solutions take the place of the right-hand sides. Gaussian elimination with row pivoting; meant for the few unknowns
/// of one collocation panel, where a library call costs more than the work. Zeros below a pivot and above the diagonal
/// cost nothing. False if a pivot vanishes or is not finite.
inline bool eliminate(std::vector<double>& system, std::size_t m, std::size_t right) {
  const std::size_t width = m + right;
  const auto row = [&](std::size_t i) { return system.data() + i * width; };
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < m; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(pivot)[k])) pivot = i;
    const double diagonal = row(pivot)[k];
    if (!(std::abs(diagonal) > 0.0) || !std::isfinite(diagonal)) return false;
    if (pivot != k)
      for (std::size_t j = k; j < width; ++j) std::swap(row(k)[j], row(pivot)[j]);
    const double* const upper = row(k);
    const double inverse = 1.0 / diagonal;
    for (std::size_t i = k + 1; i < m; ++i) {
      double* const lower = row(i);
      if (lower[k] == 0.0) continue;
      const double factor = lower[k] * inverse;
      for (std::size_t j = k + 1; j < width; ++j) lower[j] -= factor * upper[j];
    }
  }
  for (std::size_t k = m; k-- > 0;) {
    double* const own = row(k);
    for (std::size_t j = k + 1; j < m; ++j) {
      if (own[j] == 0.0) continue;
      const double factor = own[j];
      const double* const below = row(j);
      for (std::size_t r = m; r < width; ++r) own[r] -= factor * below[r];
    }
    const double inverse = 1.0 / own[k];
    for (std::size_t r = m; r < width; ++r) own[r] *= inverse;
  }
  return true;
}

/// The same for one matrix and many right-hand sides in turn: its triangular factors, with row pivoting.
class Factors {
 public:
  /// Takes the m x m matrix, row-major. False if a pivot vanishes or is not finite.
  bool take(std::vector<double>& matrix, std::size_t m) {
    factors_.swap(matrix);
    pivots_.resize(m);
    for (std::size_t k = 0; k < m; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < m; ++i)
        if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
      if (!(std::abs(at(pivot, k)) > 0.0) || !std::isfinite(at(pivot, k))) return false;
      pivots_[k] = pivot;
      if (pivot != k)
        for (std::size_t j = 0; j < m; ++j) std::swap(at(k, j), at(pivot, j));
      const double inverse = 1.0 / at(k, k);
      for (std::size_t i = k + 1; i < m; ++i) {
        if (at(i, k) == 0.0) continue;
        const double factor = at(i, k) *= inverse;
        for (std::size_t j = k + 1; j < m; ++j) at(i, j) -= factor * at(k, j);
      }
    }
    return true;
  }
  /// The solution takes the place of the right-hand side.
  void solve(std::vector<double>& right) const {
    const std::size_t m = pivots_.size();
    for (std::size_t k = 0; k < m; ++k) std::swap(right[k], right[pivots_[k]]);
    for (std::size_t i = 1; i < m; ++i)
      for (std::size_t j = 0; j < i; ++j) right[i] -= at(i, j) * right[j];
    for (std::size_t i = m; i-- > 0;) {
      for (std::size_t j = i + 1; j < m; ++j) right[i] -= at(i, j) * right[j];
      right[i] /= at(i, i);
    }
  }

 private:
  double& at(std::size_t i, std::size_t j) { return factors_[i * pivots_.size() + j]; }
  double at(std::size_t i, std::size_t j) const { return factors_[i * pivots_.size() + j]; }

  std::vector<double> factors_;
  std::vector<std::size_t> pivots_;
};

}  // namespace limcycle
