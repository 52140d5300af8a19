#include "limcycle/analysis/motion/sampling.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {

const Sampled<double>* sampled_at(const Loop& loop, std::size_t k) { return loop.elements[k].as<Sampled<double>>(); }

namespace {

/// Number of its states that the continuous controller has too; the others are past inputs.
std::size_t states_of_controller(const Sampled<double>& sampled) {
  return static_cast<std::size_t>(sampled.order() - static_cast<int>(sampled.memory));
}

/// The same sizes of an input and of the rate at which it changes, and of the states that are no past inputs.
struct SampledSizes {
  double input, rate;
  State states;

  /// Of the output: that of the force or signal that a command has to overcome, if there is one; that of a difference
  /// is a rate.
  double output(const Loop& loop, std::size_t k) const {
    const Sampled<double>& sampled = *sampled_at(loop, k);
    const bool drives =
        loop.ports[k].path == "loop.controller" || !loop.B.col(static_cast<Eigen::Index>(k)).isZero(0.0);
    if (drives && sampled_at(loop, loop.elements.size() - 1) == nullptr)
      return output_level(loop, loop.elements.size() - 1);
    double mean = sampled.D, size = 0.0;
    for (std::size_t i = 0; i < sampled.C.size(); ++i) {
      if (i < states.size()) size += std::abs(sampled.C[i]) * states[i];
      if (i >= states.size()) mean += sampled.C[i];
    }
    const bool difference = states.empty() && std::abs(mean) < 1e-9 * std::abs(sampled.D);
    return size + (difference ? rate : std::abs(sampled.D) * input);
  }
};

/// Which states of Loop::continuous belong to the plant and what follows it, and which, with their names, to
/// controllers.
struct Shares {
  std::vector<std::size_t> plant;
  std::vector<std::pair<std::string, std::size_t>> controllers;

  explicit Shares(const Loop& loop) {
    for (std::size_t i = 0; i < loop.continuous->state_names.size(); ++i) {
      const std::string& name = loop.continuous->state_names[i];
      if (std::ranges::find(loop.state_names, name) != loop.state_names.end())
        plant.push_back(i);
      else
        controllers.emplace_back(name, i);
    }
  }

  /// The next `count` states of the controller at a path, which they leave: of a diagram those whose names begin with
  /// that of the block.
  std::vector<std::size_t> take(const std::string& path, std::size_t count) {
    constexpr std::string_view diagram = "diagram.";
    const std::string block = path.starts_with(diagram) ? path.substr(diagram.size()) + "." : "";
    std::vector<std::size_t> some;
    std::erase_if(controllers, [&](const auto& one) {
      const bool own = some.size() < count && one.first.starts_with(block);
      if (own) some.push_back(one.second);
      return own;
    });
    return some;
  }
};

template <class Values>
State those(const std::vector<std::size_t>& places, const Values& X) {
  State some;
  for (const std::size_t i : places) some.push_back(X[static_cast<decltype(X.size())>(i)]);
  return some;
}

/// The sizes of the linear states, and behind them those of what approximates a dead time: the state of each delayed
/// signal, the row of which the last state of its approximation has, has the size of that signal.
State with_delayed_sizes(const Loop& loop, State sizes) {
  const auto n = std::ssize(sizes);
  const Eigen::VectorXd known = Eigen::Map<const Eigen::VectorXd>(sizes.data(), n);
  sizes.resize(static_cast<std::size_t>(loop.states()));
  double size = 0.0;
  for (Eigen::Index i = loop.states() - 1; i >= n; --i) {
    const Eigen::RowVectorXd signal = loop.A.row(i).head(n);
    if (signal.norm() > 0.0) size = (signal.cwiseAbs() * known).value() / signal.norm();
    sizes[static_cast<std::size_t>(i)] = size;
  }
  return sizes;
}

}  // namespace

