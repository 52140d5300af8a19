#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "limcycle/analysis/study/identify/record/friction_response.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Derivatives of a law's functions by its own numbers, exact, by dual numbers; those by velocity, drive and state are
/// ElementSlopes. One object serves one thread. Cost: an evaluation on eight-fold dual numbers for every eight numbers.
class NumberSlopes {
 public:
  virtual ~NumberSlopes() = default;

  /// Takes the values of a law of the kind of this object.
  virtual void take(const Element& law) = 0;
  virtual Eigen::Index count() const = 0;
  /// Derivatives of the output (first row) and of the rate of each state (a row each): a column for each number.
  virtual const Eigen::MatrixXd& response(const Input<double>& in, Mode mode, std::span<const double> z) = 0;
  /// Derivatives of the value of a guard, in one row.
  virtual const Eigen::MatrixXd& guard(const Input<double>& in, Mode mode, std::span<const double> z,
                                       std::size_t guard) = 0;
};

/// For derivatives by `numbers`: see response_of().
std::unique_ptr<NumberSlopes> number_slopes_of(const Element& law, std::vector<LawNumber> numbers,
                                               std::vector<std::size_t> own_rows);

}  // namespace limcycle
