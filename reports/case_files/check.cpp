#include "limcycle/reports/case_files/check.hpp"

#include <fmt/format.h>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

std::string line(const std::string& name, const std::string& value) { return item(name, 10, value); }

std::string poles_text(const CheckSummary& summary) {
  if (!summary.stable) return "not computed: the loop has a delay";
  if (!summary.slowest_pole) return "none";
  return fmt::format("largest real part {} 1/s: {} without the elements", with_digits(*summary.slowest_pole, 4),
                     *summary.stable ? "stable" : "not asymptotically stable");
}

std::string search_text(const SearchBox& box, bool from_case) {
  const auto number = [&](double value) { return from_case ? shortest(value) : with_digits(value, 4); };
  return fmt::format("amplitude {} .. {}, frequency {} .. {} rad/s ({})", number(box.amplitude_min),
                     number(box.amplitude_max), number(box.frequency_min), number(box.frequency_max),
                     from_case ? "from the case" : "from the loop's own scales");
}

std::vector<std::string> parts(const CheckSummary& summary) {
  std::vector<std::string> names;
  for (const auto& part : summary.elements) names.push_back(part.path + ": " + part.kind);
  return names;
}

}  // namespace

std::string check_text(const Provenance& provenance, const CheckSummary& summary) {
  std::string text = line("title", provenance.title) + fmt::format("{:<12}{}\n", "file", provenance.file);
  if (summary.plant) text += line("plant", *summary.plant) + line("controller", *summary.controller);
  for (std::size_t i = 0; i < summary.blocks.size(); ++i) {
    const auto& block = summary.blocks[i];
    const std::string inputs = fmt::format("{}", fmt::join(block.inputs, "; "));
    text += line(i == 0 ? "blocks" : "", block.name + ": " + block.kind +
                                             (block.inputs.empty() ? "" : (block.touches ? " on " : " of ") + inputs));
  }
  text += line("elements", summary.elements.empty() ? "none" : fmt::format("{}", fmt::join(parts(summary), ", ")));
  text += line("states", summary.states.empty() ? "none" : fmt::format("{}", fmt::join(summary.states, ", ")));
  if (summary.plant || !summary.blocks.empty()) {
    text += line("order", fmt::format("{} (linear part{})", summary.order,
                                      summary.delay > 0.0 ? ", delay " + shortest(summary.delay) + " s" : ""));
    text += line("poles", poles_text(summary));
  }
  for (const MeasuredPlantAt& plant : provenance.measured) {
    text += line("data", plant.path + ": " + plant.response->data_in_words());
    text += line("fit", plant.response->fit_in_words());
  }
  if (summary.search) text += line("search box", search_text(*summary.search, summary.search_from_case));
  if (!summary.sections.empty()) text += line("sections", fmt::format("{}", fmt::join(summary.sections, "; ")));
  return text + "The case is valid.\n";
}

std::string check_json(const Provenance& provenance, const CheckSummary& summary) {
  Json elements = Json::array();
  for (const auto& part : summary.elements) elements.push_back({{"path", part.path}, {"kind", part.kind}});
  Json blocks = Json::array();
  for (const auto& block : summary.blocks)
    blocks.push_back({{"name", block.name}, {"kind", block.kind}, {"inputs", block.inputs}});
  Json search = nullptr;
  if (const auto& box = summary.search)
    search = {{"amplitude", {box->amplitude_min, box->amplitude_max}},
              {"frequency", {box->frequency_min, box->frequency_max}},
              {"from_case", summary.search_from_case}};
  const Json body{{"plant", or_null(summary.plant)},
                  {"controller", or_null(summary.controller)},
                  {"blocks", blocks},
                  {"elements", elements},
                  {"states", summary.states},
                  {"order", summary.order},
                  {"delay", summary.delay},
                  {"slowest_pole", or_null(summary.slowest_pole)},
                  {"stable", or_null(summary.stable)},
                  {"search", search}};
  return json_document("check", provenance, json_text(body));
}

std::string check_csv(const Provenance& provenance, const CheckSummary& summary) {
  const auto& box = summary.search;
  const auto number = [](const std::optional<double>& value) { return value ? shortest(*value) : std::string(); };
  const auto edge = [&](double SearchBox::*member) { return box ? shortest((*box).*member) : std::string(); };
  return csv_line({"title", "plant", "controller", "elements", "states", "order", "delay", "slowest_pole", "stable",
                   "amplitude_from", "amplitude_to", "frequency_from", "frequency_to"}) +
         csv_line({provenance.title, summary.plant.value_or(""), summary.controller.value_or(""),
                   fmt::format("{}", fmt::join(parts(summary), " ")), fmt::format("{}", fmt::join(summary.states, " ")),
                   std::to_string(summary.order), shortest(summary.delay), number(summary.slowest_pole),
                   summary.stable ? (*summary.stable ? "true" : "false") : "", edge(&SearchBox::amplitude_min),
                   edge(&SearchBox::amplitude_max), edge(&SearchBox::frequency_min), edge(&SearchBox::frequency_max)});
}

}  // namespace limcycle
