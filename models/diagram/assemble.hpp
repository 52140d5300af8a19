#pragma once
#include <stdexcept>

#include "limcycle/models/element/of_controllers/output_rate.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A diagram that is no loop that can be computed: `rule.key` is the path of a block.
struct BrokenDiagram : std::invalid_argument {
  explicit BrokenDiagram(BrokenRule broken)
      : std::invalid_argument(broken.key + ": " + broken.rule), rule(std::move(broken)) {}
  BrokenRule rule;
};

/// Joins the blocks of a diagram. External signals other than the reference and the load are zero, and the states are
/// those of the loop at rest, for any rate of the reference. Elements are numbered so that each comes after those into
/// whose output it looks straight; friction laws come last, those at the body of the output after the others. Throws
/// BrokenDiagram for an algebraic loop, a velocity that does not exist, a derivative of a signal that jumps, and delays
/// that differ.
Loop assemble(const Diagram& diagram, double reference, double load);

/// What stands for a sampled controller: itself, the continuous one that acts as it does on average behind the dead
/// time of hold and computation, or the continuous one that it was made from.
enum class Clock { sampled, averaged, continuous };

/// The five slots of a loop as a diagram, and the same joined, without checking them: where validate() reports an
/// error, the result is wrong or this throws. Of a loop with a sampled controller the averaged form is returned, which
/// holds the others: see Loop::sampled.
Diagram short_form(const LoopParts& parts, Clock clock = Clock::continuous);
Loop assemble(const LoopParts& parts);

/// A signal of a loop: a row over its linear states, one over the outputs of its elements and one over the external
/// signals.
struct SignalRow {
  Eigen::RowVectorXd states, outputs, external;
};

/// The force of the actuator on the plant, friction and load excluded. Empty for a diagram, for a sampled controller,
/// and with a dead time.
std::optional<SignalRow> command_row(const LoopParts& parts);

/// Element that computes the rate of the output of an element on the error; empty where that rate is not available.
std::optional<OutputRate<double>> output_rate(const Element& element);

/// True if the error e = r - y is used; false for friction without a controller or an element in series.
bool uses_error(const LoopParts& parts);

}  // namespace limcycle
