#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "limcycle/analysis/dense_elimination.hpp"
#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"
#include "limcycle/analysis/frequency/march/radau_iia.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// State of an element during a march, with the derivative of z by the initial state.
struct ElementState {
  Mode mode;
  std::vector<double> z;
  std::vector<double> sensitivity;  ///< n x n, row-major
};

/// Radau IIA collocation of one element on one panel of prescribed motion, in one mode: Newton with the exact Jacobian
/// (one iteration if the law is linear in its state) and, from the same elimination, the derivative of the final state
/// by the initial state of the march. Cost of a panel: (s m)^3/3 multiplications for the m states that move, m s^3/3
/// where their dependence has no cycle, s^3/3 where they have the same rate, and about 3 s evaluations per state that
/// is not Element::unused.
template <Motion M = PrescribedMotion>
class CollocationPanel {
 public:
  CollocationPanel(const Element& element, const M& motion, int stages)
      : element_(element),
        dual_(element.on<Dual<1>>()),
        motion_(motion),
        table_(radau_iia(stages)),
        s_(static_cast<std::size_t>(stages)),
        n_(static_cast<std::size_t>(element.states())),
        drive_is_of_rate_(drive_is_of_rate(element)) {
    nodes_.resize(s_);
    z_.resize(s_ * n_);
    rates_.resize(s_ * n_);
    jacobians_.resize(s_ * n_ * n_);
    if (n_ > 2) wide_.emplace(element.on<Dual<width>>());
    trial_.resize(n_);
    trial_rate_.resize(n_);
  }

  std::size_t stages() const { return s_; }
  double node_fraction(std::size_t stage) const { return table_.c[stage]; }
  double weight(std::size_t stage) const { return table_.b[stage]; }
  const MotionNode& node(std::size_t stage) const { return nodes_[stage]; }
  std::span<const double> state(std::size_t stage) const { return {z_.data() + stage * n_, n_}; }
  bool finite() const { return n_ == 0 || std::isfinite(rates_.front()); }
  long evaluations() const { return evaluations_; }

  /// State and sensitivity at the end of the panel.
  void end(ElementState& state) const {
    std::copy(z_.end() - static_cast<std::ptrdiff_t>(n_), z_.end(), state.z.begin());
    std::copy(sensitivities_.begin(), sensitivities_.end(), state.sensitivity.begin());
  }

  /// The collocation polynomial at the part t of the panel that began in `state`.
  void interpolate(double t, const ElementState& state, std::span<double> z) const {
    std::array<double, RadauIIA::most_stages + 1> weights;
    table_.interpolation(t, weights);
    std::ranges::copy(state.z, z.begin());
    for (const std::size_t p : moving_) {
      z[p] *= weights[0];
      for (std::size_t i = 0; i < s_; ++i) z[p] += weights[i + 1] * z_[i * n_ + p];
    }
  }

  /// Motion at one phase. The drive has the sign of the acceleration if the law's signal is the rate (friction), the
  /// sign of the direction of motion on this panel if it is the input.
  MotionNode node_at(int anchor, double local) const {
    MotionNode node = motion_.at(anchor, local);
    node.in.drive = std::copysign(infinite, drive_is_of_rate_ ? node.slope : direction_);
    return node;
  }

  /// Carries `state` from `from` to `to` in its present mode. False if Newton failed: see hold_or_relax.
  bool solve(int anchor, double from, double to, const ElementState& state) {
    place_nodes(anchor, from, to);
    if (n_ == 0) return true;
    sensitivities_ = state.sensitivity;
    find_used(state.mode);
    find_depended(state);
    const double step = (to - from) / motion_.frequency();
    guess({anchor, from, to, state.mode}, state);
    // The derivatives of many states cost more than a second elimination: they are found when Newton has converged.
    const bool at_once = n_ <= 2;
    double before = infinite;
    for (int iteration = 0; iteration < 12; ++iteration) {
      for (std::size_t i = 0; i < s_; ++i) linearise(i, state.mode);
      find_moving();
      const double stiffness = step * steepest();
      if (!correct(step, state, {.states = true, .derivatives = at_once})) return false;
      evaluate_rates(state.mode);
      double worst = 0.0;
      for (const std::size_t p : moving_) {
        double size = std::numeric_limits<double>::min(), defect = 0.0;
        for (std::size_t i = 0; i < s_; ++i) {
          size = std::max({size, std::abs(z_[i * n_ + p]), std::abs(step * rates_[i * n_ + p])});
          defect = std::max(defect, std::abs(residual(step, state, i, p)));
        }
        // The rate may be a difference of forces much larger than itself, so a tolerance relative to z alone will not
        // do.
        size += 0.01 * stiffness / (1.0 + stiffness) * element_.state_scale(static_cast<int>(p));
        worst = std::max(worst, defect / size);
      }
      if (worst <= 2e-14 * (1.0 + stiffness)) {
        solved_ = Stretch{anchor, from, to, state.mode};
        return at_once || correct(step, state, {.states = false, .derivatives = true});
      }
      if (!(worst < before) || iteration > 6) return false;
      before = worst;
    }
    return false;
  }

