#include "limcycle/analysis/motion/clock_wait.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/motion/sampling.hpp"

namespace limcycle {
namespace {

constexpr double nearly_all = 1.0 - 1e-9;
constexpr double roundings_of_terms = 64.0 * std::numeric_limits<double>::epsilon();
constexpr int at_first = 32;  ///< repetitions before the first leap

/// The inputs that are read in quanta.
std::vector<double> quantized_inputs(const LoopField& field) {
  std::vector<double> inputs;
  const auto& elements = field.loop().elements;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (const auto* sampled = sampled_at(field.loop(), i); sampled && sampled->input_quantum > 0.0)
      inputs.push_back(field.input(i).x);
  return inputs;
}

bool as_expected(double change, double expected, double size) {
  return std::abs(change - expected) <= 1e-9 * std::abs(expected) + roundings_of_terms * size;
}

/// Changes until |value| reaches the bound; 0 beyond it.
double steps_within(double bound, double value, double change) {
  if (!(std::abs(value) < bound)) return 0.0;
  return change == 0.0 ? infinite : (change > 0.0 ? bound - value : bound + value) / std::abs(change);
}

}  // namespace

ClockWait::ClockWait(const Loop& loop) : loop_(loop), repetition_(repetition_time(loop)) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const auto* sampled = sampled_at(loop, i);
    if (!sampled) continue;
    catch_up_ = std::max(catch_up_, 1 + static_cast<int>(std::ceil(sampled->delay() / repetition_)));
  }
}

bool ClockWait::is_affine(const LoopField& field) const {
  for (std::size_t i = 0; i < loop_.elements.size(); ++i)
    if (!field.holds(i) && !loop_.elements[i].facts().piecewise_affine) return false;
  return true;
}

void ClockWait::begin(const LoopField& field, const State& x, double t) {
  repetitions_ = is_affine(field) ? 0 : none;
  t_ = t;
  x_ = first_x_ = x;
  modes_ = field.modes();
  first_guards_ = lowest_ = guards_ = quiet_;
  trusted_ = 0.0;
  inputs_ = quantized_inputs(field);
}

/// The guards of the elements without a clock.
void ClockWait::observe(const LoopField& field, const std::vector<double>& guards) {
  quiet_.clear();
  std::size_t at = 0;
  for (std::size_t i = 0; i < loop_.elements.size(); ++i) {
    if (loop_.ports[i].selection_of) continue;  // which has none of its own
    const Element& element = loop_.elements[i];
    const auto end = at + static_cast<std::size_t>(element.guards(field.modes()[i]));
    if (!element.facts().has_clock)
      quiet_.insert(quiet_.end(), guards.begin() + static_cast<std::ptrdiff_t>(at),
                    guards.begin() + static_cast<std::ptrdiff_t>(end));
    at = end;
  }
}

/// The size of the terms that a state is the sum of: one that stands still trembles by their roundings.
State ClockWait::term_sizes(const LoopField& field, const State& x) const {
  State sizes(x.size());
  std::ranges::transform(x, sizes.begin(), [](double value) { return std::abs(value); });
  for (std::size_t i = 0; i < loop_.elements.size(); ++i) {
    const auto* sampled = sampled_at(loop_, i);
    if (!sampled) continue;
    const std::size_t first = field.first_state(i), own = first + Sampled<double>::first_own, n = sampled->C.size();
    const double read = std::abs(sampled->reading(field.input(i).x));
    double output = std::abs(sampled->D) * read;
    for (std::size_t k = 0; k < n; ++k) {
      output += std::abs(sampled->C[k] * x[own + k]);
      sizes[own + k] = std::abs(sampled->B[k]) * read;
      for (std::size_t j = 0; j < n; ++j) sizes[own + k] += std::abs(sampled->A[k * n + j] * x[own + j]);
    }
    sizes[first + 1] = output;
    const auto end = first + static_cast<std::size_t>(sampled->states());
    for (auto k = end - static_cast<std::size_t>(sampled->places()); k < end; ++k) sizes[k] = output;
  }
  return sizes;
}

