#pragma once
#include <Eigen/Core>
#include <map>
#include <vector>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

/// Exact flow of a loop of piecewise affine elements (Coulomb with stiction, relay, saturation, dead zone, backlash,
/// ...) in fixed modes: with [x; 1]' = M [x; 1], x(t + h) is the upper part of exp(M h) [x; 1]. Error: that of the
/// matrix exponential, a few roundings (scaling and squaring of its series, as exp - I).
class AffineFlow {
 public:
  explicit AffineFlow(LoopField& field) : field_(&field) {}

  /// True if every element of the loop is piecewise affine, so that this flow is its motion.
  static bool applies(const Loop& loop);

  /// exp(M h) in the field's present modes, (n+1) x (n+1), kept for the last few h: a clock asks for the same ones.
  /// Cost O(n^3).
  Eigen::MatrixXd over(double h);
  /// exp(M 2^k s), cached.
  const Eigen::MatrixXd& over_power(int k);
  /// exp(M h), from the cache if h is a power of two up to the rounding of the times at its ends.
  Eigen::MatrixXd over_step(double h);

  /// The motion from x over any time h, without its matrix: by the binary digits of h, each of which has a matrix that
  /// is kept, and the series for the rest. Cost O(n^2), and O(n^3) once for each digit and mode.
  void move(double h, const State& x, State& out);

  /// The motion from x by a matrix of the above.
  static void apply(const Eigen::MatrixXd& exponential, const State& x, State& out);

 private:
  struct InMode {
    Eigen::MatrixXd generator;
    int least = 0;                           ///< 2^least s is short enough for the series
    std::vector<Eigen::MatrixXd> doublings;  ///< exp - I over 2^least s, twice that, ...
    std::map<int, Eigen::MatrixXd> powers;
    std::vector<std::pair<double, Eigen::MatrixXd>> last;
  };
  InMode& present();
  static const Eigen::MatrixXd& doubled_to(InMode& mode, int k);

  LoopField* field_;
  std::map<std::vector<std::int64_t>, InMode> modes_;
  std::vector<std::int64_t> key_;        ///< memory of what is done at every step, kept for the next one
  Eigen::VectorXd moved_, term_, part_;  ///< likewise
};

}  // namespace limcycle
