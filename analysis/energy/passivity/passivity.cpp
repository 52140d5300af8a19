#include "limcycle/analysis/energy/passivity/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/energy/one_state/one_state.hpp"
#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/energy/passivity/adversary.hpp"
#include "limcycle/analysis/energy/passivity/certificate.hpp"
#include "limcycle/analysis/energy/passivity/held_input.hpp"
#include "limcycle/analysis/energy/passivity/reference_march.hpp"
#include "limcycle/analysis/energy/passivity/static_supply.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Share of the energy by which the independent simulation may differ.
constexpr double agreement = 1e-4;

/// True if the independent simulation takes the same energy out, from the state in which the motion repeats.
bool confirm(const Element& element, const PassivityOptions& options, Counterexample& example) {
  if (port_of(element) == DrivenBy::input) {
    example.confirmed = -stepped_supply(element, example.input, example.z0, example.mode0);
  } else {
    ReferenceMarchOptions how;
    how.stop = options.stop;
    const ReferenceMarch run = reference_march(element, example.input, example.z0, example.mode0, 1, how);
    if (run.status != Status::converged) return false;
    example.confirmed = -run.supplied;
  }
  return std::abs(example.confirmed - example.energy) <= agreement * example.energy;
}

Passivity certified(const Certificate& certificate) {
  Passivity result;
  result.passive = Passive::yes;
  result.method = "storage function of the law";
  result.searched = std::nan("");
  result.why = "the supply is never below the rise of the law's stored energy, checked at " +
               std::to_string(certificate.states) + " states that motions lead to and all velocities at each (least " +
               "share left " + short_number(certificate.least, 3) + ")";
  return result;
}

Passivity unanswered(Status status, const char* method, const char* why) {
  Passivity result;
  result.status = status;
  result.deficit = result.searched = std::nan("");
  result.method = method;
  result.why = why;
  return result;
}

/// For laws without states: decided by the supply; if that can be negative, a motion must still be found that takes
/// energy repeatedly.
Passivity without_states(const Element& element, const PassivityOptions& options) {
  Passivity result = static_passivity(element, options);
  if (result.passive != Passive::undecided || element.needs_drive()) return result;
  const std::string why = result.why;
  result = searched_passivity(element, options);
  if (result.passive == Passive::undecided) result.why = why + "; " + result.why;
  return result;
}

}  // namespace

std::string_view to_string(Passive passive) {
  return passive == Passive::yes ? "yes" : passive == Passive::no ? "no" : "undecided";
}

double VelocityCycle::at(double t) const {
  const double T = period();
  double within = std::fmod(t, T);
  if (within < 0.0) within += T;
  const auto after = std::ranges::upper_bound(time, within);
  if (after == time.end()) return velocity.front();
  const auto k = static_cast<std::size_t>(after - time.begin());
  const double share = (within - time[k - 1]) / (time[k] - time[k - 1]);
  return velocity[k - 1] + share * (velocity[k] - velocity[k - 1]);
}

Passivity searched_passivity(const Element& element, const PassivityOptions& options) {
  Passivity result;
  result.method = "search";
  result.deficit = std::nan("");
  const MotionScales scales = motion_scales(element, options.top_speed);
  const Attack found = attack(element, scales, options);
  result.searched = std::isfinite(found.least) ? found.least : std::nan("");
  result.status = found.status;
  result.why = "of " + std::to_string(found.inputs) + " periodic inputs none took energy out, which proves nothing";
  if (!(found.least < 0.0)) return result;
  result.why = "a search found an input that seems to take energy out, which was not confirmed";
  auto example = counterexample_of(element, found.input);
  if (!example || !confirm(element, options, *example)) return result;
  result.passive = Passive::no;
  result.status = Status::converged;
  result.deficit = example->energy;
  result.why = "a periodic input takes " + short_number(example->energy) + " J out of it every cycle";
  result.counterexample = std::move(example);
  return result;
}

Passivity passivity(const Element& law, const PassivityOptions& options) {
  if (!(options.top_speed > 0.0))
    throw std::invalid_argument("top_speed must be positive, got " + std::to_string(options.top_speed));
  if (!(options.effort > 0))
    throw std::invalid_argument("effort must be positive, got " + std::to_string(options.effort));
  if (OneStateLaw::fits(law)) return one_state_passivity(law, options);
  if (law.states() == 0) return without_states(law, options);
  if (law.follows_position())
    return unanswered(Status::undefined, "none", "its output depends on where it is, not only on its rate");
  if (port_of(law) == DrivenBy::velocity) {
    const Certificate certificate = certify(law, motion_scales(law, options.top_speed), options);
    if (certificate.holds) return certified(certificate);
    if (certificate.status == Status::interrupted)
      return unanswered(Status::interrupted, "storage function of the law", "interrupted");
  }
  return searched_passivity(law, options);
}

}  // namespace limcycle
