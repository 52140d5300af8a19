#include "limcycle/models/loop.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/diagram/on_clock.hpp"
#include "limcycle/models/diagram/quanta.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/sampled_response.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

bool uses_rate(const Element& element) { return element.facts().uses_rate; }

/// Steady motion X_r t along a ramp: A X_r + E_r rate = 0 with every input constant (a rubbing displacement may move,
/// but its velocity must not change). With an element between error and controller the first condition alone does not
/// determine X_r. Rows are scaled to one size, so that the least-squares solution is exact if there is one.
Eigen::VectorXd steady_motion(const Loop& loop, double rate) {
  const Index n = loop.states(), inputs = std::ssize(loop.ports);
  Eigen::MatrixXd rows(n + inputs, n);
  Eigen::VectorXd pull(n + inputs);
  rows.topRows(n) = loop.A;
  pull.head(n) = loop.E.col(reference_value) * rate;
  for (Index i = 0; i < inputs; ++i) {
    const Port& port = loop.ports[static_cast<std::size_t>(i)];
    rows.row(n + i) = port.rubs ? port.C_v : port.C;
    pull(n + i) = port.rubs ? 0.0 : port.c(reference_value) * rate;
  }
  equilibrate(rows, pull);
  return least_squares(rows, -pull);
}

/// Measures the states from the steadily moving point X_r t of a ramp reference.
std::optional<BrokenRule> move_along(Loop& loop, double rate, const std::string& key) {
  const Eigen::VectorXd pull = loop.E.col(reference_value) * rate;
  const Eigen::VectorXd X_r = steady_motion(loop, rate);
  const double size = pull.norm() + loop.A.norm() * X_r.norm();
  if ((loop.A * X_r + pull).norm() > 1e-9 * size)
    return BrokenRule{key, "the loop has no steady motion along a ramp (it needs a controller that follows it)"};
  for (const auto& port : loop.ports) {
    const double drift = port.rubs ? (port.C_v * X_r).value() : (port.C * X_r).value() + port.c(reference_value) * rate;
    if (std::abs(drift) > 1e-9 * std::abs(rate))
      return BrokenRule{key, "the input of " + port.path + " would grow without limit along a ramp"};
  }
  loop.external(reference_slope) = rate;
  loop.E.col(constant_one) -= X_r;
  loop.origin_rate = X_r;
  loop.ramp_output_rate = (loop.C_y * X_r).value();
  return std::nullopt;
}

/// True if an element uses the force that holds its input: only friction on a body has one.
bool needs_applied_force(const Element& element) { return element.needs_drive() || element.drive_band() > 0.0; }

/// Elements with a direct path into an input that must have a rate.
std::string straight_into(const Loop& loop, const Port& port) {
  std::string names;
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    if (port.D(static_cast<Index>(i)) != 0.0) names += (names.empty() ? "" : ", ") + loop.ports[i].path;
  return names;
}

std::optional<BrokenRule> validate_ports(const Loop& loop) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i) {
    const Port& port = loop.ports[i];
    if (port.rubs || !uses_rate(loop.elements[i])) continue;
    const std::string lag = port.path.starts_with("diagram.") ? "put a low-pass between" : "add loop.controller.lag";
    if (!port.D.isZero())
      return BrokenRule{port.path, "needs the rate of its input, into which the output of " +
                                       straight_into(loop, port) + " passes straight: " + lag};
    const Row later = port.D_v.tail(port.D_v.size() - static_cast<Index>(i));
    const bool output_needs_rate = loop.elements[i].facts().needs_rate;
    if (output_needs_rate && !later.isZero(1e-12))
      return BrokenRule{port.path, "makes an algebraic loop: its input rate depends on its own output; add a lag"};
  }
  return std::nullopt;
}

