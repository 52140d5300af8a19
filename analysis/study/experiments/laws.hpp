#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "limcycle/models/elements.hpp"

namespace limcycle {

/// A friction law with values for its parameters, spelled as in a case file. Lists that a value stands for are written
/// out; keys that are left out have their default.
struct LawSetting {
  using Value = std::variant<double, std::vector<double>, std::string>;

  std::string kind;   ///< "lugre"
  std::string label;  ///< tells settings of one kind apart; also the name of the preset's file
  std::vector<std::pair<std::string, Value>> values;
  std::string note{};            ///< where the values come from, what is misprinted
  double break_away = 1e-3;      ///< displacement by which the law has broken away, m: sets "gross" displacements
  bool from_documents = false;   ///< one of the five laws that the thesis compares
  std::function<bool()> stop{};  ///< asked by the runs of this law; an experiment sets it

  const Value* find(const std::string& key) const;
  /// The number of that key; NaN if there is none.
  double number(const std::string& key) const;
  /// The same law with one value replaced; a law without that key is returned as it is unless `add`ed.
  LawSetting with(const std::string& key, Value value, bool add = false) const;
  /// The same law with a number, or all of a list, times `factor`.
  LawSetting scaled(const std::string& key, double factor) const;
};

/// The laws that the experiments compare, with the source documents' values where they print any and else with values
/// that make them comparable (break-away at 1.5 N, sliding at 1 N). cases/presets/ holds the same values. A new law is
/// one entry here; it is left out of the experiments until it is in the list of laws.
const std::vector<LawSetting>& law_settings();

/// Is there such a law in the list of laws?
bool is_friction_kind(const std::string& kind);

/// Does that law have such a parameter?
bool has_parameter(const std::string& kind, const std::string& key);

/// The law of a setting. Throws std::invalid_argument naming the key for an unknown kind or key, a value of the wrong
/// kind or out of its range, a missing one, or a broken rule of the law.
Element<double> make_law(const LawSetting& setting);

/// The setting with one of its values, or all of a list, times `factor`; empty where the law refuses that.
std::optional<LawSetting> varied(const LawSetting& setting, const std::string& key, double factor);

/// Keys of the numbers and lists of a setting that are not levels of force and not zero: what "half and double" vary.
std::vector<std::string> shape_keys(const LawSetting& setting);

/// Level of the force in steady sliding forwards at speed v > 0, by the law's own keys: g(v) + sigma2 v, the one level
/// of a law without Stribeck curve; NaN where the keys do not tell (spline).
double steady_level(const LawSetting& setting, double v);

}  // namespace limcycle
