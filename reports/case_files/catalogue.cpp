#include "limcycle/reports/case_files/catalogue.hpp"

#include <type_traits>

#include "limcycle/models/elements.hpp"
#include "limcycle/models/linear/controllers.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {
namespace {

template <class Owner>
ParameterEntry entry_of(const Parameter<Owner, double>& parameter) {
  ParameterEntry entry{.key = std::string(parameter.key),
                       .unit = std::string(parameter.unit),
                       .meaning = std::string(parameter.meaning),
                       .type = {},
                       .range = parameter.range,
                       .required = parameter.required,
                       .default_value = {},
                       .default_name = {},
                       .default_from = std::string(parameter.default_from),
                       .choices = {parameter.choices.begin(), parameter.choices.end()}};
  const Owner fresh{};
  std::visit(
      [&](auto member) {
        using T = std::decay_t<decltype(fresh.*member)>;
        if constexpr (std::is_same_v<T, double>) {
          entry.type = "number";
          if (!entry.required && entry.default_from.empty()) entry.default_value = fresh.*member;
        } else if constexpr (std::is_same_v<T, Choice>) {
          entry.type = "choice";
          if (!entry.required) entry.default_name = entry.choices.at(static_cast<std::size_t>((fresh.*member).index));
        } else {
          entry.type = std::is_same_v<T, std::vector<double>> ? "list"
                       : std::is_same_v<T, Eigen::MatrixXd>   ? "matrix"
                                                              : "complex list";
        }
      },
      parameter.member);
  return entry;
}

/// Number of states of a plant or controller whose parameters are numbers: some of them make a state only when they are
/// not zero. Empty where lists decide.
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
  const auto model = owner.model();
  int states = static_cast<int>(model.state_names.size());
  if constexpr (std::is_base_of_v<Actuator, Owner>) states += owner.lag > 0.0 ? 1 : 0;
  return states;
}

/// Number of states of an element whose lists hold so many entries each.
template <class Owner>
int states_with_entries(std::size_t entries) {
  Owner owner{};
  for (const auto& parameter : Owner::parameters())
    if (const auto* list = std::get_if<std::vector<double> Owner::*>(&parameter.member))
      (owner.*(*list)).assign(entries, 1.0);
  return owner.states();
}

/// An element has a fixed number of states, or so many for each of its parallel elements and some beside them.
template <class Owner>
void count_states(CatalogueEntry& entry) {
  const int one = states_with_entries<Owner>(1), each = states_with_entries<Owner>(2) - one;
  if (each == 0) {
    entry.states = entry.most_states = one;
  } else {
    entry.states_per_entry = each;
    entry.states_beside = one - each;
  }
}

template <class Owner>
CatalogueEntry entry_of(const std::string& group) {
  CatalogueEntry entry{.group = group,
                       .kind = std::string(Owner::kind),
                       .equation = std::string(Owner::equation),
                       .source = {},
                       .states = {},
                       .most_states = {},
                       .states_per_entry = {},
                       .states_beside = 0,
                       .features = {},
                       .parameters = {}};
  if constexpr (requires { Owner::source; }) entry.source = Owner::source;
  if constexpr (requires { Owner::features; }) entry.features = Owner::features;
  if constexpr (requires { Owner{}.states(); }) {
    count_states<Owner>(entry);
  } else {
    entry.states = states_with<Owner>(false);
    entry.most_states = states_with<Owner>(true);
  }
  for (const auto& parameter : Owner::parameters()) entry.parameters.push_back(entry_of(parameter));
  return entry;
}

template <class... Owners>
void append(std::vector<CatalogueEntry>& all, const std::string& group, std::type_identity<std::variant<Owners...>>) {
  (all.push_back(entry_of<Owners>(group)), ...);
}

}  // namespace

std::vector<CatalogueEntry> catalogue() {
  std::vector<CatalogueEntry> all;
  append(all, "friction", std::type_identity<FrictionLaws::On<double>>{});
  append(all, "element", std::type_identity<ForwardElements::On<double>>{});
  append(all, "error element", std::type_identity<KindList<Quantizer>::On<double>>{});
  append(all, "plant", std::type_identity<Plant>{});
  append(all, "controller", std::type_identity<Controller>{});
  return all;
}

std::vector<std::string> kinds_for(std::string_view section) {
  std::vector<std::string> kinds;
  if (section == "loop.error") {
    ErrorElements::for_each([&]<template <class> class Kind>() { kinds.emplace_back(Kind<double>::kind); });
    return kinds;
  }
  for (const auto& entry : catalogue()) {
    const bool element = section == "loop.element" && (entry.group == "element" || entry.group == "friction");
    if (element || section == "loop." + entry.group) kinds.push_back(entry.kind);
  }
  return kinds;
}

}  // namespace limcycle
