#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/claims/claims.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

/// Largest error relative to its tolerance, over the comparisons: "2.1e-09 of 1e-06".
std::string largest_error(const ClaimResult& result) {
  const ClaimCheck* worst = nullptr;
  double most = -1.0;
  for (const auto& check : result.checks) {
    const double share = !std::isfinite(check.error) ? HUGE_VAL
                         : check.allowed > 0.0       ? check.error / check.allowed
                         : check.error > 0.0         ? HUGE_VAL
                                                     : 0.0;
    if (share <= most) continue;
    most = share;
    worst = &check;
  }
  if (worst == nullptr || !std::isfinite(worst->error)) return "-";
  if (worst->error == 0.0) return "0";
  return as_error(worst->error) + " of " + as_error(worst->allowed);
}

/// "label: text", empty without text.
std::string paragraph(const std::string& label, const std::string& text) {
  return text.empty() ? "" : item(label, 15, text);
}

std::string in_words(const ClaimCheck& check) {
  const auto number = [&check](double value) {
    return with_digits(value, 9) + (check.unit.empty() || !std::isfinite(value) ? "" : " " + check.unit);
  };
  std::string out = check.quantity + ": claimed " + number(check.claimed) + ", computed " + number(check.computed);
  if (std::isfinite(check.error))
    out += ", error " + as_error(check.error) + " of " + as_error(check.allowed) + " allowed";
  return out + (check.random ? " (random: " : " (") + check.where + ")";
}

std::string one_in_full(const TestedClaim& one) {
  const Claim& claim = one.claim;
  const ClaimResult& result = one.result;
  std::string out = wrapped(claim.id + ": " + claim.statement);
  out += paragraph("formula", claim.formula);
  out += paragraph("source", claim.source + " (" + std::string(in_words(claim.evidence)) + ")");
  out += paragraph("range", claim.range) + paragraph("test", claim.test);
  out += paragraph("verdict", std::string(to_string(result.verdict)) + (one.as_expected() ? ", as expected" : "") +
                                  (result.finding.empty() ? "" : ": " + result.finding));
  if (!one.as_expected()) out += paragraph("expected", std::string(to_string(claim.expected)));
  out += paragraph("counter-example", result.counterexample);
  if (!result.checks.empty()) out += "comparisons\n";
  for (const auto& check : result.checks) out += item(check.holds ? "  holds" : "  fails", 7, in_words(check));
  return out;
}

/// Short text on a claim that is not one of the many that hold.
std::string in_short(const TestedClaim& one) {
  const std::string verdict(to_string(one.result.verdict)), expected(to_string(one.claim.expected));
  std::string out = wrapped(one.claim.id + ": " + verdict +
                            (one.as_expected() ? ", as expected" : ", but " + expected + " is expected"));
  out += wrapped(one.claim.statement, 80, 2) + wrapped(one.result.finding, 80, 2);
  if (!one.result.counterexample.empty()) out += wrapped("Counter-example: " + one.result.counterexample, 80, 2);
  return out;
}

}  // namespace

std::string_view in_words(Evidence evidence) {
  switch (evidence) {
    case Evidence::read:
      return "read in the source";
    case Evidence::derived:
      return "derived";
    case Evidence::knowledge:
      return "from knowledge, the source was not opened";
    case Evidence::reconstruction:
      return "of a reconstruction";
  }
  return "?";
}

std::string claims_answer(const std::vector<TestedClaim>& tested) {
  std::size_t count[3] = {};
  std::string unexpected;
  for (const auto& one : tested) {
    ++count[static_cast<std::size_t>(one.result.verdict)];
    if (!one.as_expected()) unexpected += (unexpected.empty() ? "" : ", ") + one.claim.id;
  }
  std::string out = fmt::format("{} claim{} tested: ", tested.size(), tested.size() == 1 ? "" : "s");
  std::string parts;
  const auto add = [&parts](std::size_t n, const std::string& one, const std::string& many) {
    if (n > 0) parts += (parts.empty() ? "" : ", ") + fmt::format("{} {}", n, n == 1 ? one : many);
  };
  add(count[0], "holds", "hold");
  add(count[1], "fails", "fail");
  add(count[2], "is undecided", "are undecided");
  if (tested.empty()) return out + "none.";
  return out + parts + (unexpected.empty() ? "; all as expected." : "; not as expected: " + unexpected + ".");
}

Table claims_table(const std::vector<TestedClaim>& tested) {
  Table table{{{"id", "", Align::left},
               {"verdict", "", Align::left},
               {"expected", "", Align::left},
               {"largest error", "", Align::left},
               {"checks", ""}},
              {}};
  for (const auto& one : tested) {
    table.rows.push_back({one.claim.id, std::string(to_string(one.result.verdict)),
                          std::string(to_string(one.claim.expected)), largest_error(one.result),
                          std::to_string(one.result.checks.size())});
  }
  return table;
}

Table checks_table(const ClaimResult& result) {
  Table table{{{"where", "", Align::left},
               {"quantity", "", Align::left},
               {"claimed", ""},
               {"computed", ""},
               {"error", ""},
               {"allowed", ""},
               {"holds", "", Align::left}},
              {}};
  for (const auto& check : result.checks) {
    const std::string unit = check.unit.empty() ? "" : " [" + check.unit + "]";
    table.rows.push_back({(check.random ? "random: " : "") + check.where, check.quantity + unit,
                          with_digits(check.claimed, 9), with_digits(check.computed, 9),
                          std::isfinite(check.error) ? as_error(check.error) : "-",
                          std::isfinite(check.allowed) ? as_error(check.allowed) : "-", check.holds ? "yes" : "no"});
  }
  return table;
}

Document claims_document(const std::vector<TestedClaim>& tested, bool verbose) {
  Document out(wrapped(claims_answer(tested)));
  if (tested.size() > 1) {
    out += "\n";
    out.add_untitled("Claims", claims_table(tested));
  }
  if (verbose || tested.size() == 1) {
    for (const auto& one : tested) out += "\n" + one_in_full(one);
    return out;
  }
  std::string words;
  for (const auto& one : tested)
    if (!one.as_expected() || one.result.verdict != ClaimVerdict::holds) words += "\n" + in_short(one);
  if (!words.empty()) out += "\nThose that do not hold, or not as expected\n" + words;
  return out;
}

std::string claims_text(const std::vector<TestedClaim>& tested, bool verbose) {
  return claims_document(tested, verbose).text();
}

std::string claims_list(const std::vector<Claim>& claims) {
  std::size_t width = 0;
  for (const auto& claim : claims) width = std::max(width, claim.id.size());
  std::string out =
      wrapped("Claims. `limcycle claims ID` tests one, or those whose id begins so; without an id all are tested.") +
      "\n";
  for (const auto& claim : claims) out += item(claim.id, width, claim.statement);
  return out;
}

}  // namespace limcycle
