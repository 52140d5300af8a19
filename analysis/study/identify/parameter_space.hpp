#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/identify/record/friction_response.hpp"
#include "limcycle/analysis/study/identify/record/record.hpp"

namespace limcycle {

/// Coordinate in which a number is varied: log for numbers > 0, linear for those that may be 0, logit for shares.
enum class Coordinate { log, linear, logit };

/// Number of a law that is fitted.
struct FreeNumber {
  std::string name;  ///< "Fs", "k[0]"
  std::string unit;
  LawNumber at;
  Range range;  ///< as the law states it
  Coordinate coordinate = Coordinate::log;
  double low = 0.0, high = 0.0;  ///< where fits begin: a typical range, from the records
  double scale = 1.0;            ///< of the linear coordinate
};

/// u(above) >= u(below), of coordinates; in the place of one that is -1 stands `at`.
struct Bound {
  Eigen::Index above = -1, below = -1;
  double at = 0.0;
  std::string note;    ///< for a fit on the bound
  bool of_law = true;  ///< false: the law goes on beyond, but no fit is looked for there

  /// u(above) - u(below).
  double room(const Eigen::VectorXd& u) const { return (above < 0 ? at : u(above)) - (below < 0 ? at : u(below)); }
};

/// What is fitted, besides the defaults. Keys that are no single number of a law do not concern it.
struct FreeChoice {
  std::vector<std::string> free;                      ///< keys fitted although they have a default: delta, Fs_minus
  std::vector<std::pair<std::string, double>> fixed;  ///< keys held at a value
  int elements = 4;                                   ///< of laws with parallel elements
};

/// The fitted numbers of a law, as coordinates u. Shares that sum to 1 have one among them, `dependent`, that the
/// others determine; it has no coordinate.
class ParameterSpace {
 public:
  /// For a law of that kind: all of its numbers (zba_ratio too), except those that follow others by default, shapes
  /// with a usual value (delta, exponent, vd), sigma1 of `gms`, and those that are `fixed`. Ranges come from the
  /// records by the unit. Throws std::invalid_argument for a value outside the range of its key.
  ParameterSpace(const Element& kind, const std::vector<PreparedRecord>& records, const FreeChoice& choice);

  const Element& kind() const { return kind_; }
  const std::vector<FreeNumber>& numbers() const { return numbers_; }
  std::vector<LawNumber> places() const;
  const std::vector<std::size_t>& own_rows() const { return own_rows_; }
  /// Number of coordinates, one less than numbers if there is a dependent one.
  Eigen::Index size() const { return std::ssize(of_); }
  /// Index among numbers() of a coordinate, and the coordinate of a number (-1: it is dependent).
  std::size_t number_of(Eigen::Index coordinate) const { return of_[static_cast<std::size_t>(coordinate)]; }
  Eigen::Index coordinate_of(std::size_t number) const;

  /// The number whose value `key` has, by itself or because it follows another by default; none if that is held.
  std::optional<std::size_t> source_of(std::string_view key) const;
  /// Where the laws end: numbers >= 0 of linear coordinates, and break-away levels no less than sliding ones; and where
  /// a fit stays: numbers > 0 within a thousand times their typical range. Methods may leave them on their way. The
  /// order does not depend on the dependent share.
  std::vector<Bound> bounds() const;

  /// Values of numbers() at u. Outside: a dependent share <= 0, or a number > 0 far beyond its typical range.
  Eigen::VectorXd values(const Eigen::VectorXd& u) const;
  bool inside(const Eigen::VectorXd& values) const;
  Eigen::VectorXd coordinates(const Eigen::VectorXd& values) const;
  /// d(values)/du.
  Eigen::MatrixXd chain(const Eigen::VectorXd& values) const;
  /// The law with these values.
  Element law(const Eigen::VectorXd& values) const;
  /// The point at these shares (0..1) of the ranges, with levels in their order.
  Eigen::VectorXd start(const std::vector<double>& shares) const;

  /// The same numbers with another dependent share. Nothing changes if `number` is not one of those that sum to 1.
  ParameterSpace with_dependent(std::size_t number) const;
  bool is_share_of_sum(std::size_t number) const;

 private:
  void add_numbers(std::size_t row, const ParameterValue& value, FreeNumber number);
  void number_coordinates(std::optional<std::size_t> dependent);
  bool is_own(std::size_t row) const;
  std::string_view key_behind(std::string_view key) const;

  Element kind_;
  std::vector<FreeNumber> numbers_;
  std::vector<std::size_t> of_, own_rows_;
  std::optional<std::size_t> dependent_;
};

}  // namespace limcycle
