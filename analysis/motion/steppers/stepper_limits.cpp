#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double too_many_steps = 2e5;  ///< per turn of the slowest pole

constexpr double loosest_of_all = 5e-4;

/// The bristle law that rubs, if there is one.
struct Bristles {
  double displacement = infinite;  ///< m, over which they bend
  double typical_velocity = 0.0;   ///< m/s
  double velocity_per_rtol = 0.0;  ///< m/s, absolute tolerance on the rubbing velocity at rtol = 1
  double slowest = 1.0;            ///< rad/s, the slowest pole
  bool any() const { return std::isfinite(displacement); }
};

Bristles bristles_of(const Loop& loop) {
  Bristles found;
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    if (!loop.ports[i].rubs) continue;
    const auto [displacement, states] = std::pair(loop.elements[i].scales().displacement, loop.elements[i].states());
    if (states == 0 || !std::isfinite(displacement)) continue;
    found.displacement = displacement;
    const State typical = typical_sizes(loop);
    const ErrorWeights weights = loop_weights(loop, 0.1, typical);
    for (Eigen::Index k = 0; k < loop.states(); ++k) {
      const double part = std::abs(loop.ports[i].C_v(k));
      const auto at = static_cast<std::size_t>(k);
      found.typical_velocity = std::max(found.typical_velocity, part * typical[at]);
      found.velocity_per_rtol += part * weights.atol[at] / weights.rtol;
    }
    if (const auto moduli = pole_moduli(loop); !moduli.empty()) found.slowest = moduli.front();
  }
  return found;
}

bool is_explicit(StepperKind stepper) {
  return stepper == StepperKind::dopri5 || stepper == StepperKind::fehlberg78 || stepper == StepperKind::cash_karp54;
}

/// The next lower power of ten, as text.
std::string tolerance(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return short_number(std::clamp(power, 1e-13, 0.1));
}

}  // namespace

double loosest_stiff_tolerance(const Loop& loop) {
  const Bristles law = bristles_of(loop);
  if (!law.any() || !(law.velocity_per_rtol > 0.0)) return infinite;
  return std::min(0.2 * law.slowest * law.displacement / law.velocity_per_rtol, loosest_of_all);
}

double explicit_steps(const Loop& loop) {
  const Bristles law = bristles_of(loop);
  if (!law.any()) return 0.0;
  return 2.0 * std::numbers::pi / law.slowest * law.typical_velocity / law.displacement / 3.3;
}

std::vector<std::string> stepper_notes(const Loop& loop, StepperKind stepper, double rtol) {
  std::vector<std::string> notes;
  if (stepper == StepperKind::automatic) stepper = choose_stepper(loop, rtol);
  if (is_explicit(stepper)) {
    const double steps = explicit_steps(loop);
    if (steps > too_many_steps)
      notes.push_back(std::string(to_string(stepper)) + " is explicit and has to follow the bristles: about " +
                      short_number(steps, 2) +
                      " steps per turn of the loop's slowest pole; rodas5p takes some hundreds");
  } else if (stepper == StepperKind::rodas5p) {
    const double limit = loosest_stiff_tolerance(loop);
    if (rtol > limit)
      notes.push_back("rtol = " + short_number(rtol) +
                      " is too loose for bristles as stiff as these: a step may miss the creep of the sticking body, "
                      "break away early and end in a false, irregular hunting; take rtol = " +
                      tolerance(limit) + " or less");
  }
  return notes;
}

}  // namespace limcycle
