#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/rubbing_coordinates.hpp"

namespace limcycle {

/// An element of a diagram with its input and, where it touches a body, its rubbing velocity.
struct ElementRows {
  const Element* element = nullptr;
  std::string path, on, against;
  Contact contact = Contact::none;
  Eigen::RowVectorXd input, rate;
};

/// The signals of a diagram as rows over [X | X delayed | w | external], so that joining blocks adds rows: X the states
/// of all blocks, w the outputs of all elements, external as in ExternalIndex. Rows are found from the inputs of a
/// block backwards, only as far as they are needed: a block whose output is a state does not ask for its input. Throws
/// BrokenDiagram.
class SignalRows {
 public:
  explicit SignalRows(const Diagram& diagram);

  /// Finds the inputs of all elements, and numbers them so that each comes after those that it looks into.
  void number_elements();

  Eigen::Index states() const { return n_; }
  Eigen::Index elements() const { return static_cast<Eigen::Index>(ports_.size()); }
  double delay() const { return delay_; }
  const std::vector<ElementRows>& ports() const { return ports_; }

  Eigen::RowVectorXd value(const SignalSum& sum);
  /// y of the loop before any delay; dX/dt. After number_elements(), rows have as many columns as there are elements.
  Eigen::RowVectorXd output();
  Eigen::MatrixXd rates();

  /// Plants known by measured data, with the rows of their inputs.
  std::vector<MeasuredPart> measured();

  std::vector<std::string> state_names() const;
  /// See Loop::own_states.
  Eigen::MatrixXd own_states() const;

 private:
  using Row = Eigen::RowVectorXd;

  /// A block with its linear part: of an element empty.
  struct Part {
    const Block* block = nullptr;
    Eigen::Index first = 0;  ///< its first state
    LinearModel linear;
    double derivative = 0.0;            ///< factor of du/dt in the output (PID without filter)
    std::optional<PlantModel> plant;    ///< in coordinates in which friction acts on one state
    Eigen::MatrixXd own_states;         ///< empty: the states of the block itself
    std::optional<Element> extra;       ///< rate of the output of an element
    std::optional<std::size_t> number;  ///< of the element; of a plant, that of its gravity
    std::optional<std::size_t> rate_number;
    bool open = false;  ///< on the way from an input backwards
  };

  class Opening;

  void add_part(const Block& block);
  bool is_rubbed(const Block& block) const;
  bool is_at_output(const Block& block) const;

  Eigen::Index size() const { return 2 * n_ + room_ + 4; }
  Row zero() const { return Row::Zero(size()); }
  Row state(const Row& c, Eigen::Index first) const;
  Row delayed(Row row) const;
  Row element_output(std::size_t number) const;
  Row external(ExternalIndex i) const;

  Part& part(const Term& term);
  /// Row of the states of a block for one of its outputs, and the number of that output.
  struct Tap {
    Row c;
    Eigen::Index output = 0;
  };
  Tap tap(const Part& from, const Term& term) const;
  Row value(const Term& term);
  Row rate(const SignalSum& sum, const Block& asking);
  Row rate(const Term& term, const Block& asking);
  Row delayed_input(Part& from);
  std::size_t number(Part& from);
  void number_contact(Part& from);
  std::vector<Row> inputs_of(const Part& from);
  Row block_rate(const Part& from, Eigen::Index i, const std::vector<Row>& inputs) const;
  Row trimmed(const Row& row) const;

  const Diagram& diagram_;
  std::vector<Part> parts_;
  std::vector<Part*> way_;  ///< blocks that are open
  std::vector<ElementRows> ports_;
  Eigen::Index n_ = 0, room_ = 0;
  double delay_ = 0.0;
};

}  // namespace limcycle
