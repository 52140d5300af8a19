#pragma once
#include <cstdint>
#include <vector>

#include "limcycle/analysis/study/global/random_stream.hpp"

namespace limcycle {

/// At which points a model is asked for Sobol indices (I. M. Sobol, 1993; A. Saltelli, Comput. Phys. Commun. 145,
/// 2002). A base sample is two independent points A and B; beside them stand, for every parameter i, A with B's i-th
/// coordinate (AB_i) and, for second order, B with A's (BA_i). A row is a point in (0, 1)^d, of shares for
/// SpreadParameter::quantile.
///
/// A and B are the halves of the points of a 2 d-dimensional Sobol sequence (GSL's, beginning with its point 0, so that
/// any 2^k first samples are a net; a power of two is the best number of samples), moved by a random digital shift: the
/// same random bits are added modulo 2 to every point, which keeps it a net and no coordinate 0 or 1. GSL's sequence
/// has at most 40 dimensions. Beyond 20 parameters GSL's reverse Halton sequence (B. Vandewoestyne, R. Cools, 2006)
/// stands in, moved by a random shift modulo 1; it needs more samples (several times its largest prime, 173 for 20
/// parameters and 541 for 50) before it is better than random points.
///
/// Rows are numbered sample by sample, and a row does not depend on the number of samples: a study can be made longer
/// without loss.
class SobolDesign {
 public:
  static constexpr std::size_t most_parameters = 614;

  /// Throws std::invalid_argument for no parameters or more than 614, and for no samples or more than 2^30.
  SobolDesign(std::size_t parameters, std::size_t samples, bool second_order, std::uint64_t seed);

  std::size_t parameters() const { return parameters_; }
  std::size_t samples() const { return samples_; }
  bool second_order() const { return second_order_; }
  /// d + 2, or 2 d + 2 for second order.
  std::size_t rows_per_sample() const { return 2 + parameters_ * (second_order_ ? 2 : 1); }
  std::size_t rows() const { return samples_ * rows_per_sample(); }

  /// Point of row k. Throws std::out_of_range.
  std::vector<double> row(std::size_t k) const;

  /// Numbers of the rows of a sample. A and B are a fair sample of the parameters by themselves (to count how often a
  /// loop hunts, say); the others repeat their coordinates.
  std::size_t row_a(std::size_t sample) const { return sample * rows_per_sample(); }
  std::size_t row_b(std::size_t sample) const { return row_a(sample) + 1; }
  std::size_t row_ab(std::size_t sample, std::size_t parameter) const { return row_a(sample) + 2 + parameter; }
  /// Only with second order.
  std::size_t row_ba(std::size_t sample, std::size_t parameter) const {
    return row_a(sample) + 2 + parameters_ + parameter;
  }

 private:
  void take_sobol(RandomStream random);
  void take_halton(RandomStream random);

  std::size_t parameters_, samples_;
  bool second_order_;
  std::vector<double> base_;  ///< 2 d numbers a sample: A, then B
};

}  // namespace limcycle
