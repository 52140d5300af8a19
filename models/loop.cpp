#include "limcycle/models/loop.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Every signal of the loop is a row over [X | X delayed | w | external]; joining blocks is adding rows.
struct SignalSpace {
  Index n, elements;
  Index size() const { return 2 * n + elements + 4; }
  Row zero() const { return Row::Zero(size()); }
  Row state(const Row& c, Index first) const { return placed(c, first); }
  Row delayed_state(const Row& c, Index first) const { return placed(c, n + first); }
  Row output(Index i) const { return Row::Unit(size(), 2 * n + i); }
  Row external(ExternalIndex i) const { return Row::Unit(size(), 2 * n + elements + i); }

 private:
  Row placed(const Row& c, Index at) const {
    Row row = zero();
    row.segment(at, c.size()) = c;
    return row;
  }
};

bool uses_rate(const Element<double>& element) {
  return std::visit(
      []<class E>(const E&) {
        return requires { E::uses_rate; }
        || NeedsRate<E>;
      },
      element);
}

const Actuator& actuator_of(const Controller& controller) {
  return std::visit([](const auto& c) -> const Actuator& { return c; }, controller);
}

PlantModel plant_model(const Plant& plant) {
  return std::visit([](const auto& p) { return p.model(); }, plant);
}

ControllerModel controller_model(const Controller& controller) {
  return std::visit([](const auto& c) { return c.model(); }, controller);
}

/// Size of a row product compared with rounding of its terms: is C B really zero?
bool vanishes(const Row& C, const Eigen::VectorXd& B) {
  const double size = (C.cwiseAbs() * B.cwiseAbs()).value();
  return std::abs((C * B).value()) <= 1e-12 * size;
}

/// Builds the rows of the loop block by block, from the error to the plant.
class Assembly {
 public:
  explicit Assembly(const LoopParts& from)
      : parts_(from),
        plant_(plant_model(from.plant)),
        controller_(controller_model(from.controller)),
        actuator_(actuator_of(from.controller)) {
    np_ = plant_.A.rows();
    nc_ = controller_.ss.states();
    const Index lag = actuator_.lag > 0.0 ? 1 : 0;
    const Index saturation = std::isfinite(actuator_.saturation) ? 1 : 0;
    s_ = {np_ + nc_ + lag, saturation + (from.element ? 1 : 0) + (from.friction ? 1 : 0)};
    rates_ = Eigen::MatrixXd::Zero(s_.n, s_.size());
  }

  Loop build() {
    loop_.C_y = Row::Zero(s_.n);
    loop_.C_y.head(np_) = plant_.C_y;
    loop_.delay = plant_.delay;
    const Row command = actuator(controller());
    plant(forward(command));
    split();
    return std::move(loop_);
  }

 private:
  Row measured(const Row& c) const { return plant_.delay > 0.0 ? s_.delayed_state(c, 0) : s_.state(c, 0); }

  Row controller() {
    if (parts_.friction && !parts_.element && std::holds_alternative<NoController>(parts_.controller)) return s_.zero();
    const Row e = s_.external(reference_value) - measured(plant_.C_y);
    const Row e_rate = s_.external(reference_slope) - measured(plant_.C_y * plant_.A);
    const auto& [A, B, C, D] = controller_.ss;
    for (Index i = 0; i < nc_; ++i) rates_.row(np_ + i) = s_.state(A.row(i), np_) + B(i, 0) * e;
    return s_.state(C.row(0), np_) + D(0, 0) * e + controller_.D_rate * e_rate;
  }

  Row actuator(Row command) {
    if (std::isfinite(actuator_.saturation)) {
      Saturation<double> saturation;
      saturation.limit = actuator_.saturation;
      command = add(saturation, "loop.controller.saturation", command);
    }
    if (actuator_.lag > 0.0) {
      const Index i = s_.n - 1;
      const Row state = s_.state(Row::Ones(1), i);
      rates_.row(i) = (command - state) / actuator_.lag;
      command = state;
    }
    return command;
  }

