#include "limcycle/analysis/motion/field/loop_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

using Eigen::Index;

LoopField::Sparse::Sparse(const Eigen::RowVectorXd& row) {
  for (Index i = 0; i < row.size(); ++i)
    if (row(i) != 0.0) entries.emplace_back(static_cast<std::size_t>(i), row(i));
}

LoopField::LoopField(const Loop& loop)
    : loop_(&loop),
      n_(static_cast<std::size_t>(loop.states())),
      ne_(loop.elements.size()),
      has_follower_(ne_, false),
      modes_(ne_),
      w_(ne_, 0.0),
      inputs_(ne_) {
  size_ = n_;
  for (const auto& element : loop.elements) {
    first_state_.push_back(size_);
    slopes_.emplace_back(element);
    size_ += static_cast<std::size_t>(slopes_.back().states());
  }
  for (Index i = 0; i < loop.states(); ++i) {
    A_.emplace_back(loop.A.row(i));
    E_.emplace_back(loop.E.row(i));
  }
  for (std::size_t i = 0; i < ne_; ++i) {
    ports_.push_back(sparse_port(i));
    if (const auto& leader = loop.ports[i].selection_of) has_follower_[*leader] = true;
    if (loop.elements[i].facts().has_clock) clocks_.push_back(i);
  }
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!loop.elements[i].needs_drive()) continue;
    if (i + 1 != ne_)
      throw std::invalid_argument(loop.ports[i].path + " needs the applied force: it can only be friction");
    asks_drive_ = i;
    const auto column = loop.B.col(static_cast<Index>(i));
    const double reach = (loop.ports[i].C_v * column).value();
    const double size = (loop.ports[i].C_v.cwiseAbs() * column.cwiseAbs()).value();
    drive_reach_ = reach < -1e-12 * size ? reach : 0.0;
  }
  dX_.resize(n_);
  E_ext_.resize(n_);
  ext_ = loop.external;
  ext_rate_ = External::Zero();
  for (std::size_t i = 0; i < n_; ++i) E_ext_[i] = E_[i].dot(ext_.data());
  if (PlainField::applies(loop)) plain_.emplace(loop);
  // The search for the force that a compensation and its friction share leaves other values behind.
  evaluated_.kept =
      !clocks_.empty() && !asks_drive_ && std::ranges::none_of(has_follower_, [](bool has) { return has; });
}

LoopField::SparsePort LoopField::sparse_port(std::size_t i) const {
  const Port& port = loop_->ports[i];
  const Element& element = loop_->elements[i];
  const auto column = loop_->B.col(static_cast<Index>(i));
  SparsePort sparse{Sparse(port.C),
                    Sparse(port.D),
                    Sparse(port.C_v),
                    Sparse(port.D_v),
                    Sparse(port.c),
                    Sparse(port.c_v),
                    Sparse(column.transpose()).entries};
  const Eigen::RowVectorXd& row = element.facts().holds == Held::input ? port.C : port.C_v;
  sparse.reach = (row * column).value();
  sparse.reaches = sparse.reach < -1e-12 * (row.cwiseAbs() * column.cwiseAbs()).value();
  sparse.uses_drive =
      port.rubs || element.is_friction() || element.facts().holds != Held::nothing || element.needs_drive();
  if (sparse.C_v.entries.size() == 1) sparse.velocity = sparse.C_v.entries.front().first;
  return sparse;
}

/// One that shares another law's selection is held by that.
Held LoopField::held(std::size_t i) const {
  return has_own_guards(i) ? loop_->elements[i].held(modes_[i]) : Held::nothing;
}

/// Row c such that the rate of the signal that element i can hold is c dX/dt + the returned number.
double LoopField::hold_row(std::size_t i, Eigen::RowVectorXd& row) const {
  const Port& port = loop_->ports[i];
  const bool input = loop_->elements[i].facts().holds == Held::input;
  row = input ? port.C : port.C_v;
  return (input ? port.c : port.c_v).dot(ext_rate_.transpose());
}

/// The state that is the velocity held by element i, if it is one state.
std::optional<std::size_t> LoopField::held_state(std::size_t i) const {
  const SparsePort& port = ports_[i];
  if (held(i) != Held::rate || port.c_v.dot(ext_.data()) != 0.0 || port.c_v.dot(ext_rate_.data()) != 0.0)
    return std::nullopt;
  return port.velocity;
}

