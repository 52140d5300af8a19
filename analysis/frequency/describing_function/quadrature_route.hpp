#pragma once
#include <array>
#include <optional>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/frequency/kernels/gms_period.hpp"
#include "limcycle/analysis/frequency/kernels/linear_period.hpp"
#include "limcycle/analysis/frequency/march/harmonic_sums.hpp"
#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Meshes from coarse to fine. Any two successive ones differ in width, stages and cap, hence in where their panels
/// lie.
inline constexpr std::array<MeshSettings, 7> quadrature_meshes{
    {{4, 1.0, 0.1}, {5, 0.75, 0.03}, {6, 0.6, 4e-3}, {7, 0.5, 5e-4}, {8, 0.4, 3e-5}, {9, 0.3, 1e-6}, {10, 0.2, 1e-8}}};

/// Agreement of a mesh with its coarser neighbour below this is chance: hardly any problem is solved better on that
/// mesh.
inline constexpr std::array<double, 7> chance{1.0, 2e-7, 4e-10, 1e-11, 0.0, 0.0, 0.0};

/// One element at one point: harmonics by the quadrature of the collocation itself on graded meshes.
class QuadratureRoute {
 public:
  QuadratureRoute(Element element, const PrescribedMotion& motion, bool try_symmetric, const DfOptions& options)
      : element_(std::move(element)),
        motion_(motion),
        try_symmetric_(try_symmetric),
        options_(options),
        tolerance_(1e-4 * options.accuracy),
        sums_(options.harmonics) {
    if (options.method != DfMethod::automatic) return;
    linear_ = LinearPeriod::of(element_);
    if (try_symmetric) gms_ = GmsPeriod::of(element_);
  }

  /// A first harmonic below this share of the mean |output| that two meshes cannot distinguish from zero is reported as
  /// zero: sliding without reversals on a level that has become constant.
  static constexpr double indistinct = 1e-11;

  /// Refines until two successive meshes agree to the wanted accuracy and returns the finer result. Its error is the
  /// sum of three parts: twice their difference (as a rule the error of the coarser mesh, far larger than that of the
  /// finer), the error that agreement by chance could hide, and the errors common to both meshes (defect of periodicity
  /// and roundings). Incomplete if no mesh reached the accuracy.
  DescribingFunction refine() {
    DescribingFunction best;
    bool have = false;
    for (std::size_t level = first_level(); level < quadrature_meshes.size(); ++level) {
      DescribingFunction now = on_mesh(quadrature_meshes[level]);
      now.evaluations += best.evaluations;
      if (now.status != Status::converged) {
        if (!have || now.status == Status::not_finite) return now;
        best.status = Status::incomplete;
        return best;
      }
      const double difference = have ? relative(std::abs(now.gain - best.gain), now.gain) : 1.0;
      const double floor = now.error;
      now.error = 2.0 * difference + chance[level] + floor;
      best = now;
      if (have && best.error <= options_.accuracy) return best;
      if (have && difference <= floor && tolerance_ == 0.0) break;  // rounding: a finer mesh does not help
      if (floor > 0.1 * options_.accuracy) tolerance_ = 0.0;
      have = true;
    }
    if (best.error >= 1.0 && std::abs(best.harmonics[0]) <= indistinct * size_) {
      best.gain = best.harmonics[0] = 0.0;
      best.error = 0.0;
      return best;
    }
    best.status = Status::incomplete;
    return best;
  }

  /// The result on one mesh. `error` holds only the errors common to two meshes: defect of periodicity and rounding.
  DescribingFunction on_mesh(MeshSettings settings) {
    settings.harmonics = options_.harmonics;
    PeriodMesh mesh = graded_mesh(motion_, element_.scales(), settings);
    if (const auto knots = element_.knots(); !knots.empty()) split_at_speeds(mesh, motion_, knots);
    sums_.restart();
    if (auto periodic = linear_ ? linear_->find(motion_, mesh, settings.stages, try_symmetric_, sums_) : std::nullopt)
      return take(std::move(*periodic), linear_->evaluations());
    if (auto periodic = gms_ ? gms_->find(motion_, mesh, settings.stages, sums_) : std::nullopt)
      return take(std::move(*periodic), gms_->evaluations());
    ElementMarch march(element_, motion_, settings.stages);
    PeriodicStateSearch search(march, mesh, try_symmetric_, tolerance_);
    PeriodicState periodic = search.find(sums_, has_guess_ ? &guess_ : nullptr);
    return take(std::move(periodic), march.evaluations());
  }

