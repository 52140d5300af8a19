#pragma once
#include <array>
#include <cstddef>

namespace limcycle {

/// Radau IIA collocation with s stages on [0, 1]: nodes c (the last is 1), matrix a (row-major s x s), weights b = last
/// row of a. Order 2s - 1 at the end of a step and for integrals taken with b, L-stable: it follows a fast relaxation
/// and a slow drift with the same step. Hairer and Wanner, Solving Ordinary Differential Equations II (1996), IV.5.
struct RadauIIA {
  static constexpr int most_stages = 12;
  int stages = 0;
  std::array<double, most_stages> c{}, b{};
  std::array<double, static_cast<std::size_t>(most_stages) * most_stages> a{};
  std::array<double, most_stages + 1> barycentric{};  ///< weights of interpolation on the nodes 0, c_1 .. c_s
  std::array<double, static_cast<std::size_t>(most_stages) * most_stages> inverse{};  ///< of a
  std::array<double, most_stages> row_sum{};                                          ///< of that inverse

  /// Index of a_ij in `a`.
  std::size_t position(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(stages) + static_cast<std::size_t>(j);
  }
  double coefficient(int i, int j) const { return a[position(i, j)]; }

  /// Weights with which the values at 0, c_1 .. c_s give the collocation polynomial at t.
  void interpolation(double t, std::array<double, most_stages + 1>& weights) const;
};

/// Table for `stages` in 2..12, computed once in extended precision. Throws std::invalid_argument otherwise.
const RadauIIA& radau_iia(int stages);

}  // namespace limcycle
