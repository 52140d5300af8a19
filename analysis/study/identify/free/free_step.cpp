#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/steppers/radau_stages.hpp"
#include "limcycle/analysis/study/identify/free/free_march.hpp"

/// @file
/// A step of FreeMarch: rates, their derivatives, and the method.

namespace limcycle {
namespace {

using Eigen::Index;

constexpr double tolerance = 1e-6;  ///< of the error estimate, which is of third order: that of the step is far less

}  // namespace

/// d(gravity)/d(its input).
double FreeMarch::torque_slope(const Eigen::Vector2d& x) const {
  return torque_ == 0.0 ? 0.0 : torque_ * std::cos(C_gravity_.dot(x));
}

void FreeMarch::rate(double t, const State& x, State& dx) {
  const Eigen::Vector2d at = x.head<plant_states>();
  Eigen::Vector2d f = A_ * at + B_u_ * (u_ + u_slope_ * (t - t_input_));
  if (torque_ != 0.0) f -= B_gravity_ * (torque_ * std::sin(C_gravity_.dot(at)));
  in_ = {0.0, C_v_.dot(at) + v0_, C_v_.dot(f) / mobility_};
  for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = x(plant_states + static_cast<Index>(i));
  output_ = law_.respond(in_, mode_, z_, dz_);
  dx.head<plant_states>() = f - B_F_ * output_;
  for (std::size_t i = 0; i < z_.size(); ++i) dx(plant_states + static_cast<Index>(i)) = dz_[i];
}

/// d(drive)/d(states of the plant).
Eigen::RowVector2d FreeMarch::drive_row(const Eigen::Vector2d& x) const {
  return (C_v_ * A_ - C_v_.dot(B_gravity_) * torque_slope(x) * C_gravity_) / mobility_;
}

/// d(rates)/d(states) at x, in J_.
void FreeMarch::jacobian(double t, const State& x) {
  rate(t, x, work_);
  const Eigen::Vector2d at = x.head<plant_states>();
  const bool by_drive = law_.may_stick();
  const auto& law = own_slopes_.response(in_, mode_, z_.data(), by_drive);
  const Index m = n_ - plant_states;
  Eigen::RowVector2d force = law(0, 1) * C_v_;
  if (by_drive) force += law(0, 2 + m) * drive_row(at);
  J_.resize(n_, n_);
  J_.topLeftCorner<plant_states, plant_states>() = A_ - B_F_ * force - B_gravity_ * torque_slope(at) * C_gravity_;
  for (Index i = 0; i < m; ++i) {
    J_.block<plant_states, 1>(0, plant_states + i) = -B_F_ * law(0, 2 + i);
    J_.block<1, plant_states>(plant_states + i, 0) = law(1 + i, 1) * C_v_;
    for (Index k = 0; k < m; ++k) J_(plant_states + i, plant_states + k) = law(1 + i, 2 + k);
  }
}

/// Adds d(rates)/d(numbers of the law), at the point where rate() was called last, to forced_.
void FreeMarch::add_number_rates() {
  if (slopes_ == nullptr) return;
  const auto& law = slopes_->response(in_, mode_, z_);
  for (Index k = 0; k < law.cols(); ++k) {
    for (Index i = 0; i < plant_states; ++i) forced_(i, k) -= B_F_(i) * law(0, k);
    for (Index i = plant_states; i < n_; ++i) forced_(i, k) += law(i - 1, k);
  }
}

/// First guess of the stages: on the polynomial through those of the step before, if that led here.
void FreeMarch::predict(double h) {
  const auto& c = radau_stages().c;
  if (!(last_step_ > 0.0)) {
    for (std::size_t i = 0; i < stages; ++i) increments_[i] = c[i] * h * rate_;
    return;
  }
  const double nodes[] = {0.0, c[0], c[1], c[2]};
  for (std::size_t i = 0; i < stages; ++i) {
    const double s = 1.0 + c[i] * h / last_step_;
    increments_[i] = -last_increments_[2];
    for (std::size_t j = 1; j < 4; ++j) {
      double weight = 1.0;
      for (std::size_t k = 0; k < 4; ++k)
        if (k != j) weight *= (s - nodes[k]) / (nodes[j] - nodes[k]);
      increments_[i] += weight * last_increments_[j - 1];
    }
  }
}

/// Stages of a step of length h, in increments_, with the derivative at its start. False if Newton's method fails.
bool FreeMarch::solve(double h) {
  const auto& [c, a] = radau_stages();
  rate(t_, x_, rate_);
  jacobian(t_, x_);
  predict(h);
  const auto m = static_cast<std::size_t>(3 * n_);
  system_.assign(m * m, 0.0);
  for (Index k = 0; k < n_; ++k)
    for (std::size_t i = 0; i < stages; ++i) {
      double* const row = system_.data() + (static_cast<std::size_t>(k) * stages + i) * m;
      for (Index l = 0; l < n_; ++l)
        for (std::size_t j = 0; j < stages; ++j)
          row[static_cast<std::size_t>(l) * stages + j] = (k == l && i == j ? 1.0 : 0.0) - h * a[i][j] * J_(k, l);
    }
  if (!factors_.take(system_, m)) return false;
  change_.resize(m);
  double before = infinite;
  for (int pass = 0; pass < 15; ++pass) {
    for (std::size_t i = 0; i < stages; ++i) rate(t_ + c[i] * h, probe_ = x_ + increments_[i], rates_[i]);
    for (Index k = 0; k < n_; ++k)
      for (std::size_t i = 0; i < stages; ++i) {
        double& left = change_[static_cast<std::size_t>(k) * stages + i];
        left = -increments_[i](k);
        for (std::size_t j = 0; j < stages; ++j) left += h * a[i][j] * rates_[j](k);
      }
    factors_.solve(change_);
    double size = 0.0;
    for (Index k = 0; k < n_; ++k)
      for (std::size_t i = 0; i < stages; ++i) {
        const double change = change_[static_cast<std::size_t>(k) * stages + i];
        increments_[i](k) += change;
        size = std::max(size, std::abs(change) / scale_(k));
      }
    if (!std::isfinite(size)) return false;
    if (size < 1e-11) return true;
    if (size > 0.9 * before) return before < 1e-9;
    before = size;
  }
  return false;
}

/// Estimated error of the step just solved over the tolerance: the difference from an embedded method of third order.
double FreeMarch::error_of(double h) {
  static const double root = std::sqrt(6.0);
  static const double gamma = 1.0 / ((6.0 + std::cbrt(81.0) - std::cbrt(9.0)) / 30.0);
  const double weights[] = {-(13.0 + 7.0 * root) / 3.0, (-13.0 + 7.0 * root) / 3.0, -1.0 / 3.0};
  const auto n = static_cast<std::size_t>(n_), width = n + 1;
  const auto filtered = [&](const State& at_start) {
    system_.assign(n * width, 0.0);
    for (Index k = 0; k < n_; ++k) {
      double* const row = system_.data() + static_cast<std::size_t>(k) * width;
      for (Index l = 0; l < n_; ++l) row[static_cast<std::size_t>(l)] = (k == l ? gamma / h : 0.0) - J_(k, l);
      row[n] = at_start(k);
      for (std::size_t i = 0; i < stages; ++i) row[n] += weights[i] / h * increments_[i](k);
    }
    if (!eliminate(system_, n, 1)) return infinite;
    double sum = 0.0;
    for (Index k = 0; k < n_; ++k) {
      error_(k) = system_[static_cast<std::size_t>(k) * width + n];
      sum += std::pow(error_(k) / scale_(k), 2);
    }
    return std::sqrt(sum / static_cast<double>(n_));
  };
  const double allowed = tolerance / std::pow(fineness_, 4);
  double error = filtered(rate_);
  if (error > allowed && std::isfinite(error)) {  // the estimate itself is not bounded for stiff components
    State again(n_);
    rate(t_, probe_ = x_ + error_, again);
    error = std::min(error, filtered(again));
  }
  return error / allowed;
}

/// Carries the deviations over a solved step of length h.
bool FreeMarch::carry(double h) {
  const auto& [c, a] = radau_stages();
  const Index q = columns();
  const auto m = static_cast<std::size_t>(3 * n_), width = m + static_cast<std::size_t>(q);
  system_.assign(m * width, 0.0);
  forced_.resize(n_, q);
  for (std::size_t j = 0; j < stages; ++j) {
    jacobian(t_ + c[j] * h, probe_ = x_ + increments_[j]);
    for (Index r = 0; r < q; ++r) forced_.col(r).noalias() = J_.lazyProduct(deviations_.col(r));
    add_number_rates();
    for (Index k = 0; k < n_; ++k)
      for (std::size_t i = 0; i < stages; ++i) {
        double* const row = system_.data() + (static_cast<std::size_t>(k) * stages + i) * width;
        for (Index l = 0; l < n_; ++l)
          row[static_cast<std::size_t>(l) * stages + j] = (k == l && i == j ? 1.0 : 0.0) - h * a[i][j] * J_(k, l);
        for (Index r = 0; r < q; ++r) row[m + static_cast<std::size_t>(r)] += h * a[i][j] * forced_(k, r);
      }
  }
  if (!eliminate(system_, m, static_cast<std::size_t>(q))) return false;
  for (Index k = 0; k < n_; ++k) {
    const double* const end = system_.data() + (static_cast<std::size_t>(k) * stages + 2) * width + m;
    for (Index r = 0; r < q; ++r) deviations_(k, r) += end[r];
  }
  return true;
}

}  // namespace limcycle