 private:
  DescribingFunction take(PeriodicState periodic, long evaluations) {
    DescribingFunction result = collect(periodic);
    result.evaluations = evaluations;
    if (result.status == Status::converged) {
      guess_ = std::move(periodic);
      has_guess_ = true;
    }
    return result;
  }

  std::size_t first_level() const { return options_.accuracy >= 1e-7 ? 0 : options_.accuracy >= 1e-10 ? 1 : 2; }

  static double relative(double difference, std::complex<double> gain) {
    return gain == 0.0 ? (difference == 0.0 ? 0.0 : 1.0) : difference / std::abs(gain);
  }

  DescribingFunction collect(const PeriodicState& periodic) {
    DescribingFunction result;
    result.method = "quadrature";
    result.status = periodic.status;
    if (periodic.status != Status::converged) return result;
    const bool half = periodic.symmetric;
    const double A = motion_.amplitude(), size = size_ = sums_.size(half);
    for (int k = 1; k <= options_.harmonics; ++k) result.harmonics.push_back(sums_.harmonic(k, half));
    // A first harmonic of rounding size is none: a constant output has gain 0, not 1e-17.
    if (std::abs(result.harmonics[0]) <= 64.0 * epsilon * size) result.harmonics[0] = 0.0;
    result.gain = result.harmonics[0] / A;
    if (!std::isfinite(std::abs(result.gain))) {  // finer meshes would not be either
      result.status = Status::not_finite;
      return result;
    }
    result.mean = sums_.mean(half);
    result.dissipation = sums_.work(half, motion_.frequency());
    result.symmetric = half || (try_symmetric_ && odd_output(result));
    const double shared = 16.0 * epsilon * size + 1.3 * output_change(periodic);
    result.error = result.gain == 0.0 ? 0.0 : shared / std::abs(result.harmonics[0]);
    return result;
  }

  /// True if the output is half-wave symmetric although the state is not. What a law remembers of the way to the first
  /// turning point may lie on one side without any effect.
  bool odd_output(const DescribingFunction& result) const {
    double even = std::abs(result.mean);
    for (std::size_t order = 2; order <= result.harmonics.size(); order += 2)
      even = std::max(even, std::abs(result.harmonics[order - 1]));
    return even <= std::max(1e-9, options_.accuracy) * size_;
  }

  /// Change of the output at the beginning of the period when the state changes by the defect of periodicity.
  double output_change(const PeriodicState& periodic) const {
    const auto n = static_cast<std::size_t>(element_.states());
    if (n == 0 || periodic.defect == 0.0) return 0.0;
    const Input<double> in = motion_.at(1, 1e-3).in;
    std::vector<double> z = periodic.state.z;
    const double here = element_.output(in, periodic.state.mode, z);
    const double enlarged = std::max(1.0, 1e-6 / periodic.defect);  // the change must exceed roundings of the output
    for (std::size_t p = 0; p < n; ++p) z[p] += enlarged * periodic.defect * periodic.scale[p];
    const double change = std::abs(element_.output(in, periodic.state.mode, z) - here) / enlarged;
    return std::isfinite(change) ? change : 0.0;
  }

  static constexpr double epsilon = 2.3e-16;
  Element element_;
  const PrescribedMotion& motion_;
  bool try_symmetric_;
  DfOptions options_;
  std::optional<LinearPeriod> linear_;
  std::optional<GmsPeriod> gms_;
  double tolerance_;   ///< of the periodic state
  double size_ = 0.0;  ///< mean |output| of the last mesh
  HarmonicSums sums_;
  PeriodicState guess_;
  bool has_guess_ = false;
};

}  // namespace limcycle
