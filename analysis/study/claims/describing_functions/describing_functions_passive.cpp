#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;

/// Laws that are passive with the values of law_settings(), by a storage function or because F v >= 0.
constexpr std::array passive_kinds{"coulomb", "stribeck", "kikuuwe",      "dahl",  "bouc-wen",
                                   "jenkins", "iwan",     "maxwell-slip", "xiong", "non-drift"};
/// Laws that are not passive with these values (LuGre and its kin, GMS), or of which it is not established.
constexpr std::array other_kinds{"lugre", "lugre-spline", "elasto-plastic", "gms", "leuven", "two-state", "wojewoda"};

template <std::size_t n>
bool is_among(const std::array<const char*, n>& kinds, const std::string& kind) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

/// A period takes tenths of a second for these laws.
bool is_dear(const std::string& kind) { return kind == "non-drift" || kind == "leuven"; }

struct Tally {
  int points = 0, unanswered = 0, negative = 0;
};

/// Checks that the work of a period is not negative by more than the error of its computation.
void compare_work(ClaimChecks& checks, const std::string& label, const Element& law, const DfPoint& point,
                  bool required, Tally& tally) {
  const auto df = computed_gain(law, point, false, 1e-5);
  ++tally.points;
  if (!df.answered()) {
    ++tally.unanswered;
    return;
  }
  // Dissipated share of the largest possible exchange; 1 is added to give an error a reference size.
  const double A = point.amplitude, size = pi * A * A * std::abs(df.gain);
  const double part = (point.bias == 0.0 ? pi * A * A * df.gain.imag() : df.dissipation) / size;
  const double error = df.error + 1e-9;
  if (part < -error) ++tally.negative;
  if (!required) return;
  const std::string at = label + ", " + place({{"A", A, "m"}, {"w", point.frequency, "rad/s"}}) +
                         (point.bias == 0.0 ? "" : ", " + place({{"mean v", point.bias, "m/s"}}));
  checks.at_least(at, point.bias == 0.0 ? "1 + Im N/|N|" : "1 + W/(pi A^2 |N|)", "", 1.0, 1.0 + part, error);
}

/// Every law at random points, of which a third have a mean velocity.
void check_laws(ClaimChecks& checks, const ClaimOptions& options, RandomPoints& random, Tally& passive, Tally& others) {
  for (const LawSetting& setting : law_settings()) {
    const bool required = is_among(passive_kinds, setting.kind);
    if (!required && !is_among(other_kinds, setting.kind)) continue;
    const auto law = make_law(setting);
    const int points = is_dear(setting.kind) ? (options.random_points + 3) / 4 : options.random_points;
    for (int i = 0; i < points && !stopped(options); ++i) {
      const double A = random.log_between(1e-6, 1e-2), w = random.log_between(0.1, 100.0);
      const double bias = i % 3 == 2 ? A * w * random.between(-1.5, 1.5) : 0.0;
      compare_work(checks, setting.label, law, {A, w, bias}, required, required ? passive : others);
    }
  }
}

LuGre<double> damped_lugre(double Fs, double Fc, double sigma1) {
  LuGre<double> law;
  law.Fs = law.Fs_minus = Fs;
  law.Fc = law.Fc_minus = Fc;
  law.vs = 1e-3;
  law.sigma0 = 1e5;
  law.sigma1 = sigma1;
  return law;
}

/// W = pi A^2 Im N against the work of a march over one period of a steady state.
void check_work_identity(ClaimChecks& checks, double A, double w) {
  const auto law = damped_lugre(1.5, 1.0, std::sqrt(1e5));
  const auto df = computed_gain(law, {A, w, 0.0}, false, 1e-9);
  if (!df.answered()) return checks.stop(df.status);
  DrivenLaw motion(law);
  const double T = 2.0 * pi / w;
  const auto half = [&](double sign) {
    motion.go([A, w, sign](double t) { return sign * A * w * std::sin(w * t); }, 0.5 * T, 10000);
  };
  motion.go([A, w](double t) { return A * w * std::cos(w * t); }, 0.25 * T, 5000);
  for (int k = 0; k < 4; ++k) half(k % 2 == 0 ? -1.0 : 1.0);
  const double before = motion.work();
  half(-1.0);
  half(1.0);
  checks.equal("lugre, " + place({{"A", A, "m"}, {"w", w, "rad/s"}}), "W of a marched period", "J",
               pi * A * A * df.gain.imag(), motion.work() - before, 1e-5);
}

