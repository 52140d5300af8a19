#include "limcycle/reports/case_files/catalogue.hpp"

#include <type_traits>

#include "limcycle/models/catalogue.hpp"
#include "limcycle/models/diagram/linear_blocks.hpp"
#include "limcycle/models/linear/controllers.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {
namespace {

ParameterEntry entry_of(const ParameterRow& row, const ParameterValue& by_default) {
  ParameterEntry entry{.key = std::string(row.key),
                       .unit = std::string(row.unit),
                       .meaning = std::string(row.meaning),
                       .type = {},
                       .range = row.range,
                       .required = row.required,
                       .default_value = {},
                       .default_name = {},
                       .default_from = std::string(row.default_from),
                       .choices = {row.choices.begin(), row.choices.end()}};
  if (const auto* number = std::get_if<double>(&by_default)) {
    entry.type = "number";
    if (!entry.required && entry.default_from.empty()) entry.default_value = *number;
  } else if (const auto* choice = std::get_if<Choice>(&by_default)) {
    entry.type = "choice";
    if (!entry.required) entry.default_name = entry.choices.at(static_cast<std::size_t>(choice->index));
  } else {
    entry.type = std::holds_alternative<std::vector<double>>(by_default) ? "list"
                 : std::holds_alternative<Eigen::MatrixXd>(by_default)   ? "matrix"
                 : std::holds_alternative<std::string>(by_default)       ? "text"
                                                                         : "complex list";
  }
  return entry;
}

std::vector<ParameterEntry> entries_of(const std::vector<ParameterRow>& rows,
                                       const std::vector<ParameterValue>& defaults) {
  std::vector<ParameterEntry> list;
  list.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) list.push_back(entry_of(rows[i], defaults[i]));
  return list;
}

/// Number of states of a plant or controller with scalar parameters, some of which add a state only if they are not
/// zero. Empty if lists decide.
template <class Owner>
std::optional<int> states_with(bool optional_too) {
  Owner owner{};
  for (const auto& parameter : Owner::parameters()) {
    if (const auto* number = std::get_if<double Owner::*>(&parameter.member)) {
      if (parameter.required || optional_too) owner.*(*number) = 1.0;
    } else if (!std::holds_alternative<Choice Owner::*>(parameter.member)) {
      return std::nullopt;
    }
  }
  int states = 0;
  if constexpr (requires { owner.states(); })
    states = owner.states();
  else if constexpr (requires { owner.model(); })
    states = static_cast<int>(owner.model().state_names.size());
  if constexpr (std::is_base_of_v<Actuator, Owner>) states += owner.lag > 0.0 ? 1 : 0;
  return states;
}

/// Number of states of an element whose lists have this many entries each.
int states_with_entries(const Element& kind, std::size_t entries) {
  auto values = kind.values();
  for (auto& value : values)
    if (auto* list = std::get_if<std::vector<double>>(&value)) list->assign(entries, 1.0);
  return kind.with(values).states();
}

CatalogueEntry blank(const std::string& group, std::string_view kind, std::string_view equation) {
  return {.group = group,
          .kind = std::string(kind),
          .equation = std::string(equation),
          .source = {},
          .states = {},
          .most_states = {},
          .states_per_entry = {},
          .states_beside = 0,
          .features = {},
          .parameters = {}};
}

/// Entry of an element with a fixed number of states, or with some for each of its parallel elements and some more.
CatalogueEntry entry_of(const std::string& group, const Element& element) {
  CatalogueEntry entry = blank(group, element.kind(), element.facts().equation);
  entry.source = element.facts().source;
  if (element.facts().features != nullptr) entry.features = *element.facts().features;
  const int one = states_with_entries(element, 1), each = states_with_entries(element, 2) - one;
  if (each == 0) {
    entry.states = entry.most_states = one;
  } else {
    entry.states_per_entry = each;
    entry.states_beside = one - each;
  }
  entry.parameters = entries_of(element.parameters(), element.defaults());
  return entry;
}

/// Entry of a plant or controller.
template <class Owner>
CatalogueEntry entry_of(const std::string& group) {
  CatalogueEntry entry = blank(group, Owner::kind, Owner::equation);
  entry.states = states_with<Owner>(false);
  entry.most_states = states_with<Owner>(true);
  entry.parameters = entries_of(rows_of<Owner>(), values_of(Owner{}));
  return entry;
}

template <class... Owners>
void append(std::vector<CatalogueEntry>& all, const std::string& group, std::type_identity<std::variant<Owners...>>) {
  (all.push_back(entry_of<Owners>(group)), ...);
}

}  // namespace

std::vector<CatalogueEntry> catalogue() {
  std::vector<CatalogueEntry> all;
  const auto& elements = catalogue_of_elements();
  for (const auto& law : elements.friction_laws) all.push_back(entry_of("friction", law));
  for (const auto& element : elements.forward_elements) all.push_back(entry_of("element", element));
  for (const auto& element : elements.error_elements)  // the others are among those above
    if (find_kind(elements.forward_elements, element.kind()) == nullptr)
      all.push_back(entry_of("error element", element));
  append(all, "plant", std::type_identity<Plant>{});
  append(all, "controller", std::type_identity<Controller>{});
  append(all, "block", std::type_identity<LinearBlock>{});
  return all;
}

std::vector<std::string> kinds_for(std::string_view section) {
  std::vector<std::string> kinds;
  if (section == "loop.error") return kinds_of(catalogue_of_elements().error_elements);
  for (const auto& entry : catalogue()) {
    const bool element = section == "loop.element" && (entry.group == "element" || entry.group == "friction");
    if (element || section == "loop." + entry.group) kinds.push_back(entry.kind);
  }
  return kinds;
}

}  // namespace limcycle
