#pragma once
#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "limcycle/analysis/frequency/march/recorded_sums.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

/// Derivative of the harmonics of an element's periodic output by its input: the linearised equations of the panels of
/// one pass, with the saltation of every switch, closed over the (half) period.
///
/// Columns: for each order n of the input Re X_n, Im X_n; then the frequency, the mean of the input and its mean rate.
/// Rows: sine and cosine coefficient of each requested order; for order 0 the second is the mean, the first 0.
/// Exact up to the rounding of the panels; kinks that are not events (|v| in a law with a smooth state) do not
/// contribute. Cost: about nodes x columns x rows multiplications.
class ResponseDerivative {
 public:
  ResponseDerivative(const Element& element, double frequency, double mean_rate, int stages,
                     const std::vector<int>& input_orders)
      : element_(element),
        dual_(element.on<Dual<1>>()),
        table_(radau_iia(stages)),
        frequency_(frequency),
        mean_rate_(mean_rate),
        orders_(input_orders),
        n_(element.states()),
        columns_(2 * std::ssize(input_orders) + 3) {}

  Eigen::MatrixXd of(const std::vector<RecordedSums::Step>& steps, bool half, const std::vector<int>& output_orders) {
    Eigen::Index nodes = 0;
    for (const auto& step : steps) nodes += std::ssize(step.nodes);
    const auto rows = 2 * std::ssize(output_orders);
    outputs_.resize(nodes, columns_ + n_);
    trigonometry_.resize(rows, nodes);
    states_ = Eigen::MatrixXd::Zero(n_, columns_ + n_);
    states_.rightCols(n_).setIdentity();
    count_ = 0;
    for (const auto& step : steps) step.is_switch ? cross(step, output_orders) : carry(step, output_orders);
    Eigen::MatrixXd sums = trigonometry_ * outputs_ * ((half ? 2.0 : 1.0) / std::numbers::pi);
    for (Eigen::Index i = 0; i < std::ssize(output_orders); ++i)
      if (output_orders[static_cast<std::size_t>(i)] == 0) sums.middleRows(2 * i, 2) *= half ? 0.0 : 0.5;
    if (n_ == 0) return sums;
    // The state in which the period begins moves with the input so that it returns (mirrored after half a period).
    const double sign = half ? -1.0 : 1.0;
    const Eigen::MatrixXd map = sign * states_.rightCols(n_) - Eigen::MatrixXd::Identity(n_, n_);
    const Eigen::MatrixXd begin = least_squares_columns(map, -sign * states_.leftCols(columns_));
    return sums.leftCols(columns_) + sums.rightCols(n_) * begin;
  }

 private:
  using Index = Eigen::Index;
  using Row = Eigen::RowVectorXd;

