/// @file
/// The claims about limit cycles (B) and stability (E), subject by subject. Each test takes the formulas that it tests
/// as an argument, the claimed ones by default, so that one can check that it rejects wrong ones.
#pragma once
#include <complex>

#include "limcycle/analysis/study/claims/limit_cycles/cycle_claims.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"

namespace limcycle::cycle_claims {

std::vector<Claim> relay_cycle_claims();      ///< B1, B2
std::vector<Claim> smooth_cycle_claims();     ///< B3
std::vector<Claim> spring_friction_claims();  ///< B4, B5
std::vector<Claim> forced_friction_claims();  ///< B6
std::vector<Claim> hunting_claims();          ///< B7
std::vector<Claim> stick_claims();            ///< B8, B9
std::vector<Claim> sliding_claims();          ///< B10

std::vector<Claim> smooth_stability_claims();  ///< E1, E3
Claim forced_smooth_claim();                   ///< E2
Claim loeb_claim();                            ///< E4

/// B1: C (I + Phi)^-1 Gamma level = hysteresis.
ClaimResult test_relay_condition(const ClaimOptions& options, const SwitchingOutput& output = switching_output);

/// A relay followed by gain exp(-delay s)/(time s + 1).
struct LagWithDeadTime {
  double gain = 1.0, time = 1.0, delay = 0.5, level = 1.0;
};
double dead_time_half_period(const LagWithDeadTime& lag);  ///< time ln(2 exp(delay/time) - 1), s
double dead_time_amplitude(const LagWithDeadTime& lag);    ///< gain level (1 - exp(-delay/time))
using OfLag = double (*)(const LagWithDeadTime&);
/// B2.
ClaimResult test_dead_time(const ClaimOptions& options, OfLag half_period = dead_time_half_period,
                           OfLag amplitude = dead_time_amplitude);

/// Series in mu, and the asymptotic period for large mu.
struct VanDerPolFormulas {
  double (*period)(double mu);           ///< error of order mu^6
  double (*frequency)(double mu);        ///< error of order mu^6
  double (*amplitude)(double mu);        ///< error of order mu^4
  double (*slow_period)(double mu);      ///< for large mu
  double (*trace)(double mu, double x);  ///< integrand of the logarithm of the multiplier
};
VanDerPolFormulas van_der_pol_formulas();
/// B3.
ClaimResult test_van_der_pol(const ClaimOptions& options, const VanDerPolFormulas& claimed = van_der_pol_formulas());
/// Integral of f(x, dx/dt) over one period of a cycle with y = x, by the trapezoidal rule with its end correction
/// interval by interval (error of order 4 in the steps of the trace); df is the derivative of f along the motion.
double along(const Cycle& cycle, const std::function<double(double x)>& f, const std::function<double(double x)>& df);

/// A mass on a spring on a running belt; levels of the friction.
struct StickSlipBelt {
  double mass = 1.0, stiffness = 2.0, speed = 0.1, Fs = 1.5, Fc = 1.0;
};
double slip_time(const StickSlipBelt& belt);       ///< (2/w0)(pi - atan(w0 (Fs - Fc)/(k speed))), s
double stick_time(const StickSlipBelt& belt);      ///< 2 (Fs - Fc)/(k speed), s
double belt_amplitude(const StickSlipBelt& belt);  ///< sqrt(((Fs - Fc)/k)^2 + (speed/w0)^2), m
using OfBelt = double (*)(const StickSlipBelt&);
/// B4.
ClaimResult test_stick_slip(const ClaimOptions& options, OfBelt slip = slip_time, OfBelt stick = stick_time,
                            OfBelt amplitude = belt_amplitude);
/// B5: loss of amplitude in each half cycle, in units of Fc/k.
ClaimResult test_free_decay(const ClaimOptions& options, double lost_each_half = 2.0);

/// F0 cos(w t) on a mass with spring and Coulomb friction.
struct ForcedOscillator {
  double ratio = 0.7;               ///< w/w0
  double force = 1.0, level = 0.2;  ///< F0, Fc
  double mass = 1.0, stiffness = 1.0;
};
double den_hartog_amplitude(const ForcedOscillator& o);  ///< (F0/k) sqrt(V^2 - (Fc/F0)^2 U^2); NaN: no such motion
double forced_df_amplitude(const ForcedOscillator& o);   ///< (F0/k) sqrt(1 - (4 Fc/(pi F0))^2)/|1 - ratio^2|
/// True if the force on the mass at its turning points exceeds the friction: k X ratio^2 > Fc.
bool never_stops(const ForcedOscillator& o, double amplitude);
using OfForced = double (*)(const ForcedOscillator&);
/// B6.
ClaimResult test_den_hartog(const ClaimOptions& options, OfForced exact = den_hartog_amplitude,
                            OfForced first_harmonic = forced_df_amplitude);

/// B7-1: a describing function whose gain has no negative real part has no root, for any servo that `stabilised` draws.
ClaimResult test_blind_describing_function(const ClaimOptions& options,
                                           const std::function<Servo(RandomPoints&)>& stabilised = stabilising_servo);
/// B7-2: hunting if and only if Fs > Fc; `hunts` is the claimed condition on the levels.
bool hunts_by_levels(double Fs, double Fc);
ClaimResult test_hunting(const ClaimOptions& options, bool (*hunts)(double Fs, double Fc) = hunts_by_levels);
/// B7-4: the composite describing function finds the hunting that the describing function of the friction misses.
ClaimResult test_composite(const ClaimOptions& options);

/// The cycle of a servo with ideal stiction, by construction: slip from break-away to the first stop, then stick.
struct HuntingCycle {
  double amplitude = 0.0;          ///< of the error, m
  double slip = 0.0, stick = 0.0;  ///< s, each twice in a period
  double multiplier = 0.0;         ///< of the half-period map
  double period() const { return 2.0 * (slip + stick); }
};
/// Nothing if there is no such cycle.
std::optional<HuntingCycle> hunting_cycle(const Servo& servo, const Coulomb<double>& friction);
using OfServo = std::function<std::optional<HuntingCycle>(const Servo&, const Coulomb<double>&)>;
/// B7-3.
ClaimResult test_hunting_construction(const ClaimOptions& options, const OfServo& construction = hunting_cycle);

/// B8: the exact condition of a cycle without stick, and of one with a stick in each half period; `hold_share` is the
/// share of Fs at which the claimed condition lets the body break away.
ClaimResult test_friction_cycles(const ClaimOptions& options, const SwitchingOutput& output = switching_output,
                                 double hold_share = 1.0);
/// B9: two laws agree on the presence of hunting; `other` makes the law that is compared with the switch law.
Element bristles(double Fs, double Fc);
ClaimResult test_switch_and_bristles(const ClaimOptions& options, Element (*other)(double, double) = bristles);

/// B10: damping of a small oscillation at w by a LuGre law that slides at v:
/// sigma2 + (sigma0 + j w sigma1)(v g'(v)/g)/(j w + sigma0 v/g), N s/m; its real part damps.
std::complex<double> dynamic_damping(const LuGre<double>& law, double v, double w);
/// g'(v) of the Gaussian Stribeck curve plus sigma2, N s/m.
double quasi_static_damping(double Fs, double Fc, double vs, double sigma2, double v);
using OfSliding = std::complex<double> (*)(const LuGre<double>&, double v, double w);
using OfLevels = double (*)(double Fs, double Fc, double vs, double sigma2, double v);
ClaimResult test_sliding(const ClaimOptions& options, OfSliding dynamic = dynamic_damping,
                         OfLevels quasi_static = quasi_static_damping);

/// E1: the logarithm of the product of the multipliers of a smooth cycle is this share of the integral of the trace.
ClaimResult test_smooth_multipliers(const ClaimOptions& options, double share_of_trace = 1.0);
/// E2: stable if and only if all |multipliers| < `bound`.
ClaimResult test_forced_smooth(const ClaimOptions& options, double bound = 1.0);
/// E3: the half map of a hunting servo with the saltation at break-away, as claimed, or without.
ClaimResult test_saltation(const ClaimOptions& options, bool at_break_away = true);
/// E4: stable if orientation (U_A V_w - U_w V_A) > 0.
ClaimResult test_loeb(const ClaimOptions& options, double orientation = 1.0);

}  // namespace limcycle::cycle_claims
