#include "limcycle/analysis/frequency/kernels/df_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <numbers>

#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

namespace {

using std::numbers::pi;

/// Meshes from coarse to fine.
constexpr std::array<HalfPeriodSettings, 6> meshes{{{4, 1.0, 0.6, 0.1, 8e-5, 1.2e-4, 3e-5},
                                                    {4, 0.75, 0.5, 0.05, 1e-5, 1e-5, 4.5e-6},
                                                    {5, 0.81, 0.7, 0.03, 4.8e-7, 7e-7, 5.5e-7},
                                                    {6, 0.75, 0.4, 5e-3, 6e-9, 1e-8, 5.5e-8},
                                                    {8, 0.85, 0.4, 2e-3, 5e-10, 5e-10, 9e-10},
                                                    {8, 0.58, 0.2, 1e-5, 6e-12, 2e-12, 5e-12}}};
constexpr double roundings = 4e-15;

const LinearKernels& kernels_of(Isa isa) {
  return isa == Isa::avx512 ? avx512_linear_kernels : isa == Isa::avx2 ? avx2_linear_kernels : scalar_linear_kernels;
}

LevelShape shape_of(const LuGre<double>& law) {
  const double delta = law.curve.index == 1 ? 1.0 : law.delta;
  const bool even = std::fmod(delta, 2.0) == 0.0, whole = delta == std::floor(delta);
  const double velocity = law.vd > 0.0 ? std::min(law.vs, law.vd) : law.vs;
  return {law.Fs / law.sigma0, velocity, even ? 0.0 : whole ? 1.0 : delta, law.vd > 0.0};
}

struct Freed {
  void operator()(double* numbers) const { ::operator delete[](numbers, std::align_val_t{64}); }
};
using Aligned = std::unique_ptr<double[], Freed>;

/// |z| of numbers far from overflow and underflow.
double size(std::complex<double> z) { return std::sqrt(std::norm(z)); }

Aligned aligned(std::size_t count) {
  return Aligned(static_cast<double*>(::operator new[](count * sizeof(double), std::align_val_t{64})));
}

}  // namespace

/// Points that are computed on one kind of mesh, those with the same panels together.
class DfKernel::Batch {
 public:
  Batch(const DfKernel& owner, const HalfPeriodSettings& settings)
      : owner_(owner),
        settings_(settings),
        orders_((owner.options_.harmonics + 1) / 2),
        lanes_(lanes_of(owner.options_.isa)),
        panels_(HalfPeriodPanels::of(settings.stages, settings.width, orders_)),
        layers_(owner.shape_, settings),
        output_(std::visit([](const auto& law) { return law.linear_output({.x = 0.0, .v = 1.0, .drive = 0.0}); },
                           owner.law_)) {}

  /// The points numbered in `wanted`, with the bound of the mesh as the error.
  void compute(std::span<const DfPoint> points, const std::vector<std::size_t>& wanted,
               std::span<DescribingFunction> results) {
    for (const std::size_t i : wanted) {
      Group& group = group_of(layers_.range(*panels_, points[i].amplitude, points[i].frequency));
      group.points.push_back(i);
      if (std::ssize(group.points) == lanes_) run(group, points, results);
    }
    for (Group& group : groups_)
      if (!group.points.empty()) run(group, points, results);
  }

 private:
  /// Points that wait for others with the same mesh.
  struct Group {
    HalfPeriodPanels::Range mesh;
    std::vector<const double*> panels;
    std::vector<std::size_t> points;
  };

  Group& group_of(const HalfPeriodPanels::Range& mesh) {
    if (last_ < groups_.size() && groups_[last_].mesh == mesh) return groups_[last_];
    const auto known = std::ranges::find(groups_, mesh, &Group::mesh);
    last_ = static_cast<std::size_t>(known - groups_.begin());
    if (known != groups_.end()) return *known;
    groups_.push_back({mesh, {}, {}});
    panels_->select(mesh, groups_.back().panels);
    return groups_.back();
  }

  void run(Group& group, std::span<const DfPoint> points, std::span<DescribingFunction> results) {
    const int count = static_cast<int>(group.panels.size());
    need(LinearTask::scratch_size(settings_.stages, count, lanes_) + (4 * orders_ + 2) * lanes_);
    double* amplitude = scratch_.get();
    double* frequency = amplitude + lanes_;
    for (int lane = 0; lane < lanes_; ++lane) {
      const DfPoint& point = points[group.points[std::min(static_cast<std::size_t>(lane), group.points.size() - 1)]];
      amplitude[lane] = point.amplitude;
      frequency[lane] = point.frequency;
    }
    LinearTask task;
    task.collocation = &panels_->collocation();
    task.panels = group.panels.data();
    task.panel_count = count;
    task.orders = orders_;
    task.remembered = group.mesh.remembered;
    task.amplitude = amplitude;
    task.frequency = frequency;
    task.state_sums = frequency + lanes_;
    const std::ptrdiff_t sums = std::ptrdiff_t{2} * orders_ * lanes_;
    task.damping_sums = owner_.constant_damping_ ? nullptr : task.state_sums + sums;
    task.scratch = task.state_sums + 2 * sums;
    const LinearKernels& kernels = kernels_of(owner_.options_.isa);
    if (const auto* lugre = std::get_if<LuGre<double>>(&owner_.law_))
      kernels.lugre[settings_.stages](*lugre, task);
    else
      kernels.dahl[settings_.stages](std::get<Dahl<double>>(owner_.law_), task);
    for (std::size_t lane = 0; lane < group.points.size(); ++lane)
      collect(task, static_cast<int>(lane), points[group.points[lane]], results[group.points[lane]]);
    group.points.clear();
  }