  /// Derivative of the input and of its rate at one phase.
  void move(const MotionNode& node, Row& dx, Row& dv) const {
    dx.setZero(columns_ + n_);
    dv.setZero(columns_ + n_);
    double s = node.sine, c = node.cosine;
    int order = 1;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      for (; order < orders_[i]; ++order) {
        const double next = s * node.cosine + c * node.sine;
        c = c * node.cosine - s * node.sine;
        s = next;
      }
      const auto at = 2 * static_cast<Index>(i);
      const double rate = orders_[i] * frequency_;
      dx(at) = s;
      dx(at + 1) = c;
      dv(at) = rate * c;
      dv(at + 1) = -rate * s;
    }
    dv(columns_ - 3) = (node.in.v - mean_rate_) / frequency_;
    dx(columns_ - 2) = 1.0;
    dv(columns_ - 1) = 1.0;
  }

  /// Derivative of the slope of the rate by the phase.
  void bend(const MotionNode& node, Row& da) const {
    Row dx, dv;
    move(node, dx, dv);
    da.setZero(columns_ + n_);
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const auto at = 2 * static_cast<Index>(i);
      da(at) = orders_[i] * dv(at + 1);
      da(at + 1) = -orders_[i] * dv(at);
    }
    da(columns_ - 3) = node.slope / frequency_;
  }

  /// Values times `weight` in the next column of trigonometry_.
  void weigh(const MotionNode& node, double weight, const std::vector<int>& output_orders) {
    double s = 0.0, c = 1.0;
    int order = 0;
    for (std::size_t i = 0; i < output_orders.size(); ++i) {
      for (; order < output_orders[i]; ++order) {
        const double next = s * node.cosine + c * node.sine;
        c = c * node.cosine - s * node.sine;
        s = next;
      }
      trigonometry_(2 * static_cast<Index>(i), count_) = weight * s;
      trigonometry_(2 * static_cast<Index>(i) + 1, count_) = weight * c;
    }
  }

  /// Derivative of something of the element by x, by v and by each state.
  struct Slopes {
    double x = 0.0, v = 0.0;
    Row z;
  };
  template <class Value>
  Slopes slopes(const Input<double>& in, std::span<const double> z, Value value) {
    Slopes result;
    std::vector<Dual<1>> state(z.begin(), z.end());
    const Input<Dual<1>> still{in.x, in.v, in.drive};
    Input<Dual<1>> moved = still;
    moved.x.d[0] = 1.0;
    result.x = value(moved, state).d[0];
    moved = still;
    moved.v.d[0] = 1.0;
    result.v = value(moved, state).d[0];
    result.z.resize(n_);
    for (std::size_t p = 0; p < z.size(); ++p) {
      state[p].d[0] = 1.0;
      result.z(static_cast<Index>(p)) = value(still, state).d[0];
      state[p].d[0] = 0.0;
    }
    return result;
  }
  Slopes rate_slopes(const Input<double>& in, Mode mode, std::span<const double> z, std::size_t p) {
    std::vector<Dual<1>> rate(z.size());
    return slopes(in, z, [&](const Input<Dual<1>>& at, const std::vector<Dual<1>>& state) {
      dual_.rate(at, mode, state, rate);
      return rate[p];
    });
  }
  Slopes output_slopes(const Input<double>& in, Mode mode, std::span<const double> z) {
    return slopes(in, z, [&](const Input<Dual<1>>& at, const std::vector<Dual<1>>& state) {
      return dual_.output(at, mode, state);
    });
  }

  /// Over one panel: the linearised collocation equations, then the output at its nodes.
  void carry(const RecordedSums::Step& step, const std::vector<int>& output_orders) {
    const auto s = std::ssize(step.nodes);
    const auto n = static_cast<std::size_t>(n_);
    const double time = step.length / frequency_;
    const auto state = [&](Index i) {
      return std::span<const double>(step.z.data() + static_cast<std::size_t>(i) * n, n);
    };
    dx_.resize(static_cast<std::size_t>(s));
    dv_.resize(static_cast<std::size_t>(s));
    for (Index i = 0; i < s; ++i)
      move(step.nodes[static_cast<std::size_t>(i)], dx_[static_cast<std::size_t>(i)], dv_[static_cast<std::size_t>(i)]);
    Eigen::MatrixXd moved(s * n_, columns_ + n_);
    if (n_ > 0) {
      Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(s * n_, n_), forcing(s * n_, columns_ + n_);
      std::vector<double> rate(n);
      for (Index j = 0; j < s; ++j) {
        const auto& node = step.nodes[static_cast<std::size_t>(j)];
        element_.rate(node.in, step.mode, state(j), rate);
        for (std::size_t p = 0; p < n; ++p) {
          const Index row = j * n_ + static_cast<Index>(p);
          const Slopes slope = rate_slopes(node.in, step.mode, state(j), p);
          jacobian.row(row) = slope.z;
          forcing.row(row) = slope.x * dx_[static_cast<std::size_t>(j)] + slope.v * dv_[static_cast<std::size_t>(j)];
          forcing(row, columns_ - 3) -= rate[p] / frequency_;
        }
      }
      Eigen::MatrixXd system = Eigen::MatrixXd::Identity(s * n_, s * n_);
      for (Index i = 0; i < s; ++i) {
        moved.middleRows(i * n_, n_) = states_;
        for (Index j = 0; j < s; ++j) {
          const double a = time * table_.coefficient(static_cast<int>(i), static_cast<int>(j));
          system.block(i * n_, j * n_, n_, n_) -= a * jacobian.middleRows(j * n_, n_);
          moved.middleRows(i * n_, n_) += a * forcing.middleRows(j * n_, n_);
        }
      }
      moved = solve_columns(system, moved);
      states_ = moved.bottomRows(n_);
    }
    for (Index i = 0; i < s; ++i, ++count_) {
      const auto at = static_cast<std::size_t>(i);
      const Slopes slope = output_slopes(step.nodes[at].in, step.mode, state(i));
      outputs_.row(count_) = slope.x * dx_[at] + slope.v * dv_[at];
      if (n_ > 0) outputs_.row(count_) += slope.z * moved.middleRows(i * n_, n_);
      weigh(step.nodes[at], step.length * table_.b[at], output_orders);
    }
  }

  bool depends_on_drive(const RecordedSums::Step& step, std::vector<Dual<1>>& guards) const {
    const Input<double>& in = step.nodes.front().in;
    Input<Dual<1>> moved{in.x, in.v, in.drive};
    moved.drive.d[0] = 1.0;
    dual_.guard(moved, step.mode, std::vector<Dual<1>>(step.z.begin(), step.z.end()), guards);
    return guards[static_cast<std::size_t>(step.guard)].d[0] != 0.0;
  }

  /// Over a switch: it moves in phase, and with it the jump of the output and of the state's course.
  void cross(const RecordedSums::Step& step, const std::vector<int>& output_orders) {
    const MotionNode& node = step.nodes.front();
    Row dx, dv;
    move(node, dx, dv);
    std::vector<Dual<1>> guards(static_cast<std::size_t>(element_.guards(step.mode)));
    const Slopes slope = slopes(node.in, step.z, [&](const Input<Dual<1>>& at, const std::vector<Dual<1>>& state) {
      dual_.guard(at, step.mode, state, guards);
      return guards[static_cast<std::size_t>(step.guard)];
    });
    const auto n = static_cast<std::size_t>(n_);
    std::vector<double> before(n), after(n);
    element_.rate(node.in, step.mode, step.z, before);
    element_.rate(node.in, step.mode_after, step.z_after, after);
    const double by_x = node.in.v / frequency_, by_v = node.slope;
    double speed = slope.x * by_x + slope.v * by_v;
    Row shift = -(slope.x * dx + slope.v * dv);
    for (Index p = 0; p < n_; ++p) speed += slope.z(p) * before[static_cast<std::size_t>(p)] / frequency_;
    if (n_ > 0) shift -= slope.z * states_;
    if (depends_on_drive(step, guards)) {  // depends on its sign: the switch is where the acceleration is zero
      bend(node, shift);
      shift = -shift;
      speed = step.bend;
    }
    if (std::isfinite(speed) && speed != 0.0)
      shift /= speed;
    else
      shift.setZero();
    const double jump =
        element_.output(node.in, step.mode, step.z) - element_.output(node.in, step.mode_after, step.z_after);
    outputs_.row(count_) = std::isfinite(jump) ? Row(jump * shift) : Row(Row::Zero(columns_ + n_));
    weigh(node, 1.0, output_orders);
    ++count_;
    if (n_ > 0) reset(step, dx + by_x * shift, dv + by_v * shift, shift, before, after);
  }

  /// The state after the switch, by differences of the reset itself (which is affine for all existing elements).
  void reset(const RecordedSums::Step& step, const Row& dx, const Row& dv, const Row& shift,
             const std::vector<double>& before, const std::vector<double>& after) {
    const Input<double> in = step.nodes.front().in;
    Eigen::MatrixXd arriving = states_, leaving = Eigen::MatrixXd::Zero(n_, columns_ + n_);
    for (Index p = 0; p < n_; ++p) arriving.row(p) += before[static_cast<std::size_t>(p)] / frequency_ * shift;
    const auto add = [&](Input<double> at, std::vector<double> z, double size, const Row& change) {
      element_.next(at, step.mode, z, step.guard);
      for (Index p = 0; p < n_; ++p) {
        const auto i = static_cast<std::size_t>(p);
        leaving.row(p) += (z[i] - step.z_after[i]) / size * change;
      }
    };
    for (Index q = 0; q < n_; ++q) {
      const double size = element_.state_scale(static_cast<int>(q)) * 0x1p-20;
      std::vector<double> z = step.z;
      z[static_cast<std::size_t>(q)] += size;
      add(in, z, size, arriving.row(q));
    }
    const double x_size = 0x1p-20 * (std::abs(in.x) + element_.state_scale(0)),
                 v_size = 0x1p-20 * (std::abs(in.v) + x_size);
    add({in.x + x_size, in.v, in.drive}, step.z, x_size, dx);
    add({in.x, in.v + v_size, in.drive}, step.z, v_size, dv);
    for (Index p = 0; p < n_; ++p) leaving.row(p) -= after[static_cast<std::size_t>(p)] / frequency_ * shift;
    states_ = leaving;
  }

  Element element_;
  ElementOn<Dual<1>> dual_;
  const RadauIIA& table_;
  double frequency_, mean_rate_;
  std::vector<int> orders_;
  Index n_, columns_, count_ = 0;
  Eigen::MatrixXd outputs_, trigonometry_, states_;
  std::vector<Row> dx_, dv_;
};

}  // namespace limcycle
