#pragma once
#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/motion/lane_march/lane_loop.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/simulate/ensemble.hpp"

namespace limcycle {

/// Members of one shape, in order, with the number already handed out.
struct EnsembleGroup {
  std::optional<LaneShape> shape;  ///< empty: to be marched one by one
  std::vector<std::size_t> members;
  std::size_t next = 0;
};

/// Data shared by all threads.
class EnsembleWork {
 public:
  EnsembleWork(std::span<const EnsembleMember> members, const EnsembleOptions& options)
      : members_(members), options_(options), results_(members.size()) {
    std::map<std::optional<LaneShape>, std::size_t> found;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto shape = lane_shape(*members[i].loop);
      const auto [at, fresh] = found.try_emplace(shape, groups_.size());
      if (fresh) groups_.push_back({shape, {}, 0});
      groups_[at->second].members.push_back(i);
    }
    // Members that are marched one by one take longest: the lanes fill the remaining time.
    std::stable_partition(groups_.begin(), groups_.end(), [](const EnsembleGroup& group) { return !group.shape; });
  }

  const EnsembleMember& member(std::size_t i) const { return members_[i]; }
  const EnsembleOptions& options() const { return options_; }
  const MotionBounds& bounds(std::size_t i) const { return members_[i].own ? *members_[i].own : options_; }
  std::vector<EnsembleGroup>& groups() { return groups_; }
  std::vector<EnsembleResult>& results() { return results_; }

  std::optional<std::size_t> take(EnsembleGroup& group) {
    const std::lock_guard lock(guard_);
    if (stopped_ || group.next == group.members.size()) return std::nullopt;
    return group.members[group.next++];
  }
  bool stopped() {
    const std::lock_guard lock(guard_);
    return stopped_ = stopped_ || (options_.stop && options_.stop());
  }
  void count(long useful, long tried) {
    const std::lock_guard lock(guard_);
    useful_ += useful;
    tried_ += tried;
  }
  double occupancy() const { return tried_ > 0 ? static_cast<double>(useful_) / static_cast<double>(tried_) : 1.0; }

  /// Stops handing out members.
  void end() {
    const std::lock_guard lock(guard_);
    stopped_ = true;
  }

 private:
  std::span<const EnsembleMember> members_;
  const EnsembleOptions& options_;
  std::vector<EnsembleGroup> groups_;
  std::vector<EnsembleResult> results_;
  std::mutex guard_;
  bool stopped_ = false;
  long useful_ = 0, tried_ = 0;
};

inline OutcomeWatch watch_for(const Loop& loop, const MotionBounds& bounds, double accuracy) {
  return {loop, {bounds.rtol, bounds.amplitude_floor, accuracy}, typical_sizes(loop), slow_time(loop)};
}

inline void conclude(EnsembleResult& result, const OutcomeWatch& watch, Status status) {
  result.outcome = watch.outcome();
  result.status = status;
  if (result.outcome != Outcome::cycle) return;
  result.period = watch.period();
  result.amplitude = watch.amplitude();
}

/// Passes a case that the watch leaves open to settle(), which uses shooting: a motion that repeated itself from the
/// start (a cycle or one of a family), a motion that never repeats, and switching without end. Only for runs of
/// unlimited duration.
inline void ask_settle(EnsembleResult& result, const EnsembleMember& member, const MotionBounds& bounds, long max_steps,
                       const std::function<bool()>& stop) {
  SettleOptions settling;
  settling.rtol = bounds.rtol;
  settling.amplitude_floor = bounds.amplitude_floor;
  settling.amplitude_ceiling = bounds.amplitude_ceiling;
  settling.max_steps = max_steps;
  settling.shooting.rtol = 0.1 * bounds.rtol;
  settling.shooting.tolerance = 0.1 * bounds.rtol;
  settling.shooting.derivative_rtol = bounds.rtol;
  settling.stop = settling.shooting.stop = stop;
  const Settled settled = settle(*member.loop, member.start, settling);
  if (settled.outcome == Outcome::undecided) return;
  result.outcome = settled.outcome;
  result.status = Status::converged;
  result.period = result.amplitude = 0.0;
  if (!settled.shot) return;
  result.period = settled.shot->cycle.period;
  result.amplitude = settled.shot->cycle.amplitude;
}

/// True if the case must be passed to settle().
inline bool leaves_open(const EnsembleResult& result, const OutcomeWatch& watch, const EnsembleOptions& options) {
  if (!options.until_decided || options.duration < infinite) return false;
  const bool ended = result.status == Status::max_iterations || result.status == Status::chattering;
  return (ended && result.outcome == Outcome::undecided) || (result.status == Status::converged && watch.doubtful());
}

/// Status of a member that reached the end of the duration.
inline Status at_end(const OutcomeWatch& watch, const EnsembleOptions& options) {
  return watch.decided() || !options.until_decided ? Status::converged : Status::incomplete;
}

}  // namespace limcycle