  /// For a panel on which Newton failed: a single state that rests keeps its value; with `force`, implicit Euler
  /// carries it, its equation being monotonic in z. False: halve the panel.
  bool hold_or_relax(double from, double to, const ElementState& state, bool force) {
    if (n_ != 1 || !finite()) return false;
    const double step = (to - from) / motion_.frequency(), start = state.z[0], scale = element_.state_scale(0);
    const Input<double> in = nodes_[s_ / 2].in;
    const auto residual_at = [&](double z) {
      trial_[0] = z;
      element_.rate(in, state.mode, trial_, trial_rate_);
      ++evaluations_;
      return z - start - step * trial_rate_[0];
    };
    double reach = scale * 1e-15, low = start - reach, high = start + reach;
    while (!(residual_at(low) <= 0.0 && residual_at(high) >= 0.0)) {
      if ((reach *= 8.0) > 1e6 * scale) return false;
      low = start - reach;
      high = start + reach;
    }
    for (int k = 0; k < 100 && high - low > 1e-17 * scale; ++k) {
      const double middle = 0.5 * (low + high);
      (residual_at(middle) < 0.0 ? low : high) = middle;
    }
    const double end = 0.5 * (low + high);
    solved_.reset();
    const bool holds = std::abs(end - start) <= 2e-13 * scale;  // ten times the tolerance of Newton
    if (!holds && !force) return false;
    for (std::size_t i = 0; i < s_; ++i) z_[i] = holds ? start : start + table_.c[i] * (end - start);
    moving_.assign(1, 0);
    std::fill(sensitivities_.begin(), sensitivities_.end(), 0.0);
    return true;
  }

 private:
  /// What one elimination is to correct.
  struct Wanted {
    bool states, derivatives;
  };

  /// What was solved last.
  struct Stretch {
    int anchor;
    double from, to;
    Mode mode;
  };

  /// First states of Newton at the nodes: those of the panel solved last where it began here, too, since one that is
  /// cut at a switch is hardly shorter; elsewhere the state at the beginning.
  void guess(const Stretch& now, const ElementState& state) {
    constexpr double farthest = 1.2;
    const bool again = solved_ && solved_->anchor == now.anchor && solved_->from == now.from &&
                       solved_->mode == now.mode && now.to - now.from <= farthest * (solved_->to - solved_->from);
    guessed_.resize(s_ * n_);
    for (std::size_t i = 0; i < s_; ++i) {
      const std::span<double> z{&guessed_[i * n_], n_};
      if (again)
        interpolate(table_.c[i] * (now.to - now.from) / (solved_->to - solved_->from), state, z);
      else
        std::ranges::copy(state.z, z.begin());
    }
    z_.swap(guessed_);
    solved_.reset();
  }

