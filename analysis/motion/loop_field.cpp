#include "limcycle/analysis/motion/loop_field.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::Index;

int states_of(const Element<double>& element) {
  return std::visit([](const auto& e) { return e.states(); }, element);
}

/// The same element on another scalar.
template <class To>
Element<To> recast_element(const Element<double>& element) {
  return std::visit(
      []<template <class> class Kind>(const Kind<double>& e) -> Element<To> { return recast<Kind, To>(e); }, element);
}

}  // namespace

LoopField::Sparse::Sparse(const Eigen::RowVectorXd& row) {
  for (Index i = 0; i < row.size(); ++i)
    if (row(i) != 0.0) entries.emplace_back(static_cast<std::size_t>(i), row(i));
}

LoopField::LoopField(const Loop& loop)
    : loop_(&loop),
      n_(static_cast<std::size_t>(loop.states())),
      ne_(loop.elements.size()),
      modes_(ne_),
      w_(ne_, 0.0),
      inputs_(ne_) {
  size_ = n_;
  std::size_t most = 0;
  for (const auto& element : loop.elements) {
    const auto own = static_cast<std::size_t>(states_of(element));
    first_state_.push_back(size_);
    size_ += own;
    most = std::max(most, own);
    dual_elements_.push_back(recast_element<DualS>(element));
  }
  for (Index i = 0; i < loop.states(); ++i) {
    A_.emplace_back(loop.A.row(i));
    E_.emplace_back(loop.E.row(i));
  }
  for (std::size_t i = 0; i < ne_; ++i) {
    const Port& port = loop.ports[i];
    ports_.push_back({Sparse(port.C), Sparse(port.D), Sparse(port.C_v), Sparse(port.D_v), Sparse(port.c),
                      Sparse(port.c_v), Sparse(loop.B.col(static_cast<Index>(i)).transpose()).entries});
  }
  dual_z_.resize(most);
  dual_dz_.resize(most);
  base_.resize(n_);
  dX_.resize(n_);
  E_ext_.resize(n_);
  ext_ = loop.external;
  ext_rate_ = External::Zero();
  for (std::size_t i = 0; i < n_; ++i) E_ext_[i] = E_[i].dot(ext_.data());
}

Held LoopField::held(std::size_t i) const {
  return std::visit(
      [&]<class E>(const E& e) {
        if constexpr (CanHold<E>) return e.held(modes_[i]);
        return Held::nothing;
      },
      loop_->elements[i]);
}

/// Row c such that the rate of the signal that element i can hold is c dX/dt + the returned number.
double LoopField::hold_row(std::size_t i, Eigen::RowVectorXd& row) const {
  const Port& port = loop_->ports[i];
  const bool input = std::holds_alternative<Relay<double>>(loop_->elements[i]);
  row = input ? port.C : port.C_v;
  return (input ? port.c : port.c_v).dot(ext_rate_.transpose());
}

/// Output that would hold the signal of element i, the other outputs being what they are; +-infinity if no output can.
double LoopField::drive_of(std::size_t i) const {
  Eigen::RowVectorXd row;
  const double free_rate = hold_row(i, row);
  const auto column = loop_->B.col(static_cast<Index>(i));
  const double reach = (row * column).value();
  const double without =
      row.dot(Eigen::Map<const Eigen::RowVectorXd>(dX_.data(), row.size())) + free_rate - reach * w_[i];
  const double size = (row.cwiseAbs() * column.cwiseAbs()).value();
  if (!(reach < -1e-12 * size)) return without >= 0.0 ? infinite : -infinite;
  return -without / reach;
}

void LoopField::evaluate_element(std::size_t i, const State& x) {
  const SparsePort& port = ports_[i];
  Input<double>& in = inputs_[i];
  in.x = port.C.dot(x.data()) + port.D.dot(w_.data()) + port.c.dot(ext_.data());
  in.v = port.C_v.dot(x.data()) + port.D_v.dot(w_.data()) + port.c_v.dot(ext_.data());
  if (held(i) != Held::nothing) {  // solved for afterwards
    holding_.push_back(i);
    return;
  }
  const std::span<const double> z(x.data() + first_state_[i], x.data() + x.size());
  w_[i] = std::visit([&](const auto& e) { return e.output(in, modes_[i], z); }, loop_->elements[i]);
}

/// Outputs of the holding elements: all held signals have zero rate. On entry dX_ holds the rates without them.
void LoopField::solve_held() {
  const Index m = std::ssize(holding_);
  Eigen::MatrixXd M(m, m);
  Eigen::VectorXd rhs(m);
  Eigen::RowVectorXd row;
  for (Index k = 0; k < m; ++k) {
    const double free_rate = hold_row(holding_[static_cast<std::size_t>(k)], row);
    rhs(k) = -row.dot(Eigen::Map<const Eigen::RowVectorXd>(dX_.data(), row.size())) - free_rate;
    for (Index j = 0; j < m; ++j)
      M(k, j) = (row * loop_->B.col(static_cast<Index>(holding_[static_cast<std::size_t>(j)]))).value();
  }
  const Eigen::VectorXd outputs = m == 1 ? Eigen::VectorXd(rhs / M(0, 0)) : Eigen::VectorXd(M.fullPivLu().solve(rhs));
  for (Index k = 0; k < m; ++k) {
    const std::size_t i = holding_[static_cast<std::size_t>(k)];
    w_[i] = inputs_[i].drive = outputs(k);
    add_output(i, w_[i]);
  }
}

