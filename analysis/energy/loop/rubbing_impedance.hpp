#pragma once
#include <optional>
#include <string>

#include "limcycle/analysis/energy/loop/positive_real.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The mechanical impedance Z(s) = 1/H_v(s) of the rest of a loop at its friction: the force applied at the rubbing
/// point, over the velocity there; H_v is from the friction force to minus the rubbing velocity. Re Z(jw), its
/// resistance (N s/m), determines the energy that the rest absorbs at w: m s + kd + kp/s has kd at every w, with
/// integral action it is kd - ki/w^2.
///
/// Use (passivity theorem, applied to one period; G. Zames 1966; Khalil, Nonlinear Systems, section 6.5): if a viscous
/// term nu v makes the law passive, then in a periodic motion int (F + nu v) v dt >= 0, since the stored energy
/// returns. The rest of the loop gives F_k = -Z(jkw) V_k for every harmonic, hence
///   sum over k of (Re Z(jkw) - nu) |V_k|^2 <= 0,
/// and if Re Z(jw) > nu at every w > 0, and V_0 = 0, the rubbing velocity vanishes: there is no cycle. Constant forces
/// and a constant reference act on k = 0 only, and drop out where v is the rate of a displacement that acts on the
/// loop. With a mean sliding velocity (belt, ramp) F_0 V_0 stays, on which passivity makes no statement: not
/// applicable.
class RubbingImpedance {
 public:
  explicit RubbingImpedance(const Loop& loop);

  /// yes; not_applicable with the reason; undecided if Z could not be computed.
  const Answer& applies() const { return applies_; }
  /// Re Z(jw) at w > 0; needs applies().
  double resistance(double w) const { return real_->at(w); }
  /// Its infimum over w > 0, N s/m: the viscous deficit that a law may have. -infinity with integral action.
  /// needs applies().
  RealPart::Least margin() const { return real_->least(); }
  /// Passivity of the rest of the loop by itself (Z positive real).
  PositiveReal rest_is_passive() const;

  /// Absence of cycles for any law that `deficit` (N s/m; negative: an excess) of viscous friction makes passive. yes:
  /// proved up to rounding. no: not proved by this method.
  Answer no_cycle(double deficit) const;

 private:
  Answer check(const Loop& loop);

  Answer applies_;
  std::optional<RealPart> real_;
  bool needs_zero_frequency_ = false;  ///< the body may drift: k = 0 counts
  bool free_mode_ = false;             ///< a mode on the imaginary axis that friction does not affect
};

}  // namespace limcycle
