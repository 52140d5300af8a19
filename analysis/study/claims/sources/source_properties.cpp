#include <algorithm>
#include <cmath>

#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/claims/sources/source_documents.hpp"
#include "limcycle/analysis/study/experiments/runs/velocity_run.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {
namespace {

/// A velocity to which the law is not tuned: pieces of constant acceleration between speeds of all sizes, with
/// occasional standstills.
struct ShownMotion {
  Signal acceleration;
  double duration = 0.0;

  /// A hundred instants within each piece. Steps that end there miss no turning point of the law's deflection; longer
  /// steps do, and their forces then differ by 1e-4 to 1e-2 of Fs at any tolerance.
  std::vector<double> instants() const {
    std::vector<double> list;
    const auto& t = acceleration.times;
    for (std::size_t i = 1; i < t.size(); ++i)
      for (int k = 1; k < 100 && t[i] > t[i - 1]; ++k) list.push_back(t[i - 1] + (t[i] - t[i - 1]) * k / 100.0);
    return list;
  }
};

ShownMotion random_motion(RandomShares& random, const LawSetting& law, int pieces) {
  std::vector<double> times{0.0}, values;
  double v = 0.0;
  for (int i = 0; i < pieces; ++i) {
    const double speed = random.log_between(1e-2 * law.number("vs"), 1e2 * law.number("vs"));
    const double next = random.share() < 0.15 ? 0.0 : (random.share() < 0.6) == (v < 0.0) ? speed : -speed;
    const double mean = 0.5 * (std::abs(next) + std::abs(v));
    // Long enough for a displacement between a twentieth and twice Zb, at speeds that do not take minutes.
    const double T = mean > 0.0 ? std::min(law.number("Zb") * random.log_between(0.05, 2.0) / mean, 5.0) : 0.1;
    values.push_back((next - v) / T);
    times.push_back(times.back() + T);
    v = next;
  }
  return {piecewise_constant(times, values), times.back()};
}

/// Calls test(law, where) for the printed law, then for random ones.
template <class Test>
void over_laws(const ClaimOptions& options, int laws, ClaimChecks& checks, const Test& test) {
  RandomShares random(options.seed);
  const LawSetting printed = document_law("non-drift");
  test(printed, values_of(printed), random);
  checks.random(true);
  for (int k = 0; k < laws; ++k) {
    if (options.stop && options.stop()) return checks.stop(Status::interrupted);
    const LawSetting law = random_proposed_law(random);
    test(law, values_of(law), random);
  }
}

/// Largest difference of the force between two steppers with different tolerances, at the instants where both end
/// steps.
void two_steppers(const Element& law, const ShownMotion& motion, const std::string& where, double Fs,
                  const ClaimOptions& options, ClaimChecks& checks) {
  ForcedOptions how;
  how.duration = motion.duration;
  how.stop = options.stop;
  how.samples = motion.instants();
  how.rtol = 1e-9;
  const ForcedRun one = run_accelerated(law, motion.acceleration, how, "rodas5p");
  how.rtol = 1e-8;
  const ForcedRun two = run_accelerated(law, motion.acceleration, how, "dopri5");
  if (!completed(one, checks) || !completed(two, checks)) return;
  double worst = -1.0, of_one = 0.0, of_two = 0.0;
  for (std::size_t i = 0, k = 0; i < one.t.size(); ++i) {
    while (k + 1 < two.t.size() && two.t[k] < one.t[i]) ++k;
    if (two.t[k] != one.t[i] || std::abs(two.F[k] - one.F[i]) <= worst) continue;
    worst = std::abs(two.F[k] - one.F[i]);
    of_one = one.F[i];
    of_two = two.F[k];
  }
  checks.equal(where, "F by dopri5 against rodas5p, where they differ most", "N", of_one, of_two, 1e-6, Fs);
}

/// Two deflections on the virgin branch under one velocity never separate: the one-sided Lipschitz condition, with 0.
void do_not_part(const LawSetting& setting, const std::string& where, RandomShares& random, ClaimChecks& checks) {
  const Element law(make_law(setting));
  std::vector<double> a(static_cast<std::size_t>(law.states()), 0.0), da(a), b(a), db(a);
  const double v = random.log_between(1e-3, 1e2) * setting.number("vs");
  const Input<double> in{0.0, v, infinite};
  const Mode mode = law.start(in, a);
  b = a;
  a[0] = setting.number("Zb") * random.share();
  b[0] = setting.number("Zb") * random.share();
  law.rate(in, mode, a, da);
  law.rate(in, mode, b, db);
  checks.at_most(where + ", v = " + short_number(v) + " m/s", "rate at which two deflections part", "m/s", 0.0,
                 (da[0] - db[0]) * (a[0] < b[0] ? -1.0 : 1.0), 1e-14 * v);
}

ClaimResult uniqueness(const ClaimOptions& options) {
  ClaimChecks checks;
  over_laws(options, options.random_points, checks,
            [&](const LawSetting& setting, const std::string& where, RandomShares& random) {
              const ShownMotion motion = random_motion(random, setting, 12);
              two_steppers(make_law(setting), motion, where, setting.number("Fs"), options, checks);
              do_not_part(setting, where, random, checks);
            });
  return checks.result();
}

ClaimResult boundedness(const ClaimOptions& options) {
  ClaimChecks checks;
  over_laws(options, options.random_points, checks,
            [&](const LawSetting& setting, const std::string& where, auto& random) {
              ShownMotion motion = random_motion(random, setting, 25);
              // After a rest, in which the level has returned to Fs, a jerk to a speed far beyond vs.
              auto& t = motion.acceleration.times;
              auto& u = motion.acceleration.values;
              const double jerk = 1e4 * setting.number("vs");
              t.insert(t.end(), {motion.duration, motion.duration + 1e-2});
              u.insert(u.end(), {jerk, jerk});
              ForcedOptions how;
              how.duration = motion.duration += 1e-2;
              how.stop = options.stop;
              const ForcedRun run = run_accelerated(make_law(setting), motion.acceleration, how);
              if (!completed(run, checks)) return;
              double most = 0.0;
              for (const double F : run.F) most = std::max(most, std::abs(F));
              const double Fs = setting.number("Fs");
              checks.at_most(where, "largest |F| of an irregular motion", "N", Fs, most, 1e-7 * Fs);
            });
  return checks.result();
}

/// Checks that the printed law is certified; takes a second or more.
void certify(const ClaimOptions& options, ClaimChecks& checks) {
  const LawSetting printed = document_law("non-drift");
  PassivityOptions ask;
  ask.stop = options.stop;
  const Passivity answer = passivity(make_law(printed), ask);
  if (answer.passive == Passive::undecided)
    return checks.stop(answer.status == Status::converged ? Status::incomplete : answer.status);
  checks.is_true(values_of(printed), "passive from v to F: " + answer.method, answer.passive == Passive::yes);
}

/// The least energy that a mass has given to the law so far, when driven by a force that jumps: int u dx - m v^2/2,
/// exact between samples, where u is constant.
ClaimResult dissipativity(const ClaimOptions& options) {
  ClaimChecks checks;
  certify(options, checks);
  over_laws(options, options.random_points / 2, checks,
            [&](const LawSetting& setting, const std::string& where, auto& random) {
              const Element law = make_law(setting);
              std::vector<double> times{0.0}, values;
              for (int i = 0; i < 30; ++i) {
                times.push_back(times.back() + random.log_between(0.01, 0.5));
                values.push_back(setting.number("Fs") * random.between(-1.5, 1.5));
              }
              ForcedOptions how;
              how.duration = times.back();
              how.stop = options.stop;
              const ForcedRun run = run_forced(law, piecewise_constant(times, values), how);
              if (!completed(run, checks)) return;
              double given = 0.0, least = 0.0, turned = 0.0;
              for (std::size_t i = 1; i < run.t.size(); ++i) {
                const double push = run.u[i - 1] * (run.x[i] - run.x[i - 1]);
                given += push;
                turned += std::abs(push);
                least = std::min(least, given - 0.5 * run.v[i] * run.v[i]);
              }
              checks.at_least(where, "least energy given to it so far by a mass that is pushed about", "J", 0.0, least,
                              1e-6 * turned);
            });
  return checks.result();
}

ClaimResult stability(const ClaimOptions& options) {
  ClaimChecks checks;
  over_laws(
      options, options.random_points, checks, [&](const LawSetting& setting, const std::string& where, auto& random) {
        const double Fs = setting.number("Fs"), Fc = setting.number("Fc");
        const double kick = Fs * random.between(1.5, 5.0), hold = 0.95 * Fc * random.between(-1.0, 1.0);
        ForcedOptions how;
        how.duration = 60.0;
        how.stop = options.stop;
        const ForcedRun run =
            run_forced(make_law(setting), piecewise_constant({0.0, 0.2, how.duration}, {kick, hold}), how);
        if (!completed(run, checks)) return;
        double fastest = 0.0;
        for (const double v : run.v) fastest = std::max(fastest, std::abs(v));
        const std::string at = where + ", kicked with " + short_number(kick) + " N, then " + short_number(hold) + " N";
        checks.at_most(at, "speed after 60 s over the largest", "", 1e-6, std::abs(run.v.back()) / fastest, 0.0);
        checks.equal(at, "F at the end against the force applied", "N", hold, run.F.back(), 1e-5, Fs);
      });
  return checks.result();
}

ClaimResult steady_curve(const ClaimOptions& options) {
  ClaimChecks checks;
  over_laws(
      options, options.random_points, checks, [&](const LawSetting& setting, const std::string& where, auto& random) {
        for (const double share : {0.1, 0.5, 1.0, 2.0, 20.0, random.log_between(0.02, 50.0)}) {
          const double v = share * setting.number("vs");
          const VelocityRun run = run_constant_velocity(make_law(setting), v, 20.0 * setting.break_away / v + 1.0);
          if (run.status != Status::converged) return checks.stop(run.status);
          checks.equal(where + ", v = " + short_number(v) + " m/s", "F", "N", steady_level(setting, v), run.F.back(),
                       1e-6);
        }
      });
  return checks.result();
}

ClaimResult through_zero(const ClaimOptions& options) {
  ClaimChecks checks;
  over_laws(
      options, options.random_points / 2, checks, [&](const LawSetting& setting, const std::string& where, auto&) {
        const VelocityRun run = run_velocity(make_law(setting), 0.0, 20.0 * setting.number("Zb"), 1.0);
        if (run.status != Status::converged) return checks.stop(run.status);
        double most = 0.0, at_reversal = 0.0;
        for (const double F : run.F) most = std::max(most, std::abs(F));
        // The run begins at a reversal of the velocity: the force there is almost the same as a hundredth of Zb later.
        for (std::size_t i = 0; i < run.x.size() && std::abs(run.x[i] - run.x[0]) < 1e-6 * setting.number("Zb"); ++i)
          at_reversal = std::max(at_reversal, std::abs(run.F[i] - run.F[0]));
        checks.at_most(where, "largest |F|", "N", setting.number("Fs"), most, 1e-7 * setting.number("Fs"));
        checks.at_most(where, "change of F over the first millionth of Zb after a reversal", "N",
                       0.01 * setting.number("Fs"), at_reversal, 0.0);
      });
  return checks.result();
}

const std::string reconstructed =
    " (the equations are a reconstruction from the thesis's text: memory masing, Koizumi-Shibazaki branch)";
const std::string random_range =
    "the printed parameters (Fs = 1.5, Fc = 1, vs = 0.001, Zb = 0.001, sigma = sqrt(1e5), "
    "tau = 0.002); at random: Fc from 0.4 to 3 N, Fs up to 2 Fc, the others up to 3 times "
    "smaller or larger";

}  // namespace

