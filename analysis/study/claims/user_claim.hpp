#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/analysis/study/claims/claim.hpp"
#include "limcycle/analysis/study/parameter_spread.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

enum class Comparison { equal, less, at_most, greater, at_least };

/// What a quantity of a user's claim is asked of.
enum class QuantityOf { cycle, describing_function, law };

/// A quantity that a user's claim may be about.
struct ClaimQuantity {
  std::string_view name, unit;
  QuantityOf of;
  std::string_view meaning;
};

/// All of them. A new one is a row there and the line that computes it.
const std::vector<ClaimQuantity>& claim_quantities();

/// A claim of a user's own, [[claim]] of a case: QUANTITY COMPARISON FORMULA.
struct UserClaim {
  std::string id, statement;
  std::string source;  ///< empty: the case
  std::string quantity;
  Comparison comparison = Comparison::equal;
  double tolerance = 1e-6;  ///< relative, of an equality
  std::string formula;      ///< as written
  ClaimVerdict expected = ClaimVerdict::holds;
  std::optional<DfPoint> at;          ///< where a describing function is asked
  std::vector<SpreadParameter> over;  ///< what is drawn at random: numbers of the case, and of `at` ("at.amplitude")
  int random_points = 10;             ///< if anything is
};

/// A case with some of its numbers replaced: what the claim says there, and of what.
struct ClaimPoint {
  double claimed = 0.0;                    ///< value of the formula
  std::optional<Loop> loop;                ///< for quantities of a cycle
  std::optional<Element<double>> element;  ///< for those of an element
  DfPoint at;
};

/// The case with these numbers (path, value); empty where that is not a valid case.
using ClaimPoints = std::function<std::optional<ClaimPoint>(const std::vector<std::pair<std::string, double>>&)>;

/// The claim, tested at the case's own numbers, then at random ones. Quantities of a cycle are those of the stable
/// limit cycle that predict() finds, of several the one of largest amplitude. Where there is none the claim fails (it
/// holds where "cycles" or "hunts" are claimed to be 0); where the methods cannot say it is undecided. `predict`: how
/// cycles are looked for. `source`: the case.
Claim user_claim(const UserClaim& user, const PredictOptions& predict, const ClaimPoints& points,
                 const std::string& source);

std::string_view to_string(Comparison comparison);

}  // namespace limcycle
