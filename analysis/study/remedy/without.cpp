#include "limcycle/analysis/study/remedy/without.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/element/with_memory/valve_stiction.hpp"
#include "limcycle/models/linear/integral_action.hpp"

namespace limcycle {

void free_integral(Pid& pid) {
  pid.integral_limit = pid.integral_band = infinite;
  pid.integral_dead_zone = pid.integral_hysteresis = 0.0;
  pid.integral_reset = pid.reset_interval = pid.reset_speed = 0.0;
}

namespace {

/// What is done to each part of a loop; each returns true if it changed something.
struct PartChange {
  std::function<bool(Controller&)> controller = [](Controller&) { return false; };
  std::function<bool(Plant&)> plant = [](Plant&) { return false; };
  std::function<bool(Element&)> element = [](Element&) { return false; };
  std::function<bool(Block&)> block = [](Block&) { return false; };
};

bool changed_slots(LoopParts& parts, const PartChange& change) {
  bool any = change.controller(parts.controller);
  any = change.plant(parts.plant) || any;
  for (std::optional<Element>* slot : {&parts.element, &parts.friction, &parts.error})
    if (*slot) any = change.element(**slot) || any;
  return any;
}

bool changed_blocks(Diagram& diagram, const PartChange& change) {
  bool any = false;
  for (Block& block : diagram.blocks) {
    if (auto* controller = std::get_if<Controller>(&block.what)) any = change.controller(*controller) || any;
    if (auto* plant = std::get_if<Plant>(&block.what)) any = change.plant(*plant) || any;
    if (auto* element = std::get_if<Element>(&block.what)) any = change.element(*element) || any;
    any = change.block(block) || any;
  }
  return any;
}

std::optional<LoopParts> changed_parts(LoopParts parts, const PartChange& change) {
  const bool any = parts.diagram ? changed_blocks(*parts.diagram, change) : changed_slots(parts, change);
  if (!any || validate(parts)) return std::nullopt;
  return parts;
}

/// Sets the members to `value`; true if one of them was another.
template <class Owner>
bool set_members(Owner& owner, std::initializer_list<double Owner::*> members, double value) {
  bool any = false;
  for (const auto member : members) any = std::exchange(owner.*member, value) != value || any;
  return any;
}

ControllerParts& own_parts(Controller& controller) {
  return std::visit([](auto& one) -> ControllerParts& { return one; }, controller);
}

/// Lowers each number of the law to that of another key; true if one was larger.
bool lower_to(Element& law, std::string_view key, std::string_view to) {
  const auto high = law.number(key), low = law.number(to);
  if (!high || !low || !(*high > *low)) return false;
  law = law.with(key, *low);
  return true;
}

/// Each direction of a measured curve becomes level at its least force.
bool flatten_table(Element& law) {
  const auto& rows = law.parameters();
  auto values = law.values();
  bool any = false;
  const auto flatten = [&](std::string_view forces_key, std::string_view rest_key) {
    const auto place = [&](std::string_view key) {
      return static_cast<std::size_t>(std::ranges::find(rows, key, &ParameterRow::key) - rows.begin());
    };
    const std::size_t at = place(forces_key), rest = place(rest_key);
    if (at == rows.size() || rest == rows.size()) return;
    auto* forces = std::get_if<std::vector<double>>(&values[at]);
    if (forces == nullptr || forces->empty()) return;
    const double least = *std::ranges::min_element(*forces);
    any = any || *std::ranges::max_element(*forces) > least || values[rest] != ParameterValue(least);
    std::ranges::fill(*forces, least);
    values[rest] = least;
  };
  flatten("forces", "Fs");
  flatten("forces_minus", "Fs_minus");
  if (any) law = law.with(values);
  return any;
}

bool is_siso(const StateSpaceBlock& block) { return block.B.cols() == 1 && block.C.rows() == 1; }

/// True if the controller had integral action.
bool end_integral(Controller& controller) {
  if (auto* pid = std::get_if<Pid>(&controller)) {
    free_integral(*pid);
    return set_members(*pid, {&Pid::ki}, 0.0);
  }
  if (auto* cascade = std::get_if<Cascade>(&controller)) {
    cascade->anti_windup = {};
    return set_members(*cascade, {&Cascade::position_ki, &Cascade::velocity_ki}, 0.0);
  }
  std::optional<Rational> rest;
  if (const auto* given = std::get_if<TransferFunctionController>(&controller))
    rest = without_integral_action(Rational{given->numerator, given->denominator});
  else if (const auto* matrices = std::get_if<StateSpaceController>(&controller))
    rest = without_integral_action(rational_of(matrices->model().ss));
  if (!rest) return false;
  TransferFunctionController without;
  static_cast<ControllerParts&>(without) = own_parts(controller);
  without.numerator = std::move(rest->numerator);
  without.denominator = std::move(rest->denominator);
  controller = std::move(without);
  return true;
}

}  // namespace

std::optional<LoopParts> without_integral_action(LoopParts parts) {
  PartChange change;
  change.controller = end_integral;
  change.element = [](Element& element) {
    auto* clamped = element.as<ClampedPi<double>>();
    return clamped != nullptr && std::exchange(clamped->ki, 0.0) != 0.0;
  };
  change.block = [](Block& block) {
    auto* linear = std::get_if<LinearBlock>(&block.what);
    if (linear == nullptr) return false;
    if (auto* integrator = std::get_if<Integrator>(linear)) return set_members(*integrator, {&Integrator::gain}, 0.0);
    std::optional<Rational> rest;
    if (const auto* block_of = std::get_if<ProperTransferFunction>(linear))
      rest = without_integral_action(Rational{block_of->numerator, block_of->denominator});
    else if (const auto* matrices = std::get_if<StateSpaceBlock>(linear); matrices != nullptr && is_siso(*matrices))
      rest = without_integral_action(rational_of(matrices->model().ss));
    if (rest) *linear = ProperTransferFunction{std::move(rest->numerator), std::move(rest->denominator)};
    return rest.has_value();
  };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_falling_friction(LoopParts parts) {
  PartChange change;
  change.element = [](Element& element) {
    if (!element.is_friction()) return false;
    bool any = lower_to(element, "Fs", "Fc");
    any = lower_to(element, "Fs_minus", "Fc_minus") || any;
    return flatten_table(element) || any;
  };
  return changed_parts(std::move(parts), change);
}

bool friction_is_measured(LoopParts parts) {
  bool any = false;
  PartChange look;
  look.element = [&](Element& element) {
    any = any || (element.is_friction() && std::ranges::find(element.parameters(), std::string_view("forces"),
                                                             &ParameterRow::key) != element.parameters().end());
    return false;
  };
  changed_parts(std::move(parts), look);
  return any;
}

std::optional<LoopParts> without_delay(LoopParts parts) {
  PartChange change;
  change.controller = [](Controller& controller) {
    Sampling& sampling = own_parts(controller);
    if (!sampling.is_on()) return false;
    sampling = Sampling{};
    if (auto* cascade = std::get_if<Cascade>(&controller)) cascade->position_every = 1.0;
    return true;
  };
  change.plant = [](Plant& plant) { return end_delay(plant); };
  change.block = [](Block& block) {
    const bool sampled = std::exchange(block.sampling, {}).is_on();
    return end_delay(block) || sampled;
  };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_quanta(LoopParts parts) {
  PartChange change;
  const auto exact = [](Sampling& sampling) {
    return set_members(sampling, {&Sampling::input_step, &Sampling::output_step}, 0.0);
  };
  change.controller = [&](Controller& controller) { return exact(own_parts(controller)); };
  change.block = [&](Block& block) { return exact(block.sampling); };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_relay(LoopParts parts, double swing) {
  PartChange change;
  change.element = [swing](Element& element) {
    const auto* relay = element.as<Relay<double>>();
    if (relay == nullptr || !(swing > 0.0)) return false;
    Saturation<double> smooth;
    smooth.limit = relay->level;
    smooth.slope = 0.5 * relay->level / swing;
    element = Element(smooth);
    return true;
  };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_compensation(LoopParts parts) {
  PartChange change;
  change.controller = [](Controller& controller) {
    return std::exchange(own_parts(controller).friction_compensation, 0.0) != 0.0;
  };
  change.element = [](Element& element) {
    auto* compensation = element.as<Compensation<double>>();
    return compensation != nullptr && std::exchange(compensation->level, 0.0) != 0.0;
  };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_sticking_valve(LoopParts parts) {
  constexpr double far = 1e9;  // times the band: never reached
  PartChange change;
  change.element = [](Element& element) {
    const auto* valve = element.as<ValveStiction<double>>();
    if (valve == nullptr) return false;
    Saturation<double> straight;
    straight.limit = far * valve->S;
    element = straight;
    return true;
  };
  return changed_parts(std::move(parts), change);
}

std::optional<LoopParts> without_limits(LoopParts parts) {
  constexpr double far = 1e9;  // times the limit: never reached
  PartChange change;
  change.controller = [](Controller& controller) {
    bool any = std::isfinite(std::exchange(own_parts(controller).saturation, infinite));
    auto* cascade = std::get_if<Cascade>(&controller);
    if (cascade == nullptr) return any;
    cascade->anti_windup = {};
    return std::isfinite(std::exchange(cascade->limit, infinite)) || any;
  };
  change.element = [](Element& element) {
    auto* saturation = element.as<Saturation<double>>();
    auto* clamped = element.as<ClampedPi<double>>();
    if (saturation != nullptr) saturation->limit *= far;
    if (clamped != nullptr) clamped->limit *= far;
    return saturation != nullptr || clamped != nullptr;
  };
  return changed_parts(std::move(parts), change);
}

}  // namespace limcycle