double sample_time(const Loop& loop) {
  for (const Element& element : loop.elements)
    if (const auto* sampled = element.as<Sampled<double>>()) return sampled->sample_time;
  return infinite;
}

double repetition_time(const Loop& loop) {
  double longest = 0.0;
  for (const Element& element : loop.elements)
    if (const auto* sampled = element.as<Sampled<double>>())
      longest = std::max(longest, sampled->sample_time * sampled->every);
  return longest;
}

State sampled_sizes(const Loop& loop, const State& continuous) {
  Shares shares(loop);
  State result = with_delayed_sizes(loop, those(shares.plant, continuous));
  const Eigen::VectorXd X = Eigen::Map<const Eigen::VectorXd>(result.data(), loop.states());
  Eigen::VectorXd outputs = Eigen::VectorXd::Zero(std::ssize(loop.elements));
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Element& element = loop.elements[k];
    const Port& port = loop.ports[k];
    SampledSizes sizes{
        (port.C.cwiseAbs() * X + port.D.cwiseAbs() * outputs).value(), (port.C_v.cwiseAbs() * X).value(), {}};
    double& output = outputs(static_cast<Eigen::Index>(k));
    output = sizes.input;
    const auto* sampled = sampled_at(loop, k);
    if (sampled) {
      sizes.states = those(shares.take(port.path, states_of_controller(*sampled)), continuous);
      output = sizes.output(loop, k);
    }
    for (int i = 0; i < element.states(); ++i) {
      const int own = i - Sampled<double>::first_own;
      if (!sampled || element.even_state(i))
        result.push_back(element.state_scale(i));
      else if (own < 0 || own >= sampled->order())
        result.push_back(output);
      else
        result.push_back(own < std::ssize(sizes.states) ? sizes.states[static_cast<std::size_t>(own)] : sizes.input);
    }
  }
  return result;
}

LoopState sampled_state(const Loop& loop, const Eigen::VectorXd& X) {
  Shares shares(loop);
  const State of_plant = those(shares.plant, X);
  const Eigen::Map<const Eigen::VectorXd> plant(of_plant.data(), std::ssize(of_plant));
  LoopState state = without_history(loop, with_constant_history(loop, plant));
  LoopField field(loop);
  field.modes() = state.modes;
  bool read = false;  // elements behind a reading begin at its output
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Element& element = loop.elements[k];
    const auto* sampled = sampled_at(loop, k);
    read = read || sampled;
    if (!read || !element.has_modes()) continue;
    std::vector<double> guards;  // which need the inputs with their drives
    field.guards(state.x, 0.0, guards);
    const std::span<double> z(state.x.data() + field.first_state(k), static_cast<std::size_t>(element.states()));
    if (sampled) {
      const auto own = z.subspan(Sampled<double>::first_own, static_cast<std::size_t>(sampled->order()));
      std::ranges::fill(own, sampled->reading(field.input(k).x));
      std::ranges::copy(those(shares.take(loop.ports[k].path, states_of_controller(*sampled)), X), own.begin());
    }
    field.modes()[k] = state.modes[k] = element.start(field.input(k), z);
  }
  return state;
}

Eigen::VectorXd continuous_state(const Loop& loop, const LoopState& here) {
  Shares shares(loop);
  const LoopField field(loop);
  Eigen::VectorXd X = Eigen::VectorXd::Zero(loop.continuous->states());
  const auto put = [&](const std::vector<std::size_t>& places, std::size_t first) {
    for (std::size_t i = 0; i < places.size(); ++i) X(static_cast<Eigen::Index>(places[i])) = here.x[first + i];
  };
  put(shares.plant, 0);
  for (std::size_t k = 0; k < loop.elements.size(); ++k)
    if (const auto* sampled = sampled_at(loop, k))
      put(shares.take(loop.ports[k].path, states_of_controller(*sampled)),
          field.first_state(k) + Sampled<double>::first_own);
  return X;
}

}  // namespace limcycle
