#pragma once
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// Has the law a mode in which it holds its body at rest, as set-valued friction has?
template <class E>
constexpr bool holds_rate() {
  if constexpr (CanHold<E>) return E::holds == Held::rate;
  return false;
}

/// The same of an element.
inline bool may_stick(const Element<double>& element) {
  return std::visit([]<class E>(const E&) { return holds_rate<E>(); }, element);
}

}  // namespace limcycle
