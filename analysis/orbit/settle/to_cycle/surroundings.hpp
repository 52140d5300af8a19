#pragma once
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Motions close to a periodic one, where its multipliers do not tell what it is.
class Surroundings {
 public:
  /// `options`: of the shooting that found the cycle. All must outlive this. `rtol`: of the marches.
  Surroundings(const Loop& loop, const Cycle& cycle, const Section& section, const ShootingOptions& options,
               double rtol);

  /// True if motions that begin 1 % farther out and 1 % nearer return to the cycle within 24 periods. Decides where
  /// a multiplier does not exist, as for a Stribeck curve that begins with infinite slope.
  bool attracts();
  /// True if another periodic motion lies close: shooting from 2 % farther out, or nearer, finds it. `half`: by half
  /// periods.
  bool has_neighbour(bool half);
  /// True if motions that begin aside along `neutral`, on either side, by 1 % or less of their swing, are or come to
  /// other periodic ones whose period and size differ by less than a thousandth of that: the cycle keeps a number of
  /// what was before, as the integral of a sampled controller of a relay does. Beside an orbit of a centre, whose size
  /// depends on the start, both change as much as the start does.
  bool has_twins(const Eigen::VectorXd& neutral);
  /// Steps of all marches so far.
  long steps() const { return steps_; }

 private:
  bool has_twin(const LoopState& beside, double aside);
  ReturnMap map_of_period() const;
  double distance(const State& one, const State& other) const;
  LoopState farther_out(double factor) const;
  LoopState opposite() const;

  const Loop& loop_;
  const Cycle& cycle_;
  const Section& section_;
  const ShootingOptions& options_;
  double rtol_;
  State sizes_, middle_;  ///< typical sizes, or the swing of a state where that is larger; centre of the motion
  long steps_ = 0;
};

}  // namespace limcycle
