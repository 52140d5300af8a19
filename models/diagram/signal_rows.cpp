#include "limcycle/models/diagram/signal_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace limcycle {

namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

const Element* element_in(const Block& block) { return std::get_if<Element>(&block.what); }

template <class Kind>
const Kind* linear_in(const Block& block) {
  const auto* linear = std::get_if<LinearBlock>(&block.what);
  return linear != nullptr ? std::get_if<Kind>(linear) : nullptr;
}

}  // namespace

SignalRows::SignalRows(const Diagram& diagram) : diagram_(diagram) {
  parts_.reserve(diagram.blocks.size());
  for (const Block& block : diagram.blocks) add_part(block);
}

bool SignalRows::is_rubbed(const Block& block) const {
  return std::ranges::any_of(diagram_.blocks, [&](const Block& other) {
    return other.contact == Contact::opposes && (other.on == block.name || other.against == block.name);
  });
}

/// The friction law at the body that y is measured of is the one that questions about one element are about.
bool SignalRows::is_at_output(const Block& block) const {
  return block.on == diagram_.output.block || block.against == diagram_.output.block;
}

void SignalRows::add_part(const Block& block) {
  Part part;
  part.block = &block;
  part.first = n_;
  if (const auto* plant = std::get_if<Plant>(&block.what)) {
    PlantCoordinates in{limcycle::model_of(*plant), {}};
    if (is_rubbed(block)) in = rubbing_coordinates(std::move(in.plant));
    part.linear.ss = {in.plant.A, in.plant.B_u, in.plant.C_y, Eigen::MatrixXd::Zero(1, 1)};
    part.linear.delay = in.plant.delay + block.late;
    part.linear.state_names = in.plant.state_names;
    if (in.plant.gravity) ++room_;
    part.own_states = in.own_states;
    part.plant = std::move(in.plant);
  } else if (const auto* controller = std::get_if<Controller>(&block.what)) {
    ControllerModel model = limcycle::model_of(*controller);
    part.linear.ss = std::move(model.ss);
    part.linear.state_names = std::move(model.state_names);
    part.derivative = model.D_rate;
  } else if (const auto* linear = std::get_if<LinearBlock>(&block.what)) {
    part.linear = model_of(*linear);
    if (const auto* delay = std::get_if<DelayBlock>(linear)) part.linear.delay = delay->delay;
  } else {
    room_ += 2;  // the element, and the rate of its output
  }
  if (!block.states.empty()) part.linear.state_names = block.states;
  n_ += part.linear.ss.states();
  if (part.linear.delay > 0.0) {
    if (delay_ > 0.0 && delay_ != part.linear.delay)
      throw BrokenDiagram(
          {block.path + ".delay", "must be that of the other dead time in this loop: only one is known"});
    delay_ = part.linear.delay;
  }
  parts_.push_back(std::move(part));
}

void SignalRows::number_elements() {
  for (Part& from : parts_) {
    if (!from.plant || !from.plant->gravity) continue;
    from.number = ports_.size();
    from.extra = Element(*from.plant->gravity);
    ports_.push_back({&*from.extra,
                      from.block->path + ".gravity",
                      {},
                      {},
                      Contact::none,
                      state(from.plant->C_gravity, from.first),
                      {}});
  }
  for (Part& from : parts_) {
    if (element_in(*from.block) != nullptr && from.block->contact == Contact::none)
      number(from);
    else if (from.block->contact == Contact::senses && !from.number)
      number_contact(from);
    else if (std::holds_alternative<Controller>(from.block->what))
      value(Term{1.0, from.block->name, {}});
  }
  for (const bool at_output : {false, true})
    for (Part& from : parts_)
      if (from.block->contact == Contact::opposes && is_at_output(*from.block) == at_output) number_contact(from);
  for (ElementRows& port : ports_) {
    port.input = trimmed(port.input);
    if (port.rate.size() != 0) port.rate = trimmed(port.rate);
  }
  room_ = elements();
}

Row SignalRows::trimmed(const Row& row) const {
  Row cut(2 * n_ + elements() + 4);
  cut << row.head(2 * n_ + elements()), row.tail(4);
  return cut;
}

Row SignalRows::state(const Row& c, Index first) const {
  Row row = zero();
  row.segment(first, c.size()) = c;
  return row;
}

