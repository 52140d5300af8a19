#include "limcycle/analysis/frequency/harmonic_balance/balance_newton.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

namespace {

using Eigen::VectorXd;

constexpr int most_halvings = 10;

class Newton {
 public:
  Newton(BalanceEquations& equations, const BalanceNewtonOptions& options) : equations_(equations), options_(options) {}

  BalanceSolution run(const BalancePoint& start) {
    u_ = equations_.pack(start);
    BalanceSolution now = evaluate(u_);
    if (now.status != Status::converged) return now;
    for (int iteration = 0; now.residual > options_.tolerance; ++iteration) {
      if (iteration == options_.max_iterations) return ended(now, Status::max_iterations);
      if (stopped()) return ended(now, Status::interrupted);
      const VectorXd step = direction(now);
      if (!(step.norm() > 0.0) || !step.allFinite()) return ended(now, Status::stalled);
      if (!advance(step, now)) return ended(now, stopped() ? Status::interrupted : Status::stalled);
    }
    return now;
  }

 private:
  static BalanceSolution ended(BalanceSolution now, Status status) {
    now.status = status;
    return now;
  }

  bool stopped() const { return options_.stop && options_.stop(); }

  /// Point, outputs and residual at the unknowns u; the vector of residuals stays in r_trial_.
  BalanceSolution evaluate(const VectorXd& u) {
    BalanceSolution result{Status::converged, equations_.unpack(u), {}, 0.0};
    result.outputs = equations_.outputs(result.point, equations_.orders());
    result.status = result.outputs.status;
    if (result.status != Status::converged) return result;
    r_trial_ = equations_.residual(result.point, result.outputs);
    if (!r_trial_.allFinite()) {
      result.status = Status::not_finite;
      return result;
    }
    if (r_.size() == 0) r_ = r_trial_;
    result.residual = r_trial_.cwiseAbs().maxCoeff();
    return result;
  }

  /// Newton's step; of least norm where the loop integrates and a mean may be free.
  VectorXd direction(const BalanceSolution& now) {
    Eigen::MatrixXd J;
    if (!equations_.jacobian(now.point, now.outputs, J)) return VectorXd::Zero(u_.size());
    if (equations_.free_parts() > 0) return -least_squares(J, r_);
    return -solve(J, r_);
  }

  /// Follows the step as far as the residual falls. False if it does not fall.
  bool advance(const VectorXd& step, BalanceSolution& now) {
    const auto main = equations_.main_index();
    double part = std::min({1.0, 0.3 / std::abs(step(main + 1)), 0.5 * std::abs(u_(main) / step(main))});
    for (int k = 0; k < most_halvings && !stopped(); ++k, part *= 0.5) {
      const VectorXd u = u_ + part * step;
      BalanceSolution trial = evaluate(u);
      if (trial.status != Status::converged || !(r_trial_.norm() < (1.0 - 1e-4 * part) * r_.norm())) continue;
      u_ = u;
      r_ = r_trial_;
      now = std::move(trial);
      return true;
    }
    return false;
  }

  BalanceEquations& equations_;
  const BalanceNewtonOptions& options_;
  VectorXd u_, r_, r_trial_;
};

}  // namespace

BalanceSolution solve_balance(BalanceEquations& equations, const BalancePoint& start,
                              const BalanceNewtonOptions& options) {
  return Newton(equations, options).run(start);
}

}  // namespace limcycle
