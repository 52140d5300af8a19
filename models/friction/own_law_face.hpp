#pragma once
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// What a user's own friction law says, on double; spans are as long as it has states. Missing gifts are filled in by
/// OwnLawFaceOf.
struct OwnLawFace {
  virtual ~OwnLawFace() = default;
  virtual std::string_view name() const = 0;
  virtual int states() const = 0;
  virtual double output(const Input<double>& in, Mode mode, std::span<const double> z) const = 0;
  virtual void rate(const Input<double>& in, Mode mode, std::span<const double> z, std::span<double> dz) const = 0;
  virtual int guards(Mode mode) const = 0;
  virtual void guard(const Input<double>& in, Mode mode, std::span<const double> z, std::span<double> g) const = 0;
  virtual Mode next(const Input<double>& in, Mode mode, std::span<double> z, int fired) const = 0;
  virtual Mode start(const Input<double>& in, std::span<double> z) const = 0;
  virtual bool knows_sliding() const = 0;
  virtual Mode after_sliding(const Input<double>& in, std::span<double> z) const = 0;
  virtual bool odd() const = 0;
  virtual Mode mirror(Mode mode) const = 0;
  virtual Scales scales() const = 0;
  virtual double state_scale(int i) const = 0;
  virtual bool even_state(int i) const = 0;
  virtual bool follows_position() const = 0;
  virtual bool has_storage() const = 0;
  virtual double storage(Mode mode, std::span<const double> z) const = 0;
  virtual std::optional<std::complex<double>> exact_describing_function(double A, double w, double bias) const = 0;
};

/// What holds of a law at the points where it is tried. Throws std::invalid_argument where it contradicts itself.
struct TriedLaw {
  bool depends_on_position = false;
};
TriedLaw try_own_law(const OwnLawFace& law);

/// A type that has some member of those that modes need.
template <class Law>
concept NamesModes = requires {
  &Law::guards;
}
|| requires { &Law::guard; }
|| requires { &Law::next; }
|| requires { &Law::start; };

/// A user's type behind the face.
template <class Law>
class OwnLawFaceOf final : public OwnLawFace {
  using View = std::span<const double>;
  using Room = std::span<double>;
  static constexpr bool has_states = requires(const Law law) { law.states(); };
  static constexpr bool has_rate = requires(const Law law, Input<double> in, Mode mode, View z, Room dz) {
    law.rate(in, mode, z, dz);
  };
  static constexpr bool has_modes = HasModes<Law, double>;
  static constexpr bool names_modes = NamesModes<Law>;

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
  static_assert(
      !CanHold<Law> && !requires { Law::holds; } && !NeedsDrive<Law>,
      "an own law can not hold a body at rest nor ask for the drive (CanHold, NeedsDrive): give it a bristle, or "
      "round it off about v = 0");
  static_assert(has_modes == names_modes,
                "an own law with modes needs all of guards, guard, next and start, as the concept HasModes has them");
  static_assert(
      HasStorage<Law, double> || !requires { &Law::storage; },
      "the storage of an own law is: double storage(Mode mode, std::span<const double> z) const");
  static_assert(
      KnowsSliding<Law> || !requires { &Law::after_sliding; },
      "the sliding state of an own law is: Mode after_sliding(const Input<double>& in, std::span<double> z) const");

 public:
  explicit OwnLawFaceOf(Law law) : law_(std::move(law)) {
    if constexpr (requires { law_.validate(); })
      if (const std::optional<BrokenRule> broken = law_.validate())
        throw std::invalid_argument(std::string(OwnLawFaceOf::name()) + ": " + broken->key + " " + broken->rule);
    tried_ = try_own_law(*this);
  }

  std::string_view name() const override {
    if constexpr (requires {
                    { Law::kind } -> std::convertible_to<std::string_view>;
                  })
      return Law::kind;
    return "own-law";
  }
  int states() const override {
    if constexpr (has_states) return law_.states();
    return 0;
  }
  double output(const Input<double>& in, Mode mode, View z) const override { return law_.output(in, mode, z); }
  void rate(const Input<double>& in, Mode mode, View z, Room dz) const override {
    if constexpr (has_rate) law_.rate(in, mode, z, dz);
  }
  int guards(Mode mode) const override {
    if constexpr (has_modes) return law_.guards(mode);
    return 0;
  }
  void guard(const Input<double>& in, Mode mode, View z, Room g) const override {
    if constexpr (has_modes) law_.guard(in, mode, z, g);
  }
  Mode next(const Input<double>& in, Mode mode, Room z, int fired) const override {
    if constexpr (has_modes) return law_.next(in, mode, z, fired);
    return mode;
  }
  Mode start(const Input<double>& in, Room z) const override {
    if constexpr (has_modes) return law_.start(in, z);
    return {};
  }
  bool knows_sliding() const override { return KnowsSliding<Law>; }
  Mode after_sliding(const Input<double>& in, Room z) const override {
    if constexpr (KnowsSliding<Law>) return law_.after_sliding(in, z);
    return OwnLawFaceOf::start(in, z);
  }
  bool odd() const override {
    if constexpr (requires { law_.odd(); }) return law_.odd();
    return false;
  }
  Mode mirror(Mode mode) const override {
    if constexpr (requires { law_.mirror(mode); }) return law_.mirror(mode);
    return mode;
  }
  Scales scales() const override { return law_.scales(); }
  double state_scale(int i) const override {
    if constexpr (requires { law_.state_scale(i); }) return law_.state_scale(i);
    return law_.scales().displacement;
  }
  bool even_state(int i) const override { return is_even_state(law_, i); }
  bool follows_position() const override {
    if constexpr (requires { law_.follows_position(); }) return law_.follows_position();
    return tried_.depends_on_position;
  }
  bool has_storage() const override {
    if constexpr (requires { law_.has_storage(); }) return law_.has_storage();
    return HasStorage<Law, double>;
  }
  double storage(Mode mode, View z) const override {
    if constexpr (HasStorage<Law, double>) return law_.storage(mode, z);
    return 0.0;
  }
  std::optional<std::complex<double>> exact_describing_function(double A, double w, double bias) const override {
    if constexpr (HasExactDescribingFunction<Law>) return law_.exact_describing_function(A, w, bias);
    return std::nullopt;
  }

 private:
  Law law_;
  TriedLaw tried_{};
};

}  // namespace limcycle
