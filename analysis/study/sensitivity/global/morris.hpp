#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "limcycle/analysis/study/sensitivity/global/estimate.hpp"

namespace limcycle {

/// Points of a model for elementary effects (M. D. Morris, Technometrics 33, 1991): trajectories from a random point of
/// a grid, on which every parameter is moved once, in random order. A row is a point in (0, 1)^d, of shares for
/// SpreadParameter::quantile.
///
/// A coordinate takes the middles of `levels` equal cells, (k + 1/2) / levels, so that an unbounded distribution has a
/// value there, and is moved by levels / 2 of them: by 1/2, up from the lower half and down from the upper one. So all
/// levels are equally likely before a move and after it (on Morris's own grid only with his step levels / (2 (levels -
/// 1))). A single row without an answer costs two effects, but never a whole trajectory.
///
/// Rows are numbered trajectory by trajectory, and a row does not depend on the number of trajectories.
class MorrisDesign {
 public:
  static constexpr double step = 0.5;

  /// Throws std::invalid_argument for no parameters, no trajectories, or levels that are not even or below 4.
  MorrisDesign(std::size_t parameters, std::size_t trajectories, std::size_t levels, std::uint64_t seed);

  std::size_t parameters() const { return parameters_; }
  std::size_t trajectories() const { return trajectories_; }
  std::size_t rows() const { return trajectories_ * (parameters_ + 1); }

  /// Point of row k. Throws std::out_of_range.
  std::vector<double> row(std::size_t k) const;

  /// Number of a trajectory's row before its first move (0) and after each (1 .. parameters).
  std::size_t row_of(std::size_t trajectory, std::size_t moves) const { return trajectory * (parameters_ + 1) + moves; }
  /// The parameter changed by the move after row_of(trajectory, move), and true if upwards.
  std::size_t moved(std::size_t trajectory, std::size_t move) const;
  bool upwards(std::size_t trajectory, std::size_t parameter) const;

 private:
  std::size_t parameters_, trajectories_, levels_;
  std::vector<std::size_t> start_, order_;  ///< levels, and parameters in the order of their moves, by trajectory
};

/// Elementary effects of a parameter: change of the output per change of the share of the distribution, that is, in
/// units of the output for the whole of the parameter's range (all quantiles from 0 to 1).
struct MorrisEffects {
  Estimate mu;       ///< their mean: effects of opposite sign cancel
  Estimate mu_star;  ///< mean of their magnitudes (F. Campolongo et al., 2007): importance of the parameter
  Estimate sigma;    ///< their standard deviation: it acts nonlinearly, or together with others
  std::size_t effects = 0, without_answer = 0;  ///< out of the number of trajectories

  double share_without_answer() const;
};

/// Elementary effects of every parameter on one output.
struct MorrisResult {
  std::size_t rows = 0, rows_without_answer = 0;
  std::vector<MorrisEffects> parameters;  ///< in the order of the design
  std::vector<std::string> notes;         ///< limitations, for the reader

  double share_without_answer() const;
  /// Numbers of the parameters, largest mu_star first; those with an unknown one come last.
  std::vector<std::size_t> by_mu_star() const;
};

/// Effects from the answers in the rows of a design, with 95 % intervals by bootstrap over the trajectories
/// (`resamples` of them, from `seed`). An effect without an answer at either end is omitted and counted. One effect has
/// no sigma, fewer than 8 have no intervals; without any effect everything is unknown. If answers are missing in a part
/// of the space, effects are those within the rest of it. Throws std::invalid_argument if answers and rows differ in
/// number.
MorrisResult morris_effects(const MorrisDesign& design, RowAnswers answers, std::size_t resamples = 1000,
                            std::uint64_t seed = 0);

}  // namespace limcycle
