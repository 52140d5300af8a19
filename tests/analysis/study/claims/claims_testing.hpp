#pragma once
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "limcycle/analysis/study/claims/claim.hpp"

/// Checks of a list of claims.
namespace limcycle::test {

inline ClaimOptions at_random(int points, std::uint64_t seed = 1) {
  ClaimOptions options;
  options.random_points = points;
  options.seed = seed;
  return options;
}

inline const Claim& claim(const std::vector<Claim>& list, const std::string& id) {
  for (const Claim& one : list)
    if (one.id == id) return one;
  FAIL("no claim " << id);
  return list.front();
}

/// Comparisons with a number: not a bound, not a statement that is true or false.
inline bool is_equality(const ClaimCheck& check) {
  return check.allowed > 0.0 && check.quantity.find("claimed") == std::string::npos;
}

/// The same comparisons with every claimed number wrong by a share; returns how many of them detect it.
inline int noticed(const ClaimResult& result, double share, int& asked) {
  int found = 0;
  for (const ClaimCheck& check : result.checks) {
    if (!is_equality(check) || check.claimed == 0.0) continue;
    ++asked;
    ClaimChecks again;
    // The error was relative to a size that may be larger than the number itself.
    const double off = std::abs(check.computed - check.claimed), size = check.error > 0.0 ? off / check.error : 0.0;
    again.equal("", check.quantity, check.unit, check.claimed + share * std::max(size, std::abs(check.claimed)),
                check.computed, check.allowed, size);
    found += again.result().verdict == ClaimVerdict::fails;
  }
  return found;
}

/// Every claim is complete, is tested at printed or fixed points, and has the expected result.
inline void check_list(const std::vector<Claim>& list, const std::set<std::string>& ids, int random_points) {
  std::set<std::string> found;
  for (const Claim& one : list) {
    CAPTURE(one.id);
    CHECK(found.insert(one.id).second);
    for (const auto& text : {one.statement, one.formula, one.source, one.range, one.test}) CHECK_FALSE(text.empty());
    const ClaimResult result = one.run(at_random(random_points));
    CAPTURE(result.finding, result.counterexample);
    CHECK(result.verdict == one.expected);
    CHECK_FALSE(result.checks.empty());
    int asked = 0;
    const int seen = noticed(result, 0.02, asked);
    CHECK(seen == asked);
  }
  CHECK(found == ids);
}

}  // namespace limcycle::test