  void place_nodes(int anchor, double from, double to) {
    direction_ = motion_.at(anchor, 0.5 * (from + to)).in.v < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < s_; ++i)
      nodes_[i] = node_at(anchor, i + 1 == s_ ? to : from + table_.c[i] * (to - from));
  }

  /// The states that something depends on in this mode; the derivatives by all others are 0.
  void find_used(Mode mode) {
    if (!used_.empty() && mode == used_in_) return;
    used_in_ = mode;
    used_.clear();
    used_.reserve(n_);
    for (std::size_t p = 0; p < n_; ++p)
      if (!element_.unused(mode, static_cast<int>(p))) used_.push_back(p);
    std::fill(jacobians_.begin(), jacobians_.end(), 0.0);
  }

  /// The initial states that a used state depends on: all other derivatives are 0.
  void find_depended(const ElementState& state) {
    depended_.clear();
    for (std::size_t c = 0; c < n_; ++c)
      if (std::ranges::any_of(used_, [&](std::size_t q) { return state.sensitivity[q * n_ + c] != 0.0; }))
        depended_.push_back(c);
  }

  /// The largest derivative of a rate.
  double steepest() const {
    double most = 0.0;
    for (std::size_t i = 0; i < s_; ++i)
      for (const std::size_t p : moving_)
        for (const std::size_t q : used_) most = std::max(most, std::abs(jacobians_[(i * n_ + p) * n_ + q]));
    return most;
  }

  /// Rates and their derivatives with respect to the state at stage i, several states at a time where there are many.
  void linearise(std::size_t i, Mode mode) {
    if (wide_)
      linearise_with<width>(*wide_, i, mode);
    else
      linearise_with<1>(dual_, i, mode);
  }
  template <int Columns>
  void linearise_with(const ElementOn<Dual<Columns>>& element, std::size_t i, Mode mode) {
    const Input<double>& in = nodes_[i].in;
    const Input<Dual<Columns>> input{in.x, in.v, in.drive};
    auto& [z, rate] = std::get<Scratch<Columns>>(scratch_);
    z.resize(n_);
    rate.resize(n_);
    for (const std::size_t p : used_) z[p] = z_[i * n_ + p];
    for (std::size_t from = 0; from < used_.size(); from += Columns) {
      const std::size_t count = std::min<std::size_t>(used_.size() - from, Columns);
      for (std::size_t k = 0; k < count; ++k) z[used_[from + k]].d[k] = 1.0;
      element.rate(input, mode, z, rate);
      ++evaluations_;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t column = used_[from + k];
        z[column].d[k] = 0.0;
        for (const std::size_t p : used_) jacobians_[(i * n_ + p) * n_ + column] = rate[p].d[k];
      }
    }
    for (const std::size_t p : used_) rates_[i * n_ + p] = rate[p].value;
  }

  void evaluate_rates(Mode mode) {
    for (std::size_t i = 0; i < s_; ++i) element_.rate(nodes_[i].in, mode, {&z_[i * n_], n_}, {&rates_[i * n_], n_});
    evaluations_ += static_cast<long>(s_);
  }

  /// Residual of the collocation equations at stage i, component p.
  double residual(double step, const ElementState& state, std::size_t i, std::size_t p) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < s_; ++j) sum += table_.a[i * s_ + j] * rates_[j * n_ + p];
    return z_[i * n_ + p] - state.z[p] - step * sum;
  }

  bool coupled(std::size_t p, std::size_t q) const {
    for (std::size_t i = 0; i < s_; ++i)
      if (jacobians_[(i * n_ + p) * n_ + q] != 0.0) return true;
    return false;
  }

  /// Finds the states that move on this panel. The others (return points kept for later, elements that stick) have a
  /// rate of zero whatever the state is.
  void find_moving() {
    moving_.clear();
    moves_.assign(n_, 0);
    for (const std::size_t p : used_) {
      if (!has_rate(p)) continue;
      moving_.push_back(p);
      moves_[p] = 1;
    }
  }
  bool has_rate(std::size_t p) const {
    for (std::size_t i = 0; i < s_; ++i) {
      if (rates_[i * n_ + p] != 0.0) return true;
      for (const std::size_t q : used_)
        if (jacobians_[(i * n_ + p) * n_ + q] != 0.0) return true;
    }
    return false;
  }

  /// Finds an order in which the rate of every moving state depends only on itself and on states before it, if there is
  /// one: elements in parallel are independent, a lagged level affects all others and depends on none.
  bool find_order() {
    order_.clear();
    if (n_ == 1) return false;
    depends_.assign(n_ * n_, 0);
    placed_.assign(n_, 1);
    for (const std::size_t p : moving_) {
      placed_[p] = 0;
      for (const std::size_t q : used_) depends_[p * n_ + q] = p != q && coupled(p, q) ? 1 : 0;
    }
    for (bool more = true; more && order_.size() < moving_.size();) {
      more = false;
      for (const std::size_t p : moving_) {
        bool ready = placed_[p] == 0;
        for (const std::size_t q : used_) ready = ready && (depends_[p * n_ + q] == 0 || placed_[q] != 0);
        if (!ready) continue;
        placed_[p] = 1;
        more = true;
        order_.push_back(p);
      }
    }
    return order_.size() == moving_.size();
  }

  /// The moving state whose residual at stage i has the least rounding, where that of all is the same.
  std::size_t smallest_of_moving(std::size_t i, const ElementState& state) const {
    return *std::ranges::min_element(
        moving_, {}, [&](std::size_t p) { return std::max(std::abs(z_[i * n_ + p]), std::abs(state.z[p])); });
  }

  /// True if several states move and all have the same rate: springs in parallel that one deflection stretches.
  bool moves_as_one() const {
    const auto same = [&](std::size_t p) {
      for (std::size_t i = 0; i < s_; ++i) {
        const std::size_t own = i * n_ + p, first = i * n_ + moving_.front();
        if (rates_[own] != rates_[first] ||
            !std::equal(&jacobians_[own * n_], &jacobians_[own * n_] + n_, &jacobians_[first * n_]))
          return false;
      }
      return true;
    };
    return moving_.size() > 1 && std::ranges::all_of(moving_, same);
  }

  bool correct(double step, const ElementState& state, Wanted wanted) {
    columns_ = wanted.derivatives ? 1 + depended_.size() : 1;
    if (moves_as_one()) return correct_as_one(step, state, wanted);
    return find_order() ? correct_in_order(step, state, wanted) : correct_together(step, state, wanted);
  }

  /// One step of Newton of states that move as one: one system of the size of the stages, for their common way and its
  /// derivatives by the initial state.
  bool correct_as_one(double step, const ElementState& state, Wanted wanted) {
    const std::size_t first = moving_.front(), length = s_ + columns_;
    system_.assign(s_ * length, 0.0);
    for (std::size_t j = 0; j < s_; ++j) {
      const double* slope = &jacobians_[(j * n_ + first) * n_];
      double own = 0.0;
      for (const std::size_t q : moving_) own += slope[q];
      carried_.assign(columns_ - 1, 0.0);
      for (const std::size_t q : used_)
        for (std::size_t c = 0; slope[q] != 0.0 && c < carried_.size(); ++c)
          carried_[c] += slope[q] * state.sensitivity[q * n_ + depended_[c]];
      for (std::size_t i = 0; i < s_; ++i) {
        const double part = step * table_.a[i * s_ + j];
        system_[i * length + j] = -part * own;
        for (std::size_t c = 0; c < carried_.size(); ++c) system_[i * length + s_ + 1 + c] += part * carried_[c];
      }
    }
    for (std::size_t i = 0; i < s_; ++i) {
      system_[i * length + i] += 1.0;
      system_[i * length + s_] = -residual(step, state, i, smallest_of_moving(i, state));
    }
    if (!eliminate(system_, s_, columns_)) return false;
    const double* end = system_.data() + (s_ - 1) * length + s_ + 1;
    for (const std::size_t p : moving_) {
      for (std::size_t i = 0; wanted.states && i < s_; ++i) z_[i * n_ + p] += system_[i * length + s_];
      for (std::size_t c = 0; c + 1 < columns_; ++c)
        sensitivities_[p * n_ + depended_[c]] = state.sensitivity[p * n_ + depended_[c]] + end[c];
    }
    return true;
  }

  /// One step of Newton, state by state in that order: n systems of the size of the stages instead of one of n times
  /// that size.
  bool correct_in_order(double step, const ElementState& state, Wanted wanted) {
    const std::size_t length = s_ + columns_;
    corrections_.resize(s_ * n_ * columns_);
    for (const std::size_t p : order_) {
      system_.assign(s_ * length, 0.0);
      for (std::size_t i = 0; i < s_; ++i) {
        double* row = &system_[i * length];
        for (std::size_t j = 0; j < s_; ++j) row[j] = -step * table_.a[i * s_ + j] * jacobians_[(j * n_ + p) * n_ + p];
        row[i] += 1.0;
        row[s_] = -residual(step, state, i, p);
        for (std::size_t c = 0; c + 1 < columns_; ++c) row[s_ + 1 + c] = state.sensitivity[p * n_ + depended_[c]];
        for (const std::size_t q : used_)
          if (depends_[p * n_ + q] != 0) add_coupling(step, i, p, q, state, row + s_);
      }
      if (!eliminate(system_, s_, columns_)) return false;
      for (std::size_t i = 0; i < s_; ++i)
        std::copy_n(&system_[i * length + s_], columns_, &corrections_[(i * n_ + p) * columns_]);
    }
    for (const std::size_t p : order_) {
      for (std::size_t i = 0; wanted.states && i < s_; ++i) z_[i * n_ + p] += corrections_[(i * n_ + p) * columns_];
      take_derivatives(p, corrections_.data() + ((s_ - 1) * n_ + p) * columns_ + 1);
    }
    return true;
  }

  /// Adds to the right-hand sides of state p at stage i the contribution of the corrections of state q, found before,
  /// or of its derivatives alone if it stands.
  void add_coupling(double step, std::size_t i, std::size_t p, std::size_t q, const ElementState& state,
                    double* right) const {
    for (std::size_t j = 0; j < s_; ++j) {
      const double factor = step * table_.a[i * s_ + j] * jacobians_[(j * n_ + p) * n_ + q];
      if (moves_[q] == 0) {
        for (std::size_t c = 0; c + 1 < columns_; ++c)
          right[1 + c] += factor * state.sensitivity[q * n_ + depended_[c]];
        continue;
      }
      for (std::size_t c = 0; c < columns_; ++c) right[c] += factor * corrections_[(j * n_ + q) * columns_ + c];
    }
  }

  /// One step of Newton, all moving states together: the first column is the step of the stages, the further ones are
  /// their derivatives by the initial state.
  bool correct_together(double step, const ElementState& state, Wanted wanted) {
    const std::size_t count = moving_.size(), m = s_ * count, length = m + columns_;
    system_.assign(m * length, 0.0);
    for (std::size_t i = 0; i < s_; ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t p = moving_[k];
        double* row = &system_[(i * count + k) * length];
        for (std::size_t j = 0; j < s_; ++j)
          for (std::size_t l = 0; l < count; ++l)
            row[j * count + l] = -step * table_.a[i * s_ + j] * jacobians_[(j * n_ + p) * n_ + moving_[l]];
        row[i * count + k] += 1.0;
        row[m] = -residual(step, state, i, p);
        for (std::size_t c = 0; c + 1 < columns_; ++c) row[m + 1 + c] = state.sensitivity[p * n_ + depended_[c]];
        for (const std::size_t q : used_)
          if (moves_[q] == 0) add_coupling(step, i, p, q, state, row + m);
      }
    }
    if (!eliminate(system_, m, columns_)) return false;
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; wanted.states && i < s_; ++i)
        z_[i * n_ + moving_[k]] += system_[(i * count + k) * length + m];
      take_derivatives(moving_[k], system_.data() + ((s_ - 1) * count + k) * length + m + 1);
    }
    return true;
  }

  /// Derivatives of state p at the end of the panel, if there are any.
  void take_derivatives(std::size_t p, const double* found) {
    for (std::size_t c = 0; c + 1 < columns_; ++c) sensitivities_[p * n_ + depended_[c]] = found[c];
  }

  Element element_;
  ElementOn<Dual<1>> dual_;
  const M& motion_;
  const RadauIIA& table_;
  std::size_t s_, n_;
  bool drive_is_of_rate_;
  double direction_ = 1.0;
  long evaluations_ = 0;
  std::vector<MotionNode> nodes_;
  std::optional<Stretch> solved_;
  std::vector<double> z_, guessed_, rates_, sensitivities_, jacobians_, system_, carried_, corrections_, trial_,
      trial_rate_;
  Mode used_in_;
  std::vector<std::size_t> used_, depended_, moving_, order_;
  std::size_t columns_ = 1;  ///< right-hand sides: the step of the states, and the derivatives where they are wanted
  std::vector<char> moves_, depends_, placed_;
  static constexpr int width = 4;
  std::optional<ElementOn<Dual<width>>> wide_;
  template <int Columns>
  struct Scratch {
    std::vector<Dual<Columns>> z, rate;
  };
  std::tuple<Scratch<1>, Scratch<width>> scratch_;
};

}  // namespace limcycle
