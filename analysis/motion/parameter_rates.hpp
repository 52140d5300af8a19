#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/motion/affine_flow.hpp"
#include "limcycle/analysis/motion/loop_field.hpp"
#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// A loop whose parameter is a little less, and one whose parameter is a little more.
struct ParameterNeighbours {
  Loop low, high;
  /// Half of what the parameter differs by between them, in its unit. A relative 1e-6 serves best: of the equations,
  /// rounding then leaves 1e-10 of what they say, and what is left out is less. Where the parameter cannot be less,
  /// `low` may be the loop itself; nothing is lost if the equations are linear in it, else they are right to the first
  /// order.
  double step = 0.0;
  double value = 0.0;  ///< of the parameter; tells what share of it the step is (0: a millionth is taken for that)
};

/// How the equations of a loop change with its parameters, state and time standing still: of the rates, of the guards,
/// of what a switch resets. A case file cannot be differentiated, so these are differences between a loop and its
/// neighbours, of equations and never of a motion; relative error about 1e-10 (see ParameterNeighbours).
///
/// A law of friction has a kink where the rubbing velocity is zero, and a parameter may move that velocity (the speed
/// of a belt). So the neighbours are asked at states moved until it is the one of the loop, and the Jacobian tells what
/// the move did: no difference is taken over a kink.
class ParameterRates {
 public:
  /// The neighbours must stay where they are. Throws std::invalid_argument unless every step is finite and not zero and
  /// every neighbour has as many states, elements and modes as the loop.
  ParameterRates(const Loop& loop, std::span<const ParameterNeighbours> neighbours);

  Eigen::Index count() const { return std::ssize(pairs_); }

  /// d(dx/dt)/dp, a column each, in the modes of `field`, which was last asked at x and whose Jacobian there is J.
  /// Cost: two to four rates each.
  void rates(const LoopField& field, const State& x, const Eigen::MatrixXd& J, double t, Eigen::MatrixXd& columns);

  /// d(x after a time h)/dp at a given x, for loops of piecewise affine elements: the difference between the exact
  /// flows of the neighbours, which is free of error but for rounding and the square of the step.
  Eigen::MatrixXd over(const LoopField& field, const State& x, double h);

  /// What a switch adds to deviations by parameters.
  struct AtSwitch {
    Eigen::MatrixXd jump;      ///< d(state after)/dp, given the state before: a column each
    Eigen::RowVectorXd guard;  ///< d(guard)/dp, given the state
  };
  /// At the switch of guard `guard` from state x, at which `field`, in the modes before, was last asked; `after` are
  /// those after it. Nothing, if a neighbour switches to another mode. Cost: a few rates each.
  std::optional<AtSwitch> at_switch(const LoopField& field, const State& x, double t, std::size_t guard,
                                    const SwitchSlopes& slopes, const std::vector<Mode>& after);

  /// Velocity with which the element that rubs does so at x, where `field` was last asked, and its derivatives given
  /// the state; nothing if no element rubs.
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
  /// end is first moved to where what rubs has this velocity, to the last bit: it tells the side of the kink.
  Eigen::MatrixXd transition_beside(Eigen::Index k, bool above, const std::vector<Mode>& modes, Step& step,
                                    std::optional<double> velocity);
  /// By how much the linear part is bent between the neighbours of parameter k, as a share of how much it differs:
  /// about 1e-5 where it is smooth, up to 1 where its coordinates have a corner just here (the time scale in which a
  /// transfer function is realised is the largest of several). The differences are then of the first order.
  double bend(Eigen::Index k) const;
  double step(Eigen::Index k) const { return pairs_[static_cast<std::size_t>(k)].step; }
  /// The step as a share of the parameter.
  double share(Eigen::Index k) const { return pairs_[static_cast<std::size_t>(k)].share; }

  /// d(output_origin)/dp + d(C_y)/dp x, the part of dy/dp that comes of how y is read.
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
