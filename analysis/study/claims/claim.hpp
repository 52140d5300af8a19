#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"

namespace limcycle {

enum class ClaimVerdict { holds, fails, undecided };
std::string_view to_string(ClaimVerdict verdict);

/// Evidence for the source of a statement.
enum class Evidence { read, derived, knowledge, reconstruction };
std::string_view to_string(Evidence evidence);

/// One comparison: a number of the claim against one computed without it.
struct ClaimCheck {
  std::string where;     ///< the parameters: "A = 5e-06 m, w = 10 rad/s"
  std::string quantity;  ///< "Re N", "period"
  std::string unit;      ///< empty: none
  double claimed = 0.0;
  double computed = 0.0;
  double error = 0.0;    ///< |computed - claimed| over the size that counts
  double allowed = 0.0;  ///< error up to which they agree
  bool random = false;   ///< at parameters drawn at random
  bool holds = false;    ///< false also if a number is NaN
};

/// Result of one claim.
struct ClaimResult {
  ClaimVerdict verdict = ClaimVerdict::undecided;
  std::vector<ClaimCheck> checks;
  std::string finding;         ///< one sentence made from the numbers
  std::string counterexample;  ///< where it fails, if it does
  Status status = Status::converged;
};

/// Thoroughness of the test of a claim.
struct ClaimOptions {
  std::uint64_t seed = 0;
  int random_points = 20;  ///< of the random parameters, if a claim has a range of them
  std::function<bool()> stop;
};

/// An analytic statement and the computation that tests it.
struct Claim {
  std::string id;         ///< "A12", "thesis-passivity"
  std::string statement;  ///< in limcycle's words, one or two sentences
  std::string formula;    ///< plain text; empty if the statement is complete
  std::string source;     ///< author, year, equation; "derived" if derived here
  Evidence evidence = Evidence::derived;
  std::string range;  ///< parameters for which it is claimed, and over which random points are drawn
  std::string test;   ///< what is computed, independently of the formula
  ClaimVerdict expected = ClaimVerdict::holds;
  std::function<ClaimResult(const ClaimOptions&)> run;
};

/// Collects the comparisons of a claim.
class ClaimChecks {
 public:
  /// |computed - claimed| <= allowed * max(|claimed|, size).
  void equal(std::string where, std::string quantity, std::string unit, double claimed, double computed, double allowed,
             double size = 0.0);
  /// computed <= claimed, or >=; `slack` is the rounding or the stated error of `computed`, in its unit.
  void at_most(std::string where, std::string quantity, std::string unit, double bound, double computed, double slack);
  void at_least(std::string where, std::string quantity, std::string unit, double bound, double computed, double slack);
  /// A statement that is true or false: claimed 1, computed 1 or 0.
  void is_true(std::string where, std::string statement, bool is);
  /// Until the next call with false, checks are marked as those of random parameters.
  void random(bool are) { random_ = are; }
  void stop(Status status) { result_.status = status; }

  /// holds if every check does and there is one; fails with the worst one as counter-example; undecided if the
  /// computation ended with a status. `finding` precedes the count and the largest error.
  ClaimResult result(const std::string& finding = {}) const;

 private:
  void add(ClaimCheck check);
  bool random_ = false;
  ClaimResult result_;
};

/// All claims, in the order of the list.
const std::vector<Claim>& claims();

// The claims, one file per subject. A new subject needs its file, a line here and a line in catalogue.cpp.
std::vector<Claim> describing_function_claims();  ///< A1 to A16
std::vector<Claim> limit_cycle_claims();          ///< B1 to B10
std::vector<Claim> error_bound_claims();          ///< C1 to C3
std::vector<Claim> friction_claims();             ///< D1 to D12
std::vector<Claim> stability_claims();            ///< E1 to E4
std::vector<Claim> source_document_claims();      ///< claims of the two documents about their models

}  // namespace limcycle
