#include "limcycle/analysis/frequency/df_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <numbers>
#include <numeric>
#include <utility>

namespace limcycle {

namespace {

constexpr double pi = std::numbers::pi;

/// Meshes from coarse to fine.
constexpr std::array<HalfPeriodSettings, 6> meshes{{{4, 1.0, 0.6, 0.1, 8e-5, 1.2e-4, 3e-5},
                                                    {4, 0.75, 0.5, 0.05, 1e-5, 1.4e-5, 4e-6},
                                                    {5, 0.68, 0.5, 0.03, 4e-7, 1e-6, 1.5e-7},
                                                    {6, 0.65, 0.4, 5e-3, 1.2e-8, 3e-8, 2e-8},
                                                    {8, 0.66, 0.3, 3e-4, 1e-10, 2e-10, 4.4e-9},
                                                    {8, 0.45, 0.2, 1e-5, 4e-12, 1.4e-11, 4e-12}}};
constexpr double roundings = 4e-15;

const LinearKernels& kernels_of(Isa isa) {
  return isa == Isa::avx512 ? avx512_linear_kernels : isa == Isa::avx2 ? avx2_linear_kernels : scalar_linear_kernels;
}

LevelShape shape_of(const LuGre<double>& law) {
  const double delta = law.curve.index == 1 ? 1.0 : law.delta;
  const bool even = std::fmod(delta, 2.0) == 0.0, whole = delta == std::floor(delta);
  const double velocity = law.vd > 0.0 ? std::min(law.vs, law.vd) : law.vs;
  return {law.Fs / law.sigma0, velocity, even ? 0.0 : whole ? 1.0 : delta};
}

struct Freed {
  void operator()(double* numbers) const { ::operator delete[](numbers, std::align_val_t{64}); }
};
using Aligned = std::unique_ptr<double[], Freed>;

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
        panels_(HalfPeriodPanels::of(settings.stages, settings.width, orders_)) {}

  /// The points numbered in `wanted`, with the bound of the mesh as the error.
  void compute(std::span<const DfPoint> points, const std::vector<std::size_t>& wanted,
               std::span<DescribingFunction> results) {
    keys_.clear();
    for (const std::size_t i : wanted) keys_.push_back({mesh_of(points[i]), i});
    std::sort(keys_.begin(), keys_.end());
    for (std::size_t first = 0; first < keys_.size();) {
      std::size_t end = first;
      while (end < keys_.size() && end - first < static_cast<std::size_t>(lanes_) &&
             keys_[end].mesh == keys_[first].mesh)
        ++end;
      run(points, {keys_.data() + first, end - first}, results);
      first = end;
    }
  }

 private:
  struct Mesh {
    HalfPeriodPanels::Range range;
    int remembered = 0;
    auto operator<=>(const Mesh&) const = default;
  };
  struct Key {
    Mesh mesh;
    std::size_t point;
    auto operator<=>(const Key&) const = default;
  };

  Mesh mesh_of(const DfPoint& point) const {
    const Layers layers = layers_of(owner_.shape_, point.amplitude, point.frequency, settings_);
    Mesh mesh;
    mesh.range =
        panels_->range(std::min(1.0, settings_.cap * layers.after), std::min(1.0, settings_.cap * layers.before));
    // The initial state has decayed by e^-40 at least after the way of 40 displacements.
    const double half_sine_square = 20.0 * owner_.shape_.displacement / point.amplitude;
    const double phase = half_sine_square < 1.0 ? 2.0 * std::asin(std::sqrt(half_sine_square)) : pi;
    mesh.remembered = panels_->panels_until(mesh.range, phase);
    return mesh;
  }

  void run(std::span<const DfPoint> points, std::span<const Key> keys, std::span<DescribingFunction> results) {
    const Mesh& mesh = keys.front().mesh;
    panels_->select(mesh.range, selected_);
    const int count = static_cast<int>(selected_.size());
    need(LinearTask::scratch_size(settings_.stages, count, lanes_) + (4 * orders_ + 2) * lanes_);
    double* amplitude = scratch_.get();
    double* frequency = amplitude + lanes_;
    for (int lane = 0; lane < lanes_; ++lane) {
      const DfPoint& point = points[keys[std::min(static_cast<std::size_t>(lane), keys.size() - 1)].point];
      amplitude[lane] = point.amplitude;
      frequency[lane] = point.frequency;
    }
    LinearTask task;
    task.collocation = &panels_->collocation();
    task.panels = selected_.data();
    task.panel_count = count;
    task.orders = orders_;
    task.remembered = mesh.remembered;
    task.amplitude = amplitude;
    task.frequency = frequency;
    task.state_sums = frequency + lanes_;
    task.damping_sums = owner_.constant_damping_ ? nullptr : task.state_sums + 2 * orders_ * lanes_;
    task.scratch = task.state_sums + 4 * orders_ * lanes_;
    const LinearKernels& kernels = kernels_of(owner_.options_.isa);
    if (const auto* lugre = std::get_if<LuGre<double>>(&owner_.law_))
      kernels.lugre[settings_.stages](*lugre, task);
    else
      kernels.dahl[settings_.stages](std::get<Dahl<double>>(owner_.law_), task);
    for (std::size_t lane = 0; lane < keys.size(); ++lane)
      collect(task, static_cast<int>(lane), points[keys[lane].point], results[keys[lane].point]);
  }

