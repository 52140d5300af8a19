#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/claims/claim.hpp"

namespace limcycle {

/// A claim and its result.
struct TestedClaim {
  Claim claim;
  ClaimResult result;

  bool as_expected() const { return result.verdict == claim.expected; }
};

struct ClaimRunOptions : ClaimOptions {
  int threads = 1;  ///< 0: one per core. The results do not depend on it
  std::function<void(double, std::string_view)> progress;
};

/// Tests some claims, several at a time. Each has random parameters of its own, which depend only on the seed and its
/// id. One that throws is undecided, and its finding gives the message. Stopped early: those that were finished or had
/// begun, in the order of the list.
std::vector<TestedClaim> run_claims(const std::vector<Claim>& which, const ClaimRunOptions& options);

/// The claims of that id; if there is none, those whose id begins with it ("A": all of A). Empty: unknown.
std::vector<Claim> claims_named(const std::vector<Claim>& all, std::string_view id);

/// Share (0 up to 1) number k of a stream of random numbers that depends only on the seed.
class RandomShares {
 public:
  explicit RandomShares(std::uint64_t seed) : state_(seed) {}
  double share();                               ///< uniform in [0, 1)
  double between(double low, double high);      ///< uniform
  double log_between(double low, double high);  ///< uniform in the logarithm; 0 < low < high
 private:
  std::uint64_t state_;
};

}  // namespace limcycle
