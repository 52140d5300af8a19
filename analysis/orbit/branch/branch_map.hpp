#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/orbit/cycle/section_chart.hpp"

namespace limcycle {

/// One loop for each value of a parameter; empty where the value is not valid.
using LoopFamily = std::function<std::optional<Loop>(double parameter)>;

/// The parameter p as a number s that runs from 0 to `length` over a range: linear in p, or in log p where the range
/// spans more than a factor of 3 with one sign. `length` weighs the range against the size of the orbit.
class ParameterScale {
 public:
  static constexpr double length = 6.0;
  /// Throws std::invalid_argument unless both ends are finite and differ.
  ParameterScale(double from, double to);
  double s(double p) const;
  double p(double s) const;
  double slope(double s) const;  ///< dp/ds

 private:
  double from_, to_;
  bool logarithmic_;
};

/// More steps than a map of any cycle needs.
inline constexpr long steps_a_map = 200000;

/// Equations of a branch of cycles: R(u, s) = P(u; s) - u = 0, with P the (half) return map of the loop at s in
/// coordinates u on a section that stays the same along a stretch of the branch. Costs one map each, dR/ds two. Data
/// prepared for the map of a loop are kept for the last few values of s.
class BranchMap {
 public:
  struct Frame {
    Section section;
    bool half = false;
    LoopState origin;  ///< a point of the section, u = 0, with the modes that hold around it
    SectionChart chart;
  };
  struct Value {
    Status status = Status::converged;
    bool valid = true;  ///< false: there is no loop at this s (then status is not_finite)
    Eigen::VectorXd r;
    double time = 0.0;  ///< of the (half) period
    LoopState start;
    ReturnMap::Result motion;  ///< from there to its image
    // Only if requested:
    double amplitude = 0.0;                          ///< of y
    Eigen::MatrixXd D;                               ///< dP/du
    Eigen::RowVectorXd time_slope, amplitude_slope;  ///< over u
  };

  /// Further results besides the image: none, derivatives and extremes, or trace and extremes.
  enum class With { nothing, derivatives, trace };

  BranchMap(LoopFamily family, ParameterScale scale, double rtol, std::function<bool()> stop)
      : family_(std::move(family)), scale_(scale), rtol_(rtol), stop_(std::move(stop)) {}

  /// Null if the case is not valid.
  std::shared_ptr<const Loop> loop(double s);
  const ParameterScale& scale() const { return scale_; }
  void set_frame(Frame frame);
  const Frame& frame() const { return frame_; }
  Eigen::Index dimension() const { return frame_.chart.basis.cols(); }
  double rtol() const { return rtol_; }
  void set_rtol(double rtol) { rtol_ = rtol; }
  long maps() const { return maps_; }
  /// Steps of all integrations: the cost of a map varies by a factor of a thousand.
  long steps() const { return steps_; }
  bool stopped() const { return stop_ && stop_(); }

  Value at(const Eigen::VectorXd& u, double s, With with, double rtol);
  /// dR/ds by central differences; one-sided if the other side is not valid, has no map or jumps (detected with `here`:
  /// R at (u, s)). Empty if neither side is usable.
  std::optional<Eigen::VectorXd> slope(const Eigen::VectorXd& u, double s, double step, const Eigen::VectorXd& here,
                                       double rtol);

 private:
  struct Prepared {
    double s = 0.0;
    std::shared_ptr<const Loop> loop;
    std::unique_ptr<ReturnMap> map;  ///< of the present frame; null where it does not fit
  };
  Prepared& prepared(double s);
  void differentiate(const ReturnMap& map, Value& value) const;

  LoopFamily family_;
  ParameterScale scale_;
  double rtol_;
  std::function<bool()> stop_;
  Frame frame_;
  std::vector<Prepared> recent_;
  double longest_return_ = infinite;  ///< s, a multiple of the last one
  long maps_ = 0, steps_ = 0;
};

}  // namespace limcycle
