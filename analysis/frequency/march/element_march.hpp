#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "limcycle/analysis/frequency/march/collocation_panel.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A visitor of ElementMarch that needs nothing.
struct NoVisitor {
  static constexpr bool wants_nodes = false, wants_samples = false;
};

/// Marches one element through prescribed motion, panel by panel, with located switches at which the panel is split. A
/// panel on which Newton fails is halved; a one-state law that cannot be smooth there (Dahl with exponent < 1 reaching
/// its level) ends in implicit Euler by bisection.
///
/// A visitor may request nodes, `node(MotionNode, weight, output)` with weights of phase, or samples: `sample(output)`
/// at the end of panels marked so, and `jump(position, height)` for each jump of the output. One that declares
/// `wants_panels` receives every solved panel and every switch, see RecordedSums.
template <Motion M = PrescribedMotion>
class ElementMarch {
 public:
  ElementMarch(const Element& element, const M& motion, int stages)
      : element_(element),
        dual_(element.on<Dual<1>>()),
        motion_(motion),
        panel_(element, motion, stages),
        n_(static_cast<std::size_t>(element.states())),
        work_(n_),
        reset_(n_),
        peak_(n_) {}

  std::size_t states() const { return n_; }
  long evaluations() const { return evaluations_ + panel_.evaluations(); }
  const Element& element() const { return element_; }

  /// An element without history at phase 0.
  ElementState virgin() const {
    ElementState state{{}, std::vector<double>(n_, 0.0), std::vector<double>(n_ * n_, 0.0)};
    state.mode = element_.start(motion_.at(0, 0.0).in, state.z);
    // A slow drift would need many periods to carry every slider to its limit.
    if (element_.knows_sliding())
      if (const double V = motion_.mean_rate(); V != 0.0)
        state.mode = element_.after_sliding({0.0, V, V < 0.0 ? -infinite : infinite}, state.z);
    return state;
  }

  /// Discards a jump not yet reported to a visitor; call it when the next panels do not follow the last ones.
  void restart() {
    pending_.reset();
    std::fill(peak_.begin(), peak_.end(), 0.0);
  }

  /// Size of state p in this motion: the largest seen since the last restart, at most the element's own scale.
  double scale(std::size_t p) const {
    const double own = element_.state_scale(static_cast<int>(p));
    return peak_[p] > 0.0 ? std::min(own, peak_[p]) : own;
  }

  /// Carries the state over the panels. Not converged: chattering, or Newton failed on panels of any size.
  template <class Visitor>
  Status march(std::span<const Panel> panels, ElementState& state, Visitor& visitor) {
    for (const Panel& panel : panels) {
      if (const Status status = cross(panel, state, visitor); status != Status::converged) return status;
      if constexpr (Visitor::wants_samples)
        if (panel.sample_at_end) visitor.sample(left_output(state));
    }
    return Status::converged;
  }

 private:
  static constexpr std::size_t most_halvings = 24;
  static constexpr int most_events = 200;
  static constexpr long most_failures = 100'000;
  template <class Visitor>
  static constexpr bool wants_panels = requires {
    requires Visitor::wants_panels;
  };
  struct Event {
    int guard = 0;
    double t = 0.0;  ///< part of the panel, in [0, 1]
  };
  struct Pending {
    double position, before;
  };

  /// Slope by the phase of the slope of the rate.
  double bend(int anchor, double at) const {
    const double small = 1e-6;
    return (motion_.at(anchor, at + small).slope - motion_.at(anchor, at - small).slope) / (2.0 * small);
  }

  /// Output at the end of the last panel, before a jump that happens there.
  double left_output(const ElementState& state) const {
    if (pending_ && std::isfinite(pending_->before)) return pending_->before;
    return element_.output(panel_.node(panel_.stages() - 1).in, state.mode, state.z);
  }

