#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/analysis/study/remedy/hunting_edge.hpp"

namespace limcycle {

/// The search for the value of one remedy. The stable cycles of the loop are followed over its number until they end
/// (see OneSidedMargin); where they cannot be followed, values at three a decade are judged, the nearest first, and the
/// first change is bisected. Either way predict() then judges both sides of the edge.
class RemedySearch {
 public:
  RemedySearch(const RemedyCandidate& candidate, const HuntingLoop& loop, std::function<void(double)> progress);

  /// `ends`, `value`, `edges`, `beyond`, `why` and `after` of the remedy; its costs are left empty.
  Remedy run();

  /// Adds the edge beyond a value at which the loop does not hunt, on the outer side, to a remedy.
  void locate_far_edge(Remedy& remedy, const Bracket& near);

 private:
  MarginParameter parameter_from(double value) const;
  std::optional<Bracket> followed(bool up);
  std::optional<Bracket> followed_from(double value, const std::vector<Cycle>& cycles, bool up);
  std::optional<Bracket> followed_from_nothing(bool up);
  enum class Until { rests, hunts };
  std::optional<Bracket> scanned(bool up, double from, Until until);
  std::vector<Bracket> edges();
  Remedy without_edge(const Bracket& edge);
  Remedy at_edge(Bracket edge);
  std::optional<double> end_of_range(const Bracket& edge) const;
  Bracket around(const MarginSide& side, bool up, bool rests_beyond);
  Remedy nothing_found() const;
  std::string number(double value, int shown = 3) const;

  const RemedyCandidate& candidate_;
  const HuntingLoop& loop_;
  const double size_;
  const std::function<void(double)> progress_;
  HuntingEdge edge_;
  std::vector<std::string> seen_ = {};  ///< what became of the sides without an edge, clauses
  bool open_ = false;                   ///< something was not decided
};

}  // namespace limcycle
