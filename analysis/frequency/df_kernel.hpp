#pragma once
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/analysis/frequency/half_period_mesh.hpp"
#include "limcycle/analysis/frequency/marched_half_period.hpp"

namespace limcycle {

/// Describing functions of laws without direction dependence, many points at a time and in lanes, by the half period
/// of the periodic state: of those linear in their state (LuGre, Dahl with exponent 1) in one pass (linear_kernel.hpp);
/// of others whose states know nothing of each other (elasto-plastic, Dahl, Bouc-Wen, GMS, Xiong; see MarchedLaw) by
/// marching it through its switches (march_kernel.hpp).
///
/// The error of the first kind. In units of Fs/sigma0 and vs the problem has four numbers: alpha = A sigma0/Fs, q = A
/// w/vs, Fs/Fc and the exponent delta. For Fs <= 4 Fc, delta <= 2 and constant damping the error of each mesh was
/// measured over all alpha and q, and the bound of HalfPeriodSettings is about twice the largest that was found; tests
/// hold it against finer meshes and other methods. What lies outside is computed on three meshes or more, and the error
/// is ten times the difference of the last two (at least). The result of a point does not depend on what it is computed
/// together with.
class DfKernel {
 public:
  /// Empty if the element is none of these laws, or if the accuracy is beyond the finest mesh.
  static std::optional<DfKernel> of(const Element<double>& element, const DfOptions& options);

  /// The points without bias. Where the wanted accuracy was not reached, and for the other points, `method` stays
  /// empty. Cost of a point, laws linear in their state: 0.2 microseconds at 1e-6 with AVX-512, 1 at 1e-9.
  void compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const;

  /// Highest order of the harmonics that it computes.
  static constexpr int most_harmonics = 63;

 private:
  using Law = std::variant<LuGre<double>, Dahl<double>>;
  class Batch;
  DfKernel(Law law, const DfOptions& options);
  DfKernel(MarchedLaw law, const DfOptions& options)
      : options_(options), marched_(std::in_place, std::move(law), options) {}
  double bound(const HalfPeriodSettings& mesh) const;

  Law law_;
  DfOptions options_;
  LevelShape shape_;
  double ratio_ = 1.0;  ///< Fs/Fc
  bool verified_ = false, constant_damping_ = true;
  std::optional<MarchedHalfPeriod> marched_;  ///< the other laws
};

}  // namespace limcycle
