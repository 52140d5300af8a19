#include <fmt/format.h>

#include "limcycle/reports/claims/claims.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

std::string detail(const std::string& label, const std::string& text) {
  return text.empty() ? "" : "<p><strong>" + html_escaped(label) + ":</strong> " + html_escaped(text) + "</p>\n";
}

std::string one_html(const TestedClaim& one) {
  const Claim& claim = one.claim;
  const std::string verdict(to_string(one.result.verdict));
  std::string out = fmt::format("<details id=\"{0}\"{1}><summary>{0}: {2}{3}. {4}</summary>\n", html_escaped(claim.id),
                                one.as_expected() ? "" : " open", verdict,
                                one.as_expected() ? "" : " (expected: " + std::string(to_string(claim.expected)) + ")",
                                html_escaped(claim.statement));
  out += detail("Formula", claim.formula);
  out += detail("Source", claim.source + " (" + std::string(in_words(claim.evidence)) + ")");
  out += detail("Range", claim.range) + detail("Test", claim.test) + detail("Finding", one.result.finding);
  out += detail("Counter-example", one.result.counterexample);
  if (!one.result.checks.empty()) out += html_table(checks_table(one.result), "Comparisons of " + claim.id);
  return out + "</details>\n";
}

}  // namespace

std::string claims_page(const std::vector<TestedClaim>& tested, const Provenance& provenance,
                        const std::string& arguments, const std::string& case_text) {
  Provenance named = provenance;
  if (named.title.empty()) named.title = "Analytic claims against numbers";
  Table table = claims_table(tested);
  table.columns.push_back({"statement", "", Align::left});
  for (std::size_t i = 0; i < tested.size(); ++i) table.rows[i].push_back(tested[i].claim.statement);
  std::string body = html_table(table, "Claims and their verdicts") + "<h2>Each claim</h2>\n";
  for (const auto& one : tested) body += one_html(one);
  return html_page({.provenance = named,
                    .answer = claims_answer(tested),
                    .body = body,
                    .command = "claims",
                    .flags = arguments,
                    .case_text = case_text});
}

}  // namespace limcycle
