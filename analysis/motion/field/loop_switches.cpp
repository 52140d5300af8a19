#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {
namespace {

using Eigen::Index;

/// True if the guard of element i, when it slides, is the velocity that its own force changes.
bool slides_through_zero(const Loop& loop, std::size_t i) {
  return loop.elements[i].may_stick() && (loop.ports[i].C_v * loop.B.col(static_cast<Index>(i))).value() != 0.0;
}

}  // namespace

std::size_t LoopField::guard_count() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < ne_; ++i)
    if (has_own_guards(i)) count += static_cast<std::size_t>(loop_->elements[i].guards(modes_[i]));
  return count;
}

void LoopField::guards(const State& x, double t, std::vector<double>& g) {
  g.resize(guard_count());
  if (g.empty()) return;
  evaluate(x, t);
  find_inputs(x);
  std::size_t at = 0;
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!has_own_guards(i)) continue;
    const auto count = static_cast<std::size_t>(loop_->elements[i].guards(modes_[i]));
    if (count == 0) continue;
    loop_->elements[i].guard(inputs_[i], modes_[i], own_states(x, i), std::span<double>(g.data() + at, count));
    at += count;
  }
}

std::size_t LoopField::owner(std::size_t guard) const {
  std::size_t at = 0;
  for (std::size_t i = 0; i < ne_; ++i) {
    if (has_own_guards(i)) at += static_cast<std::size_t>(loop_->elements[i].guards(modes_[i]));
    if (guard < at) return i;
  }
  return modes_.size();
}

double LoopField::due(const State& x) const {
  double first = infinite;
  for (const std::size_t i : clocks_) first = std::min(first, loop_->elements[i].due(modes_[i], own_states(x, i)));
  return first;
}

bool LoopField::only_clocks_run(const State& dx) const {
  const auto still = [&](std::size_t from, std::size_t to) {
    return std::all_of(dx.begin() + static_cast<std::ptrdiff_t>(from), dx.begin() + static_cast<std::ptrdiff_t>(to),
                       [](double rate) { return rate == 0.0; });
  };
  if (clocks_.empty() || !still(0, n_)) return false;
  for (std::size_t i = 0; i < ne_; ++i) {
    const std::size_t end = i + 1 < ne_ ? first_state_[i + 1] : size_;
    if (!loop_->elements[i].facts().has_clock && !still(first_state_[i], end)) return false;
  }
  return true;
}

std::size_t LoopField::clock_guard(const std::vector<double>& g) const {
  std::size_t at = 0, first = g.size();
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!has_own_guards(i)) continue;
    const std::size_t end = at + static_cast<std::size_t>(loop_->elements[i].guards(modes_[i]));
    const bool has_clock = loop_->elements[i].facts().has_clock;
    for (; at < end; ++at)
      if (has_clock && (first == g.size() || g[at] < g[first])) first = at;
  }
  return first;
}

/// Number of a guard among those of its own element.
std::size_t LoopField::first_guard_of(std::size_t i, std::size_t guard) const {
  std::size_t first = guard;
  while (first > 0 && owner(first - 1) == i) --first;
  return guard - first;
}

bool LoopField::arrests_at(std::size_t i, std::size_t guard) const {
  return loop_->elements[i].arrests(modes_[i], static_cast<int>(guard));
}

/// Removes the velocity of element i from the state, along the direction in which its force acts.
void LoopField::arrest(State& x, std::size_t i) {
  const Port& port = loop_->ports[i];
  const Eigen::VectorXd column = loop_->B.col(static_cast<Index>(i));
  Eigen::Map<Eigen::VectorXd>(x.data(), column.size()) -= column * (inputs_[i].v / (port.C_v * column).value());
}

void LoopField::fire(State& x, double t, std::size_t guard) {
  const std::size_t i = owner(guard), k = first_guard_of(i, guard);
  evaluate(x, t);
  find_inputs(x);
  if (arrests_at(i, k)) {
    arrest(x, i);
    evaluate(x, t);
    find_inputs(x);
  }
  const Mode before = modes_[i];
  const Element& element = loop_->elements[i];
  if (element.has_modes()) modes_[i] = element.next(inputs_[i], modes_[i], own_states(x, i), static_cast<int>(k));
  if (has_follower_[i]) follow_modes();
  // The located v is zero to the accuracy of the location: remove the remainder. Otherwise a body that reaches v = 0
  // and continues as before would already be past its guard, and switch for ever.
  if (held(i) == Held::rate || (before == modes_[i] && slides_through_zero(*loop_, i))) arrest(x, i);
  if (held(i) == Held::rate)
    for (const std::size_t only : held_states()) x[only] = 0.0;
}

