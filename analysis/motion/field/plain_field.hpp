#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "limcycle/analysis/motion/field/element_slopes.hpp"
#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The vector field of a loop whose elements never hold a signal and never ask for the drive (bristle laws, saturation,
/// gravity, ...): one pass over the elements in order. LoopField delegates to it, because most marches are of such
/// loops and the general method costs several times as much.
class PlainField {
 public:
  static bool applies(const Loop& loop);
  explicit PlainField(const Loop& loop);

  /// Sets the external signals.
  void set_external(const External& ext);
  /// Rates dx, outputs w and the inputs they come from. Cost of the linear part: n (n + 2 n_e) multiplications.
  void rate(const State& x, std::span<const Mode> modes, std::span<Input<double>> inputs, std::span<double> w,
            State& dx) const;
  /// d(dx)/dx, exact. `inputs` must be those at x; `slopes` are those of the loop's elements, in order.
  void jacobian(const State& x, std::span<const Mode> modes, std::span<const Input<double>> inputs,
                std::span<ElementSlopes> slopes, Eigen::MatrixXd& J);

 private:
  /// One element, with its ports as whole rows: such loops have few states.
  struct Part {
    const Element* element;
    std::size_t first = 0, states = 0;      ///< of its own states in the state of the loop
    std::vector<double> B, C, C_v, D, D_v;  ///< B by linear states, D by elements before
    Eigen::RowVector4d c, c_v;
    double input_outside = 0.0, rate_outside = 0.0;  ///< c ext, c_v ext
  };
  template <std::size_t N>
  void rate_sized(const State& x, std::span<const Mode> modes, std::span<Input<double>> inputs, std::span<double> w,
                  State& dx) const;

  std::size_t n_;
  std::vector<double> A_;        ///< by columns
  std::vector<double> outside_;  ///< E ext
  Eigen::Matrix<double, Eigen::Dynamic, 4> E_;
  std::vector<Part> parts_;
  Eigen::MatrixXd w_gradient_;  ///< of the outputs, by columns
  Eigen::VectorXd input_gradient_, rate_gradient_;
};

}  // namespace limcycle
