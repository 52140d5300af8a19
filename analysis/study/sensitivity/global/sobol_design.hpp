#pragma once
#include <cstdint>
#include <vector>

#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

namespace limcycle {

/// Points of a model for Sobol indices (I. M. Sobol, 1993; A. Saltelli, Comput. Phys. Commun. 145, 2002). A base sample
/// is two independent points A and B; they are joined, for every parameter i, by A with B's i-th coordinate (AB_i) and,
/// for second order, B with A's (BA_i). A row is a point in (0, 1)^d, of shares for SpreadParameter::quantile.
///
/// A and B are the halves of the points of a 2 d-dimensional Sobol sequence (GSL's, beginning with its point 0, so that
/// any 2^k first samples are a net; a power of two is the best number of samples), with a random digital shift: the
/// same random bits are added modulo 2 to every point, which keeps it a net and no coordinate 0 or 1. GSL's sequence
/// has at most 40 dimensions: coordinates of parameters beyond the 20th are random numbers, so the parameters expected
/// to matter should come first. (Measured on Sobol's g with 25 and 60 parameters and 256 to 4096 samples: with the four
/// that matter first, errors are 0.1 to 0.9 of those of random points, with them last they are the same. GSL's reverse
/// Halton sequence, which has dimensions enough, makes them up to 20 times as large there.)
///
/// Rows are numbered sample by sample, and a row does not depend on the number of samples: a study can be extended
/// without loss.
class SobolDesign {
 public:
  /// Throws std::invalid_argument for no parameters, and for no samples or more than 2^30.
  SobolDesign(std::size_t parameters, std::size_t samples, bool second_order, std::uint64_t seed);

  std::size_t parameters() const { return parameters_; }
  std::size_t samples() const { return samples_; }
  bool second_order() const { return second_order_; }
  /// d + 2, or 2 d + 2 for second order.
  std::size_t rows_per_sample() const { return 2 + parameters_ * (second_order_ ? 2 : 1); }
  std::size_t rows() const { return samples_ * rows_per_sample(); }

  /// Point of row k. Throws std::out_of_range.
  std::vector<double> row(std::size_t k) const;

  /// Numbers of the rows of a sample. A and B alone are a fair sample of the parameters (for example to count how often
  /// a loop hunts); the others repeat their coordinates.
  std::size_t row_a(std::size_t sample) const { return sample * rows_per_sample(); }
  std::size_t row_b(std::size_t sample) const { return row_a(sample) + 1; }
  std::size_t row_ab(std::size_t sample, std::size_t parameter) const { return row_a(sample) + 2 + parameter; }
  /// Only with second order.
  std::size_t row_ba(std::size_t sample, std::size_t parameter) const {
    return row_a(sample) + 2 + parameters_ + parameter;
  }

 private:
  std::size_t parameters_, samples_;
  bool second_order_;
  std::vector<double> base_;  ///< 2 d numbers per sample: A, then B
};

}  // namespace limcycle
