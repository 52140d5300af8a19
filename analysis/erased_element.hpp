#pragma once
#include <memory>

#include "limcycle/analysis/dual.hpp"
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// Any element behind virtual calls, on one scalar. The methods that march an element through prescribed motion are
/// compiled once, on this class, instead of once a law: what they spend is in their own linear algebra, a virtual call
/// being some per cent of it. It has modes for all that its element knows: none are zero guards.
///
/// Made from an element on `double`; `recast` gives the same on dual numbers. Copies share the (constant) element.
template <class S>
class ErasedElement {
 public:
  /// What an element offers, on the scalar S.
  struct Face {
    virtual ~Face() = default;
    virtual int states() const = 0;
    virtual void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const = 0;
    virtual S output(const Input<S>& in, Mode mode, std::span<const S> z) const = 0;
    virtual bool has_modes() const = 0;
    virtual int guards(Mode mode) const = 0;
    virtual void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const = 0;
    virtual Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const = 0;
    virtual Mode start(const Input<double>& in, std::span<double> z) const = 0;
    virtual bool knows_sliding() const = 0;
    virtual Mode after_sliding(const Input<double>& in, std::span<double> z) const = 0;
    virtual bool odd() const = 0;
    virtual Mode mirror(Mode mode) const = 0;
    virtual Scales scales() const = 0;
    virtual double state_scale(int i) const = 0;
    virtual bool even_state(int i) const = 0;
    virtual Held held(Mode mode) const = 0;
    virtual bool drive_is_of_rate() const = 0;
    virtual bool arrests(Mode mode, int fired) const = 0;
    virtual bool has_storage() const = 0;
    virtual S storage(Mode mode, std::span<const S> z) const = 0;
    virtual bool needs_drive() const = 0;
    virtual bool follows_position() const = 0;
  };

  explicit ErasedElement(const Element<double>& element);

  static constexpr std::string_view kind = "element";
  const Element<double>& element() const { return *element_; }

  int states() const { return states_; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    face_->rate(in, mode, z, dz);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const { return face_->output(in, mode, z); }
  bool has_modes() const { return face_->has_modes(); }
  int guards(Mode mode) const { return face_->guards(mode); }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    face_->guard(in, mode, z, g);
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const { return face_->next(in, mode, z, fired); }
  Mode start(const Input<double>& in, std::span<double> z) const { return face_->start(in, z); }
  /// Whether the element tells its mode and state after sliding at in.v for long, and they; else those of no history.
  bool knows_sliding() const { return face_->knows_sliding(); }
  Mode after_sliding(const Input<double>& in, std::span<double> z) const { return face_->after_sliding(in, z); }
  bool odd() const { return face_->odd(); }
  Mode mirror(Mode mode) const { return face_->mirror(mode); }
  Scales scales() const { return face_->scales(); }
  double state_scale(int i) const { return face_->state_scale(i); }
  bool even_state(int i) const { return face_->even_state(i); }
  Held held(Mode mode) const { return face_->held(mode); }
  bool drive_is_of_rate() const { return face_->drive_is_of_rate(); }
  bool arrests(Mode mode, int fired) const { return face_->arrests(mode, fired); }
  /// Whether the element tells its stored energy, and that energy (J); 0 where it does not or has no state.
  bool has_storage() const { return face_->has_storage(); }
  S storage(Mode mode, std::span<const S> z) const { return face_->storage(mode, z); }
  bool needs_drive() const { return face_->needs_drive(); }
  /// Whether the output depends on the input itself, not only on its rate and the state.
  bool follows_position() const { return face_->follows_position(); }

 private:
  std::shared_ptr<const Element<double>> element_;
  std::shared_ptr<const Face> face_;
  int states_;
};

extern template class ErasedElement<double>;
extern template class ErasedElement<Dual<1>>;
extern template class ErasedElement<Dual<2>>;
extern template class ErasedElement<Dual<4>>;

template <>
inline ErasedElement<Dual<1>> recast<ErasedElement, Dual<1>, double>(const ErasedElement<double>& from) {
  return ErasedElement<Dual<1>>(from.element());
}
template <>
inline ErasedElement<Dual<2>> recast<ErasedElement, Dual<2>, double>(const ErasedElement<double>& from) {
  return ErasedElement<Dual<2>>(from.element());
}
template <>
inline ErasedElement<Dual<4>> recast<ErasedElement, Dual<4>, double>(const ErasedElement<double>& from) {
  return ErasedElement<Dual<4>>(from.element());
}

}  // namespace limcycle
