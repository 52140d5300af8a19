#include "limcycle/analysis/frequency/kernels/marched_half_period.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "limcycle/analysis/frequency/march/half_period_mesh.hpp"
#include "limcycle/analysis/frequency/march/radau_iia.hpp"

namespace limcycle {

namespace {

using std::numbers::pi;
constexpr double march_roundings = 1e-13;

/// Meshes from coarse to fine. `least`: error that agreement by chance could hide.
struct Mesh {
  MarchMesh march;
  double least = 0.0;
};
constexpr std::array<Mesh, 6> march_meshes{{{{5, 1.3, 0.6, 0.04, 5e-3, 1e-6, 5e-3}, 2e-3},
                                            {{5, 0.72, 0.42, 0.01, 2e-4, 1e-8, 3e-4}, 1e-5},
                                            {{5, 0.52, 0.33, 0.004, 4e-5, 1e-9, 1e-4}, 2.5e-7},
                                            {{8, 0.7, 0.3, 5e-4, 5e-6, 1e-11, 1e-5}, 4e-9},
                                            {{8, 0.45, 0.2, 5e-5, 1e-6, 1e-12, 1e-6}, 1.5e-10},
                                            {{8, 0.25, 0.1, 5e-6, 1e-7, 1e-12, 1e-7}, 5e-12}}};

MarchCollocation collocation_of(int stages) {
  MarchCollocation c{};
  const RadauIIA& table = radau_iia(stages);
  const CollocationNumbers numbers = HalfPeriodPanels::of(stages, 1.0, 1)->collocation();
  std::ranges::copy(numbers.inverse, c.inverse);
  std::ranges::copy(numbers.row_sum, c.row_sum);
  for (int i = 0; i < stages; ++i) {
    c.nodes[i + 1] = table.c[static_cast<std::size_t>(i)];
    c.weights[i + 1] = table.b[static_cast<std::size_t>(i)];
  }
  long double weight[9];
  for (int i = 0; i <= stages; ++i) {
    weight[i] = 1.0L;
    for (int j = 0; j <= stages; ++j) {
      if (j == i) continue;
      weight[i] /= static_cast<long double>(c.nodes[i]) - c.nodes[j];
      c.apart[i][j] = 1.0 / (c.nodes[i] - c.nodes[j]);
    }
  }
  for (int i = 1; i <= stages; ++i) c.start_slope[i] = static_cast<double>(weight[i] / weight[0]) / -c.nodes[i];
  for (int i = 0; i < stages; ++i)
    c.end_slope[i] = static_cast<double>(weight[i] / weight[stages]) / (c.nodes[stages] - c.nodes[i]);
  return c;
}

const MarchCollocation& collocation(int stages) {
  static const MarchCollocation five = collocation_of(5), eight = collocation_of(8);
  return stages == 5 ? five : eight;
}

const MarchKernels& march_kernels_of(Isa isa) {
  return isa == Isa::avx512 ? avx512_march_kernels : isa == Isa::avx2 ? avx2_march_kernels : scalar_march_kernels;
}

/// |z| of numbers far from overflow and underflow.
double modulus(std::complex<double> z) { return std::sqrt(std::norm(z)); }

/// Data of one state at one point.
struct Marching {
  std::size_t point = 0, state = 0;
  double reach = 0.0, speed = 0.0, tempo = 0.0, drag = 0.0, lag = 0.0, after = 0.0, before = 0.0;
  double start = 0.0, level = 1.0;
  int passes = 0;
};

}  // namespace

/// Points computed on one mesh after another.
class MarchedHalfPeriod::Batch {
 public:
  Batch(const MarchedHalfPeriod& owner, std::span<const DfPoint> points)
      : law_(owner.law_),
        isa_(owner.options_.isa),
        wanted_orders_(std::max(2, (owner.options_.harmonics + 1) / 2)),
        points_(points) {
    starts_.assign(points.size() * law_.states.size(), {});
  }

  /// Harmonics of the points numbered in `wanted`, [orders] each; empty where no periodic state was found.
  void run(const Mesh& mesh, const std::vector<std::size_t>& wanted) {
    mesh_ = &mesh.march;
    tolerance_ = 0.3 * std::sqrt(mesh.least);
    orders_ = mesh.least > 1e-6 ? 2 : wanted_orders_;
    outputs_.assign(points_.size() * static_cast<std::size_t>(orders_), 0.0);
    failed_.assign(points_.size(), false);
    doubtful_.assign(points_.size(), false);
    panels_.assign(points_.size(), 0);
    for (std::size_t s = 0; s < law_.states.size(); ++s) {
      pending_.clear();
      for (const std::size_t point : wanted) pending_.push_back(marching(point, s));
      for (int pass = 0; !pending_.empty() && pass < most_passes; ++pass) this->pass(law_.states[s]);
      for (const Marching& left : pending_) failed_[left.point] = true;
    }
  }

  /// Rough periodic states, from which those on finer meshes start.
  void guess(const std::vector<std::size_t>& wanted) {
    Mesh rough = march_meshes.front();
    rough.least = 5e-3;
    guessing_ = true;
    run(rough, wanted);
    guessing_ = false;
  }

