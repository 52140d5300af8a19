/// @file
/// Points at which the root search evaluates the loop equation, with a cache of the values. (Internal to the root
/// search.)
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"

namespace limcycle {

/// Thrown by RootLattice when the evaluations are used up.
struct RootBudgetExhausted {};

/// Thrown when `interrupted` or `stop` of RootSearchOptions returns true.
struct RootSearchInterrupted {};

/// Integer lattice over the box in p = ln A, q = ln w, with a cache of the values of the scaled loop equation.
///
/// The box is cut into blocks (2 x 2 initial cells) by lines that the hints move or add; each block has unit() steps in
/// both directions, so that bisected cells share nodes exactly. The scaled function is `f / sqrt(1 + |f - 1|^2)`: same
/// argument and zeros, modulus at most sqrt(2), and a relative error e of N moves it by no more than e.
/// Values that are undefined (or infinite) are NaN. The outer lines stand 1e-9 outside the box where f exists there.
class RootLattice {
 public:
  /// Keeps a reference to `f`. Throws std::invalid_argument if the box is not positive, finite and of some extent.
  RootLattice(const LoopEquation& f, const SearchBox& box, const RootSearchOptions& options);

  std::int64_t unit() const { return unit_; }
  std::int64_t columns() const { return std::ssize(p_lines_) - 1; }  ///< blocks along p
  std::int64_t rows() const { return std::ssize(q_lines_) - 1; }     ///< blocks along q
  double p(std::int64_t i) const { return coordinate(p_lines_, i); }
  double q(std::int64_t j) const { return coordinate(q_lines_, j); }
  /// Amplitude or frequency from p or q: the exact value requested on a line, exp() elsewhere.
  double amplitude(double p) const;
  double frequency(double q) const;
  bool inside(double p, double q) const;  ///< of the box with its margin
  long evaluations() const { return evaluations_; }
  /// Relative accuracies of N to request, from coarse to fine.
  const std::array<double, 3>& accuracies() const { return accuracies_; }

  /// Scaled function at a node, at least as accurate as requested; cached.
  std::complex<double> sample(std::int64_t i, std::int64_t j, double accuracy);
  bool is_known(std::int64_t i, std::int64_t j) const { return known_.contains({i, j}); }
  /// Scaled function anywhere; not cached.
  std::complex<double> at(double p, double q, double accuracy);
  /// The loop equation itself.
  std::complex<double> equation(double p, double q, double accuracy);

 private:
  struct Line {
    double coordinate;  // ln of value
    double value;
  };
  struct Known {
    std::complex<double> value;
    double accuracy;
  };
  struct NodeHash {
    std::size_t operator()(const std::pair<std::int64_t, std::int64_t>& node) const;
  };

  static std::vector<Line> lines(double from, double to, int cells, const std::vector<double>& hints);
  double coordinate(const std::vector<Line>& lines, std::int64_t i) const;

  const LoopEquation& f_;
  SearchBox box_;
  long max_evaluations_;
  std::function<bool()> stop_;
  std::array<double, 3> accuracies_;
  std::int64_t unit_;
  std::vector<Line> p_lines_, q_lines_;
  std::unordered_map<std::pair<std::int64_t, std::int64_t>, Known, NodeHash> known_;
  long evaluations_ = 0;
};

/// Amplitudes at which f begins or ceases to exist, at the middle frequency of the box, by a scan over the initial
/// cells and bisection down to rounding: the outermost amplitude at which it still exists. A describing function that
/// does not exist up to some amplitude (relay below its hysteresis) then gets a grid line exactly there.
/// Cost: one evaluation per initial cell, about 50 for each such amplitude.
std::vector<double> existence_borders(RootLattice& lattice, const SearchBox& box, int cells);

}  // namespace limcycle
