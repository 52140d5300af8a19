#pragma once
#include <algorithm>
#include <utility>

#include "limcycle/cases/section.hpp"

namespace limcycle::case_file {

/// Entries that a list of a law, plant or controller may have, and rows or columns of its matrices. Matrices of a loop
/// are dense: beyond this size a case would take longer to check than anybody waits.
inline constexpr std::size_t longest_list = 201;

/// Reads one parameter of `owner` from its section.
template <class Owner>
void read_parameter(const Place& place, const Parameter<Owner, double>& parameter, Owner& owner) {
  std::visit(
      [&](auto member) {
        auto& target = owner.*member;
        using T = std::decay_t<decltype(target)>;
        if constexpr (std::is_same_v<T, double>) {
          target = read_number(place, parameter.range, parameter.unit);
        } else if constexpr (std::is_same_v<T, std::vector<double>>) {
          target = read_list(place, longest_list, parameter.range, parameter.unit);
        } else if constexpr (std::is_same_v<T, Choice>) {
          target.index = static_cast<int>(read_choice(place, parameter.choices));
        } else if constexpr (std::is_same_v<T, Eigen::MatrixXd>) {
          target = read_matrix(place, static_cast<Eigen::Index>(longest_list));
        } else {
          target = read_complex_list(place, longest_list);
        }
      },
      parameter.member);
}

/// Copies the default of a parameter that takes it from another one.
template <class Owner>
void copy_parameter(const std::vector<Parameter<Owner, double>>& table, const Parameter<Owner, double>& to,
                    Owner& owner) {
  const auto from = std::ranges::find(table, to.default_from, &Parameter<Owner, double>::key);
  std::visit(
      [&](auto member) {
        if (const auto* source = std::get_if<decltype(member)>(&from->member)) owner.*member = owner.*(*source);
      },
      to.member);
}

/// A rule such as "must be at least Fc" with the values of the parameters that it names: "must be at least Fc = 1 N".
template <class Owner>
std::string with_values(const std::string& rule, const std::string& blamed, const Owner& owner) {
  std::string text;
  for (std::size_t begin = 0; begin < rule.size();) {
    const std::size_t end = std::min(rule.find(' ', begin), rule.size());
    const std::string_view word = std::string_view(rule).substr(begin, end - begin);
    text += (text.empty() ? "" : " ");
    text += word;
    for (const auto& parameter : Owner::parameters()) {
      const auto* number = std::get_if<double Owner::*>(&parameter.member);
      if (number == nullptr || word != parameter.key || word == blamed) continue;
      text += " = " + with_unit(owner.*(*number), parameter.unit);
    }
    begin = end + 1;
  }
  return text;
}

/// Value of a number that no one wrote, for a message; empty for other parameters.
template <class Owner>
std::string value_by_default(const std::string& key, const Owner& owner) {
  for (const auto& parameter : Owner::parameters())
    if (const auto* number = std::get_if<double Owner::*>(&parameter.member); number != nullptr && parameter.key == key)
      return with_unit(owner.*(*number), "1") + " (by default)";
  return {};
}

/// Reads a law, element, plant or controller from its section by its parameter table, and applies its own rules.
/// `extra`: keys that belong to the section but not to the table. Throws InputError.
template <class Owner>
Owner read_owner(const Section& section, std::vector<std::string> extra) {
  const auto table = Owner::parameters();
  for (const auto& parameter : table) extra.emplace_back(parameter.key);
  section.allow(extra);

  Owner owner{};
  for (const auto& parameter : table) {
    if (parameter.required) {
      const std::string unit = parameter.unit == "1" ? "" : ", " + std::string(parameter.unit);
      read_parameter(section.at(parameter.key, std::string(parameter.meaning) + unit), parameter, owner);
    } else if (const auto place = section.find(parameter.key)) {
      read_parameter(*place, parameter, owner);
    }
  }
  for (const auto& parameter : table)  // in the order of the table: a default may come from another default
    if (!parameter.default_from.empty() && !section.find(parameter.key)) copy_parameter(table, parameter, owner);

  if (const auto broken = owner.validate())
    throw section.error(broken->key, with_values(broken->rule, broken->key, owner), {},
                        value_by_default(broken->key, owner));
  return owner;
}

/// What the case format calls by name.
struct KindNames {
  std::string what;                    ///< "friction law", for messages
  std::vector<std::string> elsewhere;  ///< kinds that belong to another section...
  std::string elsewhere_hint;          ///< ...and to which
};

/// Kinds of a variant, in its order.
template <class Variant, std::size_t... I>
std::vector<std::string> kinds_of(std::index_sequence<I...>) {
  return {std::string(std::variant_alternative_t<I, Variant>::kind)...};
}
template <class Variant>
std::vector<std::string> kinds_of() {
  return kinds_of<Variant>(std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// The error for a kind that there is not, or not here.
InputError unknown_kind(const Place& kind, const std::vector<std::string>& available, const KindNames& names);

/// Reads whichever alternative of `Variant` the section's `kind` names, as a `Result`.
template <class Variant, class Result = Variant>
Result read_any(const Section& section, const KindNames& names) {
  const auto available = kinds_of<Variant>();
  const Place place = section.at("kind", "which " + names.what + " (" + joined(available) + ")");
  const std::string kind = read_string(place);
  std::optional<Result> result;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto try_one = [&]<class Owner>(std::type_identity<Owner>) {
      if (Owner::kind == kind) result = read_owner<Owner>(section, {"kind"});
    };
    (try_one(std::type_identity<std::variant_alternative_t<I, Variant>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
  if (!result) throw unknown_kind(place, available, names);
  return *std::move(result);
}

}  // namespace limcycle::case_file
