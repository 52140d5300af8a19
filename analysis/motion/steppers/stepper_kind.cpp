#include "limcycle/analysis/motion/steppers/stepper_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"

namespace limcycle {
namespace {

constexpr std::array<std::pair<StepperKind, std::string_view>, 6> names{{{StepperKind::automatic, "auto"},
                                                                         {StepperKind::exact, "exact"},
                                                                         {StepperKind::rodas5p, "rodas5p"},
                                                                         {StepperKind::dopri5, "dopri5"},
                                                                         {StepperKind::fehlberg78, "fehlberg78"},
                                                                         {StepperKind::cash_karp54, "cash-karp54"}}};

}  // namespace

StepperKind stepper_kind(const std::string& name) {
  for (const auto& [kind, text] : names)
    if (text == name) return kind;
  throw std::invalid_argument("stepper must be auto, exact, rodas5p, dopri5, fehlberg78 or cash-karp54, got " + name);
}

std::string_view to_string(StepperKind kind) { return names[static_cast<std::size_t>(kind)].second; }

StepperKind choose_stepper(const Loop& loop, double rtol, bool driven) {
  if (!driven && AffineFlow::applies(loop)) return StepperKind::exact;
  const bool bristle = std::ranges::any_of(loop.elements, [](const auto& element) {
    const bool band = element.drive_band() > 0.0 && element.needs_drive();  // a stiff layer at rest
    return band || (element.states() > 0 && std::isfinite(element.scales().displacement));
  });
  // A body that truly sticks waits as long as an integrator needs, many times the slowest time constant of the free
  // motion, while the fastest poles (the filter of a derivative) limit the step of an explicit stepper.
  const bool sticks = std::ranges::any_of(loop.elements, [](const auto& element) { return element.may_stick(); });
  // The Jacobian of a curve that begins with infinite slope is unbounded where the body stops and breaks away: implicit
  // steps shrink to nothing there, explicit ones pass.
  constexpr double too_steep = 0.6;
  const bool steep =
      std::ranges::any_of(loop.elements, [](const auto& element) { return element.steep_exponent() < too_steep; });
  const auto moduli = pole_moduli(loop);
  const double stiff = steep ? 5000.0 : sticks ? 20.0 : 200.0;
  if (bristle || (!moduli.empty() && moduli.back() > stiff * moduli.front())) return StepperKind::rodas5p;
  return explicit_stepper(rtol);
}

StepperKind explicit_stepper(double rtol) { return rtol < 1e-8 ? StepperKind::fehlberg78 : StepperKind::dopri5; }

}  // namespace limcycle
