#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/study/identify/record/record.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A number of a law: row of its table of parameters, and entry if the row is a list.
struct LawNumber {
  std::size_t row = 0, entry = 0;
};

/// The forces of one kind of friction law along measured motions, and their exact derivatives with respect to numbers
/// of the law.
///
/// The state is carried through each piece of the motion by the classical Runge-Kutta method in steps of a quarter of
/// the fastest relaxation time of the state (of a tenth of the bristle's length where the law is not linear in its
/// state), and through located switches. Derivatives are those of this computation itself: it runs on dual numbers,
/// with the time of each switch as one of them. Where a bristle slides further than ten of its lengths within a piece,
/// the march begins ten lengths before the end, from steady sliding: e^-10 and less of the difference is left. Where
/// that is a hundredth of the piece at most, and the speed at its end not below half of that in its middle, it ends in
/// steady sliding. Error: fourth order in `fineness`, below 1e-4 of the force for 1.
class FrictionResponse {
 public:
  virtual ~FrictionResponse() = default;

  /// Forces at the compared rows of a record, N, for a law of the kind of this object. `slopes`, if not null, gets a
  /// row for each force and a column for each number. `fineness` divides the steps. Returns false if something is not
  /// finite or the law does not stop switching. Cost: about 0.2 us a step, and ten times that with slopes.
  virtual bool run(const Element& law, const PreparedRecord& record, std::vector<double>& forces,
                   Eigen::MatrixXd* slopes, double fineness = 1.0) const = 0;
};

/// Kinds of laws that can be identified.
const std::vector<std::string>& identified_kinds();

/// For derivatives by `numbers`; rows of the table that follow another one by default follow it, unless they are among
/// `numbers` or `own`. Throws std::invalid_argument if the kind cannot be identified.
std::unique_ptr<FrictionResponse> response_of(const Element& law, std::vector<LawNumber> numbers,
                                              std::vector<std::size_t> own_rows = {});

}  // namespace limcycle