void LoopField::add_output(std::size_t i, double w) {
  for (const auto& [row, b] : ports_[i].B) dX_[row] += b * w;
}

void LoopField::look_outside(double t) {
  if (!signals_) return;
  signals_(t, ext_, ext_rate_);
  for (std::size_t i = 0; i < n_; ++i) E_ext_[i] = E_[i].dot(ext_.data());
}

void LoopField::evaluate(const State& x, double t) {
  look_outside(t);
  for (std::size_t i = 0; i < n_; ++i) dX_[i] = A_[i].dot(x.data()) + E_ext_[i];
  std::ranges::fill(w_, 0.0);
  holding_.clear();
  for (std::size_t i = 0; i < ne_; ++i) {
    evaluate_element(i, x);
    if (w_[i] != 0.0) add_output(i, w_[i]);
  }
  if (!holding_.empty()) solve_held();
}

/// Rates and drives that need all outputs: for guards and switches, not for the field.
void LoopField::find_inputs(const State& x) {
  for (std::size_t i = 0; i < ne_; ++i) {
    const SparsePort& port = ports_[i];
    inputs_[i].v = port.C_v.dot(x.data()) + port.D_v.dot(w_.data()) + port.c_v.dot(ext_.data());
    if (held(i) == Held::nothing) inputs_[i].drive = drive_of(i);
  }
}

void LoopField::rate(const State& x, State& dx, double t) {
  evaluate(x, t);
  dx.resize(size_);
  std::ranges::copy(dX_, dx.begin());
  for (std::size_t i = 0; i < ne_; ++i) {
    const std::span<const double> z(x.data() + first_state_[i], x.data() + x.size());
    std::visit(
        [&](const auto& e) {
          if (e.states() > 0) e.rate(inputs_[i], modes_[i], z, {dx.data() + first_state_[i], dx.data() + dx.size()});
        },
        loop_->elements[i]);
  }
}

/// Gradients of output and state rates of element i over the loop's state and time, by dual numbers in (x, v, z).
void LoopField::element_gradient(std::size_t i, const State& x) {
  const Port& port = loop_->ports[i];
  const auto row = static_cast<Index>(i), n = static_cast<Index>(n_), last = static_cast<Index>(size_);
  input_gradient_.setZero(last + 1);
  rate_gradient_.setZero(last + 1);
  if (i > 0) {
    input_gradient_.noalias() += port.D * w_gradient_;
    rate_gradient_.noalias() += port.D_v * w_gradient_;
  }
  input_gradient_.head(n) += port.C;
  rate_gradient_.head(n) += port.C_v;
  input_gradient_(last) += port.c.dot(ext_rate_.transpose());
  rate_gradient_(last) += port.c_v.dot(ext_rate_.transpose());
  const bool solved = held(i) != Held::nothing;
  const auto own = static_cast<Index>(first_state_[i]);
  const auto spread = [&](auto&& target, int seed, double factor) {
    if (seed == 0) target += factor * input_gradient_;
    if (seed == 1) target += factor * rate_gradient_;
    if (seed >= 2) target(own + seed - 2) += factor;
  };
  std::visit(
      [&](const auto& e) {
        const int nz = e.states();
        const std::span<DualS> z(dual_z_.data(), static_cast<std::size_t>(nz)), dz(dual_dz_.data(), z.size());
        for (int first = 0; first < 2 + nz; first += 4) {  // four seeds at a time
          const auto seeded = [first](double value, int k) {
            return k >= first && k < first + 4 ? DualS::variable(value, k - first) : DualS(value);
          };
          const Input<DualS> in{seeded(inputs_[i].x, 0), seeded(inputs_[i].v, 1), DualS(inputs_[i].drive)};
          for (std::size_t k = 0; k < z.size(); ++k) z[k] = seeded(x[first_state_[i] + k], 2 + static_cast<int>(k));
          const DualS out = solved ? DualS(0.0) : e.output(in, modes_[i], z);
          if (nz > 0) e.rate(in, modes_[i], z, dz);
          for (int k = first; k < std::min(2 + nz, first + 4); ++k) {
            const auto s = static_cast<std::size_t>(k - first);
            spread(w_gradient_.row(row), k, out.d[s]);
            for (std::size_t j = 0; j < z.size(); ++j)
              spread(z_gradient_.row(own - n + static_cast<Index>(j)), k, dz[j].d[s]);
          }
        }
      },
      dual_elements_[i]);
}

