#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/study/claims/claim.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"

namespace limcycle {

enum class Comparison { equal, less, at_most, greater, at_least };

/// Object to which a quantity of a user's claim refers.
enum class QuantityOf { cycle, describing_function, law };

/// A quantity that a user's claim may be about.
struct ClaimQuantity {
  std::string_view name, unit;
  QuantityOf of;
  std::string_view meaning;
};

/// All of them. A new one is a row there and the line that computes it.
const std::vector<ClaimQuantity>& claim_quantities();

/// A user's own claim, [[claim]] of a case: QUANTITY COMPARISON FORMULA.
struct UserClaim {
  std::string id, statement;
  std::string source;  ///< empty: the case
  std::string quantity;
  Comparison comparison = Comparison::equal;
  double tolerance = 1e-6;  ///< relative, of an equality
  std::string formula;      ///< as written
  ClaimVerdict expected = ClaimVerdict::holds;
  std::optional<DfPoint> at;          ///< point of a describing function
  std::vector<SpreadParameter> over;  ///< numbers drawn at random: of the case, and of `at` ("at.amplitude")
  int random_points = 10;             ///< if any number is drawn
};

/// A case with some of its numbers replaced: the value claimed there, and the object of the claim.
struct ClaimPoint {
  double claimed = 0.0;            ///< value of the formula
  std::optional<Loop> loop;        ///< for quantities of a cycle
  std::optional<Element> element;  ///< for those of an element
  DfPoint at;
};

/// The case with these numbers (path, value); empty if that is not a valid case.
using ClaimPoints = std::function<std::optional<ClaimPoint>(const std::vector<std::pair<std::string, double>>&)>;

/// The claim, tested at the case's own numbers, then at random ones. Quantities of a cycle are those of the stable
/// limit cycle that predict() finds, of several the one of largest amplitude. If there is none the claim fails (it
/// holds if "cycles" or "hunts" are claimed to be 0); if the methods leave that open it is undecided. `predict`:
/// options of the search for cycles. `source`: the case.
Claim user_claim(const UserClaim& user, const PredictOptions& predict, const ClaimPoints& points,
                 const std::string& source);

std::string_view to_string(Comparison comparison);

}  // namespace limcycle
