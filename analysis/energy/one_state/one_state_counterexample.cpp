#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "limcycle/analysis/energy/one_state/one_state_cycle.hpp"
#include "limcycle/analysis/energy/passivity/reference_march.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Converts the cycle to an input. The shorter stroke comes first: its duration then keeps all digits. A cycle that
/// passes z = 0 without being stable begins there.
Counterexample as_input(const OneStateLaw& law, const TwoSpeedCycle& cycle) {
  Counterexample example;
  const auto stroke = [&](double v, double duration) {
    const double from = example.input.time.empty() ? 0.0 : example.input.period();
    for (const double t : {from, from + duration}) {
      example.input.time.push_back(t);
      example.input.velocity.push_back(v);
    }
  };
  if (cycle.multiplier >= 1.0) {
    TwoSpeedCycle below = cycle;
    below.z2 = 0.0;
    if (below.z1 < 0.0) integrate(law, below);
    stroke(cycle.v_up, cycle.time_up - below.time_up * (below.z1 < 0.0 ? 1.0 : 0.0));
    stroke(cycle.v_down, cycle.time_down);
    if (below.z1 < 0.0) stroke(cycle.v_up, below.time_up);
    example.z0 = {0.0};
  } else if (cycle.time_up <= cycle.time_down) {
    stroke(cycle.v_up, cycle.time_up);
    stroke(cycle.v_down, cycle.time_down);
    example.z0 = {cycle.z1};
  } else {
    stroke(cycle.v_down, cycle.time_down);
    stroke(cycle.v_up, cycle.time_up);
    example.z0 = {cycle.z2};
  }
  example.mode0 = law.at(example.z0[0], example.input.velocity.front()).mode;
  example.energy = cycle.energy;
  example.error = cycle.error;
  const double near = std::max(std::abs(cycle.z1), std::abs(cycle.z2)) / (cycle.z2 - cycle.z1);
  const int digits = std::clamp(3 + static_cast<int>(std::log10(near)), 3, 15);
  example.words = "z rises from " + short_number(cycle.z1, digits) + " to " + short_number(cycle.z2, digits) + " at " +
                  short_number(cycle.v_up) + " m/s and falls back at " + short_number(cycle.v_down) +
                  " m/s; each cycle gives " + short_number(cycle.energy) + " J";
  return example;
}

/// Checks one period by the independent simulation: it must return to its state, and give the same energy.
bool is_confirmed(const OneStateLaw& law, const TwoSpeedCycle& cycle, Counterexample& example,
                  const ReferenceMarchOptions& options) {
  const ReferenceMarch check = reference_march(law.law(), example.input, example.z0, example.mode0, 1, options);
  if (check.status != Status::converged) return false;
  example.confirmed = check.taken.front();
  return std::abs(check.z[0] - example.z0[0]) <= 1e-6 * (cycle.z2 - cycle.z1) &&
         std::abs(example.confirmed - example.energy) <= 1e-6 * example.energy;
}

/// The constant velocity at which the law without history reaches z0 soonest, of those of the cycle and one in the
/// middle of the law's own range, and the time needed; false if no such velocity does.
bool find_lead(const OneStateLaw& law, Counterexample& example) {
  const double z0 = example.z0[0];
  if (z0 == 0.0) return true;
  const int direction = z0 > 0.0 ? 1 : -1;
  double best = infinite;
  const double usual = 1e-2 * law.velocity_scale();
  for (const double v : {example.input.velocity.front(), example.input.velocity.back(), usual, -usual}) {
    bool arrives = std::abs(v) <= law.top_speed();
    for (int k = 0; k <= 64 && arrives; ++k) arrives = law.at(z0 * k / 64.0, v).rate * direction > 0.0;
    if (!arrives) continue;
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    const auto pace = [&](double part) { return z0 / law.at(part * z0, v).rate; };
    const double time = Rule::integrate(pace, 0.0, 1.0, 12, 1e-12), way = std::abs(v) * time;
    if (!(way < best)) continue;  // the shortest displacement costs least
    best = way;
    example.lead_velocity = v;
    example.lead_time = time;
  }
  return std::isfinite(best);
}

/// Energy that the cycles take out of the law without history.
std::vector<double> taken_from_virgin(const OneStateLaw& law, const Counterexample& example, int cycles,
                                      const ReferenceMarchOptions& options) {
  if (example.lead_time == 0.0) return reference_march_virgin(law.law(), example.input, cycles, options).taken;
  const double v = example.lead_velocity;
  const ReferenceMarch lead = reference_march_virgin(law.law(), {{0.0, example.lead_time}, {v, v}}, 1, options);
  if (lead.status != Status::converged) return {};
  auto taken = reference_march(law.law(), example.input, lead.z, lead.mode, cycles, options).taken;
  for (double& energy : taken) energy -= lead.supplied;
  return taken;
}

/// Growth from the law without history: at least ten cycles, as many as it takes that each gives the energy of the
/// periodic motion and the total is positive, or a thousand if that takes longer.
bool grows(const OneStateLaw& law, const TwoSpeedCycle& cycle, Counterexample& example,
           const ReferenceMarchOptions& options) {
  if (!find_lead(law, example)) return false;
  for (const int cycles : {10, 100, 1000}) {
    example.taken = taken_from_virgin(law, example, cycles, options);
    const std::size_t n = example.taken.size();
    if (n < static_cast<std::size_t>(cycles)) return false;
    const double last = example.taken[n - 1] - example.taken[n - 2];
    const bool settled = std::abs(last - example.energy) < 1e-3 * example.energy;
    if (settled && example.taken.back() > 0.0) return true;
    if (settled && cycles == 1000) {
      const double left = -example.taken.back() / example.energy;
      example.words +=
          " (what it takes to get there has come out again after some " + short_number(left + 1e3, 2) + " cycles)";
      return true;
    }
    if (cycle.multiplier >= 1.0) return false;
  }
  return false;
}

}  // namespace

std::optional<Counterexample> one_state_counterexample(const OneStateLaw& law, const SlopeSurvey& survey,
                                                       const PassivityOptions& options) {
  ReferenceMarchOptions run;
  run.stop = options.stop;
  run.max_steps = 2'000'000;
  for (int reach = 0; reach < reaches; ++reach)
    for (const TwoSpeedCycle& cycle : two_speed_cycles(law, survey, reach)) {
      if (options.stop && options.stop()) return std::nullopt;
      Counterexample example = as_input(law, cycle);
      if (is_confirmed(law, cycle, example, run) && grows(law, cycle, example, run)) return example;
    }
  return std::nullopt;
}

}  // namespace limcycle
