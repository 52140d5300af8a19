#include "limcycle/analysis/study/predict/loop_in_time.hpp"

#include <algorithm>

#include "limcycle/analysis/motion/parallel.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {

bool exact_in_time(const Loop& loop) {
  return loop.delay == 0.0 || in_time_domain(loop, lowest_pade_order).pade_order == 0;
}

namespace {

/// True if a sampled controller that reads in steps also commands in steps: the describing functions see the former.
bool has_steps_in_command(const Loop& sampled) {
  bool reads = false, commands = false;
  for (std::size_t i = 0; i < sampled.elements.size(); ++i) {
    const Sampled<double>* part = sampled_at(sampled, i);
    reads = reads || (part && part->input_quantum > 0.0);
    commands = commands || (part && part->output_quantum > 0.0);
  }
  return reads && commands;
}

/// True if an element of the averaged loop stands for the steps in which a sampled controller reads or commands (beside
/// no other nonlinear element): it has the path of a reading, or of a controller and ".steps".
bool sees_quanta(const Loop& averaged) {
  const Loop& sampled = *averaged.sampled;
  const auto is_clock = [&](const std::string& path) {
    for (std::size_t i = 0; i < sampled.ports.size(); ++i)
      if (sampled.ports[i].path == path) return sampled_at(sampled, i) != nullptr;
    return false;
  };
  return std::ranges::any_of(averaged.ports, [&](const Port& port) {
    return is_clock(port.path) ||
           (port.path.ends_with(".steps") && is_clock(port.path.substr(0, port.path.rfind('.'))));
  });
}

}  // namespace

LoopInTime loop_in_time(const Loop& loop, double highest) {
  if (loop.sampled) {
    LoopInTime made = loop_in_time(*loop.sampled, highest);
    const bool seen = sees_quanta(loop);
    made.note =
        "the controller reads and writes at its sample instants in every simulation; the describing functions see "
        "its pulse transfer function, hold and computation delay, without aliases and " +
        std::string(seen ? "with its quanta as those of a quantizer" : "without its quanta") +
        (seen && has_steps_in_command(*loop.sampled) ? ", but without those of its command" : "") +
        (made.note.empty() ? "" : "; " + made.note) +
        (made.treated.pade_order > 0 ? ", which the ripple between two samples passes with a wrong phase" : "");
    return made;
  }
  if (loop.delay == 0.0) return {{loop, 0, 0}, {}};
  const double up_to = std::min(highest > 0.0 ? 7.0 * highest : 7.0 / loop.delay, 40.0 / loop.delay);
  const int order = pade_order_for(up_to, loop.delay);
  LoopInTime made{in_time_domain(loop, order), {}};
  made.note =
      made.treated.pade_order == 0
          ? std::string("the delay is exact in the frequency domain and, acting on ") +
                (loop.continuous ? "the samples" : "a relay's switches") + ", in the time domain too"
          : "the delay is exact in the frequency domain; in the time domain it is a Pade approximation of order " +
                std::to_string(order) + "/" + std::to_string(order) + ", off by at most " +
                short_number(pade_error(up_to, loop.delay, order)) + " of the delayed signal up to " +
                short_number(up_to) + " rad/s";
  return made;
}

namespace {

/// True if y alone passes through the dead time.
bool delays_output(const Loop& loop) {
  for (Eigen::Index i = 0; i < loop.A_delayed.rows(); ++i)
    if (!parallel(loop.A_delayed.row(i), loop.C_y)) return false;
  return std::ranges::all_of(
      loop.ports, [&](const Port& port) { return port.C_delayed.size() == 0 || parallel(port.C_delayed, loop.C_y); });
}

}  // namespace

double delay_error(const Loop& loop, int pade_order, const Cycle& cycle) {
  if (pade_order == 0) return 0.0;
  if (loop.sampled) return delay_error(*loop.sampled, pade_order, cycle);
  const Eigen::VectorXcd X = delays_output(loop) ? output_harmonics(cycle, 199) : input_harmonics(cycle, 199);
  double sum = 0.0;
  for (int n = 1; n < X.size(); ++n) sum += std::abs(X(n)) * pade_error(n * cycle.frequency(), loop.delay, pade_order);
  return sum / std::abs(X(1));
}

}  // namespace limcycle
