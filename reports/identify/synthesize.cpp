#include "limcycle/reports/identify/synthesize.hpp"

#include <fmt/format.h>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

/// The law's numbers by path: "loop.friction.Fs", entries of lists each.
std::vector<std::pair<std::string, double>> true_numbers(const Element& law) {
  std::vector<std::pair<std::string, double>> list;
  const auto values = law.values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string path = "loop.friction." + std::string(law.parameters()[i].key);
    if (const auto* number = std::get_if<double>(&values[i])) list.emplace_back(path, *number);
    if (const auto* numbers = std::get_if<std::vector<double>>(&values[i]))
      for (std::size_t k = 0; k < numbers->size(); ++k)
        list.emplace_back(fmt::format("{}[{}]", path, k), (*numbers)[k]);
  }
  return list;
}

}  // namespace

std::string synthesize_text(const std::string& title, const SynthesizeReport& report) {
  Table table{{{"record", "", Align::left}, {"rows", ""}, {"file", "", Align::left}}, {}};
  for (const auto& one : report.records)
    table.rows.push_back({std::string(to_string(one.kind)), std::to_string(one.rows), one.file});
  return wrapped(title) + "\n" +
         wrapped(fmt::format("Records of a rig whose friction is {}, with {} noise of the force.", report.law.kind(),
                             as_percent(report.faults.noise))) +
         "\n" + table.text() + "\nlimcycle identify " + report.case_file + "\n";
}

std::string synthesize_json(const Provenance& provenance, const SynthesizeReport& report) {
  Json top, parameters = Json::array(), records = Json::array();
  for (const auto& [name, value] : true_numbers(report.law))
    parameters.push_back({{"name", name}, {"value", number(value)}});
  for (const auto& one : report.records)
    records.push_back({{"kind", to_string(one.kind)}, {"file", one.file}, {"rows", one.rows}});
  top["law"] = {{"kind", report.law.kind()}, {"parameters", parameters}};
  top["faults"] = {{"noise", report.faults.noise},
                   {"drift", report.faults.drift},
                   {"ripple", report.faults.ripple},
                   {"quantum", report.faults.quantum},
                   {"jitter", report.faults.jitter}};
  top["records"] = records;
  top["case_file"] = report.case_file;
  return json_document("synthesize", provenance, json_text(top));
}

std::string synthesize_csv(const SynthesizeReport& report) {
  std::string out = csv_line({"kind", "file", "rows"});
  for (const auto& one : report.records)
    out += csv_line({std::string(to_string(one.kind)), one.file, std::to_string(one.rows)});
  return out;
}

}  // namespace limcycle
