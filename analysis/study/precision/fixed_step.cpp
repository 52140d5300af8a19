#include "limcycle/analysis/study/precision/fixed_step.hpp"

#include <algorithm>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

using Eigen::Index;

std::string_view to_string(FixedMethod method) {
  switch (method) {
    case FixedMethod::euler:
      return "euler";
    case FixedMethod::rk4:
      return "rk4";
    default:
      return "semi-implicit";
  }
}

int evaluations_per_step(FixedMethod method) { return method == FixedMethod::euler ? 1 : 4; }

void FixedStepper::runge_kutta(State& x, double t, double h, const State& dx) {
  const double ends[] = {0.5, 0.5, 1.0}, weights[] = {2.0, 2.0, 1.0};
  sum_ = k_ = dx;
  stage_.resize(x.size());
  for (int s = 0; s < 3; ++s) {
    for (std::size_t i = 0; i < x.size(); ++i) stage_[i] = x[i] + ends[s] * h * k_[i];
    field_.rate(stage_, k_, t + ends[s] * h);
    for (std::size_t i = 0; i < x.size(); ++i) sum_[i] += weights[s] * k_[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6.0 * sum_[i];
}

void FixedStepper::semi_implicit(State& x, double t, double h, const State& dx) {
  const auto n = static_cast<std::size_t>(field_.loop().states());
  const auto own = static_cast<Index>(x.size() - n);
  if (own > 0) {
    field_.jacobian(x, J_, t, unused_);
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(own, own) - h * J_.bottomRightCorner(own, own);
    const Eigen::VectorXd change = solve_fully_pivoted(left, h * Eigen::Map<const Eigen::VectorXd>(dx.data() + n, own));
    for (Index k = 0; k < own; ++k) x[n + static_cast<std::size_t>(k)] += change(k);
  }
  field_.rate(x, k_, t);
  for (std::size_t i = 0; i < n; ++i) x[i] += h * k_[i];
}

void FixedStepper::fire_switches(State& x, double t) {
  for (int again = 0; again < 3; ++again) {
    field_.guards(x, t, guards_);
    const auto fired = std::ranges::find_if(guards_, [](double g) { return g < 0.0; });
    if (fired == guards_.end()) return;
    field_.fire(x, t, static_cast<std::size_t>(fired - guards_.begin()));
  }
}

void FixedStepper::step(State& x, State& dx, double t, double h) {
  switch (method_) {
    case FixedMethod::euler:
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * dx[i];
      break;
    case FixedMethod::rk4:
      runge_kutta(x, t, h, dx);
      break;
    case FixedMethod::semi_implicit:
      semi_implicit(x, t, h, dx);
      break;
  }
  if (is_finite(x)) fire_switches(x, t + h);
  field_.rate(x, dx, t + h);
}

}  // namespace limcycle
