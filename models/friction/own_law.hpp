#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "limcycle/models/friction/own_law_face.hpp"

namespace limcycle {

/// A friction law of a user's own, beside those of the library: it goes through the same methods. Made by own_law().
///
/// The law itself is written on `double`. On dual numbers its derivatives are central differences by each variable q
/// that varies,
///   df/dq = (f(q + h) - f(q - h))/2h + O(h^2),   h = eps^(1/3) max(|q|, L),  eps = 2.2e-16,
/// with L the size that the law states for q: its `scales()` for x and v, its `state_scale(i)` for a state. For x,
/// which may move along without end, h = eps^(1/3) L + eps^(1/2) |x|. Where the law has a corner, the difference is the
/// mean slope over 2h. Relative error of a smooth law: about 1e-9. Cost: 2 evaluations for every variable.
template <class S>
class OwnLaw {
 public:
  static constexpr std::string_view kind = "own-law";
  static constexpr std::string_view equation = "that of a type of the user's own";
  static constexpr std::string_view source = "the program that made it";
  static constexpr bool output_needs_rate = true;  // nothing else is known of it

  explicit OwnLaw(std::shared_ptr<const OwnLawFace> law) : law_(std::move(law)) {}

  /// The same law on another scalar.
  template <class To>
  OwnLaw<To> on() const {
    return OwnLaw<To>(law_);
  }
  /// What the user's type calls itself.
  std::string_view name() const { return law_->name(); }

  static std::vector<Parameter<OwnLaw, S>> parameters() { return {}; }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return law_->states(); }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    S force[1];
    ask(in, z, force,
        [&](const Input<double>& at, auto own, std::span<double> out) { out[0] = law_->output(at, mode, own); });
    return force[0];
  }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    ask(in, z, dz.first(count()),
        [&](const Input<double>& at, auto own, std::span<double> out) { law_->rate(at, mode, own, out); });
  }
  int guards(Mode mode) const { return law_->guards(mode); }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    ask(in, z, g.first(static_cast<std::size_t>(guards(mode))),
        [&](const Input<double>& at, auto own, std::span<double> out) { law_->guard(at, mode, own, out); });
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    const std::vector<S> before(z.begin(), z.begin() + law_->states());
    Mode after = mode;
    bool first = true;  // the point itself: its neighbours tell derivatives only
    ask(in, before, z.first(count()), [&](const Input<double>& at, auto own, std::span<double> out) {
      std::ranges::copy(own, out.begin());
      const Mode reached = law_->next(at, mode, out, fired);
      if (std::exchange(first, false)) after = reached;
    });
    return after;
  }
  Mode start(const Input<double>& in, std::span<double> z) const { return law_->start(in, z.first(count())); }
  bool knows_sliding() const { return law_->knows_sliding(); }
  Mode after_sliding(const Input<double>& in, std::span<double> z) const {
    return law_->after_sliding(in, z.first(count()));
  }

  bool odd() const { return law_->odd(); }
  Mode mirror(Mode mode) const { return law_->mirror(mode); }
  Scales scales() const { return law_->scales(); }
  double state_scale(int i) const { return law_->state_scale(i); }
  bool even_state(int i) const { return law_->even_state(i); }
  bool follows_position() const { return law_->follows_position(); }
  bool has_storage() const { return law_->has_storage(); }
  S storage(Mode mode, std::span<const S> z) const {
    S energy[1];
    ask({}, z, energy,
        [&](const Input<double>&, auto own, std::span<double> out) { out[0] = law_->storage(mode, own); });
    return energy[0];
  }
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    return law_->exact_describing_function(A, w, bias);
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(law_->states()); }

  /// Values of `law`, and on other scalars than double derivatives by differences.
  template <class Law>
  void ask(const Input<S>& in, std::span<const S> z, std::span<S> out, const Law& law) const {
    z = z.first(std::min(count(), z.size()));
    if constexpr (std::is_same_v<S, double>)
      law(in, z, out);
    else
      difference(in, z, out, law);
  }

  template <class Law>
  void difference(const Input<S>& in, std::span<const S> z, std::span<S> out, const Law& law) const {
    Input<double> at{value_of(in.x), value_of(in.v), value_of(in.drive)};
    std::vector<double> own, up(out.size()), down(out.size());
    for (const S& state : z) own.push_back(value_of(state));
    law(at, std::span<const double>(own), std::span<double>(up));
    std::ranges::copy(up, out.begin());
    const auto along = [&](const S& seeded, double& variable, double h) {
      if (is_constant(seeded)) return;
      const double middle = variable, right = middle + h, left = middle - h;
      variable = right;
      law(at, std::span<const double>(own), std::span<double>(up));
      variable = left;
      law(at, std::span<const double>(own), std::span<double>(down));
      variable = middle;
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = out[i] + (up[i] - down[i]) / (right - left) * (seeded - middle);
    };
    const double third = std::cbrt(epsilon);
    const Scales scales = law_->scales();
    along(in.x, at.x, third * size_of(scales.displacement, at.x) + std::sqrt(epsilon) * std::abs(at.x));
    along(in.v, at.v, third * std::max(std::abs(at.v), size_of(scales.velocity, at.v)));
    for (std::size_t i = 0; i < own.size(); ++i)
      along(z[i], own[i], third * std::max(std::abs(own[i]), law_->state_scale(static_cast<int>(i))));
  }

  /// A size that is stated, else that of the value, else 1.
  static double size_of(double stated, double value) {
    if (std::isfinite(stated) && stated > 0.0) return stated;
    return value != 0.0 && std::isfinite(value) ? std::abs(value) : 1.0;
  }
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  std::shared_ptr<const OwnLawFace> law_;
};

