#include "limcycle/models/diagram/controller_blocks.hpp"
#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/diagram/on_clock.hpp"
#include "limcycle/models/diagram/quanta.hpp"

namespace limcycle {

Diagram short_form(const LoopParts& parts, Clock clock) {
  const Sampling& sampling = sampling_of(parts.controller);
  const bool sampled = clock == Clock::sampled, quantized = !sampled && sampling.is_on() && has_only_quanta(parts);
  Diagram diagram;
  diagram.output = {1.0, "plant", "y"};
  diagram.load_on = "plant";
  diagram.prefixed_states = false;
  auto& blocks = diagram.blocks;
  blocks.push_back({"plant", "loop.plant", parts.plant});
  if (clock == Clock::averaged) blocks.back().late = sampling.mean_delay();

  SignalSum signal;  // what has come so far on the way to the plant
  if (uses_error(parts)) {
    signal = {{1.0, "r", ""}, {-1.0, "plant", "y"}};
    if (sampled && sampling.input_step > 0.0) {
      const auto* cascade = std::get_if<Cascade>(&parts.controller);
      const Element reading = encoder(sampling, cascade != nullptr ? cascade->position_every : 1.0);
      blocks.push_back({"encoder", "loop.controller.encoder", reading, {{{1.0, "plant", "y"}}}});
      signal.back() = {-1.0, "encoder", ""};
    }
    if (quantized && sampling.input_step > 0.0) {
      through_quantizer(blocks, "encoder", "loop.controller.encoder", sampling.input_step, {{1.0, "plant", "y"}});
      signal.back() = {-1.0, "encoder", ""};
    }
    if (parts.error) {
      blocks.push_back({"error", "loop.error", *parts.error, {signal}});
      signal = {{1.0, "error", ""}};
    }
    signal = through_controller(blocks, parts.controller, std::move(signal), clock);
    if (quantized && sampling.input_step == 0.0 && sampling.output_step > 0.0)
      signal = through_quantizer(blocks, "steps", "loop.controller.steps", sampling.output_step, std::move(signal));
    add_impulses(blocks, parts.controller, {{1.0, "r", ""}, {-1.0, "plant", "y"}}, signal);
  }
  signal = through_actuator(blocks, actuator_of(parts.controller), "", "loop.controller", std::move(signal), "plant");
  if (parts.element) {
    blocks.push_back({"element", "loop.element", *parts.element, {signal}});
    signal = {{1.0, "element", ""}};
  }
  blocks.front().inputs = {signal};
  if (parts.friction) blocks.push_back({"friction", "loop.friction", *parts.friction, {}, Contact::opposes, "plant"});
  return diagram;
}

namespace {

/// The same with every integral among the linear states, as scales and starts of a sampled loop need them.
LoopParts with_linear_integral(LoopParts parts) {
  if (auto* cascade = std::get_if<Cascade>(&parts.controller)) cascade->anti_windup = {};
  return parts;
}

}  // namespace

Loop assemble(const LoopParts& parts) {
  const auto diagram_of = [](const LoopParts& of, Clock clock) {
    if (!of.diagram) return short_form(of, clock);
    Diagram diagram = expanded(*of.diagram);
    if (clock != Clock::sampled && has_only_quanta(of)) diagram = with_quantizers(std::move(diagram));
    return on_clock(std::move(diagram), clock);
  };
  const auto form = [&](const Diagram& diagram) { return assemble(diagram, parts.reference, parts.load); };
  const bool on_computer =
      parts.diagram ? is_sampled(*parts.diagram) : sampling_of(parts.controller).is_on() && uses_error(parts);
  if (!on_computer) return form(diagram_of(parts, Clock::continuous));
  Loop sampled = form(diagram_of(parts, Clock::sampled)), loop = form(diagram_of(parts, Clock::averaged));
  LoopParts linear = with_linear_integral(parts);
  if (has_only_quanta(parts)) linear = with_filtered_derivatives(std::move(linear));
  Diagram prompt = diagram_of(linear, Clock::continuous);
  for (Block& block : prompt.blocks) end_delay(block);
  sampled.continuous = std::make_shared<const Loop>(form(prompt));
  loop.sampled = std::make_shared<const Loop>(std::move(sampled));
  return loop;
}

bool uses_error(const LoopParts& parts) {
  return !parts.friction || parts.element || !std::holds_alternative<NoController>(parts.controller);
}

}  // namespace limcycle