std::optional<BrokenRule> validate_error(const LoopParts& parts, double D_rate) {
  if (!parts.error) return std::nullopt;
  if (!uses_error(parts))
    return BrokenRule{"loop.error", "needs a controller: with friction alone the error is not used"};
  if (const auto* pid = std::get_if<Pid>(&parts.controller); pid != nullptr && pid->reset_speed > 0.0)
    return BrokenRule{"loop.controller.reset_speed", "cannot stand beside [loop.error], whose output has no rate here"};
  if (D_rate == 0.0 || output_rate(*parts.error)) return std::nullopt;
  const std::string kind(parts.error->kind());
  const bool jumps = parts.error->as<Quantizer<double>>() != nullptr;
  return BrokenRule{"loop.controller.tf", "must be > 0: kd differentiates the output of the " + kind +
                                              (jumps ? ", which jumps" : " on the error, whose rate is not known")};
}

std::optional<BrokenRule> validate_sampling(const LoopParts& parts) {
  const Sampling& sampling = sampling_of(parts.controller);
  if (auto broken = sampling.broken_together()) return BrokenRule{"loop.controller." + broken->key, broken->rule};
  if (!sampling.is_on()) return std::nullopt;
  const auto refuse = [](const char* rule) { return BrokenRule{"loop.controller.sample_time", rule}; };
  if (!uses_error(parts)) return refuse("has nothing to sample: with friction alone the error is not used");
  const bool differences =
      std::holds_alternative<Cascade>(parts.controller) || std::holds_alternative<Pid>(parts.controller);
  if (sampling.velocity_window > 0.0 && !differences)
    return BrokenRule{"loop.controller.velocity_window", "is for pid and cascade: another takes no velocity"};
  if (parts.reference_rate != 0.0) return refuse("cannot stand beside a ramp yet: the reference must be constant");
  if (!has_differences(parts.controller)) return refuse("must not be the inverse of a pole of the controller");
  return std::nullopt;
}

bool has_no_elements(const Diagram& diagram) {
  return std::ranges::none_of(diagram.blocks,
                              [](const Block& block) { return std::holds_alternative<Element>(block.what); });
}

std::optional<BrokenRule> validate_slots(const LoopParts& parts) {
  const PlantModel plant = model_of(parts.plant);
  const ControllerModel controller = model_of(parts.controller);
  if (const auto* froude = std::get_if<FroudePendulum>(&parts.plant); froude && froude->clearance > 0.0)
    return BrokenRule{"loop.plant.clearance",
                      "must be 0 in a loop: clearance needs `limcycle experiment froude-pendulum`"};
  if (parts.element && needs_applied_force(*parts.element))
    return BrokenRule{"loop.element", "needs the applied force: it can only stand as [loop.friction]"};
  if (parts.friction && (!does_not_reach(plant.C_x, plant.B_F) || !does_not_reach(plant.C_y, plant.B_F)))
    return BrokenRule{"loop.plant", "needs relative degree 2 or more from force to position when there is friction" +
                                        std::string(plant.measured ? ": relative_degree = \"two\" asks for it" : "")};
  if (actuator_of(parts.controller).friction_compensation > 0.0 && !parts.friction)
    return BrokenRule{"loop.controller.friction_compensation", "has nothing to compensate: add [loop.friction]"};
  if (controller.D_rate != 0.0 && !does_not_reach(plant.C_y, plant.B_u))
    return BrokenRule{"loop.controller.tf",
                      "must be > 0: the plant has relative degree 1 and kd differentiates its output"};
  std::optional<BrokenRule> together;
  if (const auto* cascade = std::get_if<Cascade>(&parts.controller)) together = cascade->broken_together();
  if (const auto* pid = std::get_if<Pid>(&parts.controller)) together = pid->broken_together();
  if (together) return BrokenRule{"loop.controller." + together->key, together->rule};
  if (auto broken = validate_error(parts, controller.D_rate)) return broken;
  if (auto broken = validate_sampling(parts)) return broken;
  const bool named = parts.element || parts.friction || parts.error;
  if (!named &&
      has_no_elements(short_form(parts, sampling_of(parts.controller).is_on() ? Clock::averaged : Clock::continuous)))
    return BrokenRule{"loop", "needs a nonlinear element: add [loop.friction], [loop.element] or [loop.error]"};
  return std::nullopt;
}

