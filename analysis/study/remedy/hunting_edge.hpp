#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/study/remedy/hunts.hpp"
#include "limcycle/analysis/study/remedy/remedy.hpp"

namespace limcycle {

/// What is known of a loop before its remedies are sought.
struct HuntingLoop {
  Judging judging;
  std::vector<Cycle> cycles;        ///< as the loop stands
  std::vector<std::string> states;  ///< their names
  HuntingSizes sizes;
  bool followable = false;    ///< its cycles can be followed over a number: see in_exact_time()
  bool box_is_given = false;  ///< by the case
};

/// Two values between which hunting ends.
struct Bracket {
  double rests = 0.0, hunts = 0.0;
  bool diverges = false;                 ///< beyond it the motion diverges: it does not hunt
  bool has_gap = false;                  ///< `predict` does not decide all values between them
  std::optional<MotionState> hunting{};  ///< on the last hunting motion before it
};

/// Judges values of a remedy's number, and confirms the edges between those at which the loop hunts and those at which
/// it rests.
class HuntingEdge {
 public:
  HuntingEdge(const RemedyCandidate& candidate, const HuntingLoop& loop) : candidate_(candidate), loop_(loop) {}

  std::optional<Loop> loop_at(double value) const;
  bool stopped() const { return loop_.judging.predict.stop && loop_.judging.predict.stop(); }

  /// By predict() from the starts of the loop as it stands and of the changed one, and from the last hunting motion, or
  /// for a quick answer from that motion and two starts alone. For rest: where one start is not decided, the others do
  /// not matter.
  enum class Care { quick, full, for_rest };
  Hunts judged(double value, Care care = Care::full);

  /// Both sides judged with full care, few-digit numbers at most 1.5e-3 apart, or up to 1e-2 where values between them
  /// are not decided; it rests at two values beyond as well. False if that cannot be had.
  bool confirm(Bracket& bracket);

  /// For an edge that is not confirmed, as motions are too slow or too small near it: two values farther apart, the
  /// nearest of some on either side that are judged with full care to hunt and, with the next one beyond, to rest.
  std::optional<Bracket> well_apart(const Bracket& bracket);

  std::optional<MotionState> hunting = {};  ///< on the last hunting motion that was met
  Trace run = {};  ///< from the largest displacement, of the last judgement with full care without hunting

 private:
  Hunts from_last_hunting(const Loop& loop, const SearchBox& box);
  Hunts from_own_starts(const Loop& loop);
  bool widen(Bracket& bracket);
  bool narrow(Bracket& bracket);
  bool look_beyond(Bracket& bracket);

  const RemedyCandidate& candidate_;
  const HuntingLoop& loop_;
  std::optional<double> undecided_ = {};  ///< the last value between the sides of which that is known
};

inline constexpr double narrow_enough = 1e-3;  ///< relative distance of the two sides of an edge
inline constexpr double wide_enough = 1e-2;    ///< of one between whose sides values are not decided
inline constexpr int edge_digits = 4;          ///< of the values that are tried at an edge

}  // namespace limcycle
