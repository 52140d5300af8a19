#include "limcycle/analysis/energy/passivity/static_supply.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <set>

#include "limcycle/analysis/energy/passivity/motions.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_modes = 400;

/// Signals of both signs on a logarithmic grid around the scale, and the drives that go with them.
std::vector<Input<double>> inputs_of(const Element& element, double top_signal) {
  const MotionScales scales = motion_scales(element, top_signal);
  const DrivenBy port = port_of(element);
  const double force = element.scales().output;
  std::vector<double> sizes, drives{-infinite, infinite};
  for (int k = -90; k <= 60; ++k)
    if (const double size = scales.signal * std::pow(10.0, 0.1 * k); size <= top_signal) sizes.push_back(size);
  sizes.push_back(std::min(top_signal, scales.signal * 1e9));
  if (element.needs_drive() || port == DrivenBy::input) {
    for (const double share : {0.0, 0.3, 0.999999, 1.000001, 3.0, 1e3})
      for (const double sign : {1.0, -1.0}) drives.push_back(sign * share * force);
  }
  std::vector<Input<double>> inputs;
  for (const double size : sizes)
    for (const double sign : {1.0, -1.0})
      for (const double drive : drives)
        for (const double turn : {1.0, -1.0})
          inputs.push_back(port == DrivenBy::velocity ? Input<double>{0.0, sign * size, drive}
                                                      : Input<double>{sign * size, turn * scales.signal, drive});
  return inputs;
}

/// The modes that switches at these inputs can lead to.
std::set<std::int64_t> modes_of(const Element& element, const std::vector<Input<double>>& inputs) {
  std::set<std::int64_t> modes;
  if (!element.has_modes()) return {0};
  for (const auto& in : inputs)
    if (modes.size() < most_modes) modes.insert(element.start(in, {}).value);
  std::vector<std::int64_t> fresh(modes.begin(), modes.end());
  while (!fresh.empty() && modes.size() < most_modes) {
    std::vector<std::int64_t> found;
    for (const auto mode : fresh) {
      std::vector<double> guards(static_cast<std::size_t>(element.guards({mode})));
      for (const auto& in : inputs) {
        element.guard(in, {mode}, {}, guards);
        for (std::size_t k = 0; k < guards.size(); ++k)
          if (guards[k] < 0.0)
            if (const auto next = element.next(in, {mode}, {}, static_cast<int>(k)).value; modes.insert(next).second)
              found.push_back(next);
      }
    }
    fresh = found;
  }
  return modes;
}