/// Rate of the signal that element i can hold, at the present outputs.
double LoopField::free_rate_of_held(std::size_t i) const {
  const SparsePort& port = ports_[i];
  const bool input = loop_->elements[i].facts().holds == Held::input;
  return (input ? port.C : port.C_v).dot(dX_.data()) + (input ? port.c : port.c_v).dot(ext_rate_.data());
}

/// Output that would hold the signal of element i at the present other outputs; +-infinity if no output can.
double LoopField::drive_of(std::size_t i) const {
  const SparsePort& port = ports_[i];
  const double without = free_rate_of_held(i) - port.reach * w_[i];
  if (!port.reaches) return without >= 0.0 ? infinite : -infinite;
  return -without / port.reach;
}

/// The same at the turn of element i, when dX_ contains all other contributions.
double LoopField::drive_at_turn(std::size_t i) const {
  const double without = ports_[i].C_v.dot(dX_.data()) + ports_[i].c_v.dot(ext_rate_.data());
  if (drive_reach_ == 0.0) return without >= 0.0 ? infinite : -infinite;
  return -without / drive_reach_;
}

/// The same for a friction law whose selection a compensation shares: both together hold the body. Overcompensated
/// friction holds nothing.
double LoopField::drive_with_follower(std::size_t i, const State& x) {
  const Mode kept_mode = modes_[i];
  kept_.w = w_;
  kept_.dX = dX_;
  kept_.holding = holding_;
  kept_.inputs = inputs_;
  modes_[i] = Mode{};  // as if stuck
  holding_.assign(1, i);
  followed_ = true;
  const double output = outputs_by_superposition(x)(0);
  w_[i] = 0.0;
  sweep(x);
  const double without = free_rate_of_held(i);
  const bool holds = reach_(0, 0) < 0.0;
  modes_[i] = kept_mode;
  w_ = kept_.w;
  dX_ = kept_.dX;
  inputs_ = kept_.inputs;
  holding_ = kept_.holding;
  followed_ = std::ranges::any_of(holding_, [this](std::size_t k) { return has_follower_[k]; });
  if (!holds) return without >= 0.0 ? infinite : -infinite;
  return output;
}

bool LoopField::follows_held(std::size_t i) const {
  const auto& leader = loop_->ports[i].selection_of;
  return leader && held(*leader) == Held::rate;
}

/// True for a friction law that sticks and breaks away with another one.
bool LoopField::is_second_law(std::size_t i) const { return !has_own_guards(i) && loop_->elements[i].may_stick(); }

/// Gives the second law at a body the mode of the first.
void LoopField::follow_modes() {
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!is_second_law(i)) continue;
    const Mode leading = modes_[*loop_->ports[i].selection_of];
    modes_[i] = loop_->ports[i].reversed ? loop_->elements[i].mirror(leading) : leading;
  }
}

/// Output that the whole selection, of that sign, of element i stands for.
double LoopField::full_output(std::size_t i, double sign) const {
  const Element& element = loop_->elements[i];
  if (!is_second_law(i)) return element.output(inputs_[i], Mode{1}, {});
  const double share_of_unit = std::abs(element.selection(Mode{}, sign < 0.0 ? -1.0 : 1.0));  // 1/Fs
  return std::isfinite(share_of_unit) ? 1.0 / share_of_unit : 0.0;
}

/// Output of an element that shares the selection of a friction law.
double LoopField::follow(std::size_t i) const {
  const Port& port = loop_->ports[i];
  const std::size_t leader = *port.selection_of;
  if (is_second_law(i) && !follows_held(i)) return loop_->elements[i].output(inputs_[i], modes_[i], {});
  const double share = (port.reversed ? -1.0 : 1.0) * loop_->elements[leader].selection(modes_[leader], w_[leader]);
  return full_output(i, share) * share;
}

/// d(output of the follower)/d(output of the stuck law it follows).
double LoopField::follow_slope(std::size_t i) const {
  const Port& port = loop_->ports[i];
  const std::size_t leader = *port.selection_of;
  const double unit = w_[leader] < 0.0 ? -1.0 : 1.0, sense = port.reversed ? -1.0 : 1.0;
  const double share = loop_->elements[leader].selection(modes_[leader], unit);
  return full_output(i, sense * share) * sense * share / unit;
}

void LoopField::add_output(std::size_t i, double w) {
  for (const auto& [row, b] : ports_[i].B) dX_[row] += b * w;
}

