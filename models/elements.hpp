#pragma once
#include <type_traits>
#include <variant>

#include "limcycle/models/element/backlash.hpp"
#include "limcycle/models/element/compensation.hpp"
#include "limcycle/models/element/cubic.hpp"
#include "limcycle/models/element/dead_zone.hpp"
#include "limcycle/models/element/delayed_relay.hpp"
#include "limcycle/models/element/gravity.hpp"
#include "limcycle/models/element/output_rate.hpp"
#include "limcycle/models/element/quantizer.hpp"
#include "limcycle/models/element/relay.hpp"
#include "limcycle/models/element/saturation.hpp"
#include "limcycle/models/friction/awrejcewicz.hpp"
#include "limcycle/models/friction/bouc_wen.hpp"
#include "limcycle/models/friction/coulomb.hpp"
#include "limcycle/models/friction/dahl.hpp"
#include "limcycle/models/friction/elasto_plastic.hpp"
#include "limcycle/models/friction/gms.hpp"
#include "limcycle/models/friction/iwan.hpp"
#include "limcycle/models/friction/jenkins.hpp"
#include "limcycle/models/friction/karnopp.hpp"
#include "limcycle/models/friction/kikuuwe.hpp"
#include "limcycle/models/friction/leuven.hpp"
#include "limcycle/models/friction/lugre.hpp"
#include "limcycle/models/friction/lugre_spline.hpp"
#include "limcycle/models/friction/maxwell_slip.hpp"
#include "limcycle/models/friction/non_drift.hpp"
#include "limcycle/models/friction/own_law.hpp"
#include "limcycle/models/friction/quinn.hpp"
#include "limcycle/models/friction/stribeck.hpp"
#include "limcycle/models/friction/two_state.hpp"
#include "limcycle/models/friction/wojewoda.hpp"
#include "limcycle/models/friction/xiong.hpp"

namespace limcycle {

/// A list of class templates, and the variant of their members on one scalar.
template <template <class> class... Kinds>
struct KindList {
  template <class S>
  using On = std::variant<Kinds<S>...>;

  /// Calls `visit.template operator()<Kind>()` for each kind.
  static void for_each(auto&& visit) { (visit.template operator()<Kinds>(), ...); }

  /// Whether E is one of the kinds, on double.
  template <class E>
  static constexpr bool contains = (std::is_same_v<E, Kinds<double>> || ...);
};

/// Several lists in one.
template <class First, class... Rest>
struct JoinedKinds {
  using List = First;
};
template <template <class> class... A, template <class> class... B, class... Rest>
struct JoinedKinds<KindList<A...>, KindList<B...>, Rest...> : JoinedKinds<KindList<A..., B...>, Rest...> {};

/// The list of friction laws, and of the other elements. A new law is one file and one word here.
using FrictionLaws =
    KindList<Coulomb, Stribeck, Karnopp, Quinn, Kikuuwe, Awrejcewicz, Wojewoda, Dahl, BoucWen, LuGre, LuGreSpline,
             ElastoPlastic, Leuven, Jenkins, MaxwellSlip, Iwan, Gms, Xiong, TwoState, NonDrift>;
using ForwardElements = KindList<Relay, Saturation, DeadZone, Backlash, Cubic>;

/// What may stand in series after the controller, and what may act on the error before it.
using SeriesElements = JoinedKinds<FrictionLaws, ForwardElements>::List;
using ErrorElements = KindList<DeadZone, Quantizer, Saturation>;

/// What no case names as a kind: a loop makes them of its other parts.
using MadeElements = KindList<Compensation, OutputRate, DelayedRelay, Gravity>;

/// What only a program can make, from a law of its own: no case names it, no table lists it.
using ProgrammedLaws = KindList<OwnLaw>;

using Elements = JoinedKinds<SeriesElements, KindList<Quantizer>, MadeElements, ProgrammedLaws>::List;

/// Any friction law or element.
template <class S>
using Element = Elements::On<S>;

/// Name of the kind, as in a case file; of a user's own law the name that it has.
inline std::string_view kind_of(const Element<double>& element) {
  return std::visit(
      []<class E>(const E& e) -> std::string_view {
        if constexpr (ProgrammedLaws::contains<E>) return e.name();
        return E::kind;
      },
      element);
}

/// Whether a type of element is a friction law, whoever wrote it.
template <class E>
inline constexpr bool is_friction_law = FrictionLaws::contains<E> || ProgrammedLaws::contains<E>;

inline bool is_friction(const Element<double>& element) {
  return std::visit([]<class E>(const E&) { return is_friction_law<E>; }, element);
}

/// Typical sizes of what goes in and comes out.
inline Scales scales_of(const Element<double>& element) {
  return std::visit([](const auto& e) { return e.scales(); }, element);
}

}  // namespace limcycle
