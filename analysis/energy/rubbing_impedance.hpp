#pragma once
#include <optional>
#include <string>

#include "limcycle/analysis/energy/positive_real.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The mechanical impedance Z(s) = 1/H_v(s) that the rest of a loop shows to its friction: the force that must be put
/// in at the rubbing point, over the velocity there; H_v is from the friction force to minus the rubbing velocity. Re
/// Z(jw), its resistance (N s/m), is what of the energy the rest takes up at w: m s + kd + kp/s has kd at every w, with
/// integral action it is kd - ki/w^2.
///
/// Use (passivity theorem, applied to one period; G. Zames 1966; Khalil, Nonlinear Systems, section 6.5): if a viscous
/// term nu v makes the law passive, then in a periodic motion int (F + nu v) v dt >= 0, since the stored energy
/// returns. The rest of the loop says F_k = -Z(jkw) V_k for every harmonic, hence
///   sum over k of (Re Z(jkw) - nu) |V_k|^2 <= 0,
/// and if Re Z(jw) > nu at every w > 0, and V_0 = 0, the rubbing velocity vanishes: there is no cycle. Constant forces
/// and a constant reference act on k = 0 only, and drop out where v is the rate of a displacement that the loop feels.
/// With a mean sliding velocity (belt, ramp) F_0 V_0 stays, about which passivity says nothing: not applicable.
class RubbingImpedance {
 public:
  explicit RubbingImpedance(const Loop& loop);

  /// yes; not_applicable with the reason; undecided where Z could not be had.
  const Answer& applies() const { return applies_; }
  /// Re Z(jw) at w > 0; needs applies().
  double resistance(double w) const { return real_->at(w); }
  /// Its infimum over w > 0, N s/m: the viscous deficit that a law may have. -infinity with integral action.
  /// needs applies().
  RealPart::Least margin() const { return real_->least(); }
  /// Is the rest of the loop passive by itself (Z positive real)?
  PositiveReal rest_is_passive() const;

  /// Is there no cycle for any law that `deficit` (N s/m; negative: has as much to spare) of viscous friction makes
  /// passive? yes: proved, but for rounding. no: this does not prove it.
  Answer no_cycle(double deficit) const;

 private:
  Answer check(const Loop& loop);

  Answer applies_;
  std::optional<RealPart> real_;
  bool needs_zero_frequency_ = false;  ///< the body may drift: k = 0 counts
  bool free_mode_ = false;             ///< a mode on the imaginary axis that friction does not feel
};

}  // namespace limcycle
