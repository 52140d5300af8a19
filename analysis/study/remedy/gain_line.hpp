#pragma once
#include <complex>
#include <functional>
#include <optional>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The line in the plane of kp and kd of a PID, its other numbers kept, along which the loop without friction keeps
/// what a designer has chosen. With L = L0 + kp Lp + kd Ld and wc the highest frequency at which |L| = 1:
///   bandwidth:     |L(j wc)| = 1 at the present wc, a quadratic equation in kd, of whose roots the present one is
///                  followed;
///   phase margin:  L(j w) = -exp(j phi) for the present margin phi at the highest crossover, that is
///                  Im((L0 + kp Lp + exp(j phi))/Ld) = 0, the root w nearest to wc, and kd = -Re of the same.
class GainLine {
 public:
  enum class Keeps { bandwidth, phase_margin };

  /// Empty for a loop without a PID of kp > 0 and kd > 0 or without a crossover, and where open_loop() is empty.
  static std::optional<GainLine> of(const LoopParts& parts, Keeps keeps);

  /// kd on the line, >= 0; empty where there is none. Cost: up to some hundred evaluations of L.
  std::optional<double> kd(double kp) const;

  double crossover() const { return crossover_; }        ///< rad/s, of the loop as it stands
  double phase_margin() const { return phase_margin_; }  ///< rad, there

 private:
  using Gain = std::function<std::complex<double>(double)>;
  GainLine(Gain rest, Gain by_kp, Gain by_kd, Keeps keeps)
      : rest_(std::move(rest)), by_kp_(std::move(by_kp)), by_kd_(std::move(by_kd)), keeps_(keeps) {}

  std::optional<double> kd_for_bandwidth(double kp) const;
  std::optional<double> kd_for_phase_margin(double kp) const;
  std::complex<double> kd_and_fault(double kp, double w) const;

  Gain rest_, by_kp_, by_kd_;  ///< L0, Lp, Ld at jw
  Keeps keeps_;
  double crossover_ = 0.0, phase_margin_ = 0.0;
  bool larger_root_ = true;  ///< of the quadratic equation: the present kd is that one
};

}  // namespace limcycle
