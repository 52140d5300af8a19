#pragma once
#include <Eigen/Core>
#include <vector>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_response.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A periodic motion of a loop in terms of its harmonics.
struct BalancePoint {
  double frequency = 0.0;  ///< rad/s
  std::vector<Eigen::VectorXcd>
      inputs;                    ///< of each element, orders 0..H; order 0 (j mean) follows from the means below
  Eigen::VectorXd mean_outputs;  ///< of the elements
  Eigen::VectorXd free;          ///< parts of the mean state along the null space of A (a loop that integrates)
};

/// Outputs of the elements for the inputs of a BalancePoint.
struct BalanceOutputs {
  Status status = Status::converged;
  std::vector<Eigen::VectorXcd> harmonics;  ///< of each element, orders 0..
};

/// Mean state of the linear part and the resulting means at the elements.
struct BalanceMeans {
  Eigen::VectorXd state, inputs, rates;
};

/// The equations of a harmonic balance with H harmonics,
///   X_k(n) = sum_l H_kl(jnw) W_l(n),  n = 1..H (odd n only with `half_wave`),    w0_k = mean output of element k,
/// W_l(n) being the harmonics of the periodic output of element l for its input. The means follow from w0 through
/// A X0 + E ext + B w0 = 0. Where A is singular (the loop integrates) X0 has free parts along its null space, and the
/// balance along its left null space is one more equation each.
///
/// Unknowns and residuals are scaled: inputs by the size of that element's oscillation, means by that of its output, ln
/// w in the place of the phase, which is fixed: the first harmonic of the last (main) element's input keeps its cosine
/// part. Residuals of the inputs are divided by the amplitude of the main one over that of the reference, so that the
/// rest point is no solution.
class BalanceEquations {
 public:
  BalanceEquations(const Loop& loop, bool half_wave);

  int orders() const { return orders_; }
  /// Takes H and the scales from a point and its outputs.
  void set_reference(const BalancePoint& point, const BalanceOutputs& outputs);
  /// Panels of the quadrature: level of ElementHarmonics and tolerance of the periodic state.
  void set_quadrature(int level, double tolerance) {
    level_ = level;
    tolerance_ = tolerance;
  }

  /// Harmonics 0..orders of all elements' outputs. Any status but converged: no_cycle if an element does not answer
  /// half-wave symmetrically, else why its periodic state was not found. `given`: the means, instead of those that
  /// follow from the point.
  BalanceOutputs outputs(const BalancePoint& point, int orders, const BalanceMeans* given = nullptr);
  BalanceMeans means(const Eigen::VectorXd& mean_outputs, const Eigen::VectorXd& free) const;
  /// Free parts that bring the means of the inputs and rates closest to those given.
  Eigen::VectorXd closest_free(const Eigen::VectorXd& mean_outputs, const Eigen::VectorXd& inputs) const;
  Eigen::Index free_parts() const { return null_.cols(); }

  Eigen::VectorXd pack(const BalancePoint& point) const;
  BalancePoint unpack(const Eigen::VectorXd& unknowns) const;
  Eigen::VectorXd residual(const BalancePoint& point, const BalanceOutputs& outputs) const;
  /// Derivative of the residual by the unknowns, from that of each element's response. False if an element has no
  /// response.
  bool jacobian(const BalancePoint& point, const BalanceOutputs& outputs, Eigen::MatrixXd& J);

  /// Linear response to the outputs at order n >= 1.
  Eigen::MatrixXcd response(int order, double frequency) const { return loop_.element_response(order * frequency); }

  /// Index of the sine part of the main input's first harmonic among the unknowns; ln w follows it.
  Eigen::Index main_index() const { return 2 * main() * per_element(); }

  long evaluations() const { return evaluations_; }

 private:
  Eigen::Index per_element() const { return (orders_ + stride() - 1) / stride(); }
  Eigen::Index unknowns() const {
    return 2 * elements() * per_element() + (half_wave_ ? 0 : elements() + null_.cols());
  }
  PrescribedHarmonics motion(const BalancePoint& point, const BalanceMeans& means, Eigen::Index k) const;
  Eigen::MatrixXd by_unknowns(const Eigen::MatrixXd& own, Eigen::Index l, double frequency) const;
  Eigen::Index elements() const { return std::ssize(loop_.elements); }
  Eigen::Index main() const { return elements() - 1; }
  int stride() const { return half_wave_ ? 2 : 1; }

  const Loop& loop_;
  bool half_wave_;
  int orders_ = 1, level_ = 1;
  double tolerance_ = 1e-9;
  long evaluations_ = 0;
  std::vector<ElementHarmonics> responses_;
  Eigen::MatrixXd still_, pseudo_inverse_, null_, left_null_;
  Eigen::VectorXd pull_;
  Eigen::VectorXd input_scale_, output_scale_, free_scale_, balance_scale_;
  double main_cosine_ = 0.0, main_amplitude_ = 1.0;
  BalanceMeans resting_;                      ///< with outputs of mean 0
  Eigen::MatrixXd mean_inputs_, mean_rates_;  ///< derivative of the means by mean outputs and free parts
};

}  // namespace limcycle
