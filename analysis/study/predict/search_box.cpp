#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

/// rad; at 2.4 the mean of gravity over a sinusoidal swing vanishes (J0), and with it the balance of the means.
double widest_swing(const Loop& loop) {
  const bool gravity =
      std::ranges::any_of(loop.elements, [](const auto& element) { return element.pull(0.0, 0.0).has_value(); });
  return gravity ? 2.0 / output_per_input(loop) : infinite;
}

/// Gains of an element for swings far beyond its own size, or within its limit.
Gains gains_beyond(const Element& element) {
  return element.as<Quantizer<double>>() != nullptr ? element.working_gain() : Gains{0.0, 0.0};
}
Gains gains_within(const Element& element) {
  return command_limit(element) > 0.0 ? within_limit(element) : gains_beyond(element);
}

/// Largest modulus of the poles with a damping ratio below 0.5; 0: there are none.
double fastest_resonance(const Loop& loop) {
  double fastest = 0.0;
  for (const auto& pole : eigenvalues(loop.tangent()))
    if (std::abs(pole.real()) < 0.5 * std::abs(pole)) fastest = std::max(fastest, std::abs(pole));
  return fastest;
}

/// Largest response of the main element's input to `level` at its output, from w = from to 10 fast, at
/// s = (0.1 + j) w, so that an undamped resonance does not count as infinite.
double largest_response(const Loop& loop, double level, double from, double fast) {
  const auto main = std::ssize(loop.elements) - 1;
  double largest = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double w = from * std::pow(10.0 * fast / from, i / 200.0);
    const double size = std::abs(loop.element_response(std::complex<double>(0.1 * w, w))(main, main)) * level;
    if (std::isfinite(size)) largest = std::max(largest, size);
  }
  return largest;
}

/// Largest amplitudes that the main element's input may reach.
struct Reach {
  double at_all = 0.0;
  double within_limits = infinite;  ///< of the command, if it has any
};

/// Within the limits of the command by the response of the closed loop; beyond them the loop is open, and the response
/// to the limited command counts, at the open loop's own frequencies.
Reach reach(const Loop& loop, double slow, double fast) {
  const std::size_t main = loop.elements.size() - 1;
  const double level = output_level(loop, main);
  const Loop beyond_limits = with_gains(loop, main, gains_beyond);
  const double open = largest_response(beyond_limits, level, 0.1 * slow, fast);
  double limit = 0.0;
  for (std::size_t k = 0; k < main; ++k) limit = std::max(limit, command_limit(loop.elements[k]));
  if (limit == 0.0 || !loop.ports.back().rubs) return {open};
  const double beyond = largest_response(beyond_limits, std::max(level, limit), slow, fast);
  const double within = largest_response(with_gains(loop, main, gains_within), level, 0.1 * slow, fast);
  return {std::min(open, std::max(beyond, within)), within > 0.0 ? within : infinite};
}

/// Largest amplitude of interest in a loop of which quantizers are all that is not linear: far above their steps it is
/// a linear loop. Infinite for any other.
double where_steps_count(const Loop& loop) {
  constexpr double many = 30.0;
  const auto rounds = [](const Element& element) { return element.as<Quantizer<double>>() != nullptr; };
  if (loop.elements.empty() || !std::ranges::all_of(loop.elements, rounds)) return infinite;
  double largest = loop.elements.back().switching_input();  // or what a step of another one makes of its input
  for (std::size_t k = 0; k + 1 < loop.elements.size(); ++k)
    largest = std::max(
        largest, std::abs(loop.ports.back().D(static_cast<Eigen::Index>(k))) * loop.elements[k].switching_input());
  return many * largest;
}

}  // namespace

/// Two decades around the loop's poles; amplitudes up to three times the largest response to the element's level there,
/// six decades down, from what the loop does within the limits of its command. Of a loop with a sampled controller
/// those of the continuous one, up to half of the sampling rate.
SearchBox default_search_box(const Loop& loop) {
  if (loop.sampled) {  // hold and computation make poles of their own
    SearchBox box = default_search_box(*loop.sampled->continuous);
    box.frequency_max = std::min(box.frequency_max, std::numbers::pi / sample_time(*loop.sampled));
    return box;
  }
  const auto moduli = pole_moduli(loop);
  const double slow = moduli.empty() ? 1.0 : moduli.front(), fast = moduli.empty() ? 1.0 : moduli.back();
  SearchBox box{0.0, 0.0, 0.01 * slow, 100.0 * fast};
  // A delay gives infinitely many roots, one at every turn of its phase: only the first few turns can matter, and those
  // up to a resonance; the first turn does, however slow the poles are.
  if (loop.delay > 0.0)
    box.frequency_max = std::clamp(box.frequency_max, 2.0 * std::numbers::pi / loop.delay,
                                   std::max(3.0 * fastest_resonance(loop), 30.0 / loop.delay));
  auto [largest, within_limits] = reach(loop, slow, fast);
  if (!(largest > 0.0)) largest = 1.0;
  box.amplitude_max = std::min({3.0 * largest, widest_swing(loop), where_steps_count(loop)});
  box.amplitude_min = 1e-6 * std::min(box.amplitude_max, 3.0 * within_limits);
  return box;
}

}  // namespace limcycle
