#include "limcycle/analysis/orbit/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

State initial_state(const Loop& loop, const std::map<std::string, double>& named) {
  const auto names = state_names(loop);
  State x(names.size(), 0.0);
  for (const auto& [name, value] : named) {
    const auto at = std::ranges::find(names, name);
    if (at == names.end()) {
      std::string valid;
      for (const auto& n : names) valid += (valid.empty() ? "" : ", ") + n;
      throw std::invalid_argument("simulate.initial." + name + ": there is no such state; the states are " + valid);
    }
    x[static_cast<std::size_t>(at - names.begin())] = value;
  }
  return x;
}

/// External signals of a run: the loop's constants, replaced or joined by the case's signals. Up to the next break they
/// are continued smoothly from before it, so that a step that ends there does not see the jump.
ExternalSignals external(const Loop& loop, const SimulateOptions& options, const double& next_break) {
  return [constants = loop.external, options, &next_break](double time, External& value, External& rate) {
    const double t = std::min(time, std::nextafter(next_break, 0.0));
    value = constants;
    rate.setZero();
    if (options.reference) {
      value(reference_value) = options.reference->at(t);
      value(reference_slope) = options.reference->slope(t);
      rate(reference_value) = value(reference_slope);
      if (options.reference->kind == Signal::Kind::sine && t >= options.reference->start)
        rate(reference_slope) = -options.reference->at(t) * options.reference->frequency * options.reference->frequency;
    }
    if (options.force) {
      value(external_force) += options.force->at(t);
      rate(external_force) = options.force->slope(t);
    }
  };
}

void add_row(Simulation& run, LoopField& field, const State& x, double t) {
  State dx;
  field.rate(x, dx, t);
  std::vector<double> row{t};
  row.insert(row.end(), x.begin(), x.end());
  row.push_back(field.y(x));
  row.push_back(field.y_rate(dx));
  for (std::size_t i = 0; i < field.loop().elements.size(); ++i) {
    row.push_back(field.input(i).x);
    row.push_back(field.input(i).v);
    row.push_back(field.output(i));
  }
  run.rows.push_back(std::move(row));
}

std::vector<std::string> columns(const Loop& loop) {
  std::vector<std::string> names{"t"};
  for (const auto& name : state_names(loop)) names.push_back("state." + name);
  names.insert(names.end(), {"y", "dy_dt"});
  for (const auto& port : loop.ports)
    for (const char* what : {".input", ".rate", ".output"}) names.push_back(port.path + what);
  return names;
}

/// Times at which a step must end: samples and breaks of the signals, in order.
std::vector<std::pair<double, bool>> stops(const SimulateOptions& options, double sample) {
  std::vector<std::pair<double, bool>> times;
  const auto count = static_cast<long>(std::floor(options.duration / sample + 1e-9));
  for (long i = 1; i <= count; ++i)
    times.emplace_back(std::min(sample * static_cast<double>(i), options.duration), true);
  if (times.empty() || times.back().first < options.duration) times.emplace_back(options.duration, true);
  for (const auto* signal : {&options.force, &options.reference})
    if (*signal)
      for (const double t : (*signal)->breaks(options.duration)) times.emplace_back(t, false);
  std::ranges::sort(times);
  return times;
}

void check(const SimulateOptions& options) {
  if (!(options.duration > 0.0 && std::isfinite(options.duration)))
    throw std::invalid_argument("simulate.duration must be > 0 s, got " + std::to_string(options.duration));
  if (!(options.sample >= 0.0) || options.sample > options.duration)
    throw std::invalid_argument("simulate.sample must lie between 0 and the duration, got " +
                                std::to_string(options.sample));
  if (options.sample > 0.0 && options.duration / options.sample > 1e7)
    throw std::invalid_argument("simulate.sample asks for more than 1e7 rows");
}

}  // namespace

std::vector<std::string> state_names(const Loop& loop) {
  auto names = loop.state_names;
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const int count = std::visit([](const auto& e) { return e.states(); }, loop.elements[i]);
    const std::string base = loop.ports[i].path == "loop.friction" ? "z" : "z_element";
    for (int k = 0; k < count; ++k) names.push_back(count == 1 ? base : base + std::to_string(k + 1));
  }
  return names;
}

Simulation simulate(const Loop& loop, const SimulateOptions& options) {
  check(options);
  if (loop.delay > 0.0) throw std::invalid_argument("loop.plant.delay: simulate does not treat a delay yet");
  Simulation run;
  run.columns = columns(loop);
  LoopField field(loop);
  const auto times = stops(options, options.sample > 0.0 ? options.sample : options.duration / 1000.0);
  const auto break_after = [&](double t) {
    const auto next = std::ranges::find_if(times, [t](const auto& stop) { return !stop.second && stop.first > t; });
    return next == times.end() ? infinite : next->first;
  };
  double next_break = break_after(0.0);
  field.set_external(external(loop, options, next_break));
  State x = initial_state(loop, options.initial);
  const State given = x;
  field.start(x, 0.0);
  for (auto i = static_cast<std::size_t>(loop.states()); i < x.size(); ++i)
    if (given[i] != 0.0) x[i] = given[i];  // an element's own state that the case names
  March march(field, stepper_kind(options.stepper), loop_weights(loop, options.rtol));
  run.stepper = to_string(march.kind());
  march.begin(x, 0.0);
  add_row(run, field, x, 0.0);
  for (const auto& [until, is_sample] : times) {
    while (march.t() < until && run.status == Status::converged) {
      if (options.stop && options.stop()) run.status = Status::interrupted;
      if (run.status == Status::converged) run.status = march.step(until);
      if (march.last().switched && march.last().t1 == march.t())
        run.events.push_back({march.t(), loop.ports[*march.last().switched].path});
    }
    if (run.status != Status::converged) {
      run.why =
          "the run ended at t = " + std::to_string(march.t()) + " s with status " + std::string(to_string(run.status));
      break;
    }
    if (is_sample) {
      add_row(run, field, march.x(), march.t());
    } else {
      next_break = break_after(until);  // NOLINT(clang-analyzer-deadcode.DeadStores): read through the reference
      march.begin(march.x(), march.t());
    }
    if (options.progress) options.progress(march.t() / options.duration);
  }
  run.steps = march.steps();
  return run;
}

}  // namespace limcycle