/// One pass over the elements in order, with the outputs of the holding ones from w_.
void LoopField::sweep(const State& x) {
  for (std::size_t i = 0; i < n_; ++i) dX_[i] = A_[i].dot(x.data()) + E_ext_[i];
  for (std::size_t i = 0; i < ne_; ++i) {
    const SparsePort& port = ports_[i];
    Input<double>& in = inputs_[i];
    in.x = port.C.dot(x.data()) + port.D.dot(w_.data()) + port.c.dot(ext_.data());
    in.v = port.C_v.dot(x.data()) + port.D_v.dot(w_.data()) + port.c_v.dot(ext_.data());
    if (loop_->ports[i].selection_of) {
      w_[i] = follow(i);
    } else if (std::ranges::find(holding_, i) == holding_.end()) {
      if (i == asks_drive_ && !coupled_) in.drive = drive_at_turn(i);
      w_[i] = loop_->elements[i].output(in, modes_[i], own_states(x, i));
    }
    if (w_[i] != 0.0) add_output(i, w_[i]);
  }
}

/// Rates of the held signals at the last sweep.
void LoopField::hold_residual(Eigen::VectorXd& residual) const {
  residual.resize(std::ssize(holding_));
  for (Index k = 0; k < residual.size(); ++k) residual(k) = free_rate_of_held(holding_[static_cast<std::size_t>(k)]);
}

/// Holding outputs if other elements follow them: in fixed modes everything is affine in them, on either side of zero
/// (a selection may have another slope there).
const Eigen::VectorXd& LoopField::outputs_by_superposition(const State& x) {
  const Index m = std::ssize(holding_);
  auto& [base, side, outputs, residual] = superposition_;
  side.setOnes(m);
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (const std::size_t i : holding_) w_[i] = 0.0;
    sweep(x);
    hold_residual(base);
    reach_.resize(m, m);
    for (Index k = 0; k < m; ++k) {
      for (Index j = 0; j < m; ++j) w_[holding_[static_cast<std::size_t>(j)]] = j == k ? side(j) : 0.0;
      sweep(x);
      hold_residual(residual);
      reach_.col(k) = (residual - base) / side(k);
    }
    base = -base;
    solve_fully_pivoted(reach_, base, outputs);
    const auto found = outputs.unaryExpr([](double w) { return w < 0.0 ? -1.0 : 1.0; });
    if (found == side) break;
    side = found;
  }
  return outputs;
}

/// Outputs of the holding elements: all held signals have zero rate. On entry dX_ holds the rates without them.
void LoopField::solve_held(const State& x) {
  if (followed_) {
    const Eigen::VectorXd& outputs = outputs_by_superposition(x);
    for (Index k = 0; k < outputs.size(); ++k) w_[holding_[static_cast<std::size_t>(k)]] = outputs(k);
    sweep(x);
  } else if (holding_.size() == 1) {
    const std::size_t i = holding_.front();
    reach_.setConstant(1, 1, ports_[i].reach);
    w_[i] = -free_rate_of_held(i) / ports_[i].reach;
    add_output(i, w_[i]);
  } else {
    const Index m = std::ssize(holding_);
    reach_.resize(m, m);
    Eigen::RowVectorXd row;
    for (Index k = 0; k < m; ++k) {
      hold_row(holding_[static_cast<std::size_t>(k)], row);
      for (Index j = 0; j < m; ++j)
        reach_(k, j) = (row * loop_->B.col(static_cast<Index>(holding_[static_cast<std::size_t>(j)]))).value();
    }
    auto& [free, side, outputs, residual] = superposition_;
    hold_residual(free);
    free = -free;
    solve_fully_pivoted(reach_, free, outputs);
    for (Index k = 0; k < m; ++k) {
      const std::size_t i = holding_[static_cast<std::size_t>(k)];
      w_[i] = outputs(k);
      add_output(i, w_[i]);
    }
  }
  // The forces leave a rate of rounding size, on which a body at rest would creep.
  if (!followed_)
    for (const std::size_t i : holding_)
      if (const auto only = held_state(i)) dX_[*only] = 0.0;
  for (const std::size_t i : holding_) inputs_[i].drive = w_[i];
}

void LoopField::look_outside(double t) {
  if (!signals_) return;
  signals_(t, ext_, ext_rate_);
  if (plain_) return plain_->set_external(ext_);
  for (std::size_t i = 0; i < n_; ++i) E_ext_[i] = E_[i].dot(ext_.data());
}