std::optional<BrokenRule> validate_diagram(const Diagram& diagram) {
  bool nonlinear = false;
  for (const Block& block : diagram.blocks) {
    if (const auto* controller = std::get_if<Controller>(&block.what))
      if (const auto* pid = std::get_if<Pid>(controller)) {
        if (pid->holds_integral_back())
          return BrokenRule{block.path + "." + std::string(pid->held_back_by()),
                            "is not for a block of a diagram: let the integral be a block of its own, of kind "
                            "clamped-pi or reset-integrator, or window and integrator"};
        if (pid->impulse > 0.0)
          return BrokenRule{block.path + ".impulse",
                            "is not for a block of a diagram: let the impulses be a block of their own"};
      }
    if (const auto* plant = std::get_if<Plant>(&block.what)) {
      nonlinear = nonlinear || std::holds_alternative<FroudePendulum>(*plant);
      if (const auto* froude = std::get_if<FroudePendulum>(plant); froude && froude->clearance > 0.0)
        return BrokenRule{block.path + ".clearance", "must be 0 in a loop"};
    }
    const auto* element = std::get_if<Element>(&block.what);
    nonlinear = nonlinear || element != nullptr;
    if (element != nullptr && block.contact == Contact::none && needs_applied_force(*element))
      return BrokenRule{block.path, "needs the applied force: it can only act on a body, with `on`"};
  }
  if (auto broken = broken_clocks(diagram)) return broken;
  if (!nonlinear && has_no_elements(with_quantizers(expanded(diagram))))
    return BrokenRule{"diagram", "needs a nonlinear element, such as a friction law"};
  return std::nullopt;
}

/// What does not go together with a sampled controller yet.
std::optional<BrokenRule> validate_sampled_diagram(const LoopParts& parts) {
  if (!parts.diagram || !is_sampled(*parts.diagram)) return std::nullopt;
  if (parts.reference_rate != 0.0)
    return BrokenRule{"diagram.reference", "a ramp cannot stand beside a sample_time yet: it must be constant"};
  return std::nullopt;
}

/// An element that stops where its input turns sees that by the sign of the input's rate, which an approximated dead
/// time shows wrongly, and which does not show the jumps of a sampled controller (the only ones: see validate_ports).
std::optional<BrokenRule> broken_way_of_input(const Loop& loop) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    const Element& element = loop.elements[i];
    const Port& port = loop.ports[i];
    if (!element.facts().uses_rate || element.facts().needs_rate || port.rubs) continue;
    if (loop.delay > 0.0 && element.kind() == "valve-stiction")
      return BrokenRule{port.path,
                        "cannot stand in a loop with dead time: the stem stops where its command turns, and in the "
                        "time domain an approximation of the dead time would turn it too early; a valve of a mass, a "
                        "spring and friction can"};
    if (!port.D.isZero())
      return BrokenRule{port.path, "goes by the way its input moves, and the output of " + straight_into(loop, port) +
                                       " jumps: in a diagram a low-pass block may stand between them"};
  }
  return std::nullopt;
}

}  // namespace

Subject subject_of(const LoopParts& parts) {
  if (!parts.diagram) {
    if (parts.friction) return {&*parts.friction, "loop.friction", true};
    if (parts.element) return {&*parts.element, "loop.element", false};
    return parts.error ? Subject{&*parts.error, "loop.error", false} : Subject{};
  }
  for (const Contact contact : {Contact::opposes, Contact::none}) {
    const auto found = elements_of(*parts.diagram, contact);
    if (found.size() == 1)
      return {&std::get<Element>(found.front()->what), found.front()->path, contact == Contact::opposes};
    if (!found.empty()) break;
  }
  return {};
}

