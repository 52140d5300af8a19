#pragma once
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/frequency/kernels/marched_half_period.hpp"
#include "limcycle/analysis/frequency/march/half_period_mesh.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// Describing functions of laws without direction dependence, computed for many points at a time in lanes, from the
/// half period of the periodic state. Laws linear in their state (LuGre, Dahl with exponent 1) take one pass
/// (linear_kernel.hpp). Others with independent states (elasto-plastic, Dahl, Bouc-Wen, Xiong; see KernelLaw) are
/// marched through their switches (march_kernel.hpp).
///
/// Error for laws linear in their state: in units of Fs/sigma0 and vs the problem has four numbers: alpha = A
/// sigma0/Fs, q = A w/vs, Fs/Fc and the exponent delta. For Fs <= 4 Fc, delta <= 2 and constant damping the error of
/// each mesh was measured over all alpha and q, and the bound of HalfPeriodSettings is about twice the largest error
/// found; tests check it against finer meshes and other methods. Points outside are computed on three meshes or more,
/// and the error is (at least) ten times the difference of the last two. The result of a point does not depend on the
/// other points of the call.
class DfKernel {
 public:
  /// Empty if the element is none of these laws, or if the accuracy is beyond the finest mesh.
  static std::optional<DfKernel> of(const Element& element, const DfOptions& options);

  /// Computes the points without bias. If the wanted accuracy was not reached, and for points with a bias, `method`
  /// stays empty. Cost of a point, laws linear in their state: 0.2 microseconds at 1e-6 with AVX-512, 1 at 1e-9.
  void compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const;

  /// Highest order of the harmonics that the kernel computes.
  static constexpr int most_harmonics = 63;

 private:
  using Law = std::variant<LuGre<double>, Dahl<double>>;
  class Batch;
  DfKernel(Law law, const DfOptions& options);
  DfKernel(KernelLaw law, const DfOptions& options)
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