void LoopField::evaluate(const State& x, double t) {
  if (!evaluated_.kept) return evaluate_anew(x, t);
  if (evaluated_.known && evaluated_.t == t && evaluated_.x == x && evaluated_.modes == modes_) return;
  evaluated_.known = false;
  evaluate_anew(x, t);
  evaluated_.t = t;
  evaluated_.x = x;
  evaluated_.modes = modes_;
  evaluated_.known = true;
}

void LoopField::evaluate_anew(const State& x, double t) {
  look_outside(t);
  if (plain_) {
    plain_->rate(x, modes_, inputs_, w_, plain_dx_);
    std::copy_n(plain_dx_.begin(), n_, dX_.begin());
    return;
  }
  holding_.clear();
  followed_ = false;
  for (std::size_t i = 0; i < ne_; ++i) {
    if (held(i) == Held::nothing) continue;
    holding_.push_back(i);
    followed_ = followed_ || has_follower_[i];
    w_[i] = 0.0;
  }
  coupled_ = asks_drive_ && drive_reach_ != 0.0 && !holding_.empty() && held(*asks_drive_) == Held::nothing;
  if (coupled_) return solve_with_drive(x);
  if (!followed_) sweep(x);
  if (!holding_.empty()) solve_held(x);
}

/// Rates and drives that need all outputs: for guards and switches, not for the field.
void LoopField::find_inputs(const State& x) {
  for (std::size_t i = 0; i < ne_; ++i) {
    const SparsePort& port = ports_[i];
    inputs_[i].v = port.C_v.dot(x.data()) + port.D_v.dot(w_.data()) + port.c_v.dot(ext_.data());
    if (has_follower_[i])  // overcompensated friction holds nothing, even where the forces would balance
      inputs_[i].drive = drive_with_follower(i, x);
    else if (port.uses_drive && held(i) == Held::nothing && i != asks_drive_)  // which has it from its turn
      inputs_[i].drive = drive_of(i);
  }
}

/// Rates of the held signals, and the resulting drive less the assumed one, for given holding outputs and drive: affine
/// in both.
Eigen::VectorXd LoopField::held_and_drive(const State& x, const Eigen::VectorXd& unknowns) {
  const Index m = std::ssize(holding_);
  for (Index k = 0; k < m; ++k) w_[holding_[static_cast<std::size_t>(k)]] = unknowns(k);
  inputs_[*asks_drive_].drive = unknowns(m);
  sweep(x);
  Eigen::VectorXd rates, residual(m + 1);
  hold_residual(rates);
  residual << rates, drive_of(*asks_drive_) - unknowns(m);
  return residual;
}

/// Holding outputs and drive together, by superposition.
void LoopField::solve_with_drive(const State& x) {
  const Index m = std::ssize(holding_) + 1;
  const Eigen::VectorXd base = held_and_drive(x, Eigen::VectorXd::Zero(m));
  reach_.resize(m, m);
  for (Index k = 0; k < m; ++k) reach_.col(k) = held_and_drive(x, Eigen::VectorXd::Unit(m, k)) - base;
  held_and_drive(x, solve_fully_pivoted(reach_, -base));
}

void LoopField::rate(const State& x, State& dx, double t) {
  if (plain_) {
    look_outside(t);
    return plain_->rate(x, modes_, inputs_, w_, dx);
  }
  evaluate(x, t);
  dx.resize(size_);
  std::ranges::copy(dX_, dx.begin());
  for (std::size_t i = 0; i < ne_; ++i) {
    if (slopes_[i].states() > 0) loop_->elements[i].rate(inputs_[i], modes_[i], own_states(x, i), own_states(dx, i));
  }
}

std::span<const double> LoopField::own_states(const State& x, std::size_t i) const {
  return {x.data() + first_state_[i], static_cast<std::size_t>(slopes_[i].states())};
}

std::span<double> LoopField::own_states(State& x, std::size_t i) const {
  return {x.data() + first_state_[i], static_cast<std::size_t>(slopes_[i].states())};
}

double LoopField::y(const State& x) const {
  return loop_->C_y.dot(Eigen::Map<const Eigen::RowVectorXd>(x.data(), loop_->C_y.size()));
}

double LoopField::y_rate(const State& dx) const { return y(dx); }

}  // namespace limcycle
