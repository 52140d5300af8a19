#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "limcycle/models/diagram/linear_blocks.hpp"
#include "limcycle/models/element/element.hpp"
#include "limcycle/models/linear/controllers.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// A signal with a factor. The reference is the block "r", its rate the output "rate" of that; `output` picks one of
/// several outputs: "y" and "v" (= dy/dt) or the name of a state of a plant, the number of an output (from 1) of a
/// state space, else empty.
struct Term {
  double factor = 1.0;
  std::string block, output;
};

/// factor_1 signal_1 + factor_2 signal_2 + ...; empty: zero.
using SignalSum = std::vector<Term>;

/// What an element has to do with the body or bodies that it names in `on` and `against`.
enum class Contact {
  none,     ///< it stands in the path of a signal
  opposes,  ///< friction: it opposes the rubbing velocity of `on`, relative to `against` if that is named
  senses    ///< friction compensation: it follows the sign of that velocity, and its output is a signal
};

using BlockKind = std::variant<Plant, Controller, Element, LinearBlock>;

/// One block: `inputs` are sums of signals, one for each input; none for a contact or a constant.
struct Block {
  std::string name, path;  ///< "axis", "diagram.axis"
  BlockKind what;
  std::vector<SignalSum> inputs = {};
  Contact contact = Contact::none;
  std::string on = {}, against = {};
  std::vector<std::string> states = {};  ///< names of its states; empty: those of its kind
  double late = 0.0;                     ///< all outputs of a plant are read that much later, s
  Sampling sampling = {};                ///< of a linear block of one input and one output that runs on a computer
};

/// A loop of any structure: blocks that are joined by the names of their signals.
struct Diagram {
  std::vector<Block> blocks;
  Term output;                  ///< y of the loop
  std::string load_on = {};     ///< plant to whose input an external force is added; empty: none
  bool prefixed_states = true;  ///< states are named "axis.y" instead of "y"
};

/// Takes the dead time of a plant or a delay away; false if the block has none.
bool end_delay(Block& block);

/// Number of inputs of a block.
std::size_t inputs_of(const Block& block);

/// Blocks that hold an element with that contact: the friction laws, the elements in the path of a signal.
std::vector<const Block*> elements_of(const Diagram& diagram, Contact contact);

/// Position of a block of that name; empty if there is none.
std::optional<std::size_t> find_block(const Diagram& diagram, std::string_view name);

}  // namespace limcycle
