#include <algorithm>

#include "limcycle/models/linear/dense.hpp"

#include "limcycle/analysis/motion/loop_field.hpp"

namespace limcycle {
namespace {

using Eigen::Index;

/// Value seeded as variable k of a batch of four that begins at `first`.
template <class D>
D seeded(double value, int k, int first) {
  return k >= first && k < first + 4 ? D::variable(value, k - first) : D(value);
}

}  // namespace

/// Gradients of the input and its rate of element i over the loop's state and time.
void LoopField::input_gradients(std::size_t i) {
  const Port& port = loop_->ports[i];
  const auto n = static_cast<Index>(n_), last = static_cast<Index>(size_);
  input_gradient_.noalias() = port.D * w_gradient_;
  rate_gradient_.noalias() = port.D_v * w_gradient_;
  input_gradient_.head(n) += port.C;
  rate_gradient_.head(n) += port.C_v;
  input_gradient_(last) += port.c.dot(ext_rate_.transpose());
  rate_gradient_(last) += port.c_v.dot(ext_rate_.transpose());
}

/// Gradient of the drive at its element's turn: w_gradient_ holds everything else.
void LoopField::drive_gradient() {
  const auto i = static_cast<Index>(*asks_drive_), n = static_cast<Index>(n_), last = static_cast<Index>(size_);
  const Port& port = loop_->ports[*asks_drive_];
  drive_gradient_.setZero(last + 1);
  if (drive_reach_ == 0.0) return;
  for (Index k = 0; k < i; ++k) drive_gradient_ += (port.C_v * loop_->B.col(k)).value() * w_gradient_.row(k);
  drive_gradient_.head(n) += port.C_v * loop_->A;
  drive_gradient_(last) += (port.C_v * loop_->E * ext_rate_).value();
  drive_gradient_ /= -drive_reach_;
}

/// Gradients of output and state rates of element i, by dual numbers in (x, v, z) and the drive where it needs that.
void LoopField::element_gradient(std::size_t i, const State& x) {
  input_gradients(i);
  const auto row = static_cast<Index>(i), n = static_cast<Index>(n_), own = static_cast<Index>(first_state_[i]);
  const bool solved = held(i) != Held::nothing || loop_->ports[i].selection_of, driven = i == asks_drive_ && !solved;
  const auto spread = [&](auto&& target, int seed, int nz, double factor) {
    if (seed == 0) target += factor * input_gradient_;
    if (seed == 1) target += factor * rate_gradient_;
    if (seed >= 2 && seed < 2 + nz) target(own + seed - 2) += factor;
    if (seed == 2 + nz && factor != 0.0) target += factor * drive_gradient_;
  };
  if (!solved) w_gradient_.row(row).setZero();
  std::visit(
      [&](const auto& e) {
        const int nz = e.states();
        const std::span<DualS> z(dual_z_.data(), static_cast<std::size_t>(nz)), dz(dual_dz_.data(), z.size());
        const int seeds = 2 + nz + (driven ? 1 : 0);
        if (nz > 0) z_gradient_.middleRows(own - n, nz).setZero();
        for (int first = 0; first < seeds; first += 4) {  // four seeds at a time
          const Input<DualS> in{seeded<DualS>(inputs_[i].x, 0, first), seeded<DualS>(inputs_[i].v, 1, first),
                                driven ? seeded<DualS>(inputs_[i].drive, 2 + nz, first) : DualS(inputs_[i].drive)};
          for (std::size_t k = 0; k < z.size(); ++k)
            z[k] = seeded<DualS>(x[first_state_[i] + k], 2 + static_cast<int>(k), first);
          const DualS out = solved ? DualS(0.0) : e.output(in, modes_[i], z);
          if (nz > 0) e.rate(in, modes_[i], z, dz);
          for (int k = first; k < std::min(seeds, first + 4); ++k) {
            const auto s = static_cast<std::size_t>(k - first);
            if (!solved) spread(w_gradient_.row(row), k, nz, out.d[s]);
            for (std::size_t j = 0; j < z.size(); ++j)
              spread(z_gradient_.row(own - n + static_cast<Index>(j)), k, nz, dz[j].d[s]);
          }
        }
      },
      dual_elements_[i]);
}

/// The same linear system as solve_held(), for the gradients; what depends on the holding outputs then follows.
void LoopField::held_gradient(const State& x) {
  if (holding_.empty()) return;
  const Index m = std::ssize(holding_), n = static_cast<Index>(n_);
  Eigen::MatrixXd rhs(m, static_cast<Index>(size_) + 1);
  Eigen::MatrixXd free = loop_->B * w_gradient_;
  free.leftCols(n) += loop_->A;
  free.rightCols(1) += loop_->E * ext_rate_;
  Eigen::RowVectorXd row;
  for (Index k = 0; k < m; ++k) {
    hold_row(holding_[static_cast<std::size_t>(k)], row);
    rhs.row(k) = -row * free;
  }
  const Eigen::MatrixXd outputs = solve_columns_fully_pivoted(reach_, rhs);
  for (Index k = 0; k < m; ++k)
    w_gradient_.row(static_cast<Index>(holding_[static_cast<std::size_t>(k)])) = outputs.row(k);
  if (!followed_) return;
  for (std::size_t i = 0; i < ne_; ++i) {
    if (follows_held(i))
      w_gradient_.row(static_cast<Index>(i)) =
          follow_slope(i) * w_gradient_.row(static_cast<Index>(*loop_->ports[i].selection_of));
    else if (held(i) == Held::nothing && !loop_->ports[i].selection_of)
      element_gradient(i, x);
  }
}

/// The same linear system as solve_with_drive(). On entry the holding outputs and the drive count as constant.
void LoopField::held_and_drive_gradient(const State& x) {
  const Index m = std::ssize(holding_), n = static_cast<Index>(n_);
  Eigen::MatrixXd rhs(m + 1, static_cast<Index>(size_) + 1);
  Eigen::MatrixXd free = loop_->B * w_gradient_;
  free.leftCols(n) += loop_->A;
  free.rightCols(1) += loop_->E * ext_rate_;
  Eigen::RowVectorXd row;
  for (Index k = 0; k < m; ++k) {
    hold_row(holding_[static_cast<std::size_t>(k)], row);
    rhs.row(k) = -row * free;
  }
  drive_gradient();
  rhs.row(m) = -drive_gradient_;
  const Eigen::MatrixXd unknowns = solve_columns_fully_pivoted(reach_, rhs);
  for (Index k = 0; k < m; ++k)
    w_gradient_.row(static_cast<Index>(holding_[static_cast<std::size_t>(k)])) = unknowns.row(k);
  drive_gradient_ = unknowns.row(m);
  element_gradient(*asks_drive_, x);
}

/// Gradients of all outputs and of the element states' rates at the last evaluated point.
void LoopField::output_gradients(const State& x) {
  const auto size = static_cast<Index>(size_), n = static_cast<Index>(n_);
  w_gradient_.setZero(static_cast<Index>(ne_), size + 1);
  z_gradient_.setZero(size - n, size + 1);
  drive_gradient_.setZero(size + 1);
  for (std::size_t i = 0; i < ne_; ++i) {
    if (i == asks_drive_ && !coupled_) drive_gradient();
    element_gradient(i, x);
  }
  if (coupled_) return held_and_drive_gradient(x);
  held_gradient(x);
}

void LoopField::jacobian(const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
  evaluate(x, t);
  if (plain_ && !signals_) {
    dfdt.assign(size_, 0.0);
    return plain_->jacobian(x, modes_, inputs_, J);
  }
  output_gradients(x);
  const auto size = static_cast<Index>(size_), n = static_cast<Index>(n_);
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

/// Gradient of guard `guard` of element i over the state, after output_gradients(). A guard may ask for the drive
/// while the element holds (then the drive is the output), and where the element needs it anyway.
Eigen::RowVectorXd LoopField::guard_gradient(const State& x, std::size_t i, std::size_t guard) {
  input_gradients(i);
  const auto own = static_cast<Index>(first_state_[i]);
  Eigen::RowVectorXd gradient = Eigen::RowVectorXd::Zero(static_cast<Index>(size_) + 1);
  std::visit(
      [&]<class E>(const E& e) {
        if constexpr (HasModes<E, DualS>) {
          const int nz = e.states();
          dual_g_.resize(static_cast<std::size_t>(e.guards(modes_[i])));
          for (int first = 0; first < 3 + nz; first += 4) {
            const Input<DualS> in{seeded<DualS>(inputs_[i].x, 0, first), seeded<DualS>(inputs_[i].v, 1, first),
                                  seeded<DualS>(inputs_[i].drive, 2, first)};
            for (int k = 0; k < nz; ++k)
              dual_z_[static_cast<std::size_t>(k)] =
                  seeded<DualS>(x[first_state_[i] + static_cast<std::size_t>(k)], 3 + k, first);
            e.guard(in, modes_[i], std::span<const DualS>(dual_z_.data(), static_cast<std::size_t>(nz)), dual_g_);
            for (int k = first; k < std::min(3 + nz, first + 4); ++k) {
              const double slope = dual_g_[guard].d[static_cast<std::size_t>(k - first)];
              if (k == 0) gradient += slope * input_gradient_;
              if (k == 1) gradient += slope * rate_gradient_;
              if (k == 2 && slope != 0.0) {
                if (i == asks_drive_ && held(i) == Held::nothing)
                  gradient += slope * drive_gradient_;
                else
                  gradient += slope * w_gradient_.row(static_cast<Index>(i));
              }
              if (k >= 3) gradient(own + k - 3) += slope;
            }
          }
        }
      },
      dual_elements_[i]);
  return gradient.head(static_cast<Index>(size_));
}

/// Derivative of the state after the reset that the switch of this guard performs over the state before.
Eigen::MatrixXd LoopField::reset_gradient(const State& x, std::size_t i, std::size_t guard) {
  input_gradients(i);
  const auto size = static_cast<Index>(size_), own = static_cast<Index>(first_state_[i]);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Identity(size, size);
  std::visit(
      [&]<class E>(const E& e) {
        if constexpr (HasModes<E, DualS>) {
          const int nz = e.states();
          if (nz == 0) return;
          gradient.middleRows(own, nz).setZero();
          for (int first = 0; first < 2 + nz; first += 4) {
            const Input<DualS> in{seeded<DualS>(inputs_[i].x, 0, first), seeded<DualS>(inputs_[i].v, 1, first),
                                  DualS(inputs_[i].drive)};
            for (int k = 0; k < nz; ++k)
              dual_z_[static_cast<std::size_t>(k)] =
                  seeded<DualS>(x[first_state_[i] + static_cast<std::size_t>(k)], 2 + k, first);
            const std::span<DualS> z(dual_z_.data(), static_cast<std::size_t>(nz));
            e.next(in, modes_[i], z, static_cast<int>(guard));
            for (int j = 0; j < nz; ++j)
              for (int k = first; k < std::min(2 + nz, first + 4); ++k) {
                const double slope = z[static_cast<std::size_t>(j)].d[static_cast<std::size_t>(k - first)];
                if (k == 0) gradient.row(own + j) += slope * input_gradient_.head(size);
                if (k == 1) gradient.row(own + j) += slope * rate_gradient_.head(size);
                if (k >= 2) gradient(own + j, own + k - 2) += slope;
              }
          }
        }
      },
      dual_elements_[i]);
  return gradient;
}

}  // namespace limcycle
