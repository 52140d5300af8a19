#include "limcycle/analysis/motion/sampling.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/element/sampled.hpp"

namespace limcycle {
namespace {

/// Size of the command of a controller whose input and states have these sizes: that of the force or signal that it has
/// to overcome, or its own gains times these sizes if nothing follows it.
double command_size(const Loop& loop, const Sampled<double>& controller, const State& states, double input) {
  if (loop.elements.back().as<Sampled<double>>() == nullptr) return output_level(loop, loop.elements.size() - 1);
  double size = std::abs(controller.D) * input;
  for (std::size_t i = 0; i < std::min(states.size(), controller.C.size()); ++i)
    size += std::abs(controller.C[i]) * states[i];
  return size;
}

/// Which entries of X belong to the plant and what follows it, and which to the controller.
struct Shares {
  State plant, controller;
};
template <class Values>
Shares shares_of(const Loop& loop, const Values& X) {
  Shares shares;
  for (std::size_t i = 0; i < loop.continuous->state_names.size(); ++i) {
    const bool linear = std::ranges::find(loop.state_names, loop.continuous->state_names[i]) != loop.state_names.end();
    (linear ? shares.plant : shares.controller).push_back(X[static_cast<decltype(X.size())>(i)]);
  }
  return shares;
}

/// The element in place of the controller; empty for any other.
const Sampled<double>* controller_at(const Loop& loop, std::size_t k) {
  return loop.ports[k].path == "loop.controller" ? loop.elements[k].as<Sampled<double>>() : nullptr;
}

}  // namespace

double sample_time(const Loop& loop) {
  for (const Element& element : loop.elements)
    if (const auto* sampled = element.as<Sampled<double>>()) return sampled->sample_time;
  return infinite;
}

State sampled_sizes(const Loop& loop, const State& continuous) {
  auto [result, of_controller] = shares_of(loop, continuous);
  const Eigen::VectorXd X = Eigen::Map<const Eigen::VectorXd>(result.data(), loop.states());
  Eigen::VectorXd outputs = Eigen::VectorXd::Zero(std::ssize(loop.elements));
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Element& element = loop.elements[k];
    const Port& port = loop.ports[k];
    const double input = (port.C.cwiseAbs() * X + port.D.cwiseAbs() * outputs).value();
    double& output = outputs(static_cast<Eigen::Index>(k));
    output = input;
    const auto* sampled = controller_at(loop, k);
    if (sampled) output = command_size(loop, *sampled, of_controller, input);
    for (int i = 0; i < element.states(); ++i) {
      const int own = i - Sampled<double>::first_own;
      if (element.even_state(i) || element.as<Sampled<double>>() == nullptr)
        result.push_back(element.state_scale(i));
      else if (!sampled || own < 0 || own >= sampled->order())
        result.push_back(output);
      else
        result.push_back(own < std::ssize(of_controller) ? of_controller[static_cast<std::size_t>(own)] : input);
    }
  }
  return result;
}

LoopState sampled_state(const Loop& loop, const Eigen::VectorXd& X) {
  const auto [plant, controller] = shares_of(loop, X);
  LoopState state = without_history(loop, Eigen::Map<const Eigen::VectorXd>(plant.data(), std::ssize(plant)));
  LoopField field(loop);
  field.modes() = state.modes;
  bool commanded = false;  // elements behind the controller begin at its command
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Element& element = loop.elements[k];
    const auto* sampled = controller_at(loop, k);
    if (!sampled && !commanded) continue;
    State rates;
    field.rate(state.x, rates, 0.0);
    const std::span<double> z(state.x.data() + field.first_state(k), static_cast<std::size_t>(element.states()));
    if (!sampled) {
      if (element.has_modes()) field.modes()[k] = state.modes[k] = element.start(field.input(k), z);
      continue;
    }
    commanded = true;
    const auto own = z.subspan(Sampled<double>::first_own, static_cast<std::size_t>(sampled->order()));
    std::ranges::fill(own, field.input(k).x);  // the last input, for a derivative
    std::ranges::copy(controller, own.begin());
    field.modes()[k] = state.modes[k] = sampled->next(field.input(k), {}, z, 0);
  }
  return state;
}

}  // namespace limcycle
