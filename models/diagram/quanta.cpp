#include "limcycle/models/diagram/quanta.hpp"

#include <algorithm>

#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"

namespace limcycle {
namespace {

const Sampling* sampling_in(const Block& block) {
  if (const auto* controller = std::get_if<Controller>(&block.what))
    return sampling_of(*controller).is_on() ? &sampling_of(*controller) : nullptr;
  return block.sampling.is_on() ? &block.sampling : nullptr;
}

bool is_linear(const Block& block) {
  const auto* plant = std::get_if<Plant>(&block.what);
  return !std::holds_alternative<Element>(block.what) && (plant == nullptr || !model_of(*plant).gravity);
}

void filter_derivative(Controller& controller) {
  constexpr double share = 0.5;  // of a sample: the mean age of a difference
  auto* pid = std::get_if<Pid>(&controller);
  if (pid != nullptr && pid->is_on() && pid->kd != 0.0 && pid->tf == 0.0) pid->tf = share * pid->sample_time;
}

}  // namespace

bool has_only_quanta(const LoopParts& parts) {
  if (parts.diagram) return std::ranges::all_of(parts.diagram->blocks, is_linear);
  return !parts.friction && !parts.element && !parts.error && !model_of(parts.plant).gravity;
}

std::string encoder_name(std::size_t number) { return ".encoder" + (number == 0 ? "" : std::to_string(number + 1)); }

SignalSum through_quantizer(std::vector<Block>& blocks, const std::string& name, const std::string& path, double step,
                            SignalSum signal) {
  Quantizer<double> quantizer;
  quantizer.step = step;
  blocks.push_back({name, path, Element(quantizer), {std::move(signal)}});
  return {{1.0, name, ""}};
}

Diagram with_quantizers(Diagram diagram) {
  std::vector<Block> added;
  const Diagram given = diagram;
  for (Block& block : diagram.blocks) {
    const Sampling* sampling = sampling_in(block);
    if (sampling == nullptr) continue;
    std::size_t readings = 0;
    for (Term& term : block.inputs.front()) {
      const auto from = find_block(given, term.block);
      if (!(sampling->input_step > 0.0) || !from || !std::holds_alternative<Plant>(given.blocks[*from].what)) continue;
      const std::string suffix = encoder_name(readings++), name = block.name + suffix;
      through_quantizer(added, name, block.path + suffix, sampling->input_step, {{1.0, term.block, term.output}});
      term = {term.factor, name, ""};
    }
    if (sampling->input_step > 0.0 || !(sampling->output_step > 0.0)) continue;
    const std::string name = block.name + ".steps", read = block.name;
    for (Block& reader : diagram.blocks) read_instead(reader, read, name);
    through_quantizer(added, name, block.path + ".steps", sampling->output_step, {{1.0, read, ""}});
  }
  diagram.blocks.insert(diagram.blocks.end(), added.begin(), added.end());
  return diagram;
}

LoopParts with_filtered_derivatives(LoopParts parts) {
  filter_derivative(parts.controller);
  if (!parts.diagram) return parts;
  for (Block& block : parts.diagram->blocks)
    if (auto* controller = std::get_if<Controller>(&block.what)) filter_derivative(*controller);
  return parts;
}

}  // namespace limcycle
