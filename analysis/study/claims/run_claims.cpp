#include "limcycle/analysis/study/claims/run_claims.hpp"

#include <cmath>
#include <exception>
#include <optional>

#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

/// FNV-1a: the same on every machine, which std::hash need not be.
std::uint64_t seed_of(std::uint64_t seed, std::string_view id) {
  std::uint64_t hash = 14695981039346656037ULL ^ seed;
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

ClaimResult tested(const Claim& claim, const ClaimOptions& options) {
  ClaimOptions own = options;
  own.seed = seed_of(options.seed, claim.id);
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

double RandomShares::share() {
  // SplitMix64 (Steele, Lea and Flood 2014).
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

double RandomShares::between(double low, double high) { return low + (high - low) * share(); }
double RandomShares::log_between(double low, double high) { return low * std::exp(share() * std::log(high / low)); }

}  // namespace limcycle