  template <class Visitor>
  Status cross(const Panel& panel, ElementState& state, Visitor& visitor) {
    double from = panel.from;
    int events = 0;
    targets_.assign(1, panel.to);
    while (!targets_.empty()) {
      const double to = targets_.back();
      if (!(to - from > 4e-16 * std::abs(to))) {
        targets_.pop_back();
        continue;
      }
      const bool smallest = targets_.size() > most_halvings;
      if (!panel_.solve(panel.anchor, from, to, state) && !panel_.hold_or_relax(from, to, state, smallest)) {
        if (!panel_.finite()) return Status::not_finite;
        if (smallest || ++failures_ > most_failures) return Status::stalled;
        targets_.push_back(0.5 * (from + to));
        continue;
      }
      std::optional<Event> event;
      if (element_.has_modes()) event = first_event(panel.anchor, from, to, state);
      if (!event) {
        accept(panel.anchor, from, to, state, visitor);
        from = to;
        targets_.pop_back();
        continue;
      }
      if (++events > most_events) return Status::chattering;
      double at = from + event->t * (to - from);
      if (at > from) {
        bool arrived = false;
        if (!solve_to_switch(panel.anchor, from, at, to, event->guard, state, arrived)) return Status::stalled;
        accept(panel.anchor, from, at, state, visitor);
        // A guard that is crossed slowly stays on a plateau of roundings.
        arrived = arrived || at - from <= 1e-10 * (panel.to - panel.from);
        from = at;
        if (!arrived) {  // the longer panel was too rough to decide
          if (!smallest) targets_.push_back(0.5 * (from + to));
          continue;
        }
      }
      if constexpr (wants_panels<Visitor>) {
        const ElementState before = state;
        change_mode(panel.anchor, from, event->guard, state);
        visitor.switched(panel_.node_at(panel.anchor, from), bend(panel.anchor, from), event->guard, before, state);
      } else {
        change_mode(panel.anchor, from, event->guard, state);
      }
    }
    return Status::converged;
  }

  /// Solves up to the switch found on a longer panel, moving `at` to where the shorter panel, which is more accurate,
  /// switches, but not beyond `last`. `arrived` is false if it does not switch yet: the rest of the panel will decide.
  bool solve_to_switch(int anchor, double from, double& at, double last, int guard, const ElementState& state,
                       bool& arrived) {
    const auto k = static_cast<std::size_t>(guard);
    double before = from;     // the end of a panel without a switch
    double moved = infinite;  // in the last try
    // Among roundings, where the next try moves as far as the last one.
    const auto settled = [&](double next) {
      const double way = std::abs(next - at), last_way = std::exchange(moved, way);
      return way > 0.5 * last_way && way <= 1e-6 * (at - from) + 4e-16 * std::abs(at);
    };
    for (int tries = 0; tries < 20; ++tries) {
      if (!panel_.solve(anchor, from, at, state)) return false;
      const auto earlier = first_event(anchor, from, at, state);
      if (earlier && earlier->guard == guard) {
        const double sooner = from + earlier->t * (at - from);
        if (!(sooner > from) || at - sooner <= 1e-14 * (at - from) || settled(sooner)) break;
        at = sooner;
      } else if (earlier) {  // what lies before the switch is for the shorter panel
        if (before == from) break;
        at = before;
        arrived = false;
        return panel_.solve(anchor, from, at, state);
      } else if (has_arrived(anchor, from, at, state, k)) {
        break;
      } else {
        const double later = later_zero(anchor, from, at, state, k);
        arrived = later - at <= 1e-13 * (at - from) + 4e-16 * std::abs(at);
        if (arrived) return true;
        if (!(later > at && later <= last) || settled(later)) break;
        before = at;
        at = later;
      }
    }
    arrived = has_arrived(anchor, from, at, state, k);
    return true;
  }

  /// Within a rounding of the switch a guard may stay at its last positive value: that has arrived too.
  bool has_arrived(int anchor, double from, double at, const ElementState& state, std::size_t guard) {
    return at - from <= 1e-13 * std::abs(at) || guard_at(anchor, from, at, state, guard, 1.0) <=
                                                    1e-12 * std::abs(guard_at(anchor, from, at, state, guard, 0.0));
  }

