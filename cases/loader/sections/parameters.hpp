#pragma once
#include <algorithm>
#include <utility>

#include "limcycle/cases/loader/text/section.hpp"
#include "limcycle/models/catalogue.hpp"

namespace limcycle {
struct MeasuredPlant;
}

namespace limcycle::case_file {

/// Largest number of rows of measured data.
inline constexpr std::size_t longest_data = 100'000;
inline constexpr std::string_view points_of_data = "points";  ///< the key that holds them

/// Largest number of entries in a list of a law, plant or controller, and of rows or columns in its matrices. Matrices
/// of a loop are dense: beyond this size checking a case would take too long.
inline constexpr std::size_t longest_list = 201;

/// The values of a section for the rows of a table; `values` holds the defaults. `extra`: keys that belong to the
/// section but not to the table. Throws InputError.
std::vector<ParameterValue> read_values(const Section& section, const std::vector<ParameterRow>& rows,
                                        std::vector<ParameterValue> values, std::vector<std::string> extra);

/// The error for a rule that values of a section break together: "must be at least Fc = 1 N".
InputError broken_rule(const Section& section, const BrokenRule& broken, const std::vector<ParameterRow>& rows,
                       const std::vector<ParameterValue>& values);

/// Reads what stands in files that a section names. For most there is none.
template <class Owner>
void complete(const Section&, Owner&) {}
void complete(const Section& section, MeasuredPlant& plant);

/// Reads a plant or controller from its section by its parameter table, and applies its own rules.
template <class Owner>
Owner read_owner(const Section& section, std::vector<std::string> extra) {
  Owner owner{};
  const auto values = read_values(section, rows_of<Owner>(), values_of(owner), std::move(extra));
  set_values(owner, values);
  complete(section, owner);
  if (const auto broken = owner.validate()) throw broken_rule(section, *broken, rows_of<Owner>(), values);
  return owner;
}

/// Names used in messages about kinds.
struct KindNames {
  std::string what;                    ///< "friction law", for messages
  std::vector<std::string> elsewhere;  ///< kinds that belong to another section...
  std::string elsewhere_hint;          ///< ...and a hint to which
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

/// The error for a kind that is unknown, or not allowed here.
InputError unknown_kind(const Place& kind, const std::vector<std::string>& available, const KindNames& names);

/// The kind that a section names, available or not.
struct NamedKind {
  Place place;
  std::string kind;
};
NamedKind read_kind(const Section& section, const std::vector<std::string>& available, const KindNames& names);

/// Reads the alternative of `Variant` that the section's `kind` names. `extra`: keys of the section besides `kind` and
/// those of the alternative.
template <class Variant>
Variant read_any(const Section& section, const KindNames& names, std::vector<std::string> extra = {}) {
  const auto available = kinds_of<Variant>();
  const NamedKind named = read_kind(section, available, names);
  std::optional<Variant> result;
  extra.insert(extra.begin(), "kind");
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto try_one = [&]<class Owner>(std::type_identity<Owner>) {
      if (Owner::kind == named.kind) result = read_owner<Owner>(section, extra);
    };
    (try_one(std::type_identity<std::variant_alternative_t<I, Variant>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
  if (!result) throw unknown_kind(named.place, available, names);
  return *std::move(result);
}

/// Reads the element of a list that the section's `kind` names. `extra`: keys of the section besides `kind` and those
/// of the element.
Element read_element(const Section& section, const std::vector<Element>& list, const KindNames& names,
                     const std::vector<std::string>& extra = {});

}  // namespace limcycle::case_file
