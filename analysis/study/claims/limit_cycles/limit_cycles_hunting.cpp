#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/sliders/jenkins.hpp"

namespace limcycle::cycle_claims {
namespace {

/// The roots of the describing function of the friction, all with Re N < 0: none if the law has no such gain.
std::vector<Root> check_roots(const Loop& loop, const SearchBox& box, const std::string& where,
                              std::optional<std::size_t> expected, const ClaimOptions& options, ClaimChecks& checks) {
  const FirstHarmonicBalance balance(loop);
  const auto found = find_df_roots(loop, balance, box, options.stop);
  if (found.status != Status::converged && found.status != Status::no_cycle) {
    checks.stop(found.status);
    return {};
  }
  if (expected)
    checks.equal(where, "roots of the describing function", "", static_cast<double>(*expected),
                 static_cast<double>(found.roots.size()), 0.0, 1.0);
  for (const Root& root : found.roots)
    checks.at_most(where + ", " + at({{"A|m", root.amplitude}, {"w|rad/s", root.frequency}}), "Re N at the root", "N/m",
                   0.0, balance.gain(root.amplitude, root.frequency, 1e-9).real(), 0.0);
  return found.roots;
}

/// LuGre with a negative Re N: the Hurwitz servo for which the claim states a root and its place.
void check_exception(const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "LuGre, the exception";
  const Servo servo{1.0, 231468.0, 2.7672e8, 1209.58};
  checks.is_true(where, "the gains stabilise", servo.kd * servo.kp > servo.mass * servo.ki);
  const auto roots =
      check_roots(servo_loop(servo, lugre(1.5, 1.0, 0.0)), SearchBox{1e-6, 0.1, 10.0, 1e5}, where, {}, options, checks);
  checks.is_true(where, "it has a root near A = 5.6e-5 m, w = 464 rad/s", std::ranges::any_of(roots, [](const Root& r) {
                   return std::abs(r.amplitude / 5.6e-5 - 1.0) < 0.01 && std::abs(r.frequency / 464.0 - 1.0) < 0.005;
                 }));
}

/// A law whose gain has no negative part, with a friction force of about 1 N.
std::pair<const char*, Element> random_law(RandomPoints& draw) {
  const double level = draw.log_between(0.3, 3.0), stiffness = draw.log_between(10.0, 1e5);
  const double kind = draw.share();
  if (kind < 0.34) return {"Coulomb", coulomb(level * draw.between(1.0, 2.0), level, draw.between(0.0, 1.0))};
  if (kind < 0.67) {
    Jenkins<double> jenkins;
    jenkins.k = stiffness;
    jenkins.Fc = level;
    return {"Jenkins", jenkins};
  }
  Dahl<double> dahl;
  dahl.Fc = level;
  dahl.sigma0 = stiffness;
  return {"Dahl", dahl};
}

/// True if the last tenth of the points of a run stayed within 1e-3 of its start.
bool died_out(const Trace& trace) {
  const auto last = trace.y.end() - static_cast<std::ptrdiff_t>(trace.y.size() / 10);
  return std::all_of(last, trace.y.end(), [&](double y) { return std::abs(y) < 1e-3 * std::abs(trace.y.front()); });
}

bool is_hunting(const Loop& loop, double displacement, const std::string& where, const ClaimOptions& options,
                ClaimChecks& checks) {
  const auto found = settled(loop, displacement, options, 1e-4);
  // With Fs = Fc the sticks become ever longer, and rest is not recognised within every step limit.
  if (found.outcome == Outcome::undecided && (!died_out(found.trace) || (options.stop && options.stop())))
    checks.stop(options.stop && options.stop() ? Status::interrupted : Status::incomplete);
  checks.is_true(where, "it does not diverge", found.outcome != Outcome::divergence);
  return found.outcome == Outcome::cycle;
}

/// Hunting from at least one of several starts, but not from every one: see check_both_outcomes.
void check_hunting(const Servo& servo, const Element& friction, const std::string& law, double Fs, double Fc,
                   bool (*hunts)(double, double), const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = law + ", " + servo.text() + ", " + at({{"Fs|N", Fs}, {"Fc|N", Fc}});
  const Loop loop = servo_loop(servo, friction);
  bool hunting = false;
  for (const double far : {10.0, 1.0, 0.1}) {
    if (hunting && hunts(Fs, Fc)) break;
    hunting = is_hunting(loop, far * Fs / servo.kp, where, options, checks) || hunting;
  }
  checks.equal(where, "hunts", "", hunts(Fs, Fc) ? 1.0 : 0.0, hunting ? 1.0 : 0.0, 0.0, 1.0);
}

/// If the slowest pole is real, a mass can creep to the set-point without ever stopping, with the integrator settled at
/// the sliding level: rest or hunting, depending on the start.
void check_both_outcomes(const ClaimOptions& options, ClaimChecks& checks) {
  const Servo servo{0.584057, 3.98305, 2.53773, 1.45657};
  const auto friction = coulomb(0.349186, 0.317281, 0.118962);
  const auto built = hunting_cycle(servo, friction);
  const std::string where = servo.text() + ", Fs/Fc = 1.1, slowest pole real";
  checks.is_true(where, "the construction has a cycle", built.has_value());
  if (!built) return;
  const Loop loop = servo_loop(servo, friction);
  checks.is_true(where, "it hunts from 1.5 amplitudes",
                 is_hunting(loop, 1.5 * built->amplitude, where, options, checks));
  checks.is_true(where, "it does not hunt from 10 amplitudes",
                 !is_hunting(loop, 10.0 * built->amplitude, where, options, checks));
}

void check_composite(const Servo& servo, double Fs, double Fc, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = servo.text() + ", " + at({{"Fs|N", Fs}, {"Fc|N", Fc}});
  const Loop loop = servo_loop(servo, coulomb(Fs, Fc));
  const auto built = hunting_cycle(servo, coulomb(Fs, Fc));
  checks.is_true(where, "the construction has a cycle", built.has_value());
  if (!built) return;
  const auto shot = reached_cycle(loop, 1.5 * built->amplitude, where, options, checks);
  if (!shot) return;
  check_roots(loop, default_search_box(loop), where, 0, options, checks);
  CompositeSearchOptions search;
  search.frequency_min = 0.02 * shot->cycle.frequency();
  search.frequency_max = 50.0 * shot->cycle.frequency();
  search.stop = options.stop;
  const auto seen = CompositeBalance(loop).find(search);
  if (seen.status == Status::interrupted) return checks.stop(seen.status);
  checks.at_least(where, "roots of the composite describing function", "", 1.0, static_cast<double>(seen.roots.size()),
                  0.0);
}

Claim blind_claim() {
  Claim claim;
  claim.id = "B7-1";
  claim.statement =
      "The describing function of the friction alone predicts no limit cycle of a mass under any stabilising PID "
      "control, as long as the gain of the friction has no negative real or imaginary part.";
  claim.formula = "m w^2 = kp + Re N and ki = kd w^2 + Im N w contradict kd kp > m ki if Re N >= 0 and Im N >= 0";
  claim.source = "derived";
  claim.evidence = Evidence::derived;
  claim.range =
      "kd kp > m ki, Re N >= 0; random: Coulomb, Jenkins and Dahl friction of 0.3 to 3 N, m 0.3..3, sqrt(kp/m) "
      "0.5..5, margin kd kp/(m ki) 1.2..4. Not universal for LuGre, whose Re N is negative over a part of the "
      "plane: m = 1, kp = 231468, ki = 2.7672e8, kd = 1209.58 has a root near A = 5.6e-5 m, w = 464 rad/s";
  claim.test =
      "All roots in a box by subdivision, checked by the winding number; Re N at every root of LuGre (default and "
      "random gains, at most 3; the exception).";
  claim.run = [](const ClaimOptions& options) { return test_blind_describing_function(options); };
  return claim;
}

Claim hunting_claim() {
  Claim claim;
  claim.id = "B7-2";
  claim.statement =
      "A mass under stabilising PID control comes to rest with Fs = Fc (through ever smaller stick-slip); with Fs > "
      "Fc there is a limit cycle in which it hunts.";
  claim.formula = "limit cycle if and only if Fs > Fc";
  claim.source =
      "B. Armstrong-Helouvry and B. Amin (1996), Automatica 32(5), 679-692; M. Ruderman, arXiv 2006.08977 and "
      "2311.03724: abstracts read";
  claim.evidence = Evidence::read;
  claim.range =
      "no friction but Coulomb's and LuGre's; Fs clearly above Fc. Not every start hunts: where the slowest "
      "closed-loop pole is real, some creep to the set-point without ever stopping (found here; one such servo is "
      "among the fixed points). Random: gains as in B7-1, Fc 0.3..3 N, Fs/Fc 1 and 1.1..2";
  claim.test =
      "Simulation from 10, 1 and 0.1 Fs/kp until it is clear what is reached: a cycle only by shooting, rest only "
      "by the decay of all swings, to 1e-3 of the start at least. LuGre at the default gains only.";
  claim.run = [](const ClaimOptions& options) { return test_hunting(options); };
  return claim;
}

Claim construction_claim() {
  Claim claim;
  claim.id = "B7-3";
  claim.statement =
      "With ideal stiction the hunting cycle is constructed exactly from one slip and one stick; amplitude and "
      "times depend on the levels in a simple way: amplitude proportional to Fs - Fc, time of slip independent of "
      "the levels.";
  claim.formula =
      "slip from kp e + ki I = -Fs at v = 0 under m dv/dt = -(kd + sigma2) v - kp e - ki I - Fc to v = 0 at e1 = "
      "-e0; t_stick = (-I0 - I1)/e1; half-map multiplier -de1/de0, the other directions are annihilated by the "
      "stick";
  claim.source = "derived; gains and mass read in public code of the 1995 example; numbers checked by computation";
  claim.evidence = Evidence::derived;
  claim.range =
      "Fs > Fc, stabilising gains; table: m = 1, kp = 3, ki = 4, kd = 6; LuGre at the same gains by its numbers "
      "(24.43679 s, 0.063903 m); random: gains as in B7-1, Fc 0.3..3 N, Fs/Fc 1.1..2, sigma2 up to 0.3 kd";
  claim.test =
      "The construction by matrix exponentials of the slip against simulation of the whole loop with its stick and "
      "slip modes, shooting, and multipliers with saltation.";
  claim.run = [](const ClaimOptions& options) { return test_hunting_construction(options); };
  return claim;
}

Claim composite_claim() {
  Claim claim;
  claim.id = "B7-4";
  claim.statement =
      "The describing function of the friction alone does not find limit cycles that exist; with mass and friction in "
      "one block it does.";
  claim.source = "H. Olsson (1995): abstract read";
  claim.evidence = Evidence::read;
  claim.range =
      "hunting servos with ideal stiction, random gains as in B7-1, Fs/Fc 1.3..2. The period and amplitude of the "
      "block are not claimed: it is off by a factor of up to 5 and 7, and it also predicts cycles with Fs = Fc, "
      "where there are none";
  claim.test =
      "The cycle by simulation and shooting, the roots of both describing functions over a box. At most 10 random "
      "points. Gafvert's (1997) reasonable results for LuGre in a simple servo come without numbers that could be "
      "tested.";
  claim.run = [](const ClaimOptions& options) { return test_composite(options); };
  return claim;
}

}  // namespace

ClaimResult test_blind_describing_function(const ClaimOptions& options,
                                           const std::function<Servo(RandomPoints&)>& stabilised) {
  ClaimChecks checks;
  check_roots(servo_loop({}, coulomb(1.5, 1.0)), SearchBox{1e-6, 10.0, 0.01, 1000.0}, "Coulomb, default gains", 0,
              options, checks);
  check_roots(servo_loop({}, lugre(1.5, 1.0, 0.4)), SearchBox{1e-6, 1.0, 0.01, 1000.0}, "LuGre, default gains", 0,
              options, checks);
  check_exception(options, checks);
  at_random(checks, options, "B7-1", 20, [&](RandomPoints& draw) {
    const Servo servo = stabilised(draw);
    const auto [law, friction] = random_law(draw);
    const Loop loop = servo_loop(servo, friction);
    check_roots(loop, default_search_box(loop), std::string(law) + ", " + servo.text(), 0, options, checks);
  });
  at_random(checks, options, "B7-1 of LuGre", 3, [&](RandomPoints& draw) {
    const Servo servo = stabilised(draw);
    const Loop loop = servo_loop(servo, lugre(1.5, 1.0, 0.4));
    check_roots(loop, default_search_box(loop), "LuGre, " + servo.text(), 0, options, checks);
  });
  return checks.result();
}

bool hunts_by_levels(double Fs, double Fc) { return Fs > Fc; }

ClaimResult test_hunting(const ClaimOptions& options, bool (*hunts)(double, double)) {
  ClaimChecks checks;
  for (const double Fs : {1.0, 1.1, 1.5}) {
    check_hunting({}, coulomb(Fs, 1.0), "Coulomb", Fs, 1.0, hunts, options, checks);
    check_hunting({}, lugre(Fs, 1.0, 0.4), "LuGre", Fs, 1.0, hunts, options, checks);
  }
  check_both_outcomes(options, checks);
  at_random(checks, options, "B7-2", 20, [&](RandomPoints& draw) {
    const Servo servo = stabilising_servo(draw);
    const double Fc = draw.log_between(0.3, 3.0), Fs = Fc * draw.between(1.1, 2.0);
    check_hunting(servo, coulomb(Fc, Fc), "Coulomb", Fc, Fc, hunts, options, checks);
    check_hunting(servo, coulomb(Fs, Fc), "Coulomb", Fs, Fc, hunts, options, checks);
  });
  return checks.result();
}

ClaimResult test_composite(const ClaimOptions& options) {
  ClaimChecks checks;
  check_composite({}, 1.5, 1.0, options, checks);
  check_composite({}, 1.1, 1.0, options, checks);
  at_random(checks, options, "B7-4", 10, [&](RandomPoints& draw) {
    const Servo servo = stabilising_servo(draw);
    const double Fc = draw.log_between(0.3, 3.0);
    check_composite(servo, Fc * draw.between(1.3, 2.0), Fc, options, checks);
  });
  return checks.result();
}

std::vector<Claim> hunting_claims() {
  return {blind_claim(), hunting_claim(), construction_claim(), composite_claim()};
}

}  // namespace limcycle::cycle_claims
