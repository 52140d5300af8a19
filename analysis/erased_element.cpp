#include "limcycle/analysis/erased_element.hpp"

namespace limcycle {
namespace {

template <class E, class S>
class FaceOf final : public ErasedElement<S>::Face {
 public:
  explicit FaceOf(E element) : e_(std::move(element)) {}

  int states() const override { return e_.states(); }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const override {
    e_.rate(in, mode, z, dz);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const override { return e_.output(in, mode, z); }
  bool has_modes() const override { return switches; }
  int guards(Mode mode) const override {
    if constexpr (switches) return e_.guards(mode);
    return 0;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const override {
    if constexpr (switches) e_.guard(in, mode, z, g);
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const override {
    if constexpr (switches) return e_.next(in, mode, z, fired);
    return mode;
  }
  Mode start(const Input<double>& in, std::span<double> z) const override {
    if constexpr (switches) return e_.start(in, z);
    return {};
  }
  bool knows_sliding() const override {
    if constexpr (requires { e_.knows_sliding(); }) return e_.knows_sliding();
    return KnowsSliding<E>;
  }
  Mode after_sliding(const Input<double>& in, std::span<double> z) const override {
    if constexpr (KnowsSliding<E>) return e_.after_sliding(in, z);
    return start(in, z);
  }
  bool odd() const override { return e_.odd(); }
  Mode mirror(Mode mode) const override { return e_.mirror(mode); }
  Scales scales() const override { return e_.scales(); }
  double state_scale(int i) const override { return e_.state_scale(i); }
  bool even_state(int i) const override { return is_even_state(e_, i); }
  Held held(Mode mode) const override {
    if constexpr (CanHold<E>) return e_.held(mode);
    return Held::nothing;
  }
  bool drive_is_of_rate() const override { return limcycle::drive_is_of_rate(e_); }
  bool arrests(Mode mode, int fired) const override { return limcycle::arrests(e_, mode, fired); }
  bool has_storage() const override {
    if constexpr (requires { e_.has_storage(); }) return e_.has_storage();
    return HasStorage<E, S>;
  }
  S storage(Mode mode, std::span<const S> z) const override {
    if constexpr (HasStorage<E, S>) return e_.storage(mode, z);
    return S(0.0);
  }
  bool needs_drive() const override { return NeedsDrive<E>; }
  bool follows_position() const override {
    if constexpr (requires { e_.follows_position(); }) return e_.follows_position();
    return false;
  }

 private:
  static constexpr bool switches = HasModes<E, S>;
  E e_;
};

}  // namespace

template <class S>
ErasedElement<S>::ErasedElement(const Element<double>& element)
    : element_(std::make_shared<Element<double>>(element)),
      face_(std::visit(
          []<template <class> class Kind>(const Kind<double>& e) -> std::shared_ptr<const Face> {
            return std::make_shared<FaceOf<Kind<S>, S>>(recast<Kind, S>(e));
          },
          element)),
      states_(face_->states()) {}

template class ErasedElement<double>;
template class ErasedElement<Dual<1>>;
template class ErasedElement<Dual<2>>;
template class ErasedElement<Dual<4>>;

}  // namespace limcycle
