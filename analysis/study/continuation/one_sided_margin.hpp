#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"

namespace limcycle {

/// One side of one parameter: outwards from its own value by a factor, with the same sign.
class OneSidedMargin {
 public:
  OneSidedMargin(const MarginParameter& parameter, bool up, const MarginOptions& options,
                 std::function<void(double)> progress);

  /// For a loop with these cycles, at least one of them stable.
  MarginSide where_hunting_ends(const std::vector<Cycle>& cycles);
  /// For a loop without a stable cycle.
  MarginSide where_hunting_begins();

 private:
  struct Lost {
    double value, error;
    std::string why;
    enum class Kind { lost, border, failed } kind;
    LoopState last;  ///< on the last stable cycle before it
    std::optional<BranchEvent::Type> event = {};
    std::optional<Cycle> cycle = {};  ///< there
  };
  /// Follows a stable cycle from p towards `limit` until it is lost.
  Lost follow(const Cycle& cycle, double p, double limit);
  static MarginSide found(MarginSide::What what, const Lost& lost, std::string why);
  /// Result of simulations at p from these states, and from rest displaced.
  struct Reached {
    std::optional<Cycle> cycle;  ///< the first stable one
    /// Without a cycle: that of the first start. Undecided if one of them was, or continues for ever in another way.
    Outcome outcome = Outcome::undecided;
    bool irregular = false;  ///< one of them moves for ever without a period
  };
  Reached reached_at(double p, const std::vector<LoopState>& from);
  /// The side of a lost cycle: simulated outwards until a decision.
  MarginSide beyond(const Lost& lost, std::optional<Cycle>& other, double& at);
  /// From the point where a cycle that was followed back is lost, towards the own value: another stable cycle and its
  /// place; without one, `decided` is true if simulations decided that.
  std::optional<Cycle> before(const Lost& lost, double& at, bool& decided);
  /// Follows a cycle found at p, and its successors, back to the beginning of hunting.
  MarginSide back_from(Cycle cycle, double p);
  Outcome outcome_from(const LoopState& state, double p) const;
  bool stays(const LoopState& state) const;
  MarginSide at_validity(const Lost& lost) const;
  MarginSide with_error(MarginSide side, double ended, const std::vector<LoopState>& from);
  MarginSide by_bisection(MarginSide::What what, double hunts, double rests, const std::vector<LoopState>& from);
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }

  const MarginParameter& parameter_;
  const MarginOptions& options_;
  std::function<void(double)> progress_;
  double limit_;
  std::vector<LoopState> starts_;  ///< on the stable cycles at the own value
};

}  // namespace limcycle
