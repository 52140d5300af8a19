#include "limcycle/analysis/orbit/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/linear/dense.hpp"

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
  return state_of(loop, std::move(x));
}

/// External signals of a run: the loop's constants, replaced or supplemented by the case's signals. Up to the next
/// break they are continued smoothly, so that a step that ends there is not affected by the jump. `lead`: by which the
/// reference is read ahead, s.
ExternalSignals external(const Loop& loop, const SimulateOptions& options, double lead, const double& next_break) {
  return [constants = loop.external, origin = loop.external_origin, options, lead, &next_break](
             double time, External& value, External& rate) {
    const double t = std::min(time, std::nextafter(next_break, 0.0));
    value = constants;
    rate.setZero();
    if (options.reference) {
      const double ahead = t + lead;
      rate(reference_value) = options.reference->slope(ahead);
      value(reference_value) = options.reference->at(ahead) - origin(reference_value);
      value(reference_slope) = rate(reference_value) - origin(reference_slope);
      if (options.reference->kind == Signal::Kind::sine && ahead >= options.reference->start)
        rate(reference_slope) =
            -options.reference->at(ahead) * options.reference->frequency * options.reference->frequency;
    }
    if (options.force) {
      value(external_force) += options.force->at(t);
      rate(external_force) = options.force->slope(t);
    }
  };
}

std::vector<std::string> columns(const Loop& loop, const std::vector<std::size_t>& shown) {
  std::vector<std::string> names{"t"};
  const auto states = state_names(loop);
  for (const std::size_t i : shown) names.push_back("state." + states[i]);
  names.insert(names.end(), {"y", "dy_dt"});
  for (const auto& port : loop.ports)
    for (const char* what : {".input", ".rate", ".output"}) names.push_back(port.path + what);
  return names;
}

/// Times at which a step must end: samples and breaks of the signals, in order.
std::vector<std::pair<double, bool>> stops(const SimulateOptions& options, double sample, double lead) {
  std::vector<std::pair<double, bool>> times;
  const auto count = static_cast<long>(std::floor(options.duration / sample + 1e-9));
  for (long i = 1; i <= count; ++i)
    times.emplace_back(std::min(sample * static_cast<double>(i), options.duration), true);
  if (times.empty() || times.back().first < options.duration) times.emplace_back(options.duration, true);
  if (options.force)
    for (const double t : options.force->breaks(options.duration)) times.emplace_back(t, false);
  if (options.reference)
    for (const double t : options.reference->breaks(options.duration + lead))
      if (t > lead) times.emplace_back(t - lead, false);
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

/// Where a run begins, and what is behind its states.
struct Beginning {
  State state;
  std::vector<std::size_t> shown;  ///< the states that are shown
  double lead = 0.0;               ///< by which the controller runs ahead of the plant, s
};

/// Where the states of a loop are in `in`, the same loop with further linear states or elements that keep more.
std::vector<std::size_t> own_places(const Loop& loop, const Loop& in) {
  std::vector<std::size_t> places;
  const auto add = [&](std::size_t from, int count) {
    for (int k = 0; k < count; ++k) places.push_back(from + static_cast<std::size_t>(k));
  };
  add(0, static_cast<int>(loop.states()));
  auto at = static_cast<std::size_t>(in.states());
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    add(at, loop.elements[i].states());
    at += static_cast<std::size_t>(in.elements[i].states());
  }
  return places;
}

/// One run: rows at the samples, and after every step the data for the watch of the motion.
class Running {
 public:
  Running(const Loop& loop, const SimulateOptions& options, Beginning begins)
      : loop_(loop),
        options_(options),
        begins_(std::move(begins)),
        times_(stops(options, options.sample > 0.0 ? options.sample : options.duration / 1000.0, begins_.lead)),
        next_break_(break_after(0.0)),
        field_(loop) {
    run_.columns = columns(loop, begins_.shown);
    field_.set_external(external(loop, options, begins_.lead, next_break_));
    if (!options.force && !options.reference && !loop.elements.empty())
      // Tighter tolerances do not improve turning points beyond the cubic through each step.
      watch_.emplace(loop, OutcomeOptions{std::max(options.rtol, 1e-7), 1e-9, cycle_accuracy}, typical_sizes(loop),
                     slow_time(loop));
  }