Row SignalRows::delayed(Row row) const {
  row.segment(n_, n_) = row.head(n_);
  row.head(n_).setZero();
  return row;
}

Row SignalRows::element_output(std::size_t number) const {
  return Row::Unit(size(), 2 * n_ + static_cast<Index>(number));
}

Row SignalRows::external(ExternalIndex i) const { return Row::Unit(size(), size() - 4 + i); }

SignalRows::Part& SignalRows::part(const Term& term) {
  const auto found = find_block(diagram_, term.block);
  if (!found) throw BrokenDiagram({"diagram", "has no block named \"" + term.block + "\""});
  return parts_[*found];
}

SignalRows::Tap SignalRows::tap(const Part& from, const Term& term) const {
  const auto& [A, B, C, D] = from.linear.ss;
  if (term.output.empty() && C.rows() == 1) return {C.row(0), 0};
  if (from.plant && term.output == "y") return {C.row(0), 0};
  if (from.plant && term.output == "v") {
    if (!does_not_reach(C.row(0), B.col(0)) || (is_rubbed(*from.block) && !does_not_reach(C.row(0), from.plant->B_F)))
      throw BrokenDiagram({from.block->path, "has no velocity v: its output y changes at once with the force"});
    return {C.row(0) * A, 0};
  }
  const auto& names = from.linear.state_names;
  if (const auto at = std::ranges::find(names, term.output); at != names.end()) {
    const Index j = at - names.begin();
    return {from.own_states.size() != 0 ? Row(from.own_states.row(j)) : Row(Row::Unit(A.rows(), j)), -1};
  }
  Index k = 0;
  const char* end = term.output.data() + term.output.size();
  const auto [rest, fault] = std::from_chars(term.output.data(), end, k);
  if (fault == std::errc() && rest == end && k >= 1 && k <= C.rows()) return {C.row(k - 1), k - 1};
  std::string known = from.plant ? "y, v" : C.rows() > 1 ? "1 to " + std::to_string(C.rows()) : "";
  for (const auto& name : names)
    if (!from.plant || (name != "y" && name != "v")) known += (known.empty() ? "" : ", ") + name;
  throw BrokenDiagram({from.block->path, term.output.empty() ? "has several outputs; name one: " + known
                                                             : "has no output \"" + term.output + "\"" +
                                                                   (known.empty() ? "" : "; it has " + known)});
}

/// Marks a block as open while its input is asked for: a block that is met again makes an algebraic loop.
class SignalRows::Opening {
 public:
  Opening(std::vector<Part*>& way, Part& part) : way_(way), part_(part) {
    if (part.open) {
      std::string others;
      for (auto at = std::ranges::find(way, &part) + 1; at != way.end(); ++at)
        others += (others.empty() ? "" : ", ") + (*at)->block->name;
      throw BrokenDiagram({part.block->path, "makes an algebraic loop" +
                                                 (others.empty() ? " with itself" : " with " + others) +
                                                 ": its input changes at once with its own output. Put a low-pass "
                                                 "between them"});
    }
    part.open = true;
    way_.push_back(&part);
  }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;
  ~Opening() {
    way_.pop_back();
    part_.open = false;
  }

 private:
  std::vector<Part*>& way_;
  Part& part_;
};

std::size_t SignalRows::number(Part& from) {
  if (from.number) return *from.number;
  const Opening open(way_, from);
  const Row input = value(from.block->inputs.at(0));
  from.number = ports_.size();
  ports_.push_back({element_in(*from.block), from.block->path, {}, {}, Contact::none, input, {}});
  return *from.number;
}

void SignalRows::number_contact(Part& from) {
  const Block& block = *from.block;
  Row position = zero(), velocity = zero();
  const auto touch = [&](const std::string& name, double sign) {
    const Part& body = part({1.0, name, {}});
    if (!body.plant || body.plant->C_v.size() == 0)
      throw BrokenDiagram({block.path, "acts on " + name + ", which is no plant with a velocity"});
    const PlantModel& plant = *body.plant;
    const bool direct = !does_not_reach(plant.C_x, plant.B_F) || !does_not_reach(plant.C_y, plant.B_F);
    if (block.contact == Contact::opposes && direct)
      throw BrokenDiagram(
          {body.block->path, "needs relative degree 2 or more from force to position when there is friction"});
    position += sign * state(plant.C_x, body.first);
    velocity += sign * (state(plant.C_v, body.first) + plant.v0 * external(constant_one));
  };
  touch(block.on, 1.0);
  if (!block.against.empty()) touch(block.against, -1.0);
  from.number = ports_.size();
  ports_.push_back({element_in(block), block.path, block.on, block.against, block.contact, position, velocity});
}

