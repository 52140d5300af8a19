#pragma once
#include <variant>

#include "limcycle/models/element/backlash.hpp"
#include "limcycle/models/element/cubic.hpp"
#include "limcycle/models/element/dead_zone.hpp"
#include "limcycle/models/element/relay.hpp"
#include "limcycle/models/element/saturation.hpp"
#include "limcycle/models/friction/coulomb.hpp"
#include "limcycle/models/friction/dahl.hpp"
#include "limcycle/models/friction/lugre.hpp"
#include "limcycle/models/friction/stribeck.hpp"

namespace limcycle {

/// A list of class templates, and the variant of their members on one scalar.
template <template <class> class... Kinds>
struct KindList {
  template <class S>
  using On = std::variant<Kinds<S>...>;

  /// Calls visit.template operator()<Kind>() for each kind.
  static void for_each(auto&& visit) { (visit.template operator()<Kinds>(), ...); }
};

/// The list of friction laws, and of the other elements. A new law is one file and one word here.
using FrictionLaws = KindList<Coulomb, Stribeck, Dahl, LuGre>;
using ForwardElements = KindList<Relay, Saturation, DeadZone, Backlash, Cubic>;
using Elements = KindList<Coulomb, Stribeck, Dahl, LuGre, Relay, Saturation, DeadZone, Backlash, Cubic>;

/// Any friction law or element.
template <class S>
using Element = Elements::On<S>;

}  // namespace limcycle
