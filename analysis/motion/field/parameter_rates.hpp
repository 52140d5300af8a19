#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// A loop with a slightly smaller parameter, and one with a slightly larger one.
struct ParameterNeighbours {
  Loop low, high;
  /// Half the difference of the parameter between them, in its unit. A relative 1e-6 serves best: rounding then leaves
  /// a relative error of 1e-10 in the equations, and truncation less. If the parameter cannot be less, `low` may be the
  /// loop itself; the differences stay exact if the equations are linear in it, otherwise they are of first order.
  double step = 0.0;
  double value = 0.0;  ///< of the parameter, for the relative step (0: a relative step of a millionth is assumed)
};

/// Derivatives of a loop's equations by its parameters, at fixed state and time: of the rates, of the guards, of the
/// resets at switches. A case file cannot be differentiated, so these are differences between a loop and its
/// neighbours, of equations and never of a motion; relative error about 1e-10 (see ParameterNeighbours).
///
/// A friction law has a kink where the rubbing velocity is zero, and a parameter may move that velocity (the speed of a
/// belt). So the neighbours are evaluated at states moved until it is that of the loop, and the Jacobian gives the
/// effect of the move: no difference is taken over a kink.
class ParameterRates {
 public:
  /// Keeps references to the neighbours. Throws std::invalid_argument unless every step is finite and not zero and
  /// every neighbour has as many states, elements and modes as the loop.
  ParameterRates(const Loop& loop, std::span<const ParameterNeighbours> neighbours);

  Eigen::Index count() const { return std::ssize(pairs_); }

  /// d(dx/dt)/dp, a column each, in the modes of `field`, which was last evaluated at x and whose Jacobian there is J.
  /// Cost: two to four rates each.
  void rates(const LoopField& field, const State& x, const Eigen::MatrixXd& J, double t, Eigen::MatrixXd& columns);

  /// d(x after a time h)/dp at a given x, for loops of piecewise affine elements: the difference between the exact
  /// flows of the neighbours, whose only errors are rounding and the square of the step.
  Eigen::MatrixXd over(const LoopField& field, const State& x, double h);

  /// Contribution of a switch to deviations by parameters.
  struct AtSwitch {
    Eigen::MatrixXd jump;      ///< d(state after)/dp, given the state before: a column each
    Eigen::RowVectorXd guard;  ///< d(guard)/dp, given the state
  };
  /// At the switch of guard `guard` from state x, at which `field`, in the modes before, was last evaluated; `after`
  /// are those after it. Nothing if a neighbour switches to another mode. Cost: a few rates each.
  std::optional<AtSwitch> at_switch(const LoopField& field, const State& x, double t, std::size_t guard,
                                    const SwitchSlopes& slopes, const std::vector<Mode>& after);

  /// Velocity of the element that rubs at x, where `field` was last evaluated, and its derivatives at fixed state;
  /// nothing if no element rubs.
  struct Rubbing {
    double velocity = 0.0;
    Eigen::RowVectorXd by_state;
    Eigen::RowVectorXd by_parameters;
  };
  std::optional<Rubbing> rubbing(const LoopField& field, const State& x, double t);

  /// That velocity alone; 1 if no element rubs.
  double rubbing_velocity(const LoopField& field) const { return rubbing_ ? field.input(*rubbing_).v : 1.0; }

  /// The loop above (below) in parameter k, as a field.
  LoopField& neighbour(Eigen::Index k, bool above) {
    auto& pair = pairs_[static_cast<std::size_t>(k)];
    return (above ? pair.high : pair.low)->field;
  }
  /// d(state at the end of a step)/d(state at its start) in that loop in these modes, by matrix exponentials if all
  /// elements are piecewise affine; the rates at the ends of the step become those of that loop. With `velocity` the
  /// end is first moved to where the rubbing velocity has this value, to the last bit, which determines the side of the
  /// kink.
  Eigen::MatrixXd transition_beside(Eigen::Index k, bool above, const std::vector<Mode>& modes, Step& step,
                                    std::optional<double> velocity);
  /// Curvature of the linear part between the neighbours of parameter k, as a share of its difference: about 1e-5 where
  /// it is smooth, up to 1 where its coordinates have a corner just here (the time scale in which a transfer function
  /// is realised is the largest of several). The differences are then of first order.
  double bend(Eigen::Index k) const;
  double step(Eigen::Index k) const { return pairs_[static_cast<std::size_t>(k)].step; }
  /// The step as a share of the parameter.
  double share(Eigen::Index k) const { return pairs_[static_cast<std::size_t>(k)].share; }

  /// d(output_origin)/dp + d(C_y)/dp x, the part of dy/dp that comes from the definition of y.
  Eigen::RowVectorXd output(const State& x) const;

 private:
  struct Side {
    explicit Side(const Loop& of) : loop(&of), field(of), flow(field) {}
    const Loop* loop;
    LoopField field;
    AffineFlow flow;
  };
  struct Pair {
    std::unique_ptr<Side> low, high;
    double step, share;
  };
  Eigen::VectorXd move(Side& side, const LoopField& field, const State& x, double t);
  Eigen::VectorXd meet(Side& side, double velocity, State& x, double t);
  double velocity(const LoopField& field) const { return rubbing_ ? field.input(*rubbing_).v : 0.0; }

  const Loop* loop_;
  bool affine_;
  std::optional<std::size_t> rubbing_;  ///< the element that rubs
  std::vector<Pair> pairs_;
  State moved_, rate_;
  std::vector<double> guards_;
};

}  // namespace limcycle