  Simulation operator()() {
    State x = begins_.state;
    field_.start(x, 0.0);
    for (auto i = static_cast<std::size_t>(loop_.states()); i < x.size(); ++i)
      if (begins_.state[i] != 0.0) x[i] = begins_.state[i];  // an element's own state named in the case
    March march(field_, stepper_kind(options_.stepper), loop_weights(loop_, options_.rtol));
    run_.stepper = to_string(march.kind());
    run_.notes = stepper_notes(loop_, march.kind(), options_.rtol);
    if (jumps_at(0.0)) kick(x, 0.0);
    march.begin(x, 0.0);
    begin(x);
    for (const auto& [until, is_sample] : times_) {
      while (march.t() < until && run_.status == Status::converged) step(march, until);
      if (run_.status != Status::converged) break;
      if (is_sample) {
        add_row(march.x(), march.t());
      } else {
        next_break_ = break_after(until);
        State at = march.x();
        if (jumps_at(until)) kick(at, until);
        march.begin(at, until);
      }
      if (options_.progress) options_.progress(march.t() / options_.duration);
    }
    conclude(march);
    return std::move(run_);
  }

 private:
  double break_after(double t) const {
    const auto next = std::ranges::find_if(times_, [t](const auto& stop) { return !stop.second && stop.first > t; });
    return next == times_.end() ? infinite : next->first;
  }

  bool jumps_at(double t) const {
    return options_.reference && options_.reference->kind == Signal::Kind::step &&
           std::abs(options_.reference->start - begins_.lead - t) <= 1e-12 * t;
  }

  /// By the derivative of a jump of the reference.
  void kick(State& x, double t) {
    const double height = options_.reference->value;
    if (const Eigen::VectorXd change = height * loop_.E.col(reference_slope); !change.isZero(0.0))
      field_.kick(x, t, change);
    for (std::size_t i = 0; i < loop_.elements.size(); ++i) {
      const Port& port = loop_.ports[i];
      const bool differentiates = port.path.ends_with(".rate") && port.c_v(reference_slope) != 0.0;
      if ((port.c(reference_slope) == 0.0 && !differentiates) || command_limit(loop_.elements[i]) > 0.0 ||
          loop_.elements[i].kind() == "relay")
        continue;
      run_.notes.push_back("the derivative of the reference's jump is an impulse, which " + port.path +
                           " is taken not to pass on");
    }
  }

  void begin(const State& x) {
    add_row(x, 0.0);
    trace(x, 0.0);
    if (watch_) watch_->begin(0.0, field_.y(x));
  }

  void step(March& march, double until) {
    if (options_.stop && options_.stop()) run_.status = Status::interrupted;
    if (options_.watch) modes_ = field_.modes();
    if (run_.status == Status::converged) run_.status = march.step(until);
    if (run_.status != Status::converged) return;
    if (options_.watch) options_.watch(field_, march, modes_);
    if (march.last().switched && march.last().t1 == march.t())
      run_.events.push_back({march.t(), loop_.ports[*march.last().switched].path});
    trace(march.x(), march.t());
    if (watch_) look(march);
  }

  void look(const March& march) {
    const OutputStep step = OutputStep::through(loop_, march.last());
    const double level = watch_->level();
    if (step.y0 < level && step.y1 >= level) watch_->crossed(step);
    if ((field_.y_rate(march.last().dx0) < 0.0) != (field_.y_rate(march.last().dx1) < 0.0)) watch_->turned(step);
    if (march.last().switched) watch_->switched(field_, march.x(), march.t(), *march.last().switched);
    if (march.t() >= watch_->next_look()) watch_->look(march.t(), march.x(), dx_, field_.modes());
  }

  void trace(const State& x, double t) {
    field_.rate(x, dx_, t);
    run_.trace.t.push_back(t);
    run_.trace.y.push_back(field_.y(x));
    run_.trace.y_origin = loop_.output_origin;
    run_.trace.rate.push_back(field_.y_rate(dx_));
  }

  void add_row(const State& x, double t) {
    field_.rate(x, dx_, t);
    std::vector<double> row{t};
    const State values = own_values(loop_, x);
    for (const std::size_t i : begins_.shown) row.push_back(values[i]);
    row.push_back(loop_.output_origin + field_.y(x));
    row.push_back(field_.y_rate(dx_));
    for (std::size_t i = 0; i < loop_.elements.size(); ++i) {
      row.push_back(field_.input(i).x);
      row.push_back(field_.input(i).v);
      row.push_back(field_.output(i));
    }
    run_.rows.push_back(std::move(row));
  }

