#pragma once
#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

template <class S>
struct Sampled;

/// The reading or part of a controller in this place of a loop; null for any other element.
const Sampled<double>* sampled_at(const Loop& loop, std::size_t k);

/// Time between two readings of the sampled controller of a loop, s; infinite without one.
double sample_time(const Loop& loop);

/// Time after which the readings of all its parts repeat themselves, s: that of the slowest one.
double repetition_time(const Loop& loop);

/// Typical sizes of the states of a loop with a sampled controller, from those of the linear states of
/// Loop::continuous: the states of its controller are those of the element in its place, in their order; what is held
/// between two readings has the size of the input that is read, or of the command.
State sampled_sizes(const Loop& loop, const State& continuous);

/// The state of that loop at which its plant and its controller have the states X of Loop::continuous, and have had
/// them for a while; the controller reads its input now, other elements are without history.
LoopState sampled_state(const Loop& loop, const Eigen::VectorXd& X);

/// The states of Loop::continuous at which its plant and its controller have those of the loop.
Eigen::VectorXd continuous_state(const Loop& loop, const LoopState& here);

}  // namespace limcycle
