#include "limcycle/models/diagram/expand.hpp"

#include <cmath>

#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"

namespace limcycle {

SignalSum through_actuator(std::vector<Block>& blocks, const Actuator& actuator, const std::string& prefix,
                           const std::string& path, SignalSum signal, const std::string& on) {
  if (actuator.friction_compensation > 0.0) {
    Compensation<double> compensation;
    compensation.level = actuator.friction_compensation;
    const std::string name = prefix + "compensation";
    blocks.push_back({name, path + ".friction_compensation", Element(compensation), {}, Contact::senses, on});
    signal.push_back({1.0, name, ""});
  }
  const auto add = [&](const std::string& name, const std::string& key, BlockKind what) {
    blocks.push_back({prefix + name, path + "." + key, std::move(what), {signal}});
    signal = {{1.0, prefix + name, ""}};
  };
  if (std::isfinite(actuator.saturation)) {
    Saturation<double> saturation;
    saturation.limit = actuator.saturation;
    add("saturation", "saturation", Element(saturation));
  }
  if (actuator.lag > 0.0) add("lag", "lag", LinearBlock(LowPass{.time_constant = actuator.lag}));
  return signal;
}

namespace {

bool has_actuator(const Actuator& actuator) { return std::isfinite(actuator.saturation) || actuator.lag > 0.0; }

}  // namespace

void read_instead(Block& block, const std::string& name, const std::string& other) {
  for (SignalSum& sum : block.inputs)
    for (Term& term : sum)
      if (term.block == name) term.block = other;
}

Diagram expanded(Diagram diagram) {
  const std::size_t count = diagram.blocks.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto* controller = std::get_if<Controller>(&diagram.blocks[i].what);
    if (controller == nullptr || !has_actuator(actuator_of(*controller))) continue;
    const Actuator actuator = actuator_of(*controller);
    const std::string name = diagram.blocks[i].name, path = diagram.blocks[i].path;
    std::vector<Block> behind;
    const SignalSum last = through_actuator(behind, actuator, name + ".", path, {{1.0, name, ""}}, "");
    for (Block& block : diagram.blocks) read_instead(block, name, last.front().block);
    if (diagram.output.block == name) diagram.output.block = last.front().block;
    diagram.blocks.insert(diagram.blocks.end(), behind.begin(), behind.end());
  }
  return diagram;
}

}  // namespace limcycle
