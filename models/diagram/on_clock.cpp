#include "limcycle/models/diagram/on_clock.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/models/diagram/controller_blocks.hpp"
#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/diagram/quanta.hpp"
#include "limcycle/models/linear/discrete.hpp"

namespace limcycle {
namespace {

/// The sampling of a block; null for one that is continuous.
const Sampling* clock_of(const Block& block) {
  const auto* controller = std::get_if<Controller>(&block.what);
  if (controller == nullptr || !sampling_of(*controller).is_on()) return nullptr;
  return &sampling_of(*controller);
}

/// The diagram with its sampled linear blocks as controllers.
Diagram with_controllers(Diagram diagram) {
  for (Block& block : diagram.blocks) {
    const auto* linear = std::get_if<LinearBlock>(&block.what);
    if (linear == nullptr || !block.sampling.is_on()) continue;
    const LinearModel model = model_of(*linear);
    StateSpaceController controller;
    static_cast<Sampling&>(controller) = block.sampling;
    controller.A = model.ss.A / model.time;
    controller.B = model.ss.B / model.time;
    controller.C = model.ss.C;
    controller.D = model.ss.D;
    block.what = Controller(controller);
    block.sampling = {};
  }
  return diagram;
}

/// Time between two ticks of the clock that all share.
double tick_of(const Diagram& diagram) {
  double shortest = infinite;
  for (const Block& block : diagram.blocks)
    if (const Sampling* sampling = clock_of(block)) shortest = std::min(shortest, sampling->sample_time);
  return shortest;
}

/// Ticks from one reading to the next.
double ticks(const Sampling& sampling, double tick) { return std::round(sampling.sample_time / tick); }

bool reads(const Block& block, const std::string& name) {
  return std::ranges::any_of(
      block.inputs, [&](const SignalSum& sum) { return std::ranges::find(sum, name, &Term::block) != sum.end(); });
}

bool is_read_on_clock(const Diagram& diagram, const std::string& name) {
  return std::ranges::any_of(diagram.blocks,
                             [&](const Block& block) { return clock_of(block) != nullptr && reads(block, name); });
}

const Block& named(const Diagram& diagram, const std::string& name) {
  return diagram.blocks[*find_block(diagram, name)];
}

bool is_plant(const Diagram& diagram, const std::string& name) {
  return find_block(diagram, name) && std::holds_alternative<Plant>(named(diagram, name).what);
}

/// True if a block sees only plants and the reference, itself or behind others that do: a dead time may then as well
/// stand before it as behind it.
bool sees_plants_only(const Diagram& diagram, const Block& block, std::size_t depth = 0) {
  if (depth > diagram.blocks.size() || clock_of(block) != nullptr) return false;
  return std::ranges::all_of(block.inputs, [&](const SignalSum& sum) {
    return std::ranges::all_of(sum, [&](const Term& term) {
      return term.block == "r" || is_plant(diagram, term.block) ||
             sees_plants_only(diagram, named(diagram, term.block), depth + 1);
    });
  });
}

/// True if sampled controllers are all that this signal reaches, themselves or behind blocks that see only plants.
bool is_for_computers(const Diagram& diagram, const std::string& name, std::size_t depth = 0) {
  if (depth > diagram.blocks.size()) return false;
  return std::ranges::all_of(diagram.blocks, [&](const Block& block) {
    if (!reads(block, name) || clock_of(block) != nullptr) return true;
    const bool passes = !std::holds_alternative<Plant>(block.what) && sees_plants_only(diagram, block);
    return passes && is_for_computers(diagram, block.name, depth + 1);
  });
}

/// Readings of the plants in the input of a sampled controller, in multiples of its input_step.
void add_encoders(std::vector<Block>& behind, const Diagram& diagram, Block& block, double every) {
  const Sampling& sampling = *clock_of(block);
  if (!(sampling.input_step > 0.0)) return;
  Sampling shared = sampling;
  shared.sample_time = tick_of(diagram);
  for (Term& term : block.inputs.front()) {
    if (!is_plant(diagram, term.block)) continue;
    const std::string suffix = encoder_name(behind.size()), name = block.name + suffix;
    behind.push_back({name, block.path + suffix, encoder(shared, every), {{{1.0, term.block, term.output}}}});
    term = {term.factor, name, ""};
  }
}

Diagram sampled_form(Diagram diagram) {
  const double tick = tick_of(diagram);
  std::vector<Block> added;
  const Diagram given = diagram;
  for (Block& block : diagram.blocks) {
    if (clock_of(block) == nullptr) continue;
    const Controller controller = std::get<Controller>(block.what);
    const Sampling sampling = sampling_of(controller);
    const double every = ticks(sampling, tick);
    std::vector<Block> encoders;
    add_encoders(encoders, given, block, every);
    added.insert(added.end(), encoders.begin(), encoders.end());
    Sampled<double> element =
        on_computer(sampling, discrete_of(controller, sampling), model_of(controller).ss.states());
    element.sample_time = tick;
    element.every = every;
    element.computation_delay = sampling.computation_delay;
    element.output_quantum = sampling.output_step;
    block.what = Element(element);
  }
  diagram.blocks.insert(diagram.blocks.end(), added.begin(), added.end());
  return diagram;
}

/// A low-pass behind a block, of the name NAME.SUFFIX.
Block lagging(const Block& block, const std::string& suffix, double time) {
  return {block.name + suffix, block.path, LinearBlock(LowPass{.time_constant = time}), {{{1.0, block.name, ""}}}};
}

/// Mean age of what a sampled controller reads of another: half of the ticks that it does not wait for, and what was
/// not computed yet at the same tick.
double age_between(const Sampling& from, const Sampling& to) {
  const double held = 0.5 * std::max(0.0, from.sample_time - to.sample_time);
  return held + std::ceil(from.computation_delay / to.sample_time) * to.sample_time;
}

/// The dead times between sampled controllers, and those from one to the continuous part, if they are not in the
/// plants.
void add_lags(Diagram& diagram, const Diagram& given, bool dead_time_in_plants) {
  std::vector<Block> added;
  for (const Block& from : given.blocks) {
    const Sampling* own = clock_of(from);
    if (own == nullptr) continue;
    for (std::size_t i = 0; i < given.blocks.size(); ++i) {
      if (!reads(given.blocks[i], from.name)) continue;
      const Sampling* other = clock_of(given.blocks[i]);
      const double age = other ? age_between(*own, *other) : dead_time_in_plants ? 0.0 : own->mean_delay();
      if (!(age > 0.0)) continue;
      added.push_back(lagging(from, ".late" + std::to_string(added.size() + 1), age));
      read_instead(diagram.blocks[i], from.name, added.back().name);
    }
  }
  diagram.blocks.insert(diagram.blocks.end(), added.begin(), added.end());
}

/// True if the dead times that the diagram has of itself are the same in all its plants, so that more can stand there.
bool same_in_all_plants(const Diagram& diagram) {
  std::optional<double> own;
  for (const Block& block : diagram.blocks) {
    if (const auto* linear = std::get_if<LinearBlock>(&block.what))
      if (std::holds_alternative<DelayBlock>(*linear)) return false;
    const auto* plant = std::get_if<Plant>(&block.what);
    if (plant == nullptr) continue;
    const double delay = limcycle::model_of(*plant).delay;
    if (own && *own != delay) return false;
    own = delay;
  }
  return true;
}

/// The dead time of all sampled controllers that the continuous part reads, if it can stand in the plants.
std::optional<double> shared_dead_time(const Diagram& diagram) {
  if (!same_in_all_plants(diagram)) return std::nullopt;
  std::optional<double> shared;
  for (const Block& block : diagram.blocks) {
    const Sampling* sampling = clock_of(block);
    const auto reads_it = [&](const Block& other) { return clock_of(other) == nullptr && reads(other, block.name); };
    if (sampling == nullptr || !std::ranges::any_of(diagram.blocks, reads_it)) continue;
    if (shared && *shared != sampling->mean_delay()) return std::nullopt;
    shared = sampling->mean_delay();
  }
  for (const Block& block : diagram.blocks)
    if (std::holds_alternative<Plant>(block.what) && !is_for_computers(diagram, block.name)) return std::nullopt;
  return shared;
}

Diagram averaged_form(Diagram diagram) {
  const Diagram given = diagram;
  const auto dead_time = shared_dead_time(given);
  for (Block& block : diagram.blocks) {
    if (dead_time && std::holds_alternative<Plant>(block.what)) block.late = *dead_time;
    if (const Sampling* sampling = clock_of(block)) {
      const Controller controller = std::get<Controller>(block.what);
      block = averaged_block(block.name, block.path, model_behind_window(controller, *sampling), sampling->sample_time,
                             block.inputs.front());
    }
  }
  add_lags(diagram, given, dead_time.has_value());
  return diagram;
}

}  // namespace

bool has_differences(const Controller& controller) {
  const StateSpace discrete = backward_difference(model_of(controller), sampling_of(controller).sample_time);
  return discrete.A.allFinite() && discrete.C.allFinite();
}

bool is_sampled(const Diagram& diagram) {
  return std::ranges::any_of(diagram.blocks,
                             [](const Block& block) { return clock_of(block) != nullptr || block.sampling.is_on(); });
}

std::optional<BrokenRule> broken_clocks(const Diagram& given) {
  const Diagram diagram = with_controllers(given);
  const double tick = tick_of(diagram);
  for (const Block& block : diagram.blocks) {
    const auto* controller = std::get_if<Controller>(&block.what);
    if (controller == nullptr) continue;
    if (auto broken = sampling_of(*controller).broken_together())
      return BrokenRule{block.path + "." + broken->key, broken->rule};
    const Sampling* sampling = clock_of(block);
    if (sampling == nullptr) continue;
    const auto refuse = [&](const char* rule) { return BrokenRule{block.path + ".sample_time", rule}; };
    const double count = ticks(*sampling, tick);
    if (std::abs(sampling->sample_time - count * tick) > 1e-9 * sampling->sample_time)
      return refuse("must be a whole multiple of the shortest sample_time in the diagram");
    if (sampling->computation_delay >= tick && is_read_on_clock(diagram, block.name))
      return BrokenRule{block.path + ".computation_delay",
                        "must be less than the shortest sample_time in the diagram where a sampled block reads " +
                            block.name + ": it reads it one sample late for any delay above 0"};
    if (!has_differences(*controller)) return refuse("must not be the inverse of a pole of the controller");
  }
  return std::nullopt;
}

Diagram on_clock(Diagram diagram, Clock clock) {
  switch (clock) {
    case Clock::sampled:
      return sampled_form(with_controllers(std::move(diagram)));
    case Clock::averaged:
      return averaged_form(with_controllers(std::move(diagram)));
    case Clock::continuous:
      break;
  }
  return diagram;
}

}  // namespace limcycle
