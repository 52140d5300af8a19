#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// A linear controller on a computer, or a part of one: its input is read every `sample_time`, or at each `every`th of
/// these ticks, its output held in between (zero-order hold) and put out `computation_delay` after each reading:
///   e_k = input at k sample_time, rounded to a multiple of input_quantum;
///   u_k = C X_k + D e_k, limited to +-limit, then rounded to a multiple of output_quantum;
///   X_(k+1) = A X_k + B e_k + hold_back (limited u_k - u_k), with clamped != 0 X_k while u_k is beyond the limit and
///   e_k has its sign (conditional integration).
/// A, B, C: matrices of the order n in rows (n^2, n, n numbers); a quantum of 0 does not round. hold_back (n numbers,
/// or none): what the limit takes off the states (back-calculation). The last `memory` of X are past inputs.
///
/// A dead time before all that a controller reads is as well one behind what it puts out: its clock runs `ahead` of the
/// rest by the dead time, and the outputs that leave the controller (`leaves`) wait for as long. At the start it has
/// read the input, as it is then, in each period of the dead time.
///
/// State: time until the next tick (s), output in force, X (n); with every > 1 the ticks to let pass; with outputs that
/// wait also the time until the first of them comes out, and all that can be waiting at once, in their order. The clock
/// is part of the state, so that a motion that repeats itself does so together with its samples. Guards: the times.
/// Mode: number of outputs that wait.
template <class S>
struct Sampled {
  S sample_time{}, computation_delay{0.0}, input_quantum{0.0}, output_quantum{0.0}, limit{infinite}, every{1.0},
      memory{0.0}, clamped{0.0}, ahead{0.0}, leaves{0.0}, D{};
  std::vector<S> A, B, C, hold_back;

  static constexpr std::string_view kind = "sampled";
  static constexpr int first_own = 2;      ///< position of X in the state
  static constexpr double latest = 100.0;  ///< samples from a reading to its output: those between are states
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "u_k = C X_k + D e_k, X_(k+1) = A X_k + B e_k, e_k = input at k sample_time; u_k is held";
  static constexpr std::string_view source =
      "Astrom, Wittenmark (1997), Computer-Controlled Systems, 3rd ed., ch. 2 and 8";

  static std::vector<Parameter<Sampled, S>> parameters() {
    return {
        {"sample_time", "s", "time between two readings", &Sampled::sample_time, positive},
        {"computation_delay", "s", "from a reading to its output", &Sampled::computation_delay, not_negative, false},
        {"input_quantum", "1", "the input is rounded to its multiples", &Sampled::input_quantum, not_negative, false},
        {"output_quantum", "1", "the output is rounded to its multiples", &Sampled::output_quantum, not_negative,
         false},
        {"limit", "1", "of the output", &Sampled::limit, {0.0, infinite, true, false}, false},
        {"every", "1", "ticks of the clock from one reading to the next", &Sampled::every, {1.0, infinite}, false},
        {"memory", "1", "past inputs among the states, the last of them", &Sampled::memory, not_negative, false},
        {"clamped", "1", "1: the states stand still at the limit", &Sampled::clamped, {0.0, 1.0}, false},
        {"ahead", "s", "dead time by which the clock is ahead of the rest", &Sampled::ahead, not_negative, false},
        {"leaves", "1", "1: the output waits for that time", &Sampled::leaves, {0.0, 1.0}, false},
        {"hold_back", "1", "change of the states by what the limit takes off", &Sampled::hold_back, any_number, false},
        {"D", "1", "feed-through", &Sampled::D, any_number},
        {"A", "1", "state matrix, row by row", &Sampled::A},
        {"B", "1", "input matrix", &Sampled::B},
        {"C", "1", "output matrix", &Sampled::C}};
  }
  std::optional<BrokenRule> validate() const {
    if (B.size() != C.size() || A.size() != B.size() * B.size())
      return BrokenRule{"A", "must be of the order of B and C"};
    if (!hold_back.empty() && hold_back.size() != B.size())
      return BrokenRule{"hold_back", "must be of the order of B and C"};
    if (computation_delay > latest * sample_time * every)
      return BrokenRule{"computation_delay", "must be at most 100 times the time between two readings"};
    return std::nullopt;
  }

  int order() const { return static_cast<int>(B.size()); }
  /// From a reading to its output.
  S delay() const { return leaves > 0.0 ? computation_delay + ahead : computation_delay; }
  bool delays() const { return delay() > 0.0; }
  bool counts() const { return every > 1.0; }
  /// Outputs that can wait at once.
  int places() const {
    constexpr double rounding = 1e-9;
    return delays() ? std::max(1, static_cast<int>(std::ceil(value_of(delay() / (sample_time * every)) - rounding)))
                    : 0;
  }
  int states() const { return first_own + order() + (counts() ? 1 : 0) + (delays() ? 1 + places() : 0); }

  /// The clock runs down; the output waits for its time only while one is pending.
  void rate(const Input<S>&, Mode mode, std::span<const S>, std::span<S> dz) const {
    std::fill(dz.begin(), dz.begin() + states(), S(0.0));
    dz[0] = S(-1.0);
    if (mode.value > 0) dz[wait()] = S(-1.0);
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return z[1]; }

