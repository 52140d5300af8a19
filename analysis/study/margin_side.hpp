#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/margin.hpp"

namespace limcycle {

/// One side of one parameter: outwards from its own value by a factor, the sign kept.
class SideSearch {
 public:
  SideSearch(const MarginParameter& parameter, bool up, const MarginOptions& options,
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
  /// A stable cycle at p, reached from a state or from rest displaced; `outcome`: what was reached.
  std::optional<Cycle> cycle_at(double p, const LoopState* from, Outcome& outcome);
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }

  const MarginParameter& parameter_;
  const MarginOptions& options_;
  std::function<void(double)> progress_;
  double limit_;
};

}  // namespace limcycle
