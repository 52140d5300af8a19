#include "limcycle/analysis/study/claims/run_claims.hpp"

#include <cmath>
#include <exception>
#include <optional>

#include "limcycle/analysis/random_bits.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

ClaimResult tested(const Claim& claim, const ClaimOptions& options) {
  ClaimOptions own = options;
  own.seed = fnv1a(claim.id, fnv_start ^ options.seed);
  try {
    return claim.run(own);
  } catch (const std::exception& error) {
    ClaimResult result;
    result.status = Status::undefined;
    result.finding = std::string("not tested: ") + error.what();
    return result;
  }
}

}  // namespace

std::vector<TestedClaim> run_claims(const std::vector<Claim>& which, const ClaimRunOptions& options) {
  std::vector<std::optional<ClaimResult>> results(which.size());
  run_each(
      which.size(), [&](std::size_t i) { results[i] = tested(which[i], options); },
      part_of_work(options.threads, options.stop, options.progress, 0.0, 1.0, "claims"));
  std::vector<TestedClaim> all;
  for (std::size_t i = 0; i < which.size(); ++i)
    if (results[i]) all.push_back({which[i], std::move(*results[i])});
  return all;
}

std::vector<Claim> claims_named(const std::vector<Claim>& all, std::string_view id) {
  std::vector<Claim> exact, beginning;
  for (const auto& claim : all) {
    if (claim.id == id) exact.push_back(claim);
    if (!id.empty() && claim.id.starts_with(id)) beginning.push_back(claim);
  }
  return exact.empty() ? beginning : exact;
}

double RandomShares::share() { return static_cast<double>(splitmix64(state_) >> 11U) * 0x1.0p-53; }

double RandomShares::between(double low, double high) { return low + (high - low) * share(); }
double RandomShares::log_between(double low, double high) { return low * std::exp(share() * std::log(high / low)); }

}  // namespace limcycle
