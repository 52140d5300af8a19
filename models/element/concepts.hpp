#pragma once
#include <complex>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "limcycle/models/parameter.hpp"
#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// Input of an element at one instant.
template <class S>
struct Input {
  S x{};      ///< input signal (friction: relative displacement, m)
  S v{};      ///< its rate (friction: relative velocity, m/s)
  S drive{};  ///< the output that would hold the signal named by `Held` at its present value; +-infinity where the
              ///< input cannot be held (prescribed motion), with the sign of the next change of that signal (for
              ///< friction: the sign of dv/dt, which at v = 0 is that of the motion to come)
};

/// Discrete part of an element's state, defined by the element. It changes only at located events.
struct Mode {
  std::int64_t value = 0;
  bool operator==(const Mode&) const = default;
};

/// Signal that an element keeps at zero in its present mode, its output then being the drive.
enum class Held { nothing, input, rate };

/// Sizes at which an element's behaviour changes; infinite if there is no such size. They set tolerances and meshes.
struct Scales {
  double displacement = infinite;  ///< input change over which the internal state settles (bristle: Fs/sigma0, m)
  double velocity = infinite;      ///< input rate over which the output changes (Stribeck velocity, m/s)
  double output = 1.0;             ///< typical size of the output (N)
};

/// An element maps a signal and its rate to an output. It holds parameters only: state and mode are passed in, and the
/// rate of the state is passed out, so that one object serves many threads and methods.
///
/// Every element offers
///  - `kind`, `equation`, `source`, `parameters()`, `validate()`: its description;
///  - `states()`: number of continuous states; `rate(in, mode, z, dz)`; `output(in, mode, z)`;
///  - `odd()`: the output changes sign when input and state do; `mirror(mode)` is the mode of the mirrored motion;
///  - `scales()`, `state_scale(i)`.
/// Elements with modes (see HasModes) add guards, which are >= 0 while the mode lasts, and the next mode.
template <class E, class S>
concept LawOn = requires(const E e, const Input<S> in, Mode mode, std::span<const S> z, std::span<S> dz, int i) {
  { E::kind } -> std::convertible_to<std::string_view>;
  { e.states() } -> std::same_as<int>;
  { e.output(in, mode, z) } -> std::same_as<S>;
  e.rate(in, mode, z, dz);
  { e.odd() } -> std::same_as<bool>;
  { e.mirror(mode) } -> std::same_as<Mode>;
  { e.scales() } -> std::same_as<Scales>;
  { e.state_scale(i) } -> std::same_as<double>;
};

/// Optional: an element whose equations change at located events. `guard` writes `guards(mode)` values that are
/// non-negative while the mode lasts; when guard k turns negative, `next` returns the mode that follows, and may reset
/// the state; `start` returns the mode of an element without history at that input.
template <class E, class S>
concept HasModes = requires(const E e, const Input<S> in, Mode mode, std::span<const S> z, std::span<S> g, int k,
                            std::span<S> z_next, std::span<double> z_out, const Input<double> at) {
  { e.guards(mode) } -> std::same_as<int>;
  e.guard(in, mode, z, g);
  { e.next(in, mode, z_next, k) } -> std::same_as<Mode>;
  { e.start(at, z_out) } -> std::same_as<Mode>;
};

/// Optional: an element that can hold a signal, `holds`, at zero (set-valued laws stick, an ideal relay slides).
template <class E>
concept CanHold = requires(const E e, Mode mode) {
  { E::holds } -> std::convertible_to<Held>;
  { e.held(mode) } -> std::same_as<Held>;
};

/// Optional: a law that is set-valued at rest and returns the element of Sgn(v) in [-1, 1] that its output stands for.
template <class E, class S>
concept HasSelection = requires(const E e, Mode mode, const S output) {
  { e.selection(mode, output) } -> std::same_as<S>;
};

/// Optional: an element whose output depends on the drive, not only while it holds (a friction law that uses the
/// applied force or the sign of the acceleration). In each mode the output is affine in the drive, with a slope from 0
/// to 1, and the rate of the state does not depend on it. It stands last in a loop: its drive holds all the others.
template <class E>
concept NeedsDrive = requires {
  requires E::needs_drive;
};

/// True if the drive holds the rate of the input (friction), false if it holds the input itself.
template <class E>
bool drive_is_of_rate(const E& element) {
  if constexpr (requires { element.drive_is_of_rate(); })
    return element.drive_is_of_rate();
  else if constexpr (CanHold<E>)
    return E::holds == Held::rate;
  else
    return NeedsDrive<E>;
}

/// Speed below which the output depends on the size of the drive, not only on its sign: 0 for nearly every element. An
/// element with such a band offers `drive_band()`; under prescribed motion, where the drive has no size, its output is
/// undefined within the band.
template <class E>
double drive_band(const E& element) {
  if constexpr (requires { element.drive_band(); }) return element.drive_band();
  return 0.0;
}