Row SignalRows::value(const SignalSum& sum) {
  Row row = zero();
  for (const Term& term : sum) row += value(term);
  return row;
}

Row SignalRows::value(const Term& term) {
  if (term.block == "r") {
    if (!term.output.empty() && term.output != "rate")
      throw BrokenDiagram({"diagram", "the reference has no output \"" + term.output + "\"; it has rate"});
    return term.factor * external(term.output.empty() ? reference_value : reference_slope);
  }
  Part& from = part(term);
  if (from.block->contact == Contact::opposes)
    throw BrokenDiagram({from.block->path, "is friction on " + from.block->on + ": its force is no signal"});
  if (from.block->contact == Contact::senses && !from.number) number_contact(from);
  if (element_in(*from.block) != nullptr) return term.factor * element_output(number(from));
  if (const auto* constant = linear_in<Constant>(*from.block))
    return term.factor * constant->value * external(constant_one);
  if (linear_in<DelayBlock>(*from.block) != nullptr) return term.factor * delayed_input(from);
  const Tap at = tap(from, term);
  Row row = state(at.c, from.first);
  if (from.linear.delay > 0.0) row = delayed(row);
  if (at.output < 0) return term.factor * row;
  const auto& inputs = from.block->inputs;
  const auto through = from.linear.ss.D.row(at.output);
  if (through.isZero(0.0) && from.derivative == 0.0) return term.factor * row;
  const Opening open(way_, from);
  for (std::size_t k = 0; k < inputs.size(); ++k)
    if (const double gain = through(static_cast<Index>(k)); gain != 0.0) row += gain * value(inputs[k]);
  if (from.derivative != 0.0) row += from.derivative * rate(inputs.at(0), *from.block);
  return term.factor * row;
}

Row SignalRows::delayed_input(Part& from) {
  const Opening open(way_, from);
  const Row row = value(from.block->inputs.at(0));
  if (!row.segment(n_, size() - n_ - 4).isZero(0.0))
    throw BrokenDiagram({from.block->path,
                         "delays the output of an element or of another delay: put the delay behind "
                         "a block whose output is a state"});
  return delayed(row);
}

Row SignalRows::rate(const SignalSum& sum, const Block& asking) {
  Row row = zero();
  for (const Term& term : sum) row += rate(term, asking);
  return row;
}

Row SignalRows::rate(const Term& term, const Block& asking) {
  const auto refuse = [&](const std::string& why) {
    return BrokenDiagram({asking.path + ".tf", "must be > 0: kd differentiates " + term.block + ", " + why});
  };
  if (term.block == "r") return term.output.empty() ? Row(term.factor * external(reference_slope)) : zero();
  Part& from = part(term);
  if (const Element* element = element_in(*from.block)) {
    const auto of_output = output_rate(*element);
    if (!of_output || from.block->contact != Contact::none) throw refuse("whose rate is not known");
    if (!from.rate_number) {
      const Row input = value(from.block->inputs.at(0));
      from.rate_number = ports_.size();
      from.extra = Element(*of_output);
      ports_.push_back({&*from.extra, from.block->path + ".rate", {}, {}, Contact::none, input, {}});
    }
    return term.factor * element_output(*from.rate_number);
  }
  if (linear_in<Constant>(*from.block) != nullptr) return zero();
  if (linear_in<DelayBlock>(*from.block) != nullptr) throw refuse("a delayed signal");
  if (from.derivative != 0.0) throw refuse("which is itself a derivative");
  const Tap at = tap(from, term);
  const auto& [A, B, C, D] = from.linear.ss;
  Row row = state(at.c * A / from.linear.time, from.first);
  if (from.linear.delay > 0.0) row = delayed(row);
  const auto& inputs = from.block->inputs;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const auto column = static_cast<Index>(k);
    if (at.output >= 0 && D(at.output, column) != 0.0) row += D(at.output, column) * rate(inputs[k], asking);
    if (does_not_reach(at.c, B.col(column))) continue;
    if (from.linear.delay > 0.0) throw refuse("the delayed output of a plant of relative degree 1");
    row += (at.c * B.col(column)).value() / from.linear.time * value(inputs[k]);
  }
  if (from.plant && is_rubbed(*from.block) && !does_not_reach(at.c, from.plant->B_F))
    throw refuse("which changes at once with the friction");
  if (from.plant && from.plant->gravity && !does_not_reach(at.c, from.plant->B_gravity))
    row -= (at.c * from.plant->B_gravity).value() * element_output(*from.number);
  return term.factor * row;
}

