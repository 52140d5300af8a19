#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/settle/to_cycle/closed_motion.hpp"

namespace limcycle {

/// What is known of a motion from the cycle that it comes to.
struct CycleFound {
  Outcome outcome = Outcome::cycle;  ///< or a family, or undecided
  std::string why;                   ///< one sentence
  std::optional<std::size_t> known;  ///< index in SettleOptions::known, or else
  std::optional<ShootingResult> shot;
};

/// Shooting from one motion, again and again as it goes on.
class CycleTries {
 public:
  /// Both must outlive this.
  CycleTries(const Loop& loop, const SettleOptions& options) : loop_(loop), options_(options) {}

  /// Decides for a stable cycle of the swing of the motion, or for one that the motion approaches from one try to the
  /// next; a motion that leaves an unstable cycle no slower than before, or, of a sampled loop, swings as one in which
  /// no period was found, is not shot at.
  std::optional<CycleFound> look_from(const NearlyClosed& motion);

  /// Unstable cycles near which the motion was.
  const std::vector<Cycle>& passed() const { return passed_; }
  /// Steps of all return maps.
  long steps() const { return steps_; }

 private:
  bool swings_like_known(const NearlyClosed& motion) const;
  std::string converges_to(std::size_t known) const;
  bool leaves_known(const NearlyClosed& motion);
  bool lies_beside(const ShootingResult& symmetric, double change);
  ClosedMotion shoot_at(NearlyClosed motion);
  std::optional<CycleFound> judge(const NearlyClosed& motion, ClosedMotion closed);
  std::optional<CycleFound> look_around(ClosedMotion& closed);
  void pass(const Cycle& cycle);

  const Loop& loop_;
  const SettleOptions& options_;
  std::vector<Cycle> passed_;
  std::optional<Cycle> candidate_;  ///< stable, but far from the motion
  double mismatch_ = 0.0;           ///< of the motion with it
  double last_change_ = 0.0;        ///< of a period, at the last try
  double unstable_swing_ = 0.0;     ///< of the last unstable cycle that a shot found
  double beside_ = 0.0;             ///< change of a period when a symmetric cycle was last found far beside the motion
  long steps_ = 0;
};

}  // namespace limcycle
