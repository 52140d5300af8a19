#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/frequency/kernels/kernel_law.hpp"

namespace limcycle {

/// Describing functions of a marched law without bias, from the half period between two reversals: u(pi) = -u(0) is
/// solved by Newton's method. Many points at a time; the result of a point does not depend on the others.
class MarchedHalfPeriod {
 public:
  MarchedHalfPeriod(KernelLaw law, const DfOptions& options) : law_(std::move(law)), options_(options) {}

  /// Points are marched on two meshes or more, from coarse to fine. The error follows from the difference of the last
  /// two, see `trust`. If the wanted accuracy was not reached, `method` stays empty.
  void compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const;

  /// Result on mesh number `mesh`, 0..; empty if no periodic state was found. For tests.
  std::optional<std::complex<double>> on_mesh(const DfPoint& point, std::size_t mesh) const;
  static std::size_t meshes();

 private:
  class Batch;
  void march(std::span<const DfPoint> points, std::vector<std::size_t> wanted,
             std::span<DescribingFunction> results) const;
  DescribingFunction collect(const Batch& batch, std::size_t i, const DfPoint& point) const;
  KernelLaw law_;
  DfOptions options_;
};

}  // namespace limcycle