/// The applied force on a body of mass m behind a law that needs it, when the body has the velocity v and the
/// acceleration a. A solution exists because the output rises with the drive by less than the drive does.
double applied_force(const Element& law, double v, double inertia) {
  // The output lies between that at no drive and that drive, plus a part that does not depend on it.
  const double reach =
      10.0 *
      (law.scales().output + std::abs(law.output({0.0, v, 0.0}, law.start({0.0, v, 0.0}, {}), {})) + std::abs(inertia));
  double low = -reach, high = reach;
  for (int k = 0; k < 200 && high - low > 0.0; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    const Input<double> in{0.0, v, middle};
    (middle - inertia - law.output(in, law.start(in, {}), {}) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Energy supplied while the unit mass goes from v1 to v0 at a constant rate in the time T, J; `roughly`: to about
/// 1e-3, for a search.
double supply_of_braking(const Element& law, double v1, double v0, double T, bool roughly = false) {
  const double inertia = (v0 - v1) / T;
  const auto power = [&](double t) {
    const double v = v1 + inertia * t;
    return v * (applied_force(law, v, inertia) - inertia);
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;
  return roughly ? Rule::integrate(power, 0.0, T, 0) : Rule::integrate(power, 0.0, T, 10, 1e-10);
}

/// The same with the applied force given as a function of time and the motion integrated: shares only that force with
/// the above. The kinetic energy is what remains of the work of the applied force.
double simulated_braking(const Element& law, double v1, double v0, double T) {
  namespace odeint = boost::numeric::odeint;
  using Moving = std::vector<double>;
  const double inertia = (v0 - v1) / T;
  const auto force = [&](double t) { return applied_force(law, v1 + inertia * t, inertia); };
  Moving y{v1, 0.0};
  auto stepper = odeint::make_controlled(1e-12 * v1, 1e-10, odeint::runge_kutta_dopri5<Moving>());
  double t = 0.0, h = 1e-3 * T;
  const auto field = [&](const Moving& at, Moving& rate, double now) {
    const Input<double> in{0.0, at[0], force(now)};
    const double F = law.output(in, law.start(in, {}), {});
    rate = {in.drive - F, F * at[0] / v1};
  };
  for (int steps = 0; t < T && steps < 100'000; ++steps) {
    h = std::min(h, T - t);
    stepper.try_step(field, y, t, h);
  }
  return t >= T * (1.0 - 1e-12) ? y[1] * v1 : std::nan("");
}

/// Kick and hold up, see static_passivity.
std::optional<Counterexample> held_up(const Element& law) {
  const double band = law.drive_band();
  if (!(band > 0.0)) return std::nullopt;
  double best = 0.0, v1 = 0.0, T = 0.0;
  const double force = law.scales().output;
  for (int i = 0; i < 18; ++i)
    for (int k = 0; k < 22; ++k) {
      // Speed over the band, and m a of the braking over the force.
      const double top = 0.1 + 0.05 * i, pull = 0.02 * std::pow(1.2, k), time = 0.98 * top * band / (pull * force);
      const double E = supply_of_braking(law, top * band, 0.02 * top * band, time, true);
      if (E < best) best = E, v1 = top * band, T = time;
    }
  if (!(best < 0.0)) return std::nullopt;
  const double v0 = 0.02 * v1;
  best = supply_of_braking(law, v1, v0, T);
  // Speeding up costs more the longer it takes: the force is then far beyond Fs.
  const double kick = 1e-6 * T, costs = supply_of_braking(law, v0, v1, kick);
  Counterexample found;
  found.input = {{0.0, kick, kick + T}, {v0, v1, v0}};
  found.energy = -(best + costs);
  found.error = 1e-8 * std::abs(best);
  found.confirmed = -(simulated_braking(law, v1, v0, T) + simulated_braking(law, v0, v1, kick));
  for (int k = 1; k <= 12; ++k) found.taken.push_back(k * found.energy);
  found.words = "a body of 1 kg is kicked from " + short_number(v0) + " to " + short_number(v1) + " m/s within " +
                short_number(kick) + " s and brought back evenly in " + short_number(T) +
                " s by a pull that the friction holds up, over and over; the energy is proportional to the mass";
  return found;
}

}  // namespace

LeastSupply least_supply(const Element& element, double top_signal) {
  LeastSupply least;
  const DrivenBy port = port_of(element);
  const double scale = element.scales().output;
  const auto inputs = inputs_of(element, top_signal);
  for (const auto value : modes_of(element, inputs)) {
    const Mode mode{value};
    // A held rate gives no power; an output that holds an input lies between those on its two sides.
    if (element.held(mode) != Held::nothing) continue;
    std::vector<double> guards(static_cast<std::size_t>(element.guards(mode)));
    for (const auto& in : inputs) {
      element.guard(in, mode, {}, guards);
      if (!std::ranges::all_of(guards, [](double g) { return g >= 0.0; })) continue;
      const double signal = port == DrivenBy::velocity ? in.v : in.x;
      const double output = element.output(in, mode, {});
      if (!std::isfinite(output)) continue;  // no value at this drive
      ++least.points;
      const double share = signal * output / (std::abs(signal) * std::max(scale, std::abs(output)));
      if (!(share >= least.share)) least = {share, signal, in.drive, mode, least.points};
    }
  }
  return least;
}

Passivity static_passivity(const Element& element, const PassivityOptions& options) {
  Passivity result;
  result.method = "supply at every input";
  result.searched = std::nan("");
  result.deficit = std::nan("");
  const LeastSupply least = least_supply(element, options.top_speed);
  const std::string checked = std::to_string(least.points) + " inputs";
  if (least.points == 0) {
    result.status = Status::undefined;
    result.why = "no input under which the element has a value was found";
    return result;
  }
  if (least.share >= 0.0) {
    result.passive = Passive::yes;
    result.deficit = 0.0;
    result.why = "nothing is stored, and the supply is not negative at any of " + checked;
    return result;
  }
  result.why = "at the signal " + short_number(least.signal) + " and the applied force " + short_number(least.drive) +
               " energy comes out";
  if (!element.needs_drive()) return result;
  auto found = held_up(element);
  if (!found || !(found->energy > 100.0 * found->error) ||
      !(std::abs(found->confirmed - found->energy) <= 1e-4 * found->energy)) {
    result.why += "; whether a motion can go on taking it is not decided by the velocity alone";
    return result;
  }
  result.passive = Passive::no;
  result.deficit = found->energy;
  result.why += ": the force within the band is that of the applied force, which may pull against the motion";
  result.counterexample = std::move(found);
  return result;
}

}  // namespace limcycle