  /// Zero of a guard that is still positive at the end of the panel, by its slope there; NaN where it is far or absent.
  double later_zero(int anchor, double from, double at, const ElementState& state, std::size_t guard) {
    constexpr double part = 1e-3, farthest = 0.1;  // of the panel
    const double end = guard_at(anchor, from, at, state, guard, 1.0);
    const double fall = guard_at(anchor, from, at, state, guard, 1.0 - part) - end, way = part * end / fall;
    return fall > 0.0 && way < farthest ? at + way * (at - from) : std::nan("");
  }

  template <class Visitor>
  void accept(int anchor, double from, double to, ElementState& state, Visitor& visitor) {
    if constexpr (Visitor::wants_samples) {
      if (pending_) {
        const double after = element_.output(panel_.node_at(anchor, from).in, state.mode, state.z);
        visitor.jump(pending_->position, after - (std::isfinite(pending_->before) ? pending_->before : after));
      }
    }
    pending_.reset();
    if constexpr (Visitor::wants_nodes) {
      for (std::size_t i = 0; i < panel_.stages(); ++i)
        visitor.node(panel_.node(i), panel_.weight(i) * (to - from),
                     element_.output(panel_.node(i).in, state.mode, panel_.state(i)));
      evaluations_ += static_cast<long>(panel_.stages());
    }
    if constexpr (wants_panels<Visitor>) visitor.panel(panel_, to - from, state.mode);
    if (n_ == 0) return;
    panel_.end(state);
    for (std::size_t p = 0; p < n_; ++p) peak_[p] = std::max(peak_[p], std::abs(state.z[p]));
  }

  /// The first guard that turns negative on the panel just solved, if any.
  std::optional<Event> first_event(int anchor, double from, double to, const ElementState& state) {
    std::optional<Event> first;
    const auto count = static_cast<std::size_t>(element_.guards(state.mode));
    if (count == 0) return first;
    guards_.resize(count);
    double before = 0.0;
    for (std::size_t i = 0; i < panel_.stages() && !first; ++i) {
      element_.guard(panel_.node(i).in, state.mode, panel_.state(i), guards_);
      const std::vector<double> here = guards_;
      for (std::size_t k = 0; k < count; ++k) {
        if (here[k] >= 0.0) continue;
        const double t = switch_time(anchor, from, to, state, k, before, panel_.node_fraction(i));
        if (!first || t < first->t) first = Event{static_cast<int>(k), t};
      }
      before = panel_.node_fraction(i);
    }
    return first;
  }

  double guard_at(int anchor, double from, double to, const ElementState& state, std::size_t guard, double t) {
    panel_.interpolate(t, state, work_);
    element_.guard(panel_.node_at(anchor, from + t * (to - from)).in, state.mode, work_, guards_);
    ++evaluations_;
    return guards_[guard];
  }

  /// Zero of a guard between the parts `low` (guard >= 0, else it is that part) and `high` (guard < 0) of the panel:
  /// regula falsi with halved weights (Illinois), finished by bisection; the side with guard <= 0.
  double switch_time(int anchor, double from, double to, const ElementState& state, std::size_t guard, double low,
                     double high) {
    double g_low = guard_at(anchor, from, to, state, guard, low);
    if (g_low <= 0.0) return low;
    double g_high = guard_at(anchor, from, to, state, guard, high);
    int side = 0;
    for (int k = 0; k < 200 && high - low > 3e-16 * high; ++k) {
      double t = k % 3 == 2 ? 0.5 * (low + high) : (low * g_high - high * g_low) / (g_high - g_low);
      if (!(t > low && t < high)) t = 0.5 * (low + high);
      const double g = guard_at(anchor, from, to, state, guard, t);
      if (g == 0.0) return t;
      if (g < 0.0) {
        high = t;
        g_high = g;
        if (side == -1) g_low *= 0.5;
        side = -1;
      } else {
        low = t;
        g_low = g;
        if (side == 1) g_high *= 0.5;
        side = 1;
      }
    }
    return high;
  }