  bool failed(std::size_t point) const { return failed_[point]; }
  bool doubtful(std::size_t point) const { return doubtful_[point]; }
  std::complex<double> output(std::size_t point, int order) const {
    return outputs_[point * static_cast<std::size_t>(orders_) + static_cast<std::size_t>(order)];
  }
  int orders() const { return orders_; }
  /// True if the last mesh gave all harmonics; the coarse ones do not.
  bool complete() const { return orders_ == wanted_orders_; }
  long evaluations(std::size_t point) const { return static_cast<long>(panels_[point]) * mesh_->stages; }

 private:
  static constexpr int most_passes = 12;
  struct Start {
    double u = 0.0, level = 1.0;
    bool known = false;
  };

  Marching marching(std::size_t point, std::size_t s) const {
    const KernelState& state = law_.states[s];
    const double A = points_[point].amplitude, w = points_[point].frequency;
    Marching m{.point = point, .state = s};
    m.reach = A * state.reach;
    m.speed = A * w * state.speed;
    m.tempo = state.tempo / w;
    m.drag = A * w * state.drag;
    m.lag = state.lag / w;
    layers(state, m);
    const Start& start = starts_[point * law_.states.size() + s];
    m.start = start.known ? start.u : -std::min(0.9, m.reach);
    m.level = start.level;
    return m;
  }

  /// Scales of tan(phi/2) at both ends.
  void layers(const KernelState& state, Marching& m) const {
    double cap = mesh_->cap;
    if (law_.kink != 0.0 && law_.kink != 1.0) cap *= std::pow(mesh_->newton * mesh_->newton, 1.0 / (2.0 + law_.kink));
    const double way = std::sqrt(2.0 / m.reach), speed = m.speed > 0.0 ? 1.0 / m.speed : way;
    double after = way, before = 1.0;
    if (state.law == MarchLaw::elasto_plastic) {
      // Elastic at first, at any level; near the end u follows the level, or stands still where the level changes.
      if (speed < way)
        before = std::max(speed, mesh_->ignored * std::min(way, 1.0));
      else
        before = way;
    } else if (state.law != MarchLaw::dahl && state.law != MarchLaw::bouc_wen) {
      before = std::max(speed, mesh_->ignored * std::min(way, 1.0));
      after = std::min(way, before);
    }
    m.after = std::min(0.5 * cap * after, 0.5);
    m.before = std::min(0.5 * cap * before, 0.5);
  }

  void pass(const KernelState& state) {
    const std::size_t n = pending_.size(), sums = static_cast<std::size_t>(MarchTask::sums_of(orders_));
    numbers_.resize(n * (13 + sums));
    panel_counts_.resize(n);
    double* at = numbers_.data();
    const auto column = [&](double Marching::*member) {
      double* const first = at;
      for (const Marching& m : pending_) *at++ = m.*member;
      return first;
    };
    MarchTask task;
    task.collocation = &collocation(mesh_->stages);
    task.mesh = mesh_;
    task.count = static_cast<int>(n);
    task.orders = orders_;
    task.reach = column(&Marching::reach);
    task.speed = column(&Marching::speed);
    task.tempo = column(&Marching::tempo);
    task.drag = column(&Marching::drag);
    task.lag = column(&Marching::lag);
    task.after = column(&Marching::after);
    task.before = column(&Marching::before);
    task.start = column(&Marching::start);
    task.start_level = column(&Marching::level);
    task.end = at;
    task.slope = at + n;
    task.end_level = at + 2 * n;
    task.level_slope = at + 3 * n;
    task.sums = at + 4 * n;
    task.panels = panel_counts_.data();
    march_kernels_of(isa_).of[static_cast<int>(state.law)][mesh_->stages](state.numbers, task);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (!settle(state, task, i)) pending_[kept++] = pending_[i];
    pending_.resize(kept);
  }

  /// Newton on the half period; true if that has converged.
  bool settle(const KernelState& state, const MarchTask& task, std::size_t i) {
    Marching& m = pending_[i];
    panels_[m.point] += std::abs(task.panels[i]);
    if (task.panels[i] == 0) {
      failed_[m.point] = true;
      return true;
    }
    const double slope = std::clamp(task.slope[i], -0.9, 1e3);
    const double change = -(m.start + task.end[i]) / (1.0 + slope);
    double level_change = 0.0;
    if (state.lag > 0.0) level_change = (task.end_level[i] - m.level) / (1.0 - task.level_slope[i]);
    Start& start = starts_[m.point * law_.states.size() + m.state];
    m.start += change;
    m.level += level_change;
    start = {m.start, m.level, true};
    // One step is enough where the end depends little on the start.
    const double left = guessing_ ? std::min(1.0, std::abs(task.slope[i]) + 0.05) : 1.0;
    if (!(std::abs(change) * left <= tolerance_ * std::min(1.0, m.reach)) ||
        !(std::abs(level_change) <= 1e-3 * tolerance_))
      return false;
    if (task.panels[i] < 0) doubtful_[m.point] = true;
    const double w = points_[m.point].frequency;
    const double* sums = task.sums + i * static_cast<std::size_t>(MarchTask::sums_of(orders_));
    for (int order = 0; order < orders_; ++order, sums += 4) {
      const double sine = sums[0] + change * sums[2], cosine = sums[1] + change * sums[3];
      const double side = order % 2 == 0 ? 2.0 / pi : -2.0 / pi;  // phi = wt + pi/2
      const std::complex<double> u(-side * cosine, side * sine);
      outputs_[m.point * static_cast<std::size_t>(orders_) + static_cast<std::size_t>(order)] +=
          u * std::complex<double>(state.force, (2 * order + 1) * w * state.damping);
    }
    return true;
  }