  void conclude(const March& march) {
    run_.steps = march.steps();
    if (run_.status != Status::converged)
      run_.why =
          "the run ended at t = " + std::to_string(march.t()) + " s with status " + std::string(to_string(run_.status));
    if (run_.status == Status::not_finite) run_.outcome = Outcome::divergence;
    if (!watch_) return;
    if (watch_->decided()) run_.outcome = watch_->outcome();
    if (run_.outcome != Outcome::cycle) return;
    run_.period = watch_->period();
    run_.amplitude = watch_->amplitude();
    if (!watch_->doubtful()) return;
    SettleOptions settling;
    settling.stop = settling.shooting.stop = options_.stop;
    settling.shooting.rtol = settling.shooting.derivative_rtol = 1e-9;
    const Outcome outcome = settle(loop_, {march.x(), field_.modes()}, settling).outcome;
    if (outcome == Outcome::family) run_.outcome = outcome;
  }

  const Loop& loop_;
  const SimulateOptions& options_;
  Beginning begins_;
  std::vector<std::pair<double, bool>> times_;
  double next_break_;  ///< read by the external signals of the field
  LoopField field_;
  std::optional<OutcomeWatch> watch_;
  Simulation run_;
  State dx_;
  std::vector<Mode> modes_;  ///< before a step, for the watch function
};

std::string note_of_delay(const TimeDomainLoop& made, double delay, double up_to) {
  if (made.pade_order == 0 && made.loop.continuous)
    return "the dead time is exact: the controller reads the plant's state of " + short_number(delay) +
           " s before, and its own states are those of that later time";
  if (made.pade_order == 0)
    return "the dead time is exact: the relay acts " + short_number(delay) +
           " s after it decides, and the states of a controller are those of the decision";
  const std::string order = std::to_string(made.pade_order);
  return "the dead time is a Pade approximation of order " + order + "/" + order + ", off by at most " +
         short_number(pade_error(up_to, delay, made.pade_order), 2) + " of the delayed signal up to " +
         short_number(up_to, 3) + " rad/s; before t = 0 the loop stood as it starts";
}

Simulation simulate_with_delay(const Loop& loop, const SimulateOptions& options) {
  const double up_to = options.delay_band / loop.delay;
  const TimeDomainLoop made = in_time_domain(loop, pade_order_for(up_to, loop.delay));
  const State own = initial_state(loop, options.initial);
  const auto n = static_cast<std::ptrdiff_t>(loop.states());
  const Eigen::VectorXd X = with_constant_history(made, Eigen::Map<const Eigen::VectorXd>(own.data(), n));
  Beginning begins{State(state_names(made.loop).size(), 0.0), own_places(loop, made.loop),
                   made.pade_order == 0 ? loop.delay : 0.0};
  for (std::size_t i = 0; i < own.size(); ++i) begins.state[begins.shown[i]] = own[i];
  std::ranges::copy(X, begins.state.begin());
  Simulation run = Running(made.loop, options, std::move(begins))();
  run.notes.push_back(note_of_delay(made, loop.delay, up_to));
  return run;
}

}  // namespace

std::vector<std::string> state_names(const Loop& loop) {
  const auto base_of = [&](std::size_t i) {
    const std::string& path = loop.ports[i].path;
    if (path.starts_with("diagram.")) return path.substr(8) + ".z";
    return path == "loop.friction" ? "z" : "z_" + path.substr(path.rfind('.') + 1);
  };
  std::map<std::string, int> count, named;
  for (std::size_t i = 0; i < loop.elements.size(); ++i) count[base_of(i)] += loop.elements[i].states();
  auto names = loop.state_names;
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const std::string base = base_of(i);
    for (int k = 0; k < loop.elements[i].states(); ++k)
      names.push_back(count[base] == 1 ? base : base + std::to_string(++named[base]));
  }
  return names;
}

State own_values(const Loop& loop, State x) {
  Eigen::Map<Eigen::VectorXd> X(x.data(), loop.states());
  if (loop.origin.size() > 0) X += loop.origin;
  if (loop.own_states.size() > 0) X = (loop.own_states * X).eval();
  return x;
}

State state_of(const Loop& loop, State values) {
  Eigen::Map<Eigen::VectorXd> X(values.data(), loop.states());
  if (loop.own_states.size() > 0) X = solve(loop.own_states, Eigen::VectorXd(X));
  if (loop.origin.size() > 0) X -= loop.origin;
  return values;
}

Simulation simulate(const Loop& loop, const SimulateOptions& options) {
  check(options);
  if (loop.sampled) return simulate(*loop.sampled, options);
  if (loop.delay > 0.0) return simulate_with_delay(loop, options);
  return Running(loop, options, {initial_state(loop, options.initial), own_places(loop, loop)})();
}

}  // namespace limcycle
