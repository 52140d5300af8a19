#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "limcycle/analysis/orbit/settle/irregular.hpp"
#include "limcycle/analysis/study/continuation/margin.hpp"

namespace limcycle {

/// One side of one parameter of a loop whose cycles cannot be followed, as with a sampled controller: outwards from its
/// own value by a factor, with the same sign. Simulations at a few values find the first at which the loop no longer
/// does what it does at the own value, hunt or come to rest; bisection locates the change. Cost: some ten values, with
/// a simulation from each start.
class OutcomeSide {
 public:
  /// Displacements of y from which motions begin at each value, and the box that sets their scales.
  struct Starts {
    std::vector<double> displacements;
    SearchBox box;
  };

  OutcomeSide(const MarginParameter& parameter, bool up, const MarginOptions& options, Starts starts,
              std::function<void(double)> progress);

  /// `hunts`: what the loop does at the own value.
  MarginSide where_it_changes(bool hunts);

 private:
  enum class Does { hunts, ends, diverges, undecided, invalid };
  Does does(double p);
  /// Two values, and what the loop does at the second.
  struct Change {
    double as_now, changed;
    Does then;
  };
  void bisect(bool hunts, Change& change);
  std::optional<double> as_now_beyond(bool hunts, const Change& change, double far);
  MarginSide located(bool hunts, Change change);
  MarginSide to_validity(bool hunts, double last, double invalid);
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }

  const MarginParameter& parameter_;
  const MarginOptions& options_;
  Starts starts_;
  std::function<void(double)> progress_;
  double limit_;
  std::vector<IrregularMotion> known_;  ///< at other values: one of the same size and period needs no second tolerance
};

}  // namespace limcycle