/// The velocities of all bodies that are held: the force that stops one of them passes on to the others, which stay at
/// rest, to the last bit.
std::vector<std::size_t> LoopField::held_states() const {
  std::vector<std::size_t> at_rest;
  for (std::size_t i = 0; i < ne_; ++i)
    if (const auto only = held_state(i)) at_rest.push_back(*only);
  return at_rest;
}

void LoopField::keep_held(const State& start, State& end) const {
  for (std::size_t i = 0; i < ne_; ++i)
    if (const auto only = held_state(i)) end[*only] = start[*only];
}

bool LoopField::fire(State& x, double t, std::size_t guard, Eigen::MatrixXd& saltation) {
  SwitchSlopes slopes;
  const bool transversal = fire(x, t, guard, slopes);
  saltation = std::move(slopes.saltation);
  return transversal;
}

bool LoopField::fire(State& x, double t, std::size_t guard, SwitchSlopes& slopes) {
  const std::size_t i = owner(guard), k = first_guard_of(i, guard);
  const auto size = static_cast<Index>(size_);
  State before, after;
  rate(x, before, t);
  output_gradients(x);
  find_inputs(x);
  slopes.guard = guard_gradient(x, i, k);
  slopes.reset = reset_gradient(x, i, k);
  const Port& port = loop_->ports[i];
  const Eigen::VectorXd column = loop_->B.col(static_cast<Index>(i));
  const auto stop = [&](Eigen::MatrixXd& gradient) {  // derivative of arrest()
    const Eigen::MatrixXd velocity = port.C_v * gradient.topRows(column.size());
    gradient.topRows(column.size()) -= column * velocity / (port.C_v * column).value();
  };
  if (arrests_at(i, k)) stop(slopes.reset);
  fire(x, t, guard);
  rate(x, after, t);
  slopes.before = Eigen::Map<const Eigen::VectorXd>(before.data(), size);
  slopes.after = Eigen::Map<const Eigen::VectorXd>(after.data(), size);
  const Eigen::RowVectorXd& n = slopes.guard;
  slopes.crossing = n * slopes.before;
  const double speed = n.cwiseAbs() * slopes.before.cwiseAbs();
  if (!(std::abs(slopes.crossing) > 1e-12 * speed)) return false;
  slopes.saltation = slopes.reset + (slopes.after - slopes.reset * slopes.before) * n / slopes.crossing;
  if (held(i) == Held::rate) {  // deviations of the held velocity end here, to the last bit
    stop(slopes.reset);
    stop(slopes.saltation);
    for (const std::size_t only : held_states())
      for (Eigen::MatrixXd* gradient : {&slopes.reset, &slopes.saltation})
        gradient->row(static_cast<Index>(only)).setZero();
  }
  return true;
}

void LoopField::start(State& x, double t) {
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!has_own_guards(i)) continue;
    evaluate(x, t);
    find_inputs(x);
    const Element& element = loop_->elements[i];
    if (element.has_modes()) modes_[i] = element.start(inputs_[i], own_states(x, i));
    if (has_follower_[i]) follow_modes();
  }
}

void LoopField::kick(State& x, double t, const Eigen::VectorXd& change) {
  for (Eigen::Index i = 0; i < change.size(); ++i) x[static_cast<std::size_t>(i)] += change(i);
  evaluated_.known = false;
  for (std::size_t i = 0; i < ne_; ++i) {
    if (!has_own_guards(i) || !holds(i) || !loop_->elements[i].may_stick()) continue;
    evaluate(x, t);
    find_inputs(x);
    modes_[i] = loop_->elements[i].start(inputs_[i], own_states(x, i));
    if (has_follower_[i]) follow_modes();
  }
}

LoopState without_history(const Loop& loop, const Eigen::VectorXd& X) {
  LoopField field(loop);
  LoopState state{State(field.size(), 0.0), std::vector<Mode>(loop.elements.size())};
  Eigen::Map<Eigen::VectorXd>(state.x.data(), X.size()) = X;
  field.start(state.x, 0.0);
  state.modes = field.modes();
  return state;
}

}  // namespace limcycle