/// A user's own friction law, ready to stand in a loop: `parts.friction = own_law(MyLaw{...})`. `law` is a value with
/// const members that several threads may call at once; it must offer
///  - `double output(const Input<double>& in, Mode mode, std::span<const double> z) const`: the force F, N, that
///  opposes
///    the velocity in.v, m/s (positive for a positive velocity);
///  - `Scales scales() const`: the sizes over which it changes; meshes, tolerances and steps rest on them;
/// and, if it has a state, `int states() const`, `void rate(in, mode, z, std::span<double> dz) const` (dz/dt).
/// Optional, with what is taken where they are missing:
///  - `kind`, a constant: its name ("own-law");
///  - `odd()`: F(-v, -z) = -F(v, z), and dz/dt likewise (false: nothing is made of symmetry);
///  - `state_scale(i)`: size of a state (scales().displacement, which must then be finite);
///  - `even_state(i)` (false), `validate()` (nothing is broken);
///  - `guards`, `guard`, `next`, `start`, all four: modes that change at located events (see HasModes); and
///  `mirror(mode)`
///    (the mode itself);
///  - `storage(mode, z)`: energy of the state, J; `after_sliding(in, z)`; `exact_describing_function(A, w, bias)`;
///  - `follows_position()`: F depends on in.x itself (found out by trying).
/// The force must not depend on in.drive (whose sign may choose a mode): laws that hold a body at rest (CanHold,
/// NeedsDrive) can not be carried and do not compile; give the law a bristle, or round it off about v = 0.
///
/// The law is tried at a few dozen points with |z| <= state_scale and |v| <= 30 scales().velocity. Throws
/// std::invalid_argument for a broken rule of validate(), for sizes that are not positive, and if odd() turns out
/// wrong. What the law throws passes through every method to its caller; NaN ends them with Status::not_finite.
template <class Law>
OwnLaw<double> own_law(Law law) {
  return OwnLaw<double>(std::make_shared<const OwnLawFaceOf<Law>>(std::move(law)));
}

}  // namespace limcycle