/// True if the last repetition had the change of the first one.
bool ClockWait::goes_on(const LoopField& field, const State& x) const {
  if (field.modes() != modes_ || quiet_.size() != lowest_.size() || quantized_inputs(field) != inputs_) return false;
  // After a leap an output, and those that wait for their delay, are those of the states but for the error of the leap.
  if (repetitions_ < catch_up_) return true;
  const State sizes = term_sizes(field, x);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!as_expected(x[i] - x_[i], change_[i], sizes[i])) return false;
  const double forces = sizes.empty() ? 0.0 : *std::ranges::max_element(sizes);
  for (std::size_t j = 0; j < guards_.size(); ++j)
    if (!as_expected(quiet_[j] - guards_[j], slopes_[j], std::abs(quiet_[j]) + forces)) return false;
  return true;
}

/// What a controller puts out before its limit and its rounding, and the change of that in a repetition.
std::pair<double, double> ClockWait::next_output(const Sampled<double>& sampled, double input, std::size_t first,
                                                 const State& x) const {
  double output = sampled.D * sampled.reading(input), change = 0.0;
  for (std::size_t k = 0; k < sampled.C.size(); ++k) {
    const std::size_t state = first + Sampled<double>::first_own + k;
    output += sampled.C[k] * x[state];
    change += sampled.C[k] * change_[state];
  }
  return {output, change};
}

/// Repetitions until a guard could be zero, an output at its limit, or rounded to another of its quanta.
double ClockWait::room(const LoopField& field, const State& x) const {
  double most = trusted_;
  for (std::size_t j = 0; j < lowest_.size(); ++j)
    if (slopes_[j] < 0.0) most = std::min(most, lowest_[j] / -slopes_[j] - spare());
  for (std::size_t i = 0; i < loop_.elements.size(); ++i) {
    const auto* sampled = sampled_at(loop_, i);
    if (!sampled) continue;
    const auto [output, change] = next_output(*sampled, field.input(i).x, field.first_state(i), x);
    most = std::min(most, steps_within(sampled->limit, output, change) - spare());
    // Rounded as the output in force: a new quantum comes into force after the next reading, and after its delay.
    const double in_force = x[field.first_state(i) + 1];
    if (const double quantum = sampled->output_quantum; quantum > 0.0)
      most = std::min(most, steps_within(0.5 * quantum, output - in_force, change) - spare());
  }
  return most;
}

ClockWait::Leap ClockWait::over(const State& x, double t, double times) {
  Leap leap{x, t + times * repetition_};
  for (std::size_t i = 0; i < x.size(); ++i) leap.x[i] += times * change_[i];
  trusted_ += times;
  repetitions_ = 0;
  x_ = leap.x;
  t_ = leap.t;
  guards_.clear();
  std::ranges::fill(lowest_, infinite);
  return leap;
}

std::optional<ClockWait::Leap> ClockWait::look(const LoopField& field, const State& x, double t,
                                               const std::vector<double>& guards, double t_end) {
  observe(field, guards);
  if (repetitions_ == none) {
    begin(field, x, t);
    return std::nullopt;
  }
  for (std::size_t j = 0; j < std::min(lowest_.size(), quiet_.size()); ++j)
    lowest_[j] = std::min(lowest_[j], quiet_[j]);
  const double roundings_of_time = 1e-15 * std::abs(t);
  if (t - t_ < nearly_all * repetition_ - roundings_of_time) return std::nullopt;
  if (!goes_on(field, x)) {
    begin(field, x, t);
    return std::nullopt;
  }
  const bool first = trusted_ == 0.0;
  ++repetitions_;
  if (first) {  // the change so far, as exact as the wait is long
    change_.resize(x.size());
    slopes_.resize(quiet_.size());
    const State sizes = term_sizes(field, x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      change_[i] = (x[i] - first_x_[i]) / repetitions_;
      if (std::abs(change_[i]) <= roundings_of_terms * sizes[i]) change_[i] = 0.0;
    }
    for (std::size_t j = 0; j < quiet_.size(); ++j) slopes_[j] = (quiet_[j] - first_guards_[j]) / repetitions_;
    if (repetitions_ == at_first) trusted_ = at_first;
  }
  x_ = x;
  t_ = t;
  guards_ = quiet_;
  std::optional<Leap> leap;
  if (trusted_ > 0.0 && repetitions_ > catch_up_) {
    const double times = std::floor(std::min(room(field, x), (t_end - t) / repetition_ - 1.0));
    if (times >= at_first) leap = over(x, t, times);
  }
  if (!leap) lowest_ = quiet_;
  return leap;
}

}  // namespace limcycle