Row SignalRows::output() {
  const Term& term = diagram_.output;
  const auto refuse = [] {
    return BrokenDiagram({"diagram.output",
                          "must be an output that is made of states, such as axis.y: put a low-pass "
                          "behind another one"});
  };
  if (term.block == "r") throw refuse();
  Part& from = part(term);
  if (element_in(*from.block) != nullptr || linear_in<Constant>(*from.block) || linear_in<DelayBlock>(*from.block))
    throw refuse();
  const Tap at = tap(from, term);
  if (at.output >= 0 && (!from.linear.ss.D.row(at.output).isZero(0.0) || from.derivative != 0.0)) throw refuse();
  return term.factor * state(at.c, from.first);
}

Eigen::MatrixXd SignalRows::rates() {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n_, size());
  for (Part& from : parts_) {
    if (from.linear.ss.states() == 0) continue;
    const std::vector<Row> inputs = inputs_of(from);
    for (Index i = 0; i < from.linear.ss.states(); ++i) all.row(from.first + i) = block_rate(from, i, inputs);
  }
  return all;
}

std::vector<Row> SignalRows::inputs_of(const Part& from) {
  std::vector<Row> inputs;
  for (const SignalSum& sum : from.block->inputs) inputs.push_back(value(sum));
  if (diagram_.load_on == from.block->name) inputs.at(0) += external(external_force);
  return inputs;
}

std::vector<MeasuredPart> SignalRows::measured() {
  std::vector<MeasuredPart> list;
  for (Part& from : parts_) {
    if (!from.plant || !from.plant->measured) continue;
    Row input = inputs_of(from).at(0);
    for (std::size_t k = 0; k < ports_.size(); ++k) {  // friction acts where u does
      if (ports_[k].contact != Contact::opposes) continue;
      if (ports_[k].on == from.block->name) input -= element_output(k);
      if (ports_[k].against == from.block->name) input += element_output(k);
    }
    MeasuredPart& part = list.emplace_back();
    part.path = from.block->path;
    part.response = from.plant->measured;
    part.B = Eigen::VectorXd::Zero(n_);
    part.B.segment(from.first, from.linear.ss.states()) = from.linear.ss.B.col(0);
    part.C = input.head(n_);
    part.C_delayed = input.segment(n_, n_);
    part.D = input.segment(2 * n_, elements());
  }
  return list;
}

Row SignalRows::block_rate(const Part& from, Index i, const std::vector<Row>& inputs) const {
  Row row = state(from.linear.ss.A.row(i), from.first);
  for (std::size_t k = 0; k < inputs.size(); ++k) row += from.linear.ss.B(i, static_cast<Index>(k)) * inputs[k];
  row /= from.linear.time;
  if (!from.plant) return row;
  for (std::size_t k = 0; k < ports_.size(); ++k) {
    if (ports_[k].contact != Contact::opposes) continue;
    if (ports_[k].on == from.block->name) row -= from.plant->B_F(i) * element_output(k);
    if (ports_[k].against == from.block->name) row += from.plant->B_F(i) * element_output(k);
  }
  if (from.plant->gravity) row -= from.plant->B_gravity(i) * element_output(*from.number);
  return row;
}

std::vector<std::string> SignalRows::state_names() const {
  std::vector<std::string> names;
  for (const Part& from : parts_)
    for (const auto& name : from.linear.state_names)
      names.push_back(diagram_.prefixed_states ? from.block->name + "." + name : name);
  return names;
}

Eigen::MatrixXd SignalRows::own_states() const {
  if (std::ranges::all_of(parts_, [](const Part& from) { return from.own_states.size() == 0; })) return {};
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n_, n_);
  for (const Part& from : parts_)
    if (const Index size = from.own_states.rows(); size != 0)
      all.block(from.first, from.first, size, size) = from.own_states;
  return all;
}

}  // namespace limcycle