std::optional<BrokenRule> validate(const LoopParts& parts) try {
  if (auto broken = parts.diagram ? validate_diagram(*parts.diagram) : validate_slots(parts)) return broken;
  if (auto broken = validate_sampled_diagram(parts)) return broken;
  Loop loop = assemble(parts);
  const std::string reference = parts.diagram ? "diagram.reference" : "loop.reference";
  if (parts.reference_rate != 0.0 && loop.delay > 0.0)
    return BrokenRule{reference, "a ramp and a delay cannot stand in one loop"};
  if (parts.reference_rate != 0.0)
    if (auto broken = move_along(loop, parts.reference_rate, reference)) return broken;
  if (auto broken = validate_ports(loop)) return broken;
  return broken_way_of_input(loop.sampled ? *loop.sampled : loop);  // with samples, `loop` is their average
} catch (const BrokenDiagram& broken) {
  return broken.rule;
}

Loop build_loop(const LoopParts& parts) {
  if (const auto broken = validate(parts)) throw std::invalid_argument(broken->key + ": " + broken->rule);
  Loop loop = assemble(parts);
  if (parts.reference_rate != 0.0) move_along(loop, parts.reference_rate, {});
  loop.measure_from_rest();
  return loop;
}

namespace {

struct Resolvent {
  Eigen::MatrixXcd X;  ///< response of the states to the element outputs, n x n_e
  std::complex<double> shift;
};

Resolvent respond(const Loop& loop, std::complex<double> s) {
  const auto [from, B] = loop.resolved(s);
  return {solve_columns(from, B), std::exp(-s * loop.delay)};
}

}  // namespace

Loop::Resolved Loop::resolved(std::complex<double> s) const {
  using Complex = std::complex<double>;
  const Complex shift = std::exp(-s * delay);
  Resolved at{s * Eigen::MatrixXcd::Identity(states(), states()) - A.cast<Complex>(), B.cast<Complex>()};
  if (delay > 0.0) at.from -= shift * A_delayed.cast<Complex>();
  if (s.real() != 0.0) return at;
  for (const MeasuredPart& part : measured) {
    const Complex more = part.factor * part.response->ratio(s.imag()) - 1.0;
    Eigen::RowVectorXcd input = part.C.cast<Complex>();
    if (delay > 0.0) input += shift * part.C_delayed.cast<Complex>();
    at.from -= (more * part.B.cast<Complex>()) * input;
    at.B += (more * part.B.cast<Complex>()) * part.D.cast<Complex>();
  }
  return at;
}

Eigen::MatrixXcd Loop::element_response(std::complex<double> s) const {
  if (sampled) return sampled_response(*this, s).elements;
  const auto [X, shift] = respond(*this, s);
  const auto ne = std::ssize(elements);
  Eigen::MatrixXcd H(ne, ne);
  for (Index i = 0; i < ne; ++i) {
    const Port& port = ports[static_cast<std::size_t>(i)];
    if (port.rubs && port.C.isZero(0.0)) {  // no state holds the rubbing displacement
      H.row(i) = (port.C_v.cast<std::complex<double>>() * X + port.D_v.cast<std::complex<double>>()) / s;
      continue;
    }
    Eigen::RowVectorXcd row = port.C.cast<std::complex<double>>();
    if (delay > 0.0) row += shift * port.C_delayed.cast<std::complex<double>>();
    H.row(i) = row * X + port.D.cast<std::complex<double>>();
  }
  return H;
}

Eigen::RowVectorXcd Loop::output_response(double w) const {
  if (sampled) return sampled_response(*this, {0.0, w}).output;
  return C_y.cast<std::complex<double>>() * respond(*this, {0.0, w}).X;
}

}  // namespace limcycle
