#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Point reflection under which a loop of odd elements is invariant: x -> 2 centre - x, modes mirrored.
struct Reflection {
  Eigen::VectorXd centre;  ///< linear states; element states are reflected at 0

  LoopState of(const Loop& loop, const LoopState& state) const;
  /// Its derivative, a diagonal of -1 (+1 for states that a mirrored element shares, such as timers).
  static Eigen::VectorXd signs(const Loop& loop);
};

/// The reflection, if every element is odd and none is biased at the rest point of the linear part.
std::optional<Reflection> symmetry(const Loop& loop);

/// First return to a section, or with a reflection half of it: the flow to the mirrored section, reflected back.
/// With `derivative` it also carries small deviations along: variational equations in between, saltation at every
/// switch (see LoopField::fire), projection along the flow at the end. One object serves one thread; a map costs the
/// integration of one (half) period, about twice that with the derivative.
class ReturnMap {
 public:
  struct Options {
    double rtol = 1e-11;
    long max_steps = 200000;
    std::function<bool()> stop;
    bool derivative = false;
    double longest = infinite;  ///< s, time after which a motion that has not returned is abandoned
    int returns = 1;            ///< crossings of the section that make one map: several for a motion of unequal swings
    bool extremes = false;      ///< find the extremes of y on the way
    bool trace = false;         ///< record the motion
  };
  struct Result {
    Status status = Status::converged;
    LoopState state;    ///< on the section
    double time = 0.0;  ///< of the (half) period
    State largest;      ///< largest |state|, per component (linear states from the centre of the reflection, if any)
    double switch_distance = infinite;  ///< of the section from the nearest switch, share of `time`
    LocatedExtremes extremes;           ///< of y, if requested
    Trace trace;                        ///< if requested and there is one return: in the steps of the integration

    // Only with `derivative`, and only if every switch was crossed transversally (else empty):
    Eigen::MatrixXd derivative;        ///< d(state)/d(from), over all states; its image is tangent to the section
    Eigen::RowVectorXd time_gradient;  ///< d(time)/d(from)
    Eigen::RowVectorXd low_gradient, high_gradient;  ///< d(extremes)/d(from), if they were requested too (one return)
    std::vector<Eigen::MatrixXd> factors;            ///< step by step, the first acts first, before the projection
    /// Present if a switch leaves nothing of a deviation but a time shift (s, a row over the states at the start): a
    /// body that sticks, all of whose states but the position are then known. From there on the motion is the same one,
    /// earlier or later. That is exact, so the derivative is zero, and one factor stands for all.
    std::optional<Eigen::RowVectorXd> time_shift;
    double flow_defect = 0.0;  ///< relative error of the unprojected derivative in carrying the rate at the start to
                               ///< that at the end: the error of the trivial multiplier 1
  };

  ReturnMap(const Loop& loop, Section section, std::optional<Reflection> half, Options options);

  /// From a state on the section to the next one. Status max_iterations: it did not return within the step limit;
  /// no_cycle: roundings decide its time, since a body creeps to a stand on the way (Step::crept).
  Result operator()(const LoopState& from);
  /// From anywhere to the section.
  Result approach(const LoopState& from);

  /// Half the swing of y over the whole period, of a map with its extremes.
  double amplitude(const Result& result) const;
  /// d(amplitude)/d(from), of a map with its extremes and derivative (one return).
  Eigen::RowVectorXd amplitude_gradient(const Result& result) const;

  const Section& section() const { return section_; }
  bool half() const { return half_.has_value(); }
  const std::optional<Reflection>& reflection() const { return half_; }
  const Options& options() const { return options_; }
  long steps() const { return steps_; }
  void set_rtol(double rtol) { options_.rtol = rtol; }
  void set_derivative(bool derivative) { options_.derivative = derivative; }
  void set_extremes(bool extremes) { options_.extremes = extremes; }
  void set_trace(bool trace) { options_.trace = trace; }
  void set_longest(double longest) { options_.longest = longest; }

 private:
  bool rests(const Step& last) const;
  Result run(const LoopState& from, const Section& target);
  Result once(const LoopState& from);
  March& march();
  double middle(const Result& result) const;
  void carry(Result& result, March& march);
  void close_derivative(Result& result, const LoopState& from, const Section& target);
  Eigen::MatrixXd product(Result& result) const;
  Eigen::VectorXd sizes(const Result& result) const;

  const Loop* loop_;
  State typical_;
  ErrorWeights weights_;
  StepperKind kind_;
  std::unique_ptr<LoopField> field_;
  Eigen::MatrixXd carried_;     ///< product of the factors so far
  std::optional<March> march_;  ///< for the tolerance and the kind of the last map
  double march_rtol_ = 0.0;
  Section section_;
  std::optional<Reflection> half_;
  Options options_;
  long steps_ = 0;
};

}  // namespace limcycle
