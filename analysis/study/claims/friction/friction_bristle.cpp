#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/analysis/study/claims/friction/friction_claims.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {
namespace {

using std::numbers::pi;

LuGre<double> drawn_lugre(RandomPoints& random) {
  auto law = lugre_1995();
  law.Fc = law.Fc_minus = random.log_between(0.1, 10.0);
  law.Fs = law.Fs_minus = law.Fc * random.between(1.0, 3.0);
  law.vs = random.log_between(1e-4, 1e-1);
  law.sigma0 = random.log_between(1e3, 1e6);
  law.sigma1 = std::sqrt(law.sigma0) * random.between(0.0, 2.0);
  law.sigma2 = random.log_between(1e-2, 1e2);
  return law;
}

std::string lugre_in_words(const LuGre<double>& law) {
  return place({{"Fs", law.Fs, "N"},
                {"Fc", law.Fc, "N"},
                {"vs", law.vs, "m/s"},
                {"sigma0", law.sigma0, "N/m"},
                {"sigma1", law.sigma1, "N s/m"},
                {"sigma2", law.sigma2, "N s/m"}});
}

double level(const LuGre<double>& law, double v) {
  return law.Fc + (law.Fs - law.Fc) * std::exp(-std::pow(std::abs(v / law.vs), law.delta));
}

/// Force after sliding over 60 bristle lengths, from the virgin state.
double sliding_force(const LuGre<double>& law, double v) {
  DrivenLaw motion(law, v);
  motion.slide(v, 60.0 * law.Fs / law.sigma0, 4000);
  return motion.force();
}

ClaimResult test_steady_state(const ClaimOptions& options) {
  ClaimChecks checks;
  const auto law = lugre_1995();
  check_printed(checks, "v = 0.5 vs", "F", "N", 1.389400, 1e-6, sliding_force(law, 0.5 * law.vs));
  check_printed(checks, "v = vs", "F", "N", 1.183940, 1e-6, sliding_force(law, law.vs));
  check_printed(checks, "v = 2 vs", "F", "N", 1.009158, 1e-6, sliding_force(law, 2.0 * law.vs));
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    auto one = drawn_lugre(random);
    one.delta = random.between(0.5, 2.0);
    const double v = (i % 2 == 0 ? 1.0 : -1.0) * one.vs * random.log_between(0.01, 10.0);
    const double claimed = std::copysign(level(one, v), v) + one.sigma2 * v;
    checks.equal(lugre_in_words(one) + ", " + place({{"delta", one.delta}, {"v", v, "m/s"}}), "F", "N", claimed,
                 sliding_force(one, v), 1e-9);
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

/// Largest |z| over Fs/sigma0 on a motion of many pieces at constant speeds of many orders, from z0.
double largest_deflection(const LuGre<double>& law, double z0, RandomPoints& random, int pieces) {
  DrivenLaw motion(law);
  const double length = law.Fs / law.sigma0;
  motion.state()[0] = z0;
  double largest = std::abs(z0);
  motion.watch = [&](double) { largest = std::max(largest, std::abs(motion.state()[0])); };
  for (int i = 0; i < pieces; ++i) {
    const double speed = random.log_between(1e-4, 1e3) * law.vs, v = random.whole(0, 1) == 0 ? -speed : speed;
    const double distance = length * random.log_between(0.01, 5.0);
    motion.slide(v, distance, 1 + static_cast<int>(100.0 * distance / length));
  }
  return largest / length;
}

ClaimResult test_invariance(const ClaimOptions& options) {
  ClaimChecks checks;
  RandomPoints random(options.seed);
  const auto law = lugre_1995();
  const double length = law.Fs / law.sigma0, slack = 1e-9;
  for (const double start : {0.0, 1.0, -1.0})
    checks.at_most(place({{"z(0) sigma0/Fs", start}}), "largest |z| sigma0/Fs", "", 1.0,
                   largest_deflection(law, start * length, random, 100), slack);
  // The bound is sharp: creep reaches it.
  DrivenLaw slow(law);
  slow.slide(1e-6 * law.vs, 40.0 * length, 4000);
  checks.equal("creeping", "z sigma0/Fs", "", 1.0, slow.state()[0] / length, 1e-9);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const auto one = drawn_lugre(random);
    const double start = random.between(-1.0, 1.0);
    checks.at_most(lugre_in_words(one) + ", " + place({{"z(0) sigma0/Fs", start}}), "largest |z| sigma0/Fs", "", 1.0,
                   largest_deflection(one, start * one.Fs / one.sigma0, random, 60), slack);
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

/// Creeping displacement of the virgin law until its force reaches `force`; NaN if it never does.
double way_to(const LuGre<double>& law, double force) {
  DrivenLaw motion(law);
  return motion.slide_to_force(creep, force, 0.02 * law.Fs / law.sigma0, 10000) ? motion.x() : NAN;
}

ClaimResult test_virgin(const ClaimOptions& options) {
  ClaimChecks checks;
  const auto law = lugre_1995();
  check_printed(checks, "F = 1.425 N", "x", "m", 4.4936e-5, 1e-9, way_to(law, 1.425));
  const double small = 1e-4 * law.Fs;
  checks.equal("F = 1.5e-04 N", "initial stiffness F/x", "N/m", law.sigma0, small / way_to(law, small), 1e-4);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    auto one = drawn_lugre(random);
    const double share = random.between(0.05, 0.99);
    checks.equal(lugre_in_words(one) + ", " + place({{"F/Fs", share}}), "x", "m",
                 -one.Fs / one.sigma0 * std::log1p(-share), way_to(one, share * one.Fs), 1e-6);
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

/// A mass on the law under such a small force that it never slides, from rest: time and height of the first peak of x,
/// by Runge-Kutta of order 4.
struct FirstPeak {
  double time = NAN, height = NAN;
};

FirstPeak step_response(const LuGre<double>& law, double mass, double force) {
  using Vector = std::array<double, 3>;  // x, v, z
  const auto slope = [&](const Vector& s) {
    const double z[1] = {s[2]};
    double dz[1];
    const Input<double> in{s[0], s[1], 0.0};
    law.rate(in, {}, z, dz);
    return Vector{s[1], (force - law.output(in, {}, z)) / mass, dz[0]};
  };
  const double h = 1e-3 / std::sqrt(law.sigma0 / mass);
  Vector now{};
  for (int i = 0; i < 100000; ++i) {
    const auto moved = [&](const Vector& k, double part) {
      Vector to = now;
      for (std::size_t j = 0; j < to.size(); ++j) to[j] += part * h * k[j];
      return to;
    };
    const Vector k1 = slope(now), k2 = slope(moved(k1, 0.5)), k3 = slope(moved(k2, 0.5)), k4 = slope(moved(k3, 1.0));
    Vector next = now;
    for (std::size_t j = 0; j < next.size(); ++j) next[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
    if (next[1] <= 0.0) {
      const double part = now[1] / (now[1] - next[1]);
      return {h * (i + part), now[0] + 0.5 * part * h * now[1]};
    }
    now = next;
  }
  return {};
}

void check_ringing(ClaimChecks& checks, const LuGre<double>& law, double mass) {
  const double natural = std::sqrt(law.sigma0 / mass);
  const double damping = (law.sigma1 + law.sigma2) / (2.0 * std::sqrt(law.sigma0 * mass));
  const double force = 1e-8 * law.Fc, root = std::sqrt(1.0 - damping * damping);
  const FirstPeak peak = step_response(law, mass, force);
  const std::string at = lugre_in_words(law) + ", " + place({{"m", mass, "kg"}});
  checks.equal(at, "time of the first peak", "s", pi / (natural * root), peak.time, 1e-5);
  checks.equal(at, "overshoot", "", std::exp(-pi * damping / root), peak.height * law.sigma0 / force - 1.0, 1e-5, 1.0);
}

ClaimResult test_stuck_mass(const ClaimOptions& options) {
  ClaimChecks checks;
  // Frequency and damping ratio back from the first peak.
  const auto law = lugre_1995();
  const double force = 1e-8;
  const FirstPeak peak = step_response(law, 1.0, force);
  const double decrement = -std::log(peak.height * law.sigma0 / force - 1.0) / pi;
  const double ratio = decrement / std::hypot(1.0, decrement);
  check_printed(checks, "m = 1 kg, sigma2 = 0", "damping ratio", "", 0.5, 1e-4, ratio);
  check_printed(checks, "m = 1 kg, sigma2 = 0", "natural frequency", "rad/s", 316.23, 1e-2,
                pi / (peak.time * std::sqrt(1.0 - ratio * ratio)), 1e-3);
  check_ringing(checks, law, 1.0);
  RandomPoints random(options.seed);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    auto one = drawn_lugre(random);
    const double mass = random.log_between(0.1, 10.0), unit = 2.0 * std::sqrt(one.sigma0 * mass);
    one.sigma1 = unit * random.between(0.05, 0.6);
    one.sigma2 = unit * random.between(0.0, 0.3);
    check_ringing(checks, one, mass);
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

}  // namespace

std::vector<Claim> bristle_claims() {
  const std::string range =
      "Fc 0.1 to 10 N, Fs/Fc 1 to 3, vs 1e-4 to 0.1 m/s, sigma0 1e3 to 1e6 N/m, sigma1 up to 2 sqrt(sigma0), sigma2 "
      "0.01 to 100 N s/m";
  return {{"D1", "Steady sliding of LuGre follows the Stribeck curve.",
           "F = g(v) sgn v + sigma2 v, g = Fc + (Fs - Fc) exp(-|v/vs|^delta)", "derived", Evidence::derived,
           range + ", delta 0.5 to 2, |v| 0.01 to 10 vs", "the virgin law marched over 60 bristle lengths",
           ClaimVerdict::holds, test_steady_state},
          {"D6", "The bristle deflection of LuGre never leaves |z| <= Fs/sigma0 if it begins there.",
           "at |z| = Fs/sigma0: dz/dt sgn z = |v| (+-1 - Fs/g) <= 0", "derived", Evidence::derived, range,
           "the law marched through random velocities over seven decades, from inside and from the border; creeping "
           "shows that the bound is sharp",
           ClaimVerdict::holds, test_invariance},
          {"D7", "Virgin pre-sliding displacement of LuGre under a slowly rising force.",
           "x(F) = -(Fs/sigma0) ln(1 - F/Fs); initial stiffness sigma0; 4.4936e-5 m at 1.425 N", "derived",
           Evidence::derived, range + ", F/Fs from 0.05 to 0.99",
           "the law marched at 1e-12 m/s until the force is reached", ClaimVerdict::holds, test_virgin},
          {"D8", "A mass stuck on LuGre rings like a linear oscillator.",
           "wn = sqrt(sigma0/m), zeta = (sigma1 + sigma2)/(2 sqrt(sigma0 m)); 316.23 rad/s and 0.5", "derived",
           Evidence::derived, range + ", m 0.1 to 10 kg, zeta 0.05 to 0.9",
           "first peak of the response to a force of 1e-8 Fc, mass and law marched together", ClaimVerdict::holds,
           test_stuck_mass}};
}

}  // namespace limcycle
