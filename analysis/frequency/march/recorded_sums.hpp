#pragma once
#include <utility>
#include <vector>

#include "limcycle/analysis/frequency/march/harmonic_sums.hpp"
#include "limcycle/analysis/frequency/march/periodic_state.hpp"

namespace limcycle {

/// HarmonicSums that also record each panel of the pass, as solved, and each switch.
class RecordedSums : public HarmonicSums {
 public:
  static constexpr bool wants_panels = true;

  struct Step {
    bool is_switch = false;
    Mode mode;                      ///< on the panel; before the switch
    double length = 0.0;            ///< of the panel, rad
    std::vector<MotionNode> nodes;  ///< stages of the panel; the instant of the switch
    std::vector<double> z;          ///< at the stages, one after the other; before the switch
    int guard = 0;
    double bend = 0.0;  ///< second derivative of the input's rate by the phase, at the switch
    Mode mode_after;
    std::vector<double> z_after;
  };

  using HarmonicSums::HarmonicSums;

  void restart() {
    HarmonicSums::restart();
    steps_.clear();
  }
  template <class Panel>
  void panel(const Panel& solved, double length, Mode mode) {
    Step step;
    step.mode = mode;
    step.length = length;
    for (std::size_t i = 0; i < solved.stages(); ++i) {
      step.nodes.push_back(solved.node(i));
      step.z.insert(step.z.end(), solved.state(i).begin(), solved.state(i).end());
    }
    steps_.push_back(std::move(step));
  }
  void switched(const MotionNode& node, double bend, int guard, const ElementState& before, const ElementState& after) {
    steps_.push_back({true, before.mode, 0.0, {node}, before.z, guard, bend, after.mode, after.z});
  }

  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

}  // namespace limcycle
