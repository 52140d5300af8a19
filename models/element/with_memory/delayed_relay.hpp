#pragma once
#include <limits>

#include "limcycle/models/element/with_memory/relay.hpp"

namespace limcycle {

/// A relay with a dead time: it switches as Relay does, and each decision appears at its output `delay` later.
///
/// State: the time left, s, until each pending decision comes out, oldest first; unused ones are 0. Mode: the decision
/// in force, the output, and the pending decisions, packed (see Queue). Guards: those of the decision, then the oldest
/// timer. There is no sliding, since a decision changes the input only later. A relay that would have to keep more than
/// `capacity` decisions sets its timers to NaN, so that the run ends as not finite instead of giving a wrong result.
template <class S>
struct DelayedRelay {
  S level{}, hysteresis{0.0}, dead_zone{0.0}, delay{};

  static constexpr int capacity = 15;
  static constexpr std::string_view kind = "delayed-relay";
  static constexpr bool piecewise_affine = true;
  /// The states are times: reflecting the motion leaves them unchanged.
  static constexpr bool even_state(int) { return true; }
  static constexpr std::string_view equation = "y(t) = relay(x)(t - delay)";
  static constexpr std::string_view source = "exact: a relay commutes with a dead time behind it";

  /// Contents of a mode: values -1, 0, 1 in two bits each (0, 1, 2 stand for 0, 1, -1), the number of pending decisions
  /// in four. Mode{} is a relay that is off, with nothing pending.
  struct Queue {
    int decision = 0, output = 0, count = 0;
    int pending[capacity] = {};  ///< oldest first

    static Queue of(Mode mode) {
      Queue queue;
      std::int64_t bits = mode.value;
      const auto take = [&bits](int width) {
        const auto value = static_cast<int>(bits & ((1 << width) - 1));
        bits >>= width;
        return value;
      };
      const auto sign_of = [](int code) { return code == 2 ? -1 : code; };
      queue.decision = sign_of(take(2));
      queue.output = sign_of(take(2));
      queue.count = take(4);
      for (int& value : queue.pending) value = sign_of(take(2));
      return queue;
    }
    Mode mode() const {
      const auto code = [](int value) { return value < 0 ? std::int64_t{2} : std::int64_t{value}; };
      std::int64_t bits = 0;
      for (int i = capacity; i-- > 0;) bits = bits << 2 | (i < count ? code(pending[i]) : 0);
      return {((bits << 4 | count) << 2 | code(output)) << 2 | code(decision)};
    }
  };

  static std::vector<Parameter<DelayedRelay, S>> parameters() {
    return {{"level", "1", "output when on", &DelayedRelay::level, positive},
            {"hysteresis", "1", "half-width of the hysteresis", &DelayedRelay::hysteresis, not_negative, false},
            {"dead_zone", "1", "half-width of the dead zone", &DelayedRelay::dead_zone, not_negative, false},
            {"delay", "s", "dead time from decision to output", &DelayedRelay::delay, positive}};
  }
  std::optional<BrokenRule> validate() const { return relay().validate(); }

  int states() const { return capacity; }
  void rate(const Input<S>&, Mode mode, std::span<const S>, std::span<S> dz) const {
    const int count = Queue::of(mode).count;
    for (int i = 0; i < capacity; ++i) dz[static_cast<std::size_t>(i)] = S(i < count ? -1.0 : 0.0);
  }
  S output(const Input<S>&, Mode mode, std::span<const S>) const {
    return S(static_cast<double>(Queue::of(mode).output)) * level;
  }
  int guards(Mode mode) const {
    const Queue queue = Queue::of(mode);
    return deciding(queue) + (queue.count > 0 ? 1 : 0);
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    const Queue queue = Queue::of(mode);
    relay().guard(in, {queue.decision}, {}, g);
    if (queue.count > 0) g[static_cast<std::size_t>(deciding(queue))] = z[0];
  }
  Mode next(const Input<S>&, Mode mode, std::span<S> z, int fired) const {
    Queue queue = Queue::of(mode);
    if (fired == deciding(queue)) {
      pop(queue, z);
    } else {
      queue.decision = queue.decision == 0 ? (fired == 0 ? 1 : -1) : dead_zone > 0.0 ? 0 : -queue.decision;
      push(queue, z);
    }
    return queue.mode();
  }
  /// The input is taken as constant in the past; within the hysteresis the side of the input decides, at 0 its rate.
  Mode start(const Input<double>& in, std::span<double> z) const {
    for (int i = 0; i < capacity; ++i) z[static_cast<std::size_t>(i)] = 0.0;
    Queue queue;
    const double on = value_of(dead_zone + hysteresis);
    if (dead_zone > 0.0)
      queue.decision = in.x > on ? 1 : in.x < -on ? -1 : 0;
    else
      queue.decision = in.x > 0.0 || (in.x == 0.0 && in.v >= 0.0) ? 1 : -1;
    queue.output = queue.decision;
    return queue.mode();
  }
  double switching_input() const { return value_of(hysteresis > dead_zone ? hysteresis : dead_zone); }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const {
    Queue queue = Queue::of(mode);
    queue.decision = -queue.decision;
    queue.output = -queue.output;
    for (int& value : queue.pending) value = -value;
    return queue.mode();
  }
  Scales scales() const { return {.output = value_of(level)}; }
  double state_scale(int) const { return value_of(delay); }

  /// N of the relay with the phase shift of the dead time: N = N_relay exp(-j w delay).
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    const auto gain = relay().exact_describing_function(A, w, bias);
    if (!gain) return std::nullopt;
    return *gain * std::polar(1.0, -w * delay);
  }
  double exact_mean(double A, double bias) const requires std::same_as<S, double> {
    return relay().exact_mean(A, bias);
  }

 private:
  Relay<S> relay() const {
    Relay<S> same;
    same.level = level;
    same.hysteresis = hysteresis;
    same.dead_zone = dead_zone;
    return same;
  }
  static int deciding(const Queue& queue) { return queue.decision == 0 ? 2 : 1; }

  void push(Queue& queue, std::span<S> z) const {
    if (queue.count == capacity) {
      for (int i = 0; i < capacity; ++i) z[static_cast<std::size_t>(i)] = S(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    z[static_cast<std::size_t>(queue.count)] = delay;
    queue.pending[queue.count++] = queue.decision;
    clear_unused(queue, z);
  }
  static void pop(Queue& queue, std::span<S> z) {
    queue.output = queue.pending[0];
    --queue.count;
    for (int i = 0; i < queue.count; ++i) {
      queue.pending[i] = queue.pending[i + 1];
      z[static_cast<std::size_t>(i)] = z[static_cast<std::size_t>(i) + 1];
    }
    clear_unused(queue, z);
  }
  /// Resets timers that do not run: otherwise their deviations would persist for ever.
  static void clear_unused(const Queue& queue, std::span<S> z) {
    for (int i = queue.count; i < capacity; ++i) z[static_cast<std::size_t>(i)] = S(0.0);
  }
};

}  // namespace limcycle
