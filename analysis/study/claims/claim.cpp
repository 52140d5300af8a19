#include "limcycle/analysis/study/claims/claim.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Size to which an error is compared; a number without a size is compared to 1.
double size_of(double a, double b) {
  const double size = std::max(std::abs(a), std::abs(b));
  return size > 0.0 ? size : 1.0;
}

bool is_number(const ClaimCheck& check) { return !std::isnan(check.claimed) && !std::isnan(check.computed); }

/// Share of the allowed error that a check uses, to find the worst of several.
double use_of(const ClaimCheck& check) {
  if (!is_number(check)) return HUGE_VAL;
  if (check.allowed > 0.0) return check.error / check.allowed;
  return check.error > 0.0 ? HUGE_VAL : 0.0;
}

std::string compared(const ClaimCheck& check) {
  const std::string unit = check.unit.empty() ? "" : " " + check.unit;
  return check.quantity + (check.where.empty() ? "" : " at " + check.where) + ": claimed " +
         short_number(check.claimed, 8) + unit + ", computed " + short_number(check.computed, 8) + unit;
}

/// "3 of 40 comparisons (20 at random parameters) fail"
std::string count_of(const std::vector<ClaimCheck>& checks) {
  const auto failed = std::ranges::count(checks, false, &ClaimCheck::holds);
  const auto random = std::ranges::count(checks, true, &ClaimCheck::random);
  std::string out = failed > 0 ? std::to_string(failed) + " of " : "";
  out += std::to_string(checks.size()) + (checks.size() == 1 ? " comparison" : " comparisons");
  if (random > 0) out += " (" + std::to_string(random) + " at random parameters)";
  if (failed > 0) return out + (failed == 1 && checks.size() == 1 ? " fails" : " fail");
  return out + (checks.size() == 1 ? " holds" : " hold");
}

}  // namespace

void ClaimChecks::add(ClaimCheck check) {
  check.random = random_;
  if (!is_number(check)) {
    check.error = NAN;
    check.holds = false;
  }
  result_.checks.push_back(std::move(check));
}

void ClaimChecks::equal(std::string where, std::string quantity, std::string unit, double claimed, double computed,
                        double allowed, double size) {
  const double scale = size_of(claimed, size), error = std::abs(computed - claimed) / scale;
  add({std::move(where), std::move(quantity), std::move(unit), claimed, computed, error, allowed, false,
       error <= allowed});
}

void ClaimChecks::at_most(std::string where, std::string quantity, std::string unit, double bound, double computed,
                          double slack) {
  // An infinite bound has no size and excludes nothing.
  const double scale = std::isfinite(bound) ? size_of(bound, computed) : 1.0;
  add({std::move(where), std::move(quantity) + " <= claimed", std::move(unit), bound, computed,
       std::max(0.0, computed - bound) / scale, slack / scale, false, computed <= bound + slack});
}

void ClaimChecks::at_least(std::string where, std::string quantity, std::string unit, double bound, double computed,
                           double slack) {
  const double scale = std::isfinite(bound) ? size_of(bound, computed) : 1.0;
  add({std::move(where), std::move(quantity) + " >= claimed", std::move(unit), bound, computed,
       std::max(0.0, bound - computed) / scale, slack / scale, false, computed >= bound - slack});
}

void ClaimChecks::is_true(std::string where, std::string statement, bool is) {
  add({std::move(where), std::move(statement), "", 1.0, is ? 1.0 : 0.0, is ? 0.0 : 1.0, 0.0, false, is});
}

ClaimResult ClaimChecks::result(const std::string& finding) const {
  ClaimResult made = result_;
  const auto& checks = made.checks;
  made.finding = finding;
  const auto say = [&made](const std::string& words) { made.finding += (made.finding.empty() ? "" : "; ") + words; };
  if (checks.empty()) {
    say("nothing was compared");
  } else {
    say(count_of(checks));
    const auto& worst = *std::ranges::max_element(checks, {}, use_of);
    if (is_number(worst) && worst.error > 0.0)
      say("largest error " + short_number(worst.error, 2) + " of " + short_number(worst.allowed, 2) + " allowed");
  }
  // A value that could not be computed refutes nothing.
  const ClaimCheck* refuted = nullptr;
  bool unknown = false;
  for (const auto& check : checks) {
    if (!is_number(check))
      unknown = true;
    else if (!check.holds && (refuted == nullptr || use_of(check) > use_of(*refuted)))
      refuted = &check;
  }
  if (made.status != Status::converged) {
    say("the computation ended early (" + std::string(to_string(made.status)) + ")");
  } else if (refuted != nullptr) {
    made.verdict = ClaimVerdict::fails;
    made.counterexample = compared(*refuted);
  } else if (unknown) {
    say("a number could not be computed");
  } else if (!checks.empty()) {
    made.verdict = ClaimVerdict::holds;
  }
  return made;
}

std::string_view to_string(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::holds:
      return "holds";
    case ClaimVerdict::fails:
      return "fails";
    case ClaimVerdict::undecided:
      return "undecided";
  }
  return "unknown";
}

std::string_view to_string(Evidence evidence) {
  switch (evidence) {
    case Evidence::read:
      return "read";
    case Evidence::derived:
      return "derived";
    case Evidence::knowledge:
      return "knowledge";
    case Evidence::reconstruction:
      return "reconstruction";
  }
  return "unknown";
}

}  // namespace limcycle
