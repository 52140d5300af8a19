#include "limcycle/models/assemble.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/models/element/compensation.hpp"
#include "limcycle/models/element/dead_zone.hpp"
#include "limcycle/models/element/output_rate.hpp"
#include "limcycle/models/element/saturation.hpp"
#include "limcycle/models/rubbing_coordinates.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Every signal of the loop is a row over [X | X delayed | w | external], so that joining blocks adds rows.
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

bool is_set_valued(const Element& friction) { return friction.facts().has_selection; }

/// Builds the rows of the loop block by block, from the error to the plant.
class Assembly {
 public:
  explicit Assembly(const LoopParts& from)
      : parts_(from),
        coordinates_(from.friction ? rubbing_coordinates(model_of(from.plant))
                                   : PlantCoordinates{model_of(from.plant), {}}),
        plant_(coordinates_.plant),
        controller_(model_of(from.controller)),
        actuator_(actuator_of(from.controller)) {
    np_ = plant_.A.rows();
    nc_ = controller_.ss.states();
    s_ = {np_ + nc_ + (actuator_.lag > 0.0 ? 1 : 0), count_elements()};
    rates_ = Eigen::MatrixXd::Zero(s_.n, s_.size());
    rub_position_ = s_.zero();
    rub_velocity_ = s_.zero();
    if (!from.friction) return;
    rub_position_ = s_.state(plant_.C_x, 0);
    rub_velocity_ = s_.state(plant_.C_v, 0) + plant_.v0 * s_.external(constant_one);
  }

  Loop build() {
    loop_.C_y = Row::Zero(s_.n);
    loop_.C_y.head(np_) = plant_.C_y;
    loop_.delay = plant_.delay;
    if (plant_.gravity) weight_ = add(*plant_.gravity, "loop.plant.gravity", s_.state(plant_.C_gravity, 0));
    const Row command = actuator(controller());
    plant(forward(command));
    split();
    return std::move(loop_);
  }

 private:
  Index count_elements() const {
    const bool rate = parts_.error && controller_.D_rate != 0.0;
    const bool saturation = std::isfinite(actuator_.saturation), compensation = actuator_.friction_compensation > 0.0;
    const bool present[] = {plant_.gravity.has_value(), parts_.error.has_value(),   rate, compensation, saturation,
                            parts_.element.has_value(), parts_.friction.has_value()};
    return std::ranges::count(present, true);
  }

  Row measured(const Row& c) const { return plant_.delay > 0.0 ? s_.delayed_state(c, 0) : s_.state(c, 0); }

  Row controller() {
    Row e = s_.external(reference_value) - measured(plant_.C_y);
    Row e_rate = s_.external(reference_slope) - measured(plant_.C_y * plant_.A);
    if (parts_.error) {
      const Row input = e;
      e = add(*parts_.error, "loop.error", input);
      if (controller_.D_rate != 0.0)
        e_rate = add(output_rate(*parts_.error).value_or(OutputRate<double>{}), "loop.error.rate", input);
    }
    if (!uses_error(parts_)) return s_.zero();
    const auto& [A, B, C, D] = controller_.ss;
    for (Index i = 0; i < nc_; ++i) rates_.row(np_ + i) = s_.state(A.row(i), np_) + B(i, 0) * e;
    return s_.state(C.row(0), np_) + D(0, 0) * e + controller_.D_rate * e_rate;
  }

  Row actuator(Row command) {
    if (actuator_.friction_compensation > 0.0) {
      Compensation<double> compensation;
      compensation.level = actuator_.friction_compensation;
      command += add(compensation, "loop.controller.friction_compensation", rub_position_, true);
      if (parts_.friction && is_set_valued(*parts_.friction))
        loop_.ports.back().selection_of = static_cast<std::size_t>(s_.elements - 1);  // friction comes last
    }
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
    if (parts_.friction) friction = add(*parts_.friction, "loop.friction", rub_position_, true);
    for (Index i = 0; i < np_; ++i) {
      rates_.row(i) = s_.state(plant_.A.row(i), 0) + plant_.B_u(i) * force - plant_.B_F(i) * friction;
      if (plant_.gravity) rates_.row(i) -= plant_.B_gravity(i) * weight_;
    }
  }

  Row add(const Element& element, const char* path, const Row& input, bool rubs = false) {
    loop_.elements.push_back(element);
    inputs_.push_back(input);
    loop_.ports.emplace_back().path = path;
    loop_.ports.back().rubs = rubs;
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
      const Row rate = port.rubs ? rub_velocity_ : rate_of(inputs_[i]);
      port.C_v = rate.head(n);
      port.D_v = rate.segment(2 * n, ne);
      port.c_v = rate.tail(4);
    }
    loop_.external << 1.0, parts_.reference, 0.0, parts_.load;
    loop_.state_names = plant_.state_names;
    for (const auto& name : controller_.state_names) loop_.state_names.push_back(name);
    if (actuator_.lag > 0.0) loop_.state_names.emplace_back("u_lag");
    if (coordinates_.own_states.size() == 0) return;
    loop_.own_states = Eigen::MatrixXd::Identity(s_.n, s_.n);
    loop_.own_states.topLeftCorner(np_, np_) = coordinates_.own_states;
  }

  /// Time derivative of an input that reads the state and r; a direct path from another element's output has no rate.
  Row rate_of(const Row& input) const {
    Row rate = input.head(s_.n) * rates_;
    rate(2 * s_.n + s_.elements + reference_slope) += input(2 * s_.n + s_.elements + reference_value);
    return rate;
  }

  const LoopParts& parts_;
  PlantCoordinates coordinates_;
  const PlantModel& plant_;
  ControllerModel controller_;
  Actuator actuator_;
  Index np_ = 0, nc_ = 0;
  SignalSpace s_{};
  Eigen::MatrixXd rates_;
  std::vector<Row> inputs_;
  Row rub_position_, rub_velocity_, weight_;
  Loop loop_;
};

}  // namespace

std::optional<OutputRate<double>> output_rate(const Element& element) {
  if (const auto* zone = element.as<DeadZone<double>>()) return OutputRate<double>::of(*zone);
  if (const auto* limit = element.as<Saturation<double>>()) return OutputRate<double>::of(*limit);
  return std::nullopt;
}

bool uses_error(const LoopParts& parts) {
  return !parts.friction || parts.element || !std::holds_alternative<NoController>(parts.controller);
}

Loop assemble(const LoopParts& parts) { return Assembly(parts).build(); }

}  // namespace limcycle