  void need(int count) {
    if (count <= room_) return;
    room_ = 2 * count;
    scratch_ = aligned(static_cast<std::size_t>(room_));
  }

  /// Sine + j cosine coefficient, in the phase of A sin wt, of what the sums over the half period are of.
  std::complex<double> coefficient(const double* sums, int order, int lane) const {
    const double sine = sums[2 * order * lanes_ + lane], cosine = sums[(2 * order + 1) * lanes_ + lane];
    const double side = order % 2 == 0 ? 2.0 / pi : -2.0 / pi;  // phi = wt + pi/2
    return {-side * cosine, side * sine};
  }

  void collect(const LinearTask& task, int lane, const DfPoint& point, DescribingFunction& result) const {
    const double A = point.amplitude, w = point.frequency;
    const LinearOutput<double> output =
        std::visit([](const auto& law) { return law.linear_output({.x = 0.0, .v = 1.0, .drive = 0.0}); }, owner_.law_);
    const std::complex<double> j(0.0, 1.0);
    result.harmonics.assign(static_cast<std::size_t>(owner_.options_.harmonics), 0.0);
    double state_part = 0.0;
    for (int order = 0; order < orders_; ++order) {
      const auto k = static_cast<double>(2 * order + 1);
      const std::complex<double> z = coefficient(task.state_sums, order, lane);
      // Of dz/dt: j k w times that of z, which is exact. Where the damping varies: the sum over dz/dt itself.
      std::complex<double> F = output.stiffness * z;
      if (task.damping_sums == nullptr)
        F += output.damping * k * w * std::complex<double>(-z.imag(), z.real());
      else
        F += coefficient(task.damping_sums, order, lane);
      if (order == 0) {
        state_part = std::abs(F);
        F += j * (output.rest * A * w);
      }
      result.harmonics[static_cast<std::size_t>(2 * order)] = F;
    }
    result.gain = result.harmonics[0] / A;
    result.mean = 0.0;
    result.dissipation = pi * A * result.harmonics[0].imag();
    result.error = owner_.bound(settings_) * state_part / std::abs(result.harmonics[0]) + roundings;
    result.symmetric = true;
    result.status = Status::converged;
    result.evaluations += static_cast<long>(task.panel_count) * settings_.stages;
  }

  const DfKernel& owner_;
  HalfPeriodSettings settings_;
  int orders_, lanes_;
  std::shared_ptr<const HalfPeriodPanels> panels_;
  Aligned scratch_;
  int room_ = 0;
  std::vector<Key> keys_;
  std::vector<const double*> selected_;
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

std::optional<DfKernel> DfKernel::of(const Element<double>& element, const DfOptions& options) {
  if (options.harmonics > most_harmonics || options.accuracy < 2.0 * meshes.back().bound) return std::nullopt;
  if (const auto* lugre = std::get_if<LuGre<double>>(&element))
    return lugre->odd() ? std::optional(DfKernel(*lugre, options)) : std::nullopt;
  if (const auto* dahl = std::get_if<Dahl<double>>(&element))
    return dahl->is_linear_in_state() ? std::optional(DfKernel(*dahl, options)) : std::nullopt;
  return std::nullopt;
}

double DfKernel::bound(const HalfPeriodSettings& mesh) const {
  const double peak = ratio_ - 1.0;
  return mesh.bound + mesh.slope * peak + mesh.cubic * peak * peak * peak;
}

void DfKernel::compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const {
  std::vector<std::size_t> wanted(points.size());
  std::iota(wanted.begin(), wanted.end(), std::size_t{0});
  std::vector<std::complex<double>> coarser(verified_ ? 0 : points.size());
  bool have_coarser = false;
  for (const HalfPeriodSettings& mesh : meshes) {
    if (wanted.empty()) break;
    // Without a bound that is known: two meshes that are too coarse will not agree.
    if (verified_ ? bound(mesh) + roundings > options_.accuracy : mesh.bound > 100.0 * options_.accuracy) continue;
    Batch(*this, mesh).compute(points, wanted, results);
    std::erase_if(wanted, [&](std::size_t i) {
      DescribingFunction& result = results[i];
      if (!verified_) {
        const double apart = std::abs(result.gain - std::exchange(coarser[i], result.gain)) / std::abs(result.gain);
        result.error = have_coarser ? 2.0 * apart + mesh.bound + roundings : 1.0;
      }
      if (!(result.error <= options_.accuracy)) return false;
      result.method = "kernel";
      return true;
    });
    have_coarser = true;
  }
}

}  // namespace limcycle
