#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/df_table.hpp"

namespace limcycle {

/// Gain N(A, w) of a friction law at one bias, interpolated, for a search that needs many values of the same region.
///
/// The plane of ln A and ln(A w) is covered by square cells, the largest of a factor 4. On a cell N is the polynomial
/// through its values at 8 x 8 Chebyshev points. A cell whose polynomial is off by more than 0.3 times the wanted
/// accuracy at one of 9 other points (corners, middles), or on which N does not exist everywhere, is quartered, twice
/// at most: near a kink of N no cell is smooth enough. N of a rate-independent law is a function of A alone, N/w of a
/// law without states one of A w alone: there a cell needs 8 values. Cells are made when first used; a value does not
/// depend on the order of the calls.
///
/// Error: the largest of thousands of random points on four laws was below the wanted accuracy (see the test). Cost: 73
/// or 11 describing functions for a new cell, else two logarithms and some hundred multiplications.
class GainSurface {
 public:
  /// `accuracy`: wanted relative accuracy of N, 1e-7..1e-2.
  GainSurface(Element element, double bias, double accuracy);

  /// N(A, w); empty where no cell is smooth enough.
  std::optional<std::complex<double>> at(double amplitude, double frequency);

  long evaluations() const { return evaluations_; }  ///< of the element's equations, so far

 private:
  using Complex = std::complex<double>;
  static constexpr int most_halvings = 2;
  /// Values at the nodes, [amplitude][speed]; empty: split or rough.
  using Cell = std::vector<Complex>;
  /// Size of the cell as a number of halvings, and its place in units of that size.
  using Name = std::array<std::int64_t, 3>;
  /// Place in a cell, -1..1 in both directions.
  using Place = std::array<double, 2>;

  std::vector<DescribingFunction> computed(const std::vector<DfPoint>& points);
  DfPoint point(const Name& name, const Place& place) const;
  Cell made(const Name& name);
  Complex interpolated(const Cell& cell, const Place& place) const;
  /// What is interpolated: N, or N/w.
  Complex smooth(Complex gain, double frequency) const { return of_speed_ ? gain / frequency : gain; }

  Element element_;
  DfTable table_;
  double bias_, accuracy_;
  bool of_amplitude_, of_speed_;  ///< whether it is a function of one variable alone
  std::map<Name, Cell> cells_;
  long evaluations_ = 0;
};

}  // namespace limcycle
