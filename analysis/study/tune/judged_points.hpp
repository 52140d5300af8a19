#pragma once
#include <vector>

#include "limcycle/analysis/study/tune/tune_judge.hpp"
#include "limcycle/analysis/study/tune/tune_space.hpp"

namespace limcycle {

/// The points whose outcome is known, by their places.
class JudgedPoints {
 public:
  explicit JudgedPoints(const TuneSpace& space) : space_(space) {}

  /// Keeps a point unless it is not_judged.
  void add(const TunePoint& point);
  /// True if the nearest one is feasible, or there is none.
  bool suggest_feasible(std::span<const double> values) const;
  /// True if a point within this distance is not feasible.
  bool refuted_within(double distance, std::span<const double> values) const;
  /// The hunting motions that are nearest, at most three.
  std::vector<MotionState> hunting_near(std::span<const double> values) const;

 private:
  struct Judged {
    std::vector<double> place;
    bool feasible;
    std::optional<MotionState> hunting;
  };
  const TuneSpace& space_;
  std::vector<Judged> points_;
};

}  // namespace limcycle
