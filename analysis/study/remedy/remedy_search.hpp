#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/analysis/study/remedy/hunts.hpp"
#include "limcycle/analysis/study/remedy/remedy.hpp"

namespace limcycle {

/// Sizes of the motion of a loop that hunts.
struct HuntingSizes {
  double displacement = 1.0;  ///< of y
  double frequency = 1.0;     ///< rad/s
  double force = 1.0;         ///< N, of the friction

  double of(Measure measure) const;
};

/// What is known of a loop before its remedies are sought.
struct HuntingLoop {
  Judging judging;
  std::vector<Cycle> cycles;  ///< as the loop stands
  HuntingSizes sizes;
  bool followable = false;  ///< its cycles can be followed over a number: see in_exact_time()
};

/// The search for the value of one remedy. The stable cycles of the loop are followed over its number until they end
/// (see SideSearch); where they cannot be followed, values at three a decade are judged, the nearest first, and the
/// first change is bisected. Either way predict() then judges both sides of the edge.
class RemedySearch {
 public:
  RemedySearch(const RemedyCandidate& candidate, const HuntingLoop& loop, std::function<void(double)> progress);

  /// `ends`, `value`, `edges`, `beyond`, `why` and `after` of the remedy; its costs are left empty.
  Remedy run();

 private:
  /// Two values between which hunting ends.
  struct Bracket {
    double rests = 0.0, hunts = 0.0;
    bool diverges = false;               ///< beyond it the motion diverges: it does not hunt
    std::optional<LoopState> hunting{};  ///< on the last hunting motion before it
  };
  std::optional<Loop> loop_at(double value) const;
  /// By predict() and from the last hunting motion, or for a quick answer from that motion and two starts alone.
  enum class Care { quick, full };
  Hunts judged(double value, Care care = Care::full);
  Hunts from_last_hunting(const Loop& loop, const SearchBox& box);
  bool stopped() const { return loop_.judging.predict.stop && loop_.judging.predict.stop(); }

  MarginParameter parameter_from(double value) const;
  std::optional<Bracket> followed(bool up);
  std::optional<Bracket> followed_from(double value, const std::vector<Cycle>& cycles, bool up);
  std::optional<Bracket> followed_from_nothing();
  enum class Until { rests, hunts };
  std::optional<Bracket> scanned(bool up, double from, Until until);
  std::optional<Bracket> nearest();
  bool widen(Bracket& bracket);
  bool confirm(Bracket& bracket);
  bool narrow(Bracket& bracket);
  bool look_beyond(Bracket& bracket);
  void locate_far_edge(Remedy& remedy, const Bracket& near);
  Remedy nothing_found() const;
  std::string number(double value, int shown = 3) const;

  const RemedyCandidate& candidate_;
  const HuntingLoop& loop_;
  const double size_;
  const std::function<void(double)> progress_;
  std::vector<std::string> seen_;     ///< what became of the sides without an edge, clauses
  bool open_ = false;                 ///< something was not decided
  std::optional<LoopState> hunting_;  ///< on the last hunting motion that was met
  Trace run_;                         ///< from the largest displacement, of the last full judgement without hunting
};

}  // namespace limcycle
