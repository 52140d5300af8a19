#include "limcycle/analysis/frequency/march/half_period_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

#include "limcycle/analysis/frequency/march/radau_iia.hpp"

namespace limcycle {

namespace {

using std::numbers::pi;
constexpr double farthest = 32.0;  ///< tau: a phase of 2.5e-14

double at(const double* row, int i) { return row[i]; }

CollocationNumbers numbers_of(const RadauIIA& table) {
  CollocationNumbers numbers{};
  const auto count = static_cast<std::size_t>(table.stages);
  std::copy_n(table.inverse.begin(), count * count, numbers.inverse);
  std::copy_n(table.row_sum.begin(), count, numbers.row_sum);
  return numbers;
}

}  // namespace

/// A rule on [0, 1] that is far finer than the panels, with the Lagrange polynomials of the nodes of a panel on it.
struct HalfPeriodPanels::Quadrature {
  std::vector<double> t, weight, lagrange;

  Quadrature(const RadauIIA& coarse, int parts) {
    const RadauIIA& rule = radau_iia(RadauIIA::most_stages);
    const int s = coarse.stages;
    for (int part = 0; part < parts; ++part) {
      for (std::size_t i = 0; i < RadauIIA::most_stages; ++i) {
        t.push_back((part + rule.c[i]) / parts);
        weight.push_back(rule.b[i] / parts);
        for (int j = 0; j < s; ++j) {
          double product = 1.0;
          const double own = at(coarse.c.data(), j);
          for (int m = 0; m < s; ++m)
            if (m != j) product *= (t.back() - at(coarse.c.data(), m)) / (own - at(coarse.c.data(), m));
          lagrange.push_back(product);
        }
      }
    }
  }
};

HalfPeriodPanels::HalfPeriodPanels(int stages, double width, int orders)
    : stages_(stages),
      orders_(orders),
      reach_(static_cast<int>(std::ceil(farthest / width))),
      width_(width),
      collocation_(numbers_of(radau_iia(stages))) {
  const RadauIIA& table = radau_iia(stages);
  const Quadrature fine(table, 1 + orders / 4), finer(table, 2 + orders / 2);
  const auto size = static_cast<std::size_t>(PanelGeometry::size(stages, orders));
  blocks_.assign(3 * size * (2 * static_cast<std::size_t>(reach_) + 1), 0.0);
  for (int j = -reach_; j <= reach_; ++j) {
    for (const Part part : {Part::inner, Part::left_cap, Part::right_cap}) {
      const bool wide = part != Part::inner && std::abs(j) * width < 3.0;
      fill(part, j, wide ? finer : fine, const_cast<double*>(block(part, j)));
    }
  }
}

std::shared_ptr<const HalfPeriodPanels> HalfPeriodPanels::of(int stages, double width, int orders) {
  static std::mutex guard;
  static std::map<std::tuple<int, double, int>, std::shared_ptr<const HalfPeriodPanels>> made;
  const std::lock_guard lock(guard);
  auto& panels = made[{stages, width, orders}];
  if (!panels) panels = std::make_shared<const HalfPeriodPanels>(stages, width, orders);
  return panels;
}

const double* HalfPeriodPanels::block(Part part, int j) const {
  const int size = PanelGeometry::size(stages_, orders_), count = 2 * reach_ + 1;
  return blocks_.data() + static_cast<std::ptrdiff_t>(size) * (static_cast<int>(part) * count + j + reach_);
}

void HalfPeriodPanels::fill(Part part, int j, const Quadrature& fine, double* block) const {
  const RadauIIA& table = radau_iia(stages_);
  const double end = 2.0 * std::atan(std::exp(-std::abs(j) * width_)), far = pi - end;
  const double cap = part == Part::left_cap ? (j < 0 ? end : far) : (j > 0 ? end : far);
  // Phase, from the nearer reversal, and its slope by t at the part t of the panel.
  struct Place {
    bool after = true;
    double phase = 0.0, sine = 0.0, slope = 0.0;
  };
  const auto place = [&](double t) -> Place {
    if (part == Part::left_cap) return {true, cap * t, std::sin(cap * t), cap};
    if (part == Part::right_cap) return {false, cap * (1.0 - t), std::sin(cap * (1.0 - t)), cap};
    const double tau = (j + t) * width_, sech = 1.0 / std::cosh(tau);
    return {tau < 0.0, 2.0 * std::atan(std::exp(-std::abs(tau))), sech, width_ * sech};
  };
  const auto s = static_cast<std::size_t>(stages_);
  double *sine = block, *step = sine + s, *weights = step + s;
  for (std::size_t i = 0; i < s; ++i) {
    const Place here = place(table.c[i]);
    sine[i] = here.sine;
    step[i] = here.slope;
  }
  for (std::size_t q = 0; q < fine.t.size(); ++q) {
    const Place here = place(fine.t[q]);
    const double share = fine.weight[q] * here.slope;
    for (int order = 0; order < orders_; ++order) {
      const int k = 2 * order + 1;
      // For odd k: sin(k (pi - p)) = sin(k p), cos(k (pi - p)) = -cos(k p).
      const double by_sine = share * std::sin(k * here.phase);
      const double by_cosine = share * (here.after ? 1.0 : -1.0) * std::cos(k * here.phase);
      double* row = weights + 2 * s * static_cast<std::size_t>(order);
      for (std::size_t i = 0; i < s; ++i) {
        row[i] += by_sine * fine.lagrange[q * s + i];
        row[s + i] += by_cosine * fine.lagrange[q * s + i];
      }
    }
  }
}

/// Number of the last inner panel that begins at or before the end e^cap of a cap.
int HalfPeriodPanels::index_of(double cap) const {
  const double tau = cap - std::numbers::ln2;  // ln tan(phi/2) of a small phi
  return std::max(static_cast<int>(std::floor(tau / width_)), -reach_);
}

HalfPeriodPanels::Range HalfPeriodPanels::range(double after, double before, double forgotten) const {
  Range range{index_of(after), -index_of(before), 0};
  const int all = range.to - range.from + 2;
  const double panels = 1.0 + std::ceil(forgotten / width_) - range.from;
  range.remembered = panels < all ? std::max(1, static_cast<int>(panels)) : all;
  return range;
}

void HalfPeriodPanels::select(Range range, std::vector<const double*>& panels) const {
  panels.clear();
  panels.push_back(block(Part::left_cap, range.from));
  for (int j = range.from; j < range.to; ++j) panels.push_back(block(Part::inner, j));
  panels.push_back(block(Part::right_cap, range.to));
}

Layers::Layers(const LevelShape& shape, const HalfPeriodSettings& settings)
    : displacement_(std::log(shape.displacement)),
      velocity_(std::log(shape.velocity)),
      cap_(std::log(settings.cap)),
      ignored_(shape.seen ? -infinite : std::log(settings.ignored)),
      widest_(cap_),
      even_(shape.kink == 0.0) {
  // |v|^kink has no derivatives at rest: the error of a polynomial is its size there times the square of the phase.
  if (!even_ && shape.kink != 1.0) cap_ += std::log(0.1 * settings.bound) / (2.0 + shape.kink);
}

HalfPeriodPanels::Range Layers::range(const HalfPeriodPanels& panels, double amplitude, double frequency) {
  if (amplitude != amplitude_) {
    amplitude_ = amplitude;
    amplitude_log_ = std::log(amplitude);
    // The initial state has decayed by e^-40 at least after 40 displacements: A (1 - cos(phi)) with
    // 1 - cos(phi) = 2/(1 + e^(-2 tau)).
    const double half = 20.0 * std::exp(displacement_ - amplitude_log_);
    forgotten_ = half < 1.0 ? 0.5 * std::log(half / (1.0 - half)) : infinite;
  }
  const double way = 0.5 * (std::numbers::ln2 + displacement_ - amplitude_log_);  // the state settles within that phase
  const double speed = velocity_ - amplitude_log_ - std::log(frequency);          // the level changes within that
  // A layer of the level within that of the state affects the state by the square of their ratio only.
  const double inner = std::max(speed, ignored_ + way);
  double after = std::min(way, inner), before = speed < way ? inner : way;
  // In a wider one the state follows the level; near rest it stands still if the level is even in the velocity and so
  // flat.
  if (even_ && speed > way && (way < ignored_ + speed || speed > 1.1)) before = speed;
  // However slow everything is, sin(phi) itself is no polynomial.
  return panels.range(std::min(cap_ + after, widest_), std::min(cap_ + before, widest_), forgotten_);
}

}  // namespace limcycle