/// True if the switch of guard `fired` first brings the rate of the input to zero, by an impulse of the element's
/// output (the body is stopped); `next` then receives that rate. Such an element offers `arrests(mode, fired)`.
template <class E>
bool arrests(const E& element, Mode mode, int fired) {
  if constexpr (requires { element.arrests(mode, fired); }) return element.arrests(mode, fired);
  return false;
}

/// Optional: an output that depends on the input rate (so the rate must be known before the output).
template <class E>
concept NeedsRate = requires {
  requires E::output_needs_rate;
};

/// Optional: in each mode the output, the guards and the rate of the state are affine in (x, v, drive, z), the rate in
/// x and z alone, so that a loop of such elements only is integrated exactly, with matrix exponentials.
template <class E>
concept PiecewiseAffine = requires {
  requires E::piecewise_affine;
};

/// Optional: a memoryless, single-valued, odd element whose output rises between two inputs x1 < x2 by at least
/// alpha (x2 - x1) and at most beta (x2 - x1): the pair (alpha, beta), both finite. Rigorous error bounds of the
/// describing function need it.
template <class E>
concept SlopeBounded = requires(const E e) {
  { e.slope_bounds() } -> std::same_as<std::pair<double, double>>;
};

/// Optional: an element that returns its state after long sliding at in.v. A steady drift, however slow, leads there;
/// a state that changes only in sliding (a slider that sticks) would otherwise need as many periods as the drift does.
template <class E>
concept KnowsSliding = requires(const E e, const Input<double> in, std::span<double> z) {
  { e.after_sliding(in, z) } -> std::same_as<Mode>;
};

/// True if reflecting the motion leaves state i unchanged (a lagged level, a time) instead of changing its sign. An
/// element that has such states offers `even_state(i)`.
template <class E>
bool is_even_state(const E& element, int i) {
  if constexpr (requires { element.even_state(i); }) return element.even_state(i);
  return false;
}

/// True if state i stands in this mode and neither the element's equations nor its guards depend on it: a place for a
/// return point that is not there. An element that has such states offers `unused(mode, i)`.
template <class E>
bool is_unused(const E& element, Mode mode, int i) {
  if constexpr (requires { element.unused(mode, i); }) return element.unused(mode, i);
  return false;
}

/// Optional: an element with a clock of its own: `due(mode, z)` is the time, s, until the switch that comes next by
/// that clock. All its guards are such times.
template <class E>
concept HasClock = requires(const E e, Mode mode, std::span<const double> z) {
  { e.due(mode, z) } -> std::same_as<double>;
};

/// Optional: closed-form describing function N(A, w) for the input bias + A sin wt (friction: bias t + A sin wt);
/// empty where the closed form does not hold.
template <class E>
concept HasExactDescribingFunction = requires(const E e, double a) {
  { e.exact_describing_function(a, a, a) } -> std::same_as<std::optional<std::complex<double>>>;
};

/// Optional: closed form of the mean output, `exact_mean(A, bias)`, for the same input; where only the history
/// determines it, the middle of its range.
template <class E>
concept HasExactMean = requires(const E e, double a) {
  { e.exact_mean(a, a) } -> std::same_as<double>;
};

/// Optional: a storage function U(z) >= 0 of the internal state, J, with U = 0 for an element without history and no
/// rise at a switch. A friction law is passive if v F >= dU/dt in every reachable state and mode and for every v; the
/// remainder v F - dU/dt is dissipated. A law may have a U without being passive (LuGre). One that has a U for some of
/// its parameters only offers `has_storage()`.
template <class E, class S>
concept HasStorage = requires(const E e, Mode mode, std::span<const S> z) {
  { e.storage(mode, z) } -> std::same_as<S>;
};

/// Optional: a memoryless element with a restoring output at rest, like a spring, so that the loop has no rest point
/// without it. `mean_output(b, A)` is the mean of its output for the input b + A sin wt (A = 0: the output itself),
/// `mean_slope(b, A)` the derivative of that mean with respect to b.
template <class E>
concept PullsBack = requires(const E e, double b) {
  { e.mean_output(b, b) } -> std::same_as<double>;
  { e.mean_slope(b, b) } -> std::same_as<double>;
};

/// Base of elements without internal state, modes or memory.
template <class S>
struct Memoryless {
  int states() const { return 0; }
  void rate(const Input<S>&, Mode, std::span<const S>, std::span<S>) const {}
  Mode mirror(Mode mode) const { return {-mode.value}; }
  double state_scale(int) const { return 1.0; }
  S storage(Mode, std::span<const S>) const { return S(0.0); }
};

}  // namespace limcycle