  const KernelLaw& law_;
  Isa isa_;
  int wanted_orders_, orders_ = 1;
  std::span<const DfPoint> points_;
  const MarchMesh* mesh_ = nullptr;
  double tolerance_ = 0.0;
  bool guessing_ = false;
  std::vector<Start> starts_;
  std::vector<Marching> pending_;
  std::vector<double> numbers_;
  std::vector<int> panel_counts_, panels_;
  std::vector<std::complex<double>> outputs_;
  std::vector<bool> failed_, doubtful_;
};

DescribingFunction MarchedHalfPeriod::collect(const Batch& batch, std::size_t i, const DfPoint& point) const {
  const double A = point.amplitude, w = point.frequency;
  DescribingFunction result;
  result.harmonics.assign(static_cast<std::size_t>(options_.harmonics), 0.0);
  for (int order = 0; order < batch.orders() && 2 * order < options_.harmonics; ++order)
    result.harmonics[2 * static_cast<std::size_t>(order)] = batch.output(i, order);
  result.harmonics[0] += std::complex<double>(law_.spring * A, law_.viscous * A * w);
  result.gain = result.harmonics[0] / A;
  result.dissipation = pi * A * result.harmonics[0].imag();
  result.symmetric = true;
  result.evaluations = batch.evaluations(i);
  return result;
}

void MarchedHalfPeriod::compute(std::span<const DfPoint> points, std::span<DescribingFunction> results) const {
  std::vector<std::size_t> wanted, same(points.size());
  std::map<double, std::size_t> first_of;  // points of each amplitude, if the frequency does not matter
  for (std::size_t i = 0; i < points.size(); ++i) {
    same[i] = i;
    if (points[i].bias != 0.0) continue;
    if (law_.knows_rate) {
      wanted.push_back(i);
    } else {
      const auto [known, is_new] = first_of.try_emplace(points[i].amplitude, i);
      same[i] = known->second;
      if (is_new) wanted.push_back(i);
    }
  }
  march(points, std::move(wanted), results);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (same[i] != i) results[i] = results[same[i]];
}

void MarchedHalfPeriod::march(std::span<const DfPoint> points, std::vector<std::size_t> wanted,
                              std::span<DescribingFunction> results) const {
  Batch batch(*this, points);
  struct Coarser {
    std::complex<double> first, third;
  };
  std::vector<Coarser> coarser(points.size());
  std::vector<bool> have(points.size(), false);
  std::vector<int> failures(points.size(), 0);
  std::size_t first = 1;
  while (first + 2 < march_meshes.size() && march_meshes[first + 1].least > 0.3 * options_.accuracy) ++first;
  // Newton starts from the result of a coarse mesh.
  batch.guess(wanted);
  for (std::size_t k = first; k < march_meshes.size() && !wanted.empty(); ++k) {
    const Mesh& mesh = march_meshes[k];
    batch.run(mesh, wanted);
    std::erase_if(wanted, [&](std::size_t i) {
      if (batch.failed(i)) {
        have[i] = false;
        return ++failures[i] == 2;
      }
      DescribingFunction now = collect(batch, i, points[i]);
      if (have[i] && !batch.doubtful(i)) {
        const double A = points[i].amplitude;
        // The third harmonic counts as well: two meshes may agree on one number by chance.
        const double apart = modulus(now.gain - coarser[i].first) + modulus(batch.output(i, 1) - coarser[i].third) / A;
        now.error = law_.trust * apart / modulus(now.gain) + mesh.least + law_.least + march_roundings;
        if (now.error <= options_.accuracy && batch.complete()) {
          now.method = "kernel";
          results[i] = std::move(now);
          return true;
        }
      }
      have[i] = !batch.doubtful(i);
      coarser[i] = {now.gain, batch.output(i, 1)};
      return false;
    });
  }
}

std::size_t MarchedHalfPeriod::meshes() { return march_meshes.size(); }

std::optional<std::complex<double>> MarchedHalfPeriod::on_mesh(const DfPoint& point, std::size_t mesh) const {
  Batch batch(*this, {&point, 1});
  batch.run(march_meshes.at(mesh), {0});
  if (batch.failed(0)) return std::nullopt;
  return collect(batch, 0, point).gain;
}

}  // namespace limcycle
