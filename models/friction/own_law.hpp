#pragma once
#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

/// A type that has at least one of the members for modes.
template <class Law>
concept NamesModes = requires {
  &Law::guards;
}
|| requires { &Law::guard; }
|| requires { &Law::next; }
|| requires { &Law::start; };

/// Compile-time errors for a class that own_law() cannot take.
template <class Law>
constexpr void check_own_law() {
  using View = std::span<const double>;
  using Room = std::span<double>;
  constexpr bool has_states = requires(const Law law) { law.states(); };
  constexpr bool has_rate = requires(const Law law, Input<double> in, Mode mode, View z, Room dz) {
    law.rate(in, mode, z, dz);
  };
  static_assert(
      requires(const Law law, Input<double> in, Mode mode, View z) {
        { law.output(in, mode, z) } -> std::convertible_to<double>;
      },
      "an own law needs: double output(const Input<double>& in, Mode mode, std::span<const double> z) const");
  static_assert(
      requires(const Law law) {
        { law.scales() } -> std::same_as<Scales>;
      },
      "an own law needs: Scales scales() const, the sizes over which it changes");
  static_assert(
      has_states == has_rate,
      "an own law with a state needs both: int states() const and void rate(const Input<double>& in, Mode mode, "
      "std::span<const double> z, std::span<double> dz) const");
  static_assert(HasModes<Law, double> == NamesModes<Law>,
                "an own law with modes needs all of guards, guard, next and start, as the concept HasModes has them");
  static_assert(
      CanHold<Law> == requires { Law::holds; },
      "an own law that holds its body at rest needs both: static constexpr Held holds and Held held(Mode mode) const");
  static_assert(!CanHold<Law> || HasModes<Law, double>,
                "an own law that holds its body at rest needs modes: the guards tell when it breaks away");
  static_assert(
      HasStorage<Law, double> || !requires { &Law::storage; },
      "the storage of an own law is: double storage(Mode mode, std::span<const double> z) const");
  static_assert(
      KnowsSliding<Law> || !requires { &Law::after_sliding; },
      "the sliding state of an own law is: Mode after_sliding(const Input<double>& in, std::span<double> z) const");
}

/// A friction law of the user, ready to stand in a loop: `parts.friction = own_law(MyLaw{...})`. The same methods apply
/// to it as to those of the library. `law` is a value with const members that several threads may call at once;
/// it must offer
///  - `double output(const Input<double>& in, Mode mode, std::span<const double> z) const`: the force F, N, that
///    opposes the velocity in.v, m/s (positive for a positive velocity);
///  - `Scales scales() const`: the sizes over which it changes; meshes, tolerances and steps depend on them;
/// and, if it has a state, `int states() const`, `void rate(in, mode, z, std::span<double> dz) const` (dz/dt).
/// Optional, with the default in brackets:
///  - `kind`, a constant: its name ("own-law");
///  - `odd()`: F(-v, -z) = -F(v, z), and dz/dt likewise (false: no use is made of symmetry);
///  - `state_scale(i)`: size of a state (scales().displacement, which must then be finite);
///  - `even_state(i)` (false), `validate()` (no rule is broken);
///  - `guards`, `guard`, `next`, `start`, all four: modes that change at located events (see HasModes); and
///    `mirror(mode)` (the mode itself);
///  - `holds` and `held(mode)`: it holds its body at rest in some of its modes (see CanHold, and Coulomb for an
///  example);
///    `selection(mode, output)`: see HasSelection;
///  - `storage(mode, z)`: energy of the state, J; `after_sliding(in, z)`; `exact_describing_function(A, w, bias)`;
///  - `follows_position()`: F depends on in.x itself (found by evaluation).
///
/// Derivatives are exact for a class template on its scalar, passed on double, that can be instantiated on another one:
/// by a static `parameters()` as the laws of the library have it, or by `template <class To> MyLaw<To> on() const`. For
/// a class written on double they are differences: see Differenced.
///
/// The law is evaluated at a few dozen points with |z| <= state_scale and |v| <= 30 scales().velocity. Throws
/// std::invalid_argument for a broken rule of validate(), for sizes that are not positive, and if odd() turns out
/// wrong. An exception of the law passes through every method to its caller; NaN ends a method with Status::not_finite.
template <class Law>
Element own_law(const Law& law) {
  check_own_law<Law>();
  if constexpr (requires { law.validate(); })
    if (const std::optional<BrokenRule> broken = law.validate())
      throw std::invalid_argument(std::string(facts_of<Law>(Author::user).kind) + ": " + broken->key + " " +
                                  broken->rule);
  return Element(std::make_shared<FaceOf<Law>>(law, Author::user));
}

}  // namespace limcycle
