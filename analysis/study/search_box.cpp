#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/study/output_per_input.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {
namespace {

/// rad; at 2.4 the mean of gravity over a sinusoidal swing vanishes (J0), and with it the balance of the means.
double widest_swing(const Loop& loop) {
  const bool gravity = std::ranges::any_of(loop.elements, [](const auto& element) {
    return std::visit([]<class E>(const E&) { return PullsBack<E>; }, element);
  });
  return gravity ? 2.0 / output_per_input(loop) : infinite;
}

/// The loop as large swings see it: a quantizer passes them as they are.
Loop at_large_swings(Loop loop) {
  Port& main = loop.ports.back();
  for (std::size_t k = 0; k + 1 < loop.elements.size(); ++k) {
    const bool passes = std::visit(
        []<class E>(const E&) {
          return requires(const E& e) { e.step; };
        },
        loop.elements[k]);
    if (!passes) continue;
    const Port& port = loop.ports[k];
    const auto column = static_cast<Eigen::Index>(k);
    loop.A += loop.B.col(column) * port.C;
    if (loop.A_delayed.size() > 0 && port.C_delayed.size() > 0) loop.A_delayed += loop.B.col(column) * port.C_delayed;
    main.C += main.D(column) * port.C;
  }
  return loop;
}

}  // namespace

/// Two decades around the loop's poles; amplitudes up to three times the largest response to the element's level there
/// (at s = (0.1 + j) w, so that an undamped resonance does not count as infinite), six decades down.
SearchBox default_search_box(const Loop& loop) {
  const auto moduli = pole_moduli(loop);
  const double slow = moduli.empty() ? 1.0 : moduli.front(), fast = moduli.empty() ? 1.0 : moduli.back();
  SearchBox box{0.0, 0.0, 0.01 * slow, 100.0 * fast};
  // A delay makes roots without end, at every turn of its phase: the first few turns are what can matter.
  if (loop.delay > 0.0) box.frequency_max = std::min(box.frequency_max, std::max(10.0 * fast, 30.0 / loop.delay));
  const auto main = std::ssize(loop.elements) - 1;
  const double output = output_level(loop, loop.elements.size() - 1);
  const Loop swung = at_large_swings(loop);
  double largest = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double w = 0.1 * slow * std::pow(100.0 * fast / slow, i / 200.0);
    const double level = std::abs(swung.element_response(std::complex<double>(0.1 * w, w))(main, main)) * output;
    if (std::isfinite(level)) largest = std::max(largest, level);
  }
  if (!(largest > 0.0)) largest = 1.0;
  box.amplitude_max = std::min(3.0 * largest, widest_swing(loop));
  box.amplitude_min = 1e-6 * box.amplitude_max;
  return box;
}

}  // namespace limcycle
