#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/experiments/experiment.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string findings(const Experiment& one) {
  std::size_t width = 0;
  for (const auto& finding : one.findings) width = std::max(width, finding.law.size());
  std::string out;
  for (const auto& finding : one.findings) out += item(finding.law, width, finding.text);
  return out;
}

std::string claims(const Experiment& one) {
  std::string out;
  for (const auto& claim : one.claims)
    out += item(std::string(to_string(claim.outcome)), 13,
                claim.statement + " (" + claim.source + ")" + (claim.measure.empty() ? "" : ": " + claim.measure));
  return out;
}

std::string section(const std::string& heading, const std::string& body) {
  return body.empty() ? "" : "\n" + heading + "\n" + body;
}

Document one_document(const Experiment& one, bool with_numbers) {
  Document out(wrapped(one.name + ": " + one.title));
  out += wrapped("After: " + one.document + ".") + wrapped("Input: " + one.input + ".");
  out += section("Findings", findings(one));
  if (with_numbers && !one.rows.empty() && one.rows.size() <= longest_experiment_table)
    out.add("Numbers", experiment_table(one));
  else if (with_numbers && !one.rows.empty())
    out += fmt::format("\n{} rows of numbers: --csv FILE, --json FILE or -o FILE.html\n", one.rows.size());
  out += section("Claims of the documents", claims(one));
  out += notes_text(one.notes);
  if (one.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(one.status));
  return out;
}

}  // namespace

std::string experiment_list(const std::vector<ExperimentEntry>& entries) {
  std::size_t width = 0;
  for (const auto& entry : entries) width = std::max(width, entry.name.size());
  std::string out = wrapped(
                        "Experiments of the source documents. `limcycle experiment NAME` runs one, `limcycle "
                        "experiment all` all of them.") +
                    "\n";
  for (const auto& entry : entries) out += item(std::string(entry.name), width, std::string(entry.title));
  return out;
}

std::string claims_in_words(const std::vector<Experiment>& experiments) {
  std::size_t count[4] = {};
  for (const auto& one : experiments)
    for (const auto& claim : one.claims) ++count[static_cast<std::size_t>(claim.outcome)];
  const std::size_t tested = count[0] + count[1] + count[2];
  if (tested + count[3] == 0) return "";
  std::string out = fmt::format("Of {} claim{} tested, {} confirmed, {} not confirmed", tested, tested == 1 ? "" : "s",
                                count[0], count[1]);
  if (count[2] > 0) out += fmt::format(", {} depending on the definition or the law", count[2]);
  if (count[3] > 0) out += fmt::format("; {} not tested, their laws not being in this run", count[3]);
  return out + ".";
}

Document experiment_document(const std::vector<Experiment>& experiments) {
  Document out;
  for (const auto& one : experiments) {
    if (&one != &experiments.front()) out += "\n\n";
    out += one_document(one, experiments.size() == 1);
  }
  if (const std::string words = claims_in_words(experiments); !words.empty()) out += "\n" + wrapped(words);
  return out;
}

std::string experiment_text(const std::vector<Experiment>& experiments) {
  return experiment_document(experiments).text();
}

Table experiment_table(const Experiment& one) {
  const bool varied = std::ranges::any_of(one.rows, [](const Measured& row) { return !row.setting.empty(); });
  Table table{{{"law", "", Align::left}}, {}};
  if (varied) table.columns.push_back({"setting", "", Align::left});
  for (const auto& quantity : one.quantities) table.columns.push_back({quantity.heading, quantity.unit});
  for (const auto& row : one.rows) {
    std::vector<std::string> cells{row.law};
    if (varied) cells.push_back(row.setting);
    for (const double value : row.values) cells.push_back(with_digits(value, 5));
    cells.resize(table.columns.size(), "-");
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace limcycle
