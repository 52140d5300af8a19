#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

using Eigen::Index;

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

/// Gradient of the drive at its element's turn: w_gradient_ contains all other contributions.
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

/// Gradients of output and state rates of element i, by dual numbers in (x, v, z), and in the drive if it needs that.
void LoopField::element_gradient(std::size_t i, const State& x) {
  input_gradients(i);
  const auto row = static_cast<Index>(i), n = static_cast<Index>(n_), own = static_cast<Index>(first_state_[i]);
  const bool solved = held(i) != Held::nothing || follows_held(i) || (!has_own_guards(i) && !is_second_law(i));
  const bool driven = i == asks_drive_ && !solved;
  const auto& slopes = slopes_[i].response(inputs_[i], modes_[i], x.data() + first_state_[i], driven, !solved);
  const Index nz = slopes_[i].states();
  const auto spread = [&](auto&& target, Index from) {
    target.setZero();
    target += slopes(from, 0) * input_gradient_;
    target += slopes(from, 1) * rate_gradient_;
    for (Index k = 0; k < nz; ++k) target(own + k) += slopes(from, 2 + k);
    if (driven && slopes(from, 2 + nz) != 0.0) target += slopes(from, 2 + nz) * drive_gradient_;
  };
  if (!solved) spread(w_gradient_.row(row), 0);
  for (Index j = 0; j < nz; ++j) spread(z_gradient_.row(own - n + j), 1 + j);
}

/// The same linear system as solve_held(), for the gradients; dependent outputs then follow.
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
    else if (held(i) == Held::nothing && (has_own_guards(i) || is_second_law(i)))
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
  const auto still = [&] {  // as in the rates
    for (const std::size_t only : held_states()) J.row(static_cast<Index>(only)).setZero();
  };
  if (plain_ && !signals_) {
    dfdt.assign(size_, 0.0);
    plain_->jacobian(x, modes_, inputs_, slopes_, J);
    return still();
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
  still();
  dfdt.assign(size_, 0.0);
  if (!signals_) return;
  Eigen::Map<Eigen::VectorXd> time(dfdt.data(), size);
  time.head(n) = loop_->B * w_gradient_.col(size) + loop_->E * ext_rate_;
  time.tail(size - n) = z_gradient_.col(size);
}

/// Gradient of guard `guard` of element i over the state, after output_gradients(). A guard may need the drive while
/// the element holds (then the drive is the output), and if the element needs it anyway.
Eigen::RowVectorXd LoopField::guard_gradient(const State& x, std::size_t i, std::size_t guard) {
  input_gradients(i);
  const auto own = static_cast<Index>(first_state_[i]);
  Eigen::RowVectorXd gradient = Eigen::RowVectorXd::Zero(static_cast<Index>(size_) + 1);
  const auto& slopes = slopes_[i].guard(inputs_[i], modes_[i], x.data() + first_state_[i], guard);
  gradient += slopes(0, 0) * input_gradient_;
  gradient += slopes(0, 1) * rate_gradient_;
  if (const double by_drive = slopes(0, 2); by_drive != 0.0) {
    if (i == asks_drive_ && held(i) == Held::nothing)
      gradient += by_drive * drive_gradient_;
    else
      gradient += by_drive * w_gradient_.row(static_cast<Index>(i));
  }
  for (Index k = 0; k < slopes_[i].states(); ++k) gradient(own + k) += slopes(0, 3 + k);
  return gradient.head(static_cast<Index>(size_));
}

/// Derivative of the state after the reset by this guard's switch, over the state before.
Eigen::MatrixXd LoopField::reset_gradient(const State& x, std::size_t i, std::size_t guard) {
  input_gradients(i);
  const auto size = static_cast<Index>(size_), own = static_cast<Index>(first_state_[i]);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Identity(size, size);
  const auto& slopes = slopes_[i].reset(inputs_[i], modes_[i], x.data() + first_state_[i], guard);
  const Index nz = slopes_[i].states();
  for (Index j = 0; j < nz; ++j) {
    auto target = gradient.row(own + j);
    target.setZero();
    target += slopes(j, 0) * input_gradient_.head(size);
    target += slopes(j, 1) * rate_gradient_.head(size);
    for (Index k = 0; k < nz; ++k) target(own + k) += slopes(j, 2 + k);
  }
  return gradient;
}

}  // namespace limcycle
