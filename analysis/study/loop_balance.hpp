#pragma once
#include <complex>
#include <optional>
#include <string>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/root_search.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// First-harmonic balance of a loop: the describing function of its main element (the friction if there is one, else
/// the forward element) against everything else. One more memoryless element (a saturated command) is eliminated by its
/// own describing function at the amplitude that the main one causes.
class LoopBalance {
 public:
  /// Why the plain describing function does not apply to this loop, or nothing.
  static std::optional<std::string> not_applicable(const Loop& loop);

  explicit LoopBalance(const Loop& loop);

  /// 1 + N(A,w) G(jw); NaN where N does not exist (no half-wave symmetric steady state in a symmetric loop).
  std::complex<double> operator()(double amplitude, double frequency, double accuracy) const;
  /// N(A,w) of the main element.
  std::complex<double> gain(double amplitude, double frequency, double accuracy) const;
  /// Amplitude of y's first harmonic when the main element's input has this amplitude.
  double output_amplitude(double amplitude, double frequency) const;
  /// Loeb's rule with the other closed-loop roots: `index` is the sign from the root search.
  std::optional<bool> stable(double amplitude, double frequency, int index) const;
  /// State of the loop on the predicted oscillation, the oscillating part times `scale`, elements without history.
  LoopState state(double amplitude, double frequency, double scale = 1.0) const;

  std::size_t main_element() const { return main_; }
  bool depends_on_frequency() const;
  /// Mean rubbing velocity (belt, ramp); 0 if the main element is not a friction law.
  double mean_velocity() const;

 private:
  struct Others {
    std::complex<double> from_main;  ///< phasor of the other element's output per unit output of the main one
    double input_amplitude = 0.0;
  };
  std::optional<Others> others(double main_output, double frequency, double accuracy) const;
  double bias(double amplitude, double frequency, double accuracy) const;
  Eigen::VectorXcd outputs(double amplitude, double frequency) const;

  const Loop* loop_;
  std::size_t main_ = 0;
  bool symmetric_ = false;
  double mean_velocity_ = 0.0;
};

}  // namespace limcycle
