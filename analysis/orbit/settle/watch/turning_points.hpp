#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace limcycle {

/// Turning points of a signal, found as its samples arrive: a reversal counts once the signal has returned by `share`
/// of the last swing, so that the bristle's tremble at each stop is not taken for an oscillation. When no reversal has
/// counted for twice as long as ever before, each uncounted one lowers that share, so that a small oscillation after a
/// large first swing is found in the end. A body that begins with a fast swing and then sticks for long on a bristle
/// that rings turns at every ring then, unless `only_large` swings count: those whose share is never lowered.
class TurningPoints {
 public:
  explicit TurningPoints(bool only_large = false) : only_large_(only_large) {}

  struct Point {
    double t, y;
  };

  /// True if this sample confirms a new turning point.
  bool feed(double t, double y) {
    if (!started_) {
      started_ = true;
      extreme_ = {t, y};
      return false;
    }
    if (direction_ == 0) return find_direction(t, y);
    const bool reversed = (y - last_) * trend_ < 0.0;
    if (y != last_) trend_ = y > last_ ? 1 : -1;
    last_ = y;
    const double last_swing = points_.empty() ? 0.0 : std::abs(extreme_.y - points_.back().y);
    if (direction_ * (y - extreme_.y) >= 0.0) {
      // Peaks that are alike but for roundings, as those of a small oscillation, do not begin the wait anew.
      if (direction_ * (y - advanced_.y) > alike * last_swing) advanced_ = {t, y};
      extreme_ = {t, y};
      return false;
    }
    if (reversed && !only_large_ && t - advanced_.t > 2.0 * longest_) part_ *= 0.8;
    if (std::abs(y - extreme_.y) <= part_ * last_swing) return false;
    if (!points_.empty()) longest_ = std::max(longest_, extreme_.t - points_.back().t);
    points_.push_back(extreme_);
    direction_ = -direction_;
    extreme_ = advanced_ = {t, y};
    part_ = share;
    return true;
  }

  const std::vector<Point>& points() const { return points_; }
  /// Swing k from the end (0: the last complete one); needs points().size() > k + 1.
  double swing(std::size_t k) const {
    const std::size_t i = points_.size() - 1 - k;
    return std::abs(points_[i].y - points_[i - 1].y);
  }

  static constexpr double share = 0.03;

 private:
  bool find_direction(double t, double y) {
    if (y == extreme_.y) return false;
    direction_ = y > extreme_.y ? 1 : -1;
    points_.push_back(extreme_);
    extreme_ = advanced_ = {t, y};
    return true;
  }

  static constexpr double alike = 1e-9;  ///< of the last swing

  std::vector<Point> points_;
  Point extreme_{};
  Point advanced_{};  ///< the last that went clearly beyond the one before
  double last_ = 0.0, part_ = share, longest_ = 0.0;
  int trend_ = 0;
  int direction_ = 0;
  bool started_ = false, only_large_;
};

}  // namespace limcycle