  /// Enters the next mode. The sensitivity passes through a reset by the derivative R of the reset itself, and through
  /// a switch whose time depends on the state by the saltation term (rate after - R rate before) dt/dz.
  void change_mode(int anchor, double at, int guard, ElementState& state) {
    const MotionNode node = panel_.node_at(anchor, at);
    if (!pending_) {
      const double before = element_.output(node.in, state.mode, state.z);
      pending_ = Pending{motion_.position(anchor, at), before};
    }
    const Mode old = state.mode;
    const std::vector<double> z_before = state.z, s_before = state.sensitivity;
    state.mode = element_.next(node.in, old, state.z, guard);
    if (n_ == 0) return;
    for (double& s : state.sensitivity) s = 0.0;
    std::vector<double> rate_before(n_), carried(n_, 0.0);  // rate before the switch, and what the reset makes of it
    element_.rate(node.in, old, z_before, rate_before);
    const Input<Dual<1>> input{node.in.x, node.in.v, node.in.drive};
    for (std::size_t q = 0; q < n_; ++q) {
      for (std::size_t p = 0; p < n_; ++p) reset_[p] = z_before[p];
      reset_[q].d[0] = 1.0;
      dual_.next(input, old, reset_, guard);
      for (std::size_t p = 0; p < n_; ++p) {
        const double slope = reset_[p].d[0];
        if (slope == 0.0) continue;
        for (std::size_t r = 0; r < n_; ++r) state.sensitivity[p * n_ + r] += slope * s_before[q * n_ + r];
        carried[p] += slope * rate_before[q];
      }
    }
    add_saltation(anchor, at, guard, old, z_before, s_before, rate_before, carried, state);
  }

  void add_saltation(int anchor, double at, int guard, Mode old, const std::vector<double>& z_before,
                     const std::vector<double>& s_before, const std::vector<double>& rate_before,
                     const std::vector<double>& carried, ElementState& state) {
    const MotionNode node = panel_.node_at(anchor, at);
    std::vector<double> slope(n_), rate_after(n_);
    std::vector<Dual<1>> z(n_), g(static_cast<std::size_t>(element_.guards(old)));
    bool depends = false;
    for (std::size_t q = 0; q < n_; ++q) {
      for (std::size_t p = 0; p < n_; ++p) z[p] = z_before[p];
      z[q].d[0] = 1.0;
      dual_.guard(Input<Dual<1>>{node.in.x, node.in.v, node.in.drive}, old, z, g);
      slope[q] = g[static_cast<std::size_t>(guard)].d[0];
      depends = depends || slope[q] != 0.0;
    }
    if (!depends) return;
    element_.rate(node.in, state.mode, state.z, rate_after);
    // Rate of the guard: by its own motion (a difference over a small phase) and by the state.
    const double small = 1e-7;
    std::vector<double> here(g.size()), before(g.size());
    element_.guard(node.in, old, z_before, here);
    element_.guard(panel_.node_at(anchor, at - small).in, old, z_before, before);
    double speed =
        (here[static_cast<std::size_t>(guard)] - before[static_cast<std::size_t>(guard)]) / small * motion_.frequency();
    for (std::size_t q = 0; q < n_; ++q) speed += slope[q] * rate_before[q];
    if (!std::isfinite(speed) || speed == 0.0) return;
    for (std::size_t r = 0; r < n_; ++r) {
      double advance = 0.0;
      for (std::size_t q = 0; q < n_; ++q) advance += slope[q] * s_before[q * n_ + r] / speed;
      for (std::size_t p = 0; p < n_; ++p) state.sensitivity[p * n_ + r] += (rate_after[p] - carried[p]) * advance;
    }
  }

  Element element_;
  ElementOn<Dual<1>> dual_;
  const M& motion_;
  CollocationPanel<M> panel_;
  std::size_t n_;
  long evaluations_ = 0, failures_ = 0;
  std::optional<Pending> pending_;
  std::vector<double> targets_, guards_, work_;
  std::vector<Dual<1>> reset_;
  std::vector<double> peak_;
};

}  // namespace limcycle
