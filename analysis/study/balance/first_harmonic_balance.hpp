#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/analysis/study/balance/amplitude_branches.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// First-harmonic balance of a loop: the describing function of its main element (the friction if there is one, else
/// the forward element) against everything else. Elements that have the same input up to a factor (a friction
/// compensation; a dead zone on the error of a rigid servo; gravity on a pendulum) act in parallel to it. One more
/// memoryless element (a saturated command, an element on the error) is eliminated by its own describing function at
/// the amplitude that they cause. Several amplitudes may be solutions (see AmplitudeBranches): results for an amplitude
/// of the main element and a frequency then refer to the one that comes nearest to satisfying the loop condition.
class FirstHarmonicBalance {
 public:
  /// Reason why the plain describing function does not apply to this loop, or nothing.
  static std::optional<std::string> not_applicable(const Loop& loop);

  explicit FirstHarmonicBalance(const Loop& loop);

  /// 1 + N(A,w) G(jw); NaN where N does not exist (no half-wave symmetric steady state in a symmetric loop).
  std::complex<double> operator()(double amplitude, double frequency, double accuracy) const;

  /// True if the amplitude of a second element is eliminated.
  bool has_second() const { return second_.has_value(); }
  /// The same on one branch of the second element's amplitude, 0..AmplitudeBranches::most - 1; NaN if it has none.
  std::complex<double> on_branch(int branch, double amplitude, double frequency, double accuracy) const;
  /// A point of the loop condition, given the amplitude of the second element.
  struct FromSecond {
    std::complex<double> left;  ///< 1 - the returning input of the second element, over that input; NaN: no such motion
    double amplitude;           ///< of the main element's input
  };
  /// The loop condition with the roles exchanged: the second element's input has this amplitude, that of the main
  /// element follows, on one of its branches. Each form finds roots in a wide region that for the other is a narrow
  /// wedge.
  FromSecond from_second(int branch, double amplitude, double frequency, double accuracy) const;
  /// Amplitudes of the second element's input between which its nonlinearity matters.
  std::pair<double, double> second_range() const;
  /// Computes together the values that operator() needs at these points with this accuracy, until `stop` (called from
  /// time to time) returns true. From one thread at a time.
  void prepare(const std::vector<SearchPoint>& points, double accuracy, const std::function<bool()>& stop = {}) const;
  /// N(A,w) of the main element.
  std::complex<double> gain(double amplitude, double frequency, double accuracy) const;
  /// Amplitude of y's first harmonic when the main element's input has this amplitude.
  double output_amplitude(double amplitude, double frequency) const;
  /// Loeb's rule with the other closed-loop roots: `index` is the sign from the root search.
  std::optional<bool> stable(double amplitude, double frequency, int index) const;
  /// State of the loop on the predicted oscillation, the oscillating part times `scale`, elements without history.
  LoopState state(double amplitude, double frequency, double scale = 1.0) const;
  /// Linear states of the loop on the predicted oscillation at a phase of the main element's input (0: rising zero).
  Eigen::VectorXd linear_state(double amplitude, double frequency, double phase, double scale = 1.0) const;

  /// Evaluations of the main element's equations so far, the cost of a search. Shared by copies.
  long evaluations() const;
  std::size_t main_element() const { return main_; }
  bool depends_on_frequency() const;
  /// Response from the main element's output to its own input at `order` times the frequency of the oscillation, the
  /// other element acting as its describing function at that oscillation; order 1 solves 1 - N response = 0.
  std::complex<double> response(double amplitude, double frequency, int order) const;
  /// Mean of the main element's input (friction: mean rubbing velocity) during the oscillation.
  double bias(double amplitude, double frequency, double accuracy) const;
  /// Means of all elements' inputs on the oscillation, if gravity is part of their static balance; 0 in a symmetric
  /// loop. NaN if there is no such balance.
  Eigen::VectorXd mean_inputs(double amplitude, double frequency, double accuracy) const;
  /// Mean rubbing velocity (belt, ramp); 0 if the main element is not a friction law.
  double mean_velocity() const;

 private:
  /// An element whose input is `factor` times the main element's.
  struct Beside {
    std::size_t index;
    double factor;
  };
  struct Sorted {
    std::vector<Beside> beside;
    std::vector<std::size_t> others;
  };
  static Sorted sort(const Loop& loop);
  /// Data of the second element.
  struct Second {
    explicit Second(const Element& element) : reach(element) {}
    ElementReach reach;
    std::shared_ptr<AmplitudeBranches> own = std::make_shared<AmplitudeBranches>();   ///< of its own amplitude
    std::shared_ptr<AmplitudeBranches> main = std::make_shared<AmplitudeBranches>();  ///< of the main element's
  };
  struct Oscillation {
    int branch;
    Eigen::VectorXcd outputs;   ///< phasors, sine reference
    std::complex<double> left;  ///< 1 + N G
  };
  std::complex<double> other_gain(double input_amplitude, double frequency, double accuracy) const;
  std::pair<double, double> main_range(double back) const;
  std::vector<Oscillation> oscillations(double amplitude, double frequency, double accuracy) const;
  std::optional<bool> pair_returns(double amplitude, double frequency) const;
  Oscillation oscillation(double amplitude, double frequency, double accuracy) const;
  std::complex<double> beside_gain(const Beside& beside, double amplitude, double frequency, double mean,
                                   double accuracy) const;
  bool has_gravity() const;
  const Loop& mean_loop() const { return passing_ ? *passing_ : *loop_; }
  Eigen::VectorXd mean_state(double amplitude, double frequency, double accuracy, bool& exact) const;
  Eigen::VectorXcd own_outputs(double amplitude, double frequency, double accuracy) const;
  Eigen::VectorXcd outputs(double amplitude, double frequency, double accuracy) const;

  class MainGain;

  const Loop* loop_;
  std::size_t main_ = 0;
  std::shared_ptr<MainGain> main_gain_;
  std::vector<Beside> beside_;        ///< without the main element itself
  std::optional<std::size_t> other_;  ///< the one that is eliminated
  std::optional<Second> second_;      ///< the same one
  /// Of a biased loop with a second element: the loop closed through that element's gain in its working range (a
  /// saturated command passes the mean that holds a load).
  std::optional<Loop> passing_;
  bool symmetric_ = false;
  double mean_velocity_ = 0.0;
};

}  // namespace limcycle
