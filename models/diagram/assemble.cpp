#include "limcycle/models/diagram/assemble.hpp"

#include "limcycle/models/diagram/signal_rows.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Puts the difference of two states, which friction between two bodies sees as c_a x_a - c_b x_b, in the place of x_a:
/// a body that sticks to another is then exactly at rest on it (see rubbing_coordinates()). Nothing for any other row.
void measure_from_other_body(Loop& loop, Row row) {
  std::vector<Index> seen;
  for (Index i = 0; i < row.size(); ++i)
    if (row(i) != 0.0) seen.push_back(i);
  if (seen.size() != 2) return;
  const Index n = loop.states();
  const Index a = row(seen[0]) > 0.0 ? seen[0] : seen[1], b = a == seen[0] ? seen[1] : seen[0];
  const double share = row(b) / row(a);
  Eigen::MatrixXd to = Eigen::MatrixXd::Identity(n, n), back = to;
  to(a, b) = share;
  back(a, b) = -share;
  loop.A = to * loop.A * back;
  loop.A_delayed = to * loop.A_delayed * back;
  loop.B = to * loop.B;
  loop.E = to * loop.E;
  loop.C_y = loop.C_y * back;
  for (Port& port : loop.ports) {
    port.C = port.C * back;
    port.C_v = port.C_v * back;
    port.C_delayed = port.C_delayed * back;
  }
  for (MeasuredPart& part : loop.measured) {
    part.B = to * part.B;
    part.C = part.C * back;
    part.C_delayed = part.C_delayed * back;
  }
  if (loop.own_states.size() == 0) loop.own_states = Eigen::MatrixXd::Identity(n, n);
  loop.own_states = loop.own_states * back;
}

/// Cuts the rows of a diagram into the matrices of the Lur'e form.
class Assembly {
 public:
  explicit Assembly(const Diagram& diagram) : rows_(diagram) {}

  Loop build(double reference, double load) {
    rows_.number_elements();
    Loop loop;
    loop.C_y = rows_.output().head(rows_.states());
    loop.delay = rows_.delay();
    rates_ = rows_.rates();
    const Index n = rows_.states(), ne = rows_.elements();
    loop.A = rates_.leftCols(n);
    loop.A_delayed = rates_.middleCols(n, n);
    loop.B = rates_.middleCols(2 * n, ne);
    loop.E = rates_.rightCols(4);
    for (const auto& port : rows_.ports()) add(port, loop);
    loop.measured = rows_.measured();
    share_selections(loop);
    loop.external << 1.0, reference, 0.0, load;
    loop.state_names = rows_.state_names();
    loop.own_states = rows_.own_states();
    for (std::size_t i = 0; i < loop.ports.size(); ++i) {
      if (rows_.ports()[i].against.empty()) continue;
      measure_from_other_body(loop, loop.ports[i].C);
      measure_from_other_body(loop, loop.ports[i].C_v);
    }
    return loop;
  }

 private:
  void add(const ElementRows& from, Loop& loop) const {
    const Index n = rows_.states(), ne = rows_.elements();
    loop.elements.push_back(*from.element);
    Port& port = loop.ports.emplace_back();
    port.path = from.path;
    port.rubs = from.contact != Contact::none;
    port.opposes = from.contact == Contact::opposes;
    port.C = from.input.head(n);
    port.C_delayed = from.input.segment(n, n);
    port.D = from.input.segment(2 * n, ne);
    port.c = from.input.tail(4);
    const Row rate = port.rubs ? from.rate : rate_of(from.input);
    port.C_v = rate.head(n);
    port.D_v = rate.segment(2 * n, ne);
    port.c_v = rate.tail(4);
  }

  /// Time derivative of an input that reads the state and r; a direct path from another element's output has no rate.
  Row rate_of(const Row& input) const {
    const Index n = rows_.states(), ne = rows_.elements();
    Row rate = input.head(n) * rates_;
    rate(2 * n + ne + reference_slope) += input(2 * n + ne + reference_value);
    return rate;
  }

  /// A compensation takes the selection of the set-valued friction law at the same body, and so does one such law of
  /// another: the last of them leads.
  void share_selections(Loop& loop) const {
    const auto& ports = rows_.ports();
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (ports[i].contact == Contact::none) continue;
      for (std::size_t k = 0; k < ports.size(); ++k) {
        if (ports[k].contact != Contact::opposes) continue;
        const bool same = ports[k].on == ports[i].on && ports[k].against == ports[i].against;
        const bool reversed = ports[k].on == ports[i].against && ports[k].against == ports[i].on;
        if (!(same || reversed) || !ports[k].element->facts().has_selection) continue;
        if (ports[i].contact == Contact::opposes && !(k > i && hold_together(ports[i], ports[k]))) continue;
        loop.ports[i].selection_of = k;
        loop.ports[i].reversed = reversed;
      }
    }
  }

  /// True for two laws that hold one body; false if one of them, or both, never do.
  static bool hold_together(const ElementRows& one, const ElementRows& other) {
    if (!one.element->may_stick() || !other.element->may_stick()) return false;
    for (const ElementRows* law : {&one, &other})
      if (law->element->needs_drive() || law->element->drive_band() > 0.0 || !law->element->facts().has_selection)
        throw BrokenDiagram({law->path, "holds the same body as " + (law == &one ? other : one).path +
                                            ", which a law of kind " + std::string(law->element->kind()) +
                                            " cannot: write both as one law, or take coulomb, stribeck or "
                                            "stribeck-table"});
    return true;
  }

  SignalRows rows_;
  Eigen::MatrixXd rates_;
};

}  // namespace

std::optional<OutputRate<double>> output_rate(const Element& element) {
  if (const auto* zone = element.as<DeadZone<double>>()) return OutputRate<double>::of(*zone);
  if (const auto* limit = element.as<Saturation<double>>()) return OutputRate<double>::of(*limit);
  return std::nullopt;
}

std::optional<SignalRow> command_row(const LoopParts& parts) {
  if (parts.diagram || sampling_of(parts.controller).is_on()) return std::nullopt;
  const Diagram diagram = short_form(parts);
  SignalRows rows(diagram);
  rows.number_elements();
  if (rows.delay() > 0.0) return std::nullopt;
  const Row row = rows.value(diagram.blocks.front().inputs.at(0));
  const Index n = rows.states();
  return SignalRow{row.head(n), row.segment(2 * n, rows.elements()), row.tail(4)};
}

Loop assemble(const Diagram& diagram, double reference, double load) {
  return Assembly(diagram).build(reference, load);
}

}  // namespace limcycle