/// The same linear system as solve_held(), for the gradients.
void LoopField::held_gradient() {
  if (holding_.empty()) return;
  const Index m = std::ssize(holding_), n = static_cast<Index>(n_);
  Eigen::MatrixXd M(m, m), rhs(m, static_cast<Index>(size_) + 1);
  Eigen::MatrixXd free = loop_->B * w_gradient_;
  free.leftCols(n) += loop_->A;
  free.rightCols(1) += loop_->E * ext_rate_;
  Eigen::RowVectorXd row;
  for (Index k = 0; k < m; ++k) {
    hold_row(holding_[static_cast<std::size_t>(k)], row);
    rhs.row(k) = -row * free;
    for (Index j = 0; j < m; ++j)
      M(k, j) = (row * loop_->B.col(static_cast<Index>(holding_[static_cast<std::size_t>(j)]))).value();
  }
  const Eigen::MatrixXd outputs = M.fullPivLu().solve(rhs);
  for (Index k = 0; k < m; ++k)
    w_gradient_.row(static_cast<Index>(holding_[static_cast<std::size_t>(k)])) = outputs.row(k);
}

void LoopField::jacobian(const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
  evaluate(x, t);
  const auto size = static_cast<Index>(size_), n = static_cast<Index>(n_);
  w_gradient_.setZero(static_cast<Index>(ne_), size + 1);
  z_gradient_.setZero(size - n, size + 1);
  for (std::size_t i = 0; i < ne_; ++i) element_gradient(i, x);
  held_gradient();
  J.resize(size, size);
  J.topRows(n).setZero();
  J.topLeftCorner(n, n) = loop_->A;
  for (std::size_t i = 0; i < ne_; ++i)
    for (const auto& [row, b] : ports_[i].B)
      J.row(static_cast<Index>(row)) += b * w_gradient_.row(static_cast<Index>(i)).head(size);
  J.bottomRows(size - n) = z_gradient_.leftCols(size);
  dfdt.assign(size_, 0.0);
  if (!signals_) return;
  Eigen::Map<Eigen::VectorXd> time(dfdt.data(), size);
  time.head(n) = loop_->B * w_gradient_.col(size) + loop_->E * ext_rate_;
  time.tail(size - n) = z_gradient_.col(size);
}

std::size_t LoopField::guard_count() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < ne_; ++i)
    std::visit(
        [&]<class E>(const E& e) {
          if constexpr (HasModes<E, double>) count += static_cast<std::size_t>(e.guards(modes_[i]));
        },
        loop_->elements[i]);
  return count;
}

void LoopField::guards(const State& x, double t, std::vector<double>& g) {
  g.resize(guard_count());
  if (g.empty()) return;
  evaluate(x, t);
  find_inputs(x);
  std::size_t at = 0;
  for (std::size_t i = 0; i < ne_; ++i)
    std::visit(
        [&]<class E>(const E& e) {
          if constexpr (HasModes<E, double>) {
            const auto count = static_cast<std::size_t>(e.guards(modes_[i]));
            const std::span<const double> z(x.data() + first_state_[i], x.data() + x.size());
            e.guard(inputs_[i], modes_[i], z, std::span<double>(g.data() + at, count));
            at += count;
          }
        },
        loop_->elements[i]);
}

std::size_t LoopField::owner(std::size_t guard) const {
  std::size_t at = 0;
  for (std::size_t i = 0; i < ne_; ++i) {
    std::visit(
        [&]<class E>(const E& e) {
          if constexpr (HasModes<E, double>) at += static_cast<std::size_t>(e.guards(modes_[i]));
        },
        loop_->elements[i]);
    if (guard < at) return i;
  }
  return modes_.size();
}

void LoopField::fire(State& x, double t, std::size_t guard) {
  const std::size_t i = owner(guard);
  std::size_t first = guard;
  while (first > 0 && owner(first - 1) == i) --first;
  evaluate(x, t);
  find_inputs(x);
  std::visit(
      [&]<class E>(const E& e) {
        if constexpr (HasModes<E, double>) {
          const std::span<double> z(x.data() + first_state_[i], x.data() + x.size());
          modes_[i] = e.next(inputs_[i], modes_[i], z, static_cast<int>(guard - first));
        }
      },
      loop_->elements[i]);
  if (held(i) != Held::rate) return;
  // The located v is zero to the accuracy of the location; take what is left out along the direction the force acts in.
  const Port& port = loop_->ports[i];
  const Eigen::VectorXd column = loop_->B.col(static_cast<Index>(i));
  Eigen::Map<Eigen::VectorXd>(x.data(), column.size()) -= column * (inputs_[i].v / (port.C_v * column).value());
}

void LoopField::start(State& x, double t) {
  for (std::size_t i = 0; i < ne_; ++i) {
    evaluate(x, t);
    find_inputs(x);
    std::visit(
        [&]<class E>(const E& e) {
          if constexpr (HasModes<E, double>)
            modes_[i] = e.start(inputs_[i], {x.data() + first_state_[i], x.data() + x.size()});
        },
        loop_->elements[i]);
  }
}

double LoopField::y(const State& x) const {
  return loop_->C_y.dot(Eigen::Map<const Eigen::RowVectorXd>(x.data(), loop_->C_y.size()));
}

double LoopField::y_rate(const State& dx) const { return y(dx); }

}  // namespace limcycle
