#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/models/catalogue.hpp"

namespace limcycle::test {

inline Element kind_named(const std::string& kind) {
  const Element* found = find_kind(catalogue_of_elements().friction_laws, kind);
  if (found == nullptr) throw std::invalid_argument(kind);
  return *found;
}

/// A law of that kind with these values, the rest by default.
inline Element law_with(const std::string& kind, const std::vector<std::pair<std::string, ParameterValue>>& chosen) {
  const Element law = kind_named(kind);
  auto values = law.values();
  const auto& rows = law.parameters();
  const auto written = [&](std::string_view key) {
    for (const auto& [name, value] : chosen)
      if (name == key) return true;
    return false;
  };
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& [name, value] : chosen)
      if (name == rows[i].key) values[i] = value;
  follow_defaults(rows, values, written);
  return law.with(values);
}

inline Element dahl_rig() { return law_with("dahl", {{"Fc", 1.0}, {"sigma0", 1e5}}); }
inline Element lugre_rig() {
  return law_with("lugre",
                  {{"Fs", 1.5}, {"Fc", 1.0}, {"vs", 1e-3}, {"sigma0", 1e5}, {"sigma1", 300.0}, {"sigma2", 20.0}});
}
inline Element elasto_plastic_rig() {
  return law_with("elasto-plastic", {{"Fs", 1.5},
                                     {"Fc", 1.0},
                                     {"vs", 1e-3},
                                     {"sigma0", 1e5},
                                     {"sigma1", 300.0},
                                     {"sigma2", 20.0},
                                     {"zba_ratio", 0.6}});
}
inline Element gms_rig() {
  return law_with("gms", {{"Fs", 1.5},
                          {"Fc", 1.0},
                          {"vs", 1e-3},
                          {"k", std::vector<double>{6e4, 3e4, 1e4, 4e3}},
                          {"alpha", std::vector<double>{0.3, 0.3, 0.2, 0.2}},
                          {"C", 100.0},
                          {"sigma2", 20.0}});
}
inline Element stribeck_rig() {
  return law_with("stribeck", {{"Fs", 1.5}, {"Fc", 1.0}, {"vs", 1e-3}, {"sigma2", 20.0}});
}
inline Element coulomb_rig() { return law_with("coulomb", {{"Fs", 1.5}, {"Fc", 1.0}, {"sigma2", 20.0}}); }

inline const IdentifiedNumber& number_named(const IdentifiedLaw& law, std::string_view name) {
  for (const auto& one : law.numbers)
    if (one.name == name) return one;
  throw std::invalid_argument(std::string(name));
}

/// Value of a number by its name, "Fs" or "k[0]".
inline double true_value(const Element& law, const std::string& name) {
  const auto bracket = name.find('[');
  if (bracket == std::string::npos) return law.number(name).value();
  const auto& rows = law.parameters();
  const auto values = law.values();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].key == name.substr(0, bracket))
      return std::get<std::vector<double>>(values[i]).at(std::stoul(name.substr(bracket + 1)));
  throw std::invalid_argument(name);
}

}  // namespace limcycle::test
