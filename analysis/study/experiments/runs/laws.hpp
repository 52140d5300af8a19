#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A friction law with values for its parameters, spelled as in a case file. Lists given by one value are written out;
/// omitted keys have their default.
struct LawSetting {
  using Value = std::variant<double, std::vector<double>, std::string>;

  std::string kind;   ///< "lugre"
  std::string label;  ///< distinguishes settings of one kind; also the name of the preset's file
  std::vector<std::pair<std::string, Value>> values;
  std::string note{};            ///< origin of the values, and misprints
  double break_away = 1e-3;      ///< displacement by which the law has broken away, m: determines "gross" displacements
  std::function<bool()> stop{};  ///< called by the runs of this law; an experiment sets it

  const Value* find(const std::string& key) const;
  /// The number of that key; NaN if there is none.
  double number(const std::string& key) const;
  /// The same law with one value replaced; a law without that key is returned unchanged unless `add` is set.
  LawSetting with(const std::string& key, Value value, bool add = false) const;
  /// The same law with a number, or all of a list, times `factor`.
  LawSetting scaled(const std::string& key, double factor) const;
};

/// The laws that the experiments compare, with the source documents' values where they print any and otherwise with
/// comparable values (break-away at 1.5 N, sliding at 1 N). cases/presets/ holds the same values. A new law needs one
/// entry here; it is omitted from the experiments until it is in the list of laws.
const std::vector<LawSetting>& law_settings();

/// True if there is such a law in the list of laws.
bool is_friction_kind(const std::string& kind);

/// True if that law has such a parameter.
bool has_parameter(const std::string& kind, const std::string& key);

/// The law of a setting. Throws std::invalid_argument naming the key for an unknown kind or key, a value of the wrong
/// kind or out of its range, a missing one, or a broken rule of the law.
Element make_law(const LawSetting& setting);

/// The setting with one of its values, or all of a list, times `factor`; empty if the law rejects that.
std::optional<LawSetting> varied(const LawSetting& setting, const std::string& key, double factor);

/// Keys of the numbers and lists of a setting that are not levels of force and not zero: varied by "half and double".
std::vector<std::string> shape_keys(const LawSetting& setting);

/// Level of the force in steady sliding forwards at speed v > 0, by the law's own keys: g(v) + sigma2 v, the one level
/// of a law without Stribeck curve; NaN if the keys do not determine it (spline).
double steady_level(const LawSetting& setting, double v);

}  // namespace limcycle