  Row forward(const Row& command) { return parts_.element ? add(*parts_.element, "loop.element", command) : command; }

  void plant(const Row& u) {
    const Row force = u + s_.external(external_force);
    Row friction = s_.zero();
    if (parts_.friction) {
      friction = add(*parts_.friction, "loop.friction", s_.state(plant_.C_x, 0));
      velocity_ = s_.state(plant_.C_v, 0) + plant_.v0 * s_.external(constant_one);
    }
    for (Index i = 0; i < np_; ++i)
      rates_.row(i) = s_.state(plant_.A.row(i), 0) + plant_.B_u(i) * force - plant_.B_F(i) * friction;
  }

  Row add(const Element<double>& element, const char* path, const Row& input) {
    loop_.elements.push_back(element);
    inputs_.push_back(input);
    loop_.ports.emplace_back().path = path;
    return s_.output(std::ssize(loop_.elements) - 1);
  }

  /// Cuts the assembled rows into the matrices of the Lur'e form.
  void split() {
    const Index n = s_.n, ne = s_.elements;
    loop_.A = rates_.leftCols(n);
    loop_.A_delayed = rates_.middleCols(n, n);
    loop_.B = rates_.middleCols(2 * n, ne);
    loop_.E = rates_.rightCols(4);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      Port& port = loop_.ports[i];
      port.C = inputs_[i].head(n);
      port.C_delayed = inputs_[i].segment(n, n);
      port.D = inputs_[i].segment(2 * n, ne);
      port.c = inputs_[i].tail(4);
      const bool rubs = port.path == "loop.friction";
      const Row rate = rubs ? velocity_ : rate_of(inputs_[i]);
      port.C_v = rate.head(n);
      port.D_v = rate.segment(2 * n, ne);
      port.c_v = rate.tail(4);
    }
    loop_.external << 1.0, parts_.reference, 0.0, parts_.load;
    loop_.state_names = plant_.state_names;
    for (const auto& name : controller_.state_names) loop_.state_names.push_back(name);
    if (actuator_.lag > 0.0) loop_.state_names.emplace_back("u_lag");
  }

  /// Time derivative of an input that reads the state and r; a direct path from another element's output has no rate.
  Row rate_of(const Row& input) const {
    Row rate = input.head(s_.n) * rates_;
    rate(2 * s_.n + s_.elements + reference_slope) += input(2 * s_.n + s_.elements + reference_value);
    return rate;
  }

  const LoopParts& parts_;
  PlantModel plant_;
  ControllerModel controller_;
  Actuator actuator_;
  Index np_ = 0, nc_ = 0;
  SignalSpace s_{};
  Eigen::MatrixXd rates_;
  std::vector<Row> inputs_;
  Row velocity_;
  Loop loop_;
};

/// Measures the states from the steadily moving point X_r t of a ramp reference: A X_r + E_r rate = 0.
std::optional<BrokenRule> move_along(Loop& loop, double rate) {
  const Eigen::VectorXd pull = loop.E.col(reference_value) * rate;
  const Eigen::VectorXd X_r = loop.A.completeOrthogonalDecomposition().solve(-pull);
  if ((loop.A * X_r + pull).norm() > 1e-9 * pull.norm())
    return BrokenRule{"loop.reference",
                      "the loop has no steady motion along a ramp (it needs a controller that follows it)"};
  for (const auto& port : loop.ports) {
    const bool rubs = port.path == "loop.friction";  // where it rubs may move along, how fast must not change
    const double drift = rubs ? (port.C_v * X_r).value() : (port.C * X_r).value() + port.c(reference_value) * rate;
    if (std::abs(drift) > 1e-9 * std::abs(rate))
      return BrokenRule{"loop.reference", "the input of " + port.path + " would grow without limit along a ramp"};
  }
  loop.external(reference_slope) = rate;
  loop.E.col(constant_one) -= X_r;
  loop.ramp_output_rate = (loop.C_y * X_r).value();
  return std::nullopt;
}