  int guards(Mode mode) const { return mode.value > 0 ? 2 : 1; }
  /// The output comes before a reading at the same time.
  void guard(const Input<S>&, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (mode.value > 0) g[0] = z[wait()];
    g[mode.value > 0 ? 1 : 0] = z[0];
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (mode.value > 0 && fired == 0) return put_out(mode, z);
    z[0] = sample_time;
    return tick(in.x, mode, z);
  }
  /// The first reading is at the start, or was ahead of it; the readings before were the same.
  Mode start(const Input<double>& in, std::span<double> z) const {
    constexpr double rounding = 1e-9;
    const double period = value_of(sample_time), lead = value_of(ahead);
    z[0] = period;
    if (counts()) z[ticks()] = 0.0;
    std::fill(z.begin() + (first_own + order() - static_cast<int>(value_of(memory))), z.begin() + (first_own + order()),
              reading(in.x));
    if (lead == 0.0) return tick(in.x, {0}, z);
    Mode mode{0};
    const int ticks_before = static_cast<int>(std::ceil(lead / period - rounding));
    for (int k = 0; k < ticks_before; ++k) mode = tick(in.x, mode, z);
    z[0] = std::max(0.0, ticks_before * period - lead);
    while (mode.value > 0 && until_first(mode, z) <= rounding * period) mode = put_out(mode, z);
    if (mode.value > 0) z[wait()] = until_first(mode, z);
    return mode;
  }

  /// What is read of an input.
  template <class T>
  T reading(const T& input) const {
    return rounded(input, input_quantum);
  }

  double due(Mode mode, std::span<const double> z) const { return mode.value > 0 ? std::min(z[0], z[wait()]) : z[0]; }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return mode; }
  bool even_state(int i) const {
    const auto at = static_cast<std::size_t>(i);
    return i == 0 || (counts() && at == ticks()) || (delays() && at == wait());
  }
  Scales scales() const { return {}; }
  double state_scale(int i) const {
    const bool time = i == 0 || (delays() && static_cast<std::size_t>(i) == wait());
    return time ? value_of(sample_time) : 1.0;
  }

 private:
  std::size_t ticks() const { return first_own + B.size(); }
  std::size_t wait() const { return ticks() + (counts() ? 1 : 0); }
  /// A parameter as the scalar of the states.
  template <class T>
  static T as(const S& value) {
    if constexpr (std::same_as<T, S>)
      return value;
    else
      return T(value_of(value));
  }
  template <class T>
  static T rounded(const T& value, const S& quantum) {
    if (!(quantum > 0.0)) return value;
    const T step = as<T>(quantum);
    return step * T(std::round(value_of(value / step)));
  }
  /// Time until the first of the outputs that wait comes into force. It follows from the clock.
  template <class T>
  T until_first(Mode waiting, std::span<T> z) const {
    const T to_reading = counts() ? z[0] + z[ticks()] * as<T>(sample_time) : z[0];
    return as<T>(delay()) - T(static_cast<double>(waiting.value)) * as<T>(every * sample_time) + to_reading;
  }
  template <class T>
  Mode put_out(Mode mode, std::span<T> z) const {
    const auto left = static_cast<std::size_t>(mode.value) - 1;
    z[1] = z[wait() + 1];
    for (std::size_t k = 1; k <= left; ++k) z[wait() + k] = z[wait() + k + 1];
    z[wait() + left + 1] = T(0.0);
    mode.value -= 1;
    z[wait()] = left == 0 ? T(0.0) : until_first(mode, z);
    return mode;
  }
  template <class T>
  Mode tick(const T& input, Mode mode, std::span<T> z) const {
    if (!counts() || !(z[ticks()] > 0.5)) return read(input, mode, z);
    z[ticks()] = z[ticks()] - T(1.0);
    return mode;
  }
  /// Reads the input, computes the output and the next state.
  template <class T>
  Mode read(const T& input, Mode mode, std::span<T> z) const {
    const T e = reading(input);
    const std::size_t n = B.size();
    T u = as<T>(D) * e;
    std::vector<T> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      u += as<T>(C[i]) * z[first_own + i];
      next[i] = as<T>(B[i]) * e;
      for (std::size_t j = 0; j < n; ++j) next[i] += as<T>(A[i * n + j]) * z[first_own + j];
    }
    const T limited = u > as<T>(limit) ? as<T>(limit) : u < -as<T>(limit) ? -as<T>(limit) : u;
    for (std::size_t i = 0; i < hold_back.size(); ++i) next[i] += as<T>(hold_back[i]) * (limited - u);
    const bool pushes = value_of(limited - u) * value_of(e) < 0.0;
    if (!(clamped > 0.0 && pushes)) std::ranges::copy(next, z.begin() + first_own);
    if (counts()) z[ticks()] = T(value_of(every) - 1.0);
    u = rounded(limited, output_quantum);
    if (!delays()) {
      z[1] = u;
      return {0};
    }
    if (mode.value == places()) mode = put_out(mode, z);  // due now, but for a rounding
    if (mode.value == 0) z[wait()] = as<T>(delay());
    z[wait() + 1 + static_cast<std::size_t>(mode.value)] = u;
    return {mode.value + 1};
  }
};

}  // namespace limcycle
