#pragma once
#include <type_traits>

#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/gravity.hpp"
#include "limcycle/models/element/memoryless/lookup.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/memoryless/sine.hpp"
#include "limcycle/models/element/memoryless/window.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/compensation.hpp"
#include "limcycle/models/element/of_controllers/impulses.hpp"
#include "limcycle/models/element/of_controllers/output_rate.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/models/element/with_memory/hysteretic_dead_zone.hpp"
#include "limcycle/models/element/with_memory/rate_limit.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/element/with_memory/valve_stiction.hpp"
#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/lugre_spline.hpp"
#include "limcycle/models/friction/bristle/lugre_table.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/bristle/two_state.hpp"
#include "limcycle/models/friction/dry/awrejcewicz.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/kikuuwe.hpp"
#include "limcycle/models/friction/dry/quinn.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/dry/stribeck_table.hpp"
#include "limcycle/models/friction/dry/wojewoda.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/models/friction/sliders/gms_table.hpp"
#include "limcycle/models/friction/sliders/iwan.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"
#include "limcycle/models/friction/sliders/leuven.hpp"
#include "limcycle/models/friction/sliders/maxwell_slip.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"

namespace limcycle {

/// A list of class templates.
template <template <class> class... Kinds>
struct KindList {
  /// Calls `visit.template operator()<Kind>()` for each kind.
  static void for_each(auto&& visit) { (visit.template operator()<Kinds>(), ...); }
};

/// Kinds of friction laws, of elements in series after the controller, of elements on the error before it, and of those
/// that a loop makes from its other parts, which no case names. A new law is one pair of files and one word here;
/// everything else uses catalogue.hpp.
using FrictionLaws = KindList<Coulomb, Stribeck, StribeckTable, Karnopp, Quinn, Kikuuwe, Awrejcewicz, Wojewoda, Dahl,
                              BoucWen, LuGre, LuGreTable, LuGreSpline, ElastoPlastic, Leuven, Jenkins, MaxwellSlip,
                              Iwan, Gms, GmsTable, Xiong, TwoState, NonDrift>;
using ForwardElements =
    KindList<Relay, Saturation, RateLimit, DeadZone, HystereticDeadZone, Backlash, ValveStiction, Cubic, Sine, Lookup,
             ClampedPi, ResetIntegrator, StopResetIntegrator, Impulses, Window>;
using ErrorElements = KindList<DeadZone, Quantizer, Saturation>;
using MadeElements = KindList<Compensation, OutputRate, DelayedRelay, Gravity, Sampled>;

}  // namespace limcycle