std::vector<Claim> document_property_claims() {
  const std::string source =
      "thesis, section 3.7: the law has the properties uniqueness, boundedness, stability and "
      "dissipativity" +
      reconstructed;
  const auto claim = [&](std::string id, std::string statement, std::string formula, std::string test, auto run) {
    return Claim{std::move(id), std::move(statement), std::move(formula),  source, Evidence::reconstruction,
                 random_range,  std::move(test),      ClaimVerdict::holds, run};
  };
  std::vector<Claim> list{
      claim(
          "thesis-uniqueness", "For a given velocity the proposed law has one force.",
          "(dz1/dt - dz2/dt)(z1 - z2) <= 0 under one velocity",
          "an irregular velocity (constant accelerations between speeds of 0.01 to 100 vs) is marched by two steppers "
          "with different tolerances; and two deflections on the virgin branch do not part",
          uniqueness),
      claim("thesis-boundedness", "The force of the proposed law without viscous part never exceeds Fs.",
            "|F| <= max(Fs, s(0)), s(0) = Fs",
            "irregular velocities between 0.01 and 100 vs, then a jerk far beyond, from a rest", boundedness),
      claim("thesis-dissipativity",
            "The proposed law is passive from v to F, whatever its parameters: no motion takes more energy out of it "
            "than was put in.",
            "int F v dt >= 0 from the virgin state",
            "with the printed parameters the energy that could be taken out is bounded by a storage function; and the "
            "energy that a mass of 1 kg "
            "has given to the law is recorded while forces of up to 1.5 Fs push it about",
            dissipativity),
      claim(
          "thesis-stability",
          "A mass on the proposed law comes to rest, wherever it starts, as long as the force stays below the Coulomb "
          "level; the friction then balances the force.",
          "|u| < Fc: v -> 0, F -> u", "a mass of 1 kg is kicked for 0.2 s, then held by a constant force; 60 s",
          stability),
      claim("thesis-steady-curve", "At constant velocity the proposed law settles on the Stribeck curve.",
            "F = Fc + (Fs - Fc) exp(-(v/vs)^2)", "the virgin law is moved at constant speeds of 0.02 to 50 vs",
            steady_curve),
      claim("thesis-through-zero",
            "The proposed law goes from stick to slip and back, through velocity zero, without a jump and within Fs.",
            "", "imposed velocity 20 Zb cos t, steady state", through_zero)};
  list[4].source = "thesis, section 3.6.2, figure 3.36b" + reconstructed;
  list[5].source = "thesis, section 3.6.2, figure 3.36a" + reconstructed;
  return list;
}

}  // namespace limcycle