std::optional<BrokenRule> validate_ports(const Loop& loop) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i) {
    const Port& port = loop.ports[i];
    if (port.path == "loop.friction" || !uses_rate(loop.elements[i])) continue;
    if (!port.D.isZero())
      return BrokenRule{"loop.element", "needs the rate of its input: put a lag behind the saturation"};
    const Row later = port.D_v.tail(port.D_v.size() - static_cast<Index>(i));
    const bool output_needs_rate = std::visit([]<class E>(const E&) { return NeedsRate<E>; }, loop.elements[i]);
    if (output_needs_rate && !later.isZero(1e-12))
      return BrokenRule{"loop.element", "makes an algebraic loop: its input rate depends on its own output; add a lag"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<BrokenRule> validate(const LoopParts& parts) {
  const PlantModel plant = plant_model(parts.plant);
  const ControllerModel controller = controller_model(parts.controller);
  if (!parts.element && !parts.friction)
    return BrokenRule{"loop", "needs a nonlinear element: add [loop.friction] or [loop.element]"};
  if (parts.friction && (!vanishes(plant.C_x, plant.B_F) || !vanishes(plant.C_y, plant.B_F)))
    return BrokenRule{"loop.plant", "needs relative degree 2 or more from force to position when there is friction"};
  if (controller.D_rate != 0.0 && !vanishes(plant.C_y, plant.B_u))
    return BrokenRule{"loop.controller.tf",
                      "must be > 0: the plant has relative degree 1 and kd differentiates its output"};
  if (parts.reference_rate != 0.0 && plant.delay > 0.0)
    return BrokenRule{"loop.reference", "a ramp and a delay cannot stand in one loop"};
  Loop loop = Assembly(parts).build();
  if (parts.reference_rate != 0.0)
    if (auto broken = move_along(loop, parts.reference_rate)) return broken;
  return validate_ports(loop);
}

Loop build_loop(const LoopParts& parts) {
  if (const auto broken = validate(parts)) throw std::invalid_argument(broken->key + ": " + broken->rule);
  Loop loop = Assembly(parts).build();
  if (parts.reference_rate != 0.0) move_along(loop, parts.reference_rate);
  return loop;
}

namespace {

struct Resolvent {
  Eigen::MatrixXcd X;  ///< response of the states to the element outputs, n x n_e
  std::complex<double> shift;
};

Resolvent respond(const Loop& loop, std::complex<double> s) {
  const std::complex<double> shift = std::exp(-s * loop.delay);
  const Index n = loop.states();
  Eigen::MatrixXcd M = s * Eigen::MatrixXcd::Identity(n, n) - loop.A.cast<std::complex<double>>();
  if (loop.delay > 0.0) M -= shift * loop.A_delayed.cast<std::complex<double>>();
  return {M.partialPivLu().solve(loop.B.cast<std::complex<double>>()), shift};
}

}  // namespace

Eigen::MatrixXcd Loop::element_response(std::complex<double> s) const {
  const auto [X, shift] = respond(*this, s);
  const auto ne = std::ssize(elements);
  Eigen::MatrixXcd H(ne, ne);
  for (Index i = 0; i < ne; ++i) {
    const Port& port = ports[static_cast<std::size_t>(i)];
    Eigen::RowVectorXcd row = port.C.cast<std::complex<double>>();
    if (delay > 0.0) row += shift * port.C_delayed.cast<std::complex<double>>();
    H.row(i) = row * X + port.D.cast<std::complex<double>>();
  }
  return H;
}

Eigen::RowVectorXcd Loop::output_response(double w) const {
  return C_y.cast<std::complex<double>>() * respond(*this, {0.0, w}).X;
}

Eigen::VectorXd Loop::rest_point(bool& exact) const {
  const Eigen::VectorXd pull = E * external;
  const Eigen::MatrixXd still = A + A_delayed;
  Eigen::VectorXd X = still.completeOrthogonalDecomposition().solve(-pull);
  exact = (still * X + pull).norm() <= 1e-12 * (1.0 + pull.norm());
  return X;
}

}  // namespace limcycle