  void need(int count) {
    if (count <= room_) return;
    room_ = 2 * count;
    scratch_ = aligned(static_cast<std::size_t>(room_));
  }

  /// Sine + j cosine coefficient, in the phase of A sin wt, from sums over the half period.
  std::complex<double> coefficient(const double* sums, int order, int lane) const {
    const double sine = sums[2 * order * lanes_ + lane], cosine = sums[(2 * order + 1) * lanes_ + lane];
    const double side = order % 2 == 0 ? 2.0 / pi : -2.0 / pi;  // phi = wt + pi/2
    return {-side * cosine, side * sine};
  }

  void collect(const LinearTask& task, int lane, const DfPoint& point, DescribingFunction& result) const {
    const double A = point.amplitude, w = point.frequency;
    result.harmonics.assign(static_cast<std::size_t>(owner_.options_.harmonics), 0.0);
    double state_part = 0.0;
    for (int order = 0; order < orders_; ++order) {
      const auto k = static_cast<double>(2 * order + 1);
      const std::complex<double> z = coefficient(task.state_sums, order, lane);
      // Coefficient of dz/dt: j k w times that of z, which is exact. If the damping varies: the sum over dz/dt itself.
      std::complex<double> F = output_.stiffness * z;
      if (task.damping_sums == nullptr)
        F += output_.damping * k * w * std::complex<double>(-z.imag(), z.real());
      else
        F += coefficient(task.damping_sums, order, lane);
      if (order == 0) {
        state_part = size(F);
        F += std::complex<double>(0.0, output_.rest * A * w);
      }
      result.harmonics[2 * static_cast<std::size_t>(order)] = F;
    }
    result.gain = result.harmonics[0] / A;
    result.mean = 0.0;
    result.dissipation = pi * A * result.harmonics[0].imag();
    result.error = owner_.bound(settings_) * state_part / size(result.harmonics[0]) + roundings;
    result.symmetric = true;
    result.status = Status::converged;
    result.evaluations += static_cast<long>(task.panel_count) * settings_.stages;
  }

  const DfKernel& owner_;
  HalfPeriodSettings settings_;
  int orders_, lanes_;
  std::shared_ptr<const HalfPeriodPanels> panels_;
  Layers layers_;
  LinearOutput<double> output_;  ///< at the rate 1; rest and damping as numbers if constant
  Aligned scratch_;
  int room_ = 0;
  std::vector<Group> groups_;
  std::size_t last_ = 0;  ///< group that was found last
};

DfKernel::DfKernel(Law law, const DfOptions& options) : law_(law), options_(options) {
  if (const auto* lugre = std::get_if<LuGre<double>>(&law_)) {
    shape_ = shape_of(*lugre);
    ratio_ = lugre->Fs / lugre->Fc;
    constant_damping_ = lugre->has_constant_damping();
    verified_ = constant_damping_ && ratio_ <= 4.0 && (lugre->delta <= 2.0 || lugre->curve.index == 1);
  } else {
    const auto& dahl = std::get<Dahl<double>>(law_);
    shape_.displacement = dahl.Fc / dahl.sigma0;
    verified_ = true;
  }
}

std::optional<DfKernel> DfKernel::of(const Element& element, const DfOptions& options) {
  if (options.harmonics > most_harmonics || options.accuracy < 2.0 * meshes.back().bound) return std::nullopt;
  if (const auto* lugre = element.as<LuGre<double>>())
    return lugre->odd() ? std::optional(DfKernel(*lugre, options)) : std::nullopt;
  if (const auto* dahl = element.as<Dahl<double>>(); dahl != nullptr && dahl->is_linear_in_state())
    return DfKernel(*dahl, options);
  if (auto law = KernelLaw::of(element); law && law->least < 0.5 * options.accuracy)
    return DfKernel(std::move(*law), options);
  return std::nullopt;
}

double DfKernel::bound(const HalfPeriodSettings& mesh) const {
  const double peak = ratio_ - 1.0;
  return mesh.bound + mesh.slope * peak + mesh.cubic * peak * peak * peak;
}

void DfKernel::compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const {
  if (marched_) {
    marched_->compute(points, results);
    return;
  }
  std::vector<std::size_t> wanted;
  wanted.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].bias == 0.0) wanted.push_back(i);
  struct Coarser {
    std::complex<double> gain;
    double apart = 0.0;  ///< difference from a mesh that was coarser still
  };
  std::vector<Coarser> coarser(verified_ ? 0 : points.size());
  int done = 0;
  for (const HalfPeriodSettings& mesh : meshes) {
    if (wanted.empty()) break;
    // Without a verified bound, three meshes are required; the coarsest of them need not reach the accuracy.
    if (verified_ ? bound(mesh) + roundings > options_.accuracy : mesh.bound > 300.0 * options_.accuracy) continue;
    Batch(*this, mesh).compute(points, wanted, results);
    std::erase_if(wanted, [&](std::size_t i) {
      DescribingFunction& result = results[i];
      if (!verified_) {
        const double apart = done > 0 ? std::abs(result.gain - coarser[i].gain) / std::abs(result.gain) : 1.0;
        // Two meshes may agree by chance; then the mesh before them differed strongly.
        result.error = 10.0 * std::max(apart, coarser[i].apart / 30.0) + 10.0 * mesh.bound + roundings;
        coarser[i] = {result.gain, apart};
      }
      if (!(result.error <= options_.accuracy) || (!verified_ && done < 2)) return false;
      result.method = "kernel";
      return true;
    });
    ++done;
  }
}

}  // namespace limcycle