/// The exception: strongly damped bristles give out energy under a sinusoid about a mean velocity, unless sigma2
/// satisfies D2.
void check_exception(ClaimChecks& checks) {
  auto law = damped_lugre(5.0, 1.0, 5e6);
  const DfPoint motion{2e-6, 400.0, 1.5 * 2e-6 * 400.0};
  const std::string at =
      place({{"Fs", 5.0, "N"}, {"Fc", 1.0, "N"}, {"sigma1", 5e6, "N s/m"}}) + ", " +
      place({{"A", motion.amplitude, "m"}, {"w", motion.frequency, "rad/s"}, {"mean v", motion.bias, "m/s"}});
  const auto without = computed_gain(law, motion, false, 1e-7);
  law.sigma2 = law.sigma1 * (law.Fs - law.Fc) / law.Fc;
  const auto with = computed_gain(law, motion, false, 1e-7);
  if (!without.answered() || !with.answered()) return checks.stop(without.answered() ? with.status : without.status);
  checks.at_most(at, "W of LuGre with sigma2 = 0, not passive", "J", 0.0, without.dissipation, 0.0);
  checks.at_least(at, "W of LuGre with sigma2 = sigma1 (Fs - Fc)/Fc", "J", 0.0, with.dissipation, 0.0);
}

/// LuGre settings that are passive by D2, as strongly damped as the exception.
void check_passive_lugre(ClaimChecks& checks, const ClaimOptions& options, RandomPoints& random, Tally& tally) {
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const double Fs = random.log_between(1.1, 10.0);
    auto law = damped_lugre(Fs, 1.0, random.log_between(10.0, 1e7));
    law.sigma2 = law.sigma1 * (law.Fs - law.Fc) / law.Fc;
    const double A = random.log_between(1e-6, 1e-2), w = random.log_between(1.0, 1e3);
    compare_work(checks, "passive lugre, " + place({{"Fs/Fc", law.Fs}, {"sigma1", law.sigma1, "N s/m"}}), law,
                 {A, w, i % 2 == 0 ? 0.0 : A * w * random.between(-2.0, 2.0)}, true, tally);
  }
}

ClaimResult test_passive(const ClaimOptions& options) {
  ClaimChecks checks;
  RandomPoints random(options.seed);
  Tally passive, others;
  check_work_identity(checks, 1e-4, 1.0);
  check_work_identity(checks, 1e-3, 10.0);
  check_exception(checks);
  checks.random(true);
  for (int i = 0; i < std::min(options.random_points, 5); ++i) {
    const double A = random.log_between(2e-5, 1e-3);
    check_work_identity(checks, A, random.log_between(0.1, 30.0));
  }
  check_laws(checks, options, random, passive, others);
  check_passive_lugre(checks, options, random, passive);
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result(
      "passive laws: " + std::to_string(passive.points) + " motions, " + std::to_string(passive.unanswered) +
      " without a periodic state; laws that are not passive or not known to be: " + std::to_string(others.negative) +
      " of " + std::to_string(others.points) + " motions give out energy");
}

}  // namespace

Claim passive_gain_claim() {
  return {
      "A16",
      "Passive friction has Im N >= 0 at every amplitude and frequency, since W = pi A^2 Im N; with a mean velocity "
      "the "
      "work of a period is not negative either. A law that is not passive (LuGre, D2) may break this.",
      "Im N >= 0; W = pi A^2 Im N",
      "derived; checked by computation",
      Evidence::derived,
      "the laws that are passive with the compared values, and LuGre with sigma2 = sigma1 (Fs - Fc)/Fc; A from 1e-6 to "
      "1e-2 m, w from 0.1 to 100 rad/s (LuGre: 1 to 1000), mean velocity up to 1.5 (LuGre: 2) A w. Laws with a band "
      "about v = 0 (karnopp, quinn, awrejcewicz) have no describing function",
      "quadrature of the periodic state; W = pi A^2 Im N against the work of a Runge-Kutta march; a LuGre setting that "
      "is not passive and gives out energy under a sinusoid about a mean velocity. Of the laws that are not passive "
      "the "
      "signs are counted, not required",
      ClaimVerdict::holds,
      test_passive};
}

}  // namespace limcycle
