#pragma once
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/analysis/frequency/half_period_mesh.hpp"

namespace limcycle {

/// Describing functions of laws that are linear in their state (LuGre without direction dependence, Dahl with exponent
/// 1), many points at a time and in lanes, by the half period of the periodic state (see linear_kernel.hpp).
///
/// The error. In units of Fs/sigma0 and vs the problem has four numbers: alpha = A sigma0/Fs, q = A w/vs, Fs/Fc and the
/// exponent delta. For Fs <= 4 Fc, delta <= 2 and constant damping the error of each mesh was measured over all alpha
/// and q, and the bound of HalfPeriodSettings is about twice the largest that was found;
/// tests hold it against finer meshes and other methods. What lies outside is computed on three meshes or more, and
/// the error is ten times the difference of the last two (at least). The result of a point does not depend on what it
/// is computed together with.
class DfKernel {
 public:
  /// Empty if the element is none of these laws, or if the accuracy is beyond the finest mesh.
  static std::optional<DfKernel> of(const Element<double>& element, const DfOptions& options);

  /// The points without bias. Where the wanted accuracy was not reached, and for the other points, `method` stays
  /// empty. Cost of a point: 0.2 microseconds at 1e-6 with AVX-512, 1 at 1e-9.
  void compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const;

  /// Highest order of the harmonics that it computes.
  static constexpr int most_harmonics = 63;

 private:
  using Law = std::variant<LuGre<double>, Dahl<double>>;
  class Batch;
  DfKernel(Law law, const DfOptions& options);
  double bound(const HalfPeriodSettings& mesh) const;

  Law law_;
  DfOptions options_;
  LevelShape shape_;
  double ratio_ = 1.0;  ///< Fs/Fc
  bool verified_ = false, constant_damping_ = true;
};

}  // namespace limcycle
