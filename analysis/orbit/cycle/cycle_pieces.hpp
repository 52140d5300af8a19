#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/field/parameter_rates.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// A moment bound to the motion, a zero of some quantity, with its derivatives by the state there and by parameters.
struct BoundMoment {
  Eigen::RowVectorXd by_state, by_parameters;  ///< s per unit
};

/// A part of a cycle over which the field is smooth, and the event at its end.
struct CyclePiece {
  Step step;
  std::vector<Mode> modes;         ///< during the piece
  Eigen::MatrixXd factor;          ///< d(state at the end)/d(state at the start), at fixed times
  Eigen::MatrixXd columns;         ///< d(state at the end)/d(parameters), given the start
  std::optional<BoundMoment> end;  ///< if the piece ends with a switch, or where the rubbing velocity is zero
  std::optional<double> reversal;  ///< the rubbing velocity there: almost zero, with the sign that it had before
  struct Switch {
    std::size_t guard = 0;
    Eigen::MatrixXd saltation, jump;  ///< its factor for deviations, and its contribution by parameters
  };
  std::optional<Switch> event;
  /// y at a node of a quadrature over the piece, and its deviation given that of the start of the piece.
  struct Reading {
    double t, weight, y;
    Eigen::RowVectorXd by_start, by_parameters;
  };
  std::vector<Reading> readings;  ///< if requested by CutOptions
};

/// The reflection x -> c + S (x - c) under which a cycle is half-wave symmetric, S diagonal.
struct CycleMirror {
  Eigen::VectorXd signs;   ///< S
  Eigen::VectorXd centre;  ///< c
  Eigen::MatrixXd moved;   ///< dc/dp, a column for each parameter
};

/// One period of a cycle in pieces, or half of one.
struct CyclePieces {
  Status status = Status::converged;
  std::vector<CyclePiece> pieces;
  std::optional<CycleMirror> mirror;  ///< half a period was covered: reflecting its end gives the start
  LoopState last;                     ///< after the period, or reflected after half of it
  Eigen::VectorXd sizes;              ///< largest |state| in the motion, at least 1e-6 of the typical one
};

/// Options for cutting a cycle into pieces.
struct CutOptions {
  double rtol = 1e-10;
  long max_steps = 200000;
  std::function<bool()> stop;
  bool read_output = false;
  std::optional<State> typical = {};  ///< sizes of the states, if not those of the linear part
};

/// Marches from `start` for the time `period` and carries small deviations along: variational equations along every
/// step (with a column for each parameter), saltation at every switch. A step is cut in two where y turns, so that
/// extremes lie at the ends of pieces, and where the rubbing velocity goes through zero, where a law may have a kink:
/// there the field has a derivative on either side, and each piece has its own. Status stalled: a switch is grazed, or
/// a neighbour switches to another mode; max_iterations: the step limit is reached.
CyclePieces cut_cycle(const Loop& loop, const LoopState& start, double period, ParameterRates& rates,
                      const CutOptions& options);

}  // namespace limcycle
