#include "limcycle/cases/loader/sections/parameters.hpp"

namespace limcycle::case_file {
namespace {

/// Value of the section for a parameter whose present value is `present`.
ParameterValue read_value(const Place& place, const ParameterRow& row, const ParameterValue& present) {
  if (std::holds_alternative<double>(present)) return read_number(place, row.range, row.unit);
  if (std::holds_alternative<std::vector<double>>(present)) return read_list(place, longest_list, row.range, row.unit);
  if (std::holds_alternative<Choice>(present)) return Choice{static_cast<int>(read_choice(place, row.choices))};
  if (std::holds_alternative<Eigen::MatrixXd>(present))
    return read_matrix(place, row.key == points_of_data ? longest_data : longest_list, longest_list);
  if (std::holds_alternative<std::string>(present)) return read_string(place);
  return read_complex_list(place, longest_list);
}

/// A rule such as "must be at least Fc" with the values of the parameters that it names: "must be at least Fc = 1 N".
std::string with_values(const BrokenRule& broken, const std::vector<ParameterRow>& rows,
                        const std::vector<ParameterValue>& values) {
  std::string text;
  for (std::size_t begin = 0; begin < broken.rule.size();) {
    const std::size_t end = std::min(broken.rule.find(' ', begin), broken.rule.size());
    const std::string_view word = std::string_view(broken.rule).substr(begin, end - begin);
    text += (text.empty() ? "" : " ");
    text += word;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto* number = std::get_if<double>(&values[i]);
      if (number == nullptr || word != rows[i].key || word == broken.key) continue;
      text += " = " + with_unit(*number, rows[i].unit);
    }
    begin = end + 1;
  }
  return text;
}

}  // namespace

std::vector<ParameterValue> read_values(const Section& section, const std::vector<ParameterRow>& rows,
                                        std::vector<ParameterValue> values, std::vector<std::string> extra) {
  for (const auto& row : rows) extra.emplace_back(row.key);
  section.allow(extra);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ParameterRow& row = rows[i];
    if (row.required) {
      const std::string unit = row.unit == "1" ? "" : ", " + std::string(row.unit);
      values[i] = read_value(section.at(row.key, std::string(row.meaning) + unit), row, values[i]);
    } else if (const auto place = section.find(row.key)) {
      values[i] = read_value(*place, row, values[i]);
    }
  }
  follow_defaults(rows, values, [&](std::string_view key) { return section.find(key).has_value(); });
  return values;
}

InputError broken_rule(const Section& section, const BrokenRule& broken, const std::vector<ParameterRow>& rows,
                       const std::vector<ParameterValue>& values) {
  const auto number = number_of(rows, values, broken.key);
  return section.error(broken.key, with_values(broken, rows, values), {},
                       number ? with_unit(*number, "1") + " (by default)" : std::string());
}

InputError unknown_kind(const Place& kind, const std::vector<std::string>& available, const KindNames& names) {
  const std::string name = *kind.value.as<std::string>();
  if (std::ranges::find(names.elsewhere, name) != names.elsewhere.end()) return kind.error(names.elsewhere_hint);
  const auto near = nearest_name(name, available);
  return kind.error("unknown " + names.what,
                    near.empty() ? "known: " + joined(available) : "did you mean \"" + near + "\"?");
}

NamedKind read_kind(const Section& section, const std::vector<std::string>& available, const KindNames& names) {
  const Place place = section.at("kind", "which " + names.what + " (" + joined(available) + ")");
  return {place, read_string(place)};
}

namespace {

/// True if the section asks for measured points in the place of a formula.
bool is_measured(const Section& section) {
  const auto curve = section.find("curve");
  const auto* name = curve ? curve->value.as<std::string>() : nullptr;
  return name != nullptr && *name == "table";
}

/// The law over measured points of a kind that has a curve, itself or in the name of the other.
const Element* measured(const Section& section, const std::vector<Element>& list, const std::string& kind) {
  if (kind.ends_with("-table")) return find_kind(list, kind);
  if (const Element* table = find_kind(list, kind + "-table")) return table;
  std::vector<std::string> with_table;
  for (const std::string& one : limcycle::kinds_of(list))
    if (one.ends_with("-table")) with_table.push_back(one.substr(0, one.size() - std::string("-table").size()));
  throw section.at("curve", "").error("is for the kinds " + joined(with_table));
}

}  // namespace

Element read_element(const Section& section, const std::vector<Element>& list, const KindNames& names,
                     const std::vector<std::string>& extra) {
  const auto available = limcycle::kinds_of(list);
  const NamedKind named = read_kind(section, available, names);
  const Element* kind = find_kind(list, named.kind);
  if (kind == nullptr) throw unknown_kind(named.place, available, names);
  std::vector<std::string> keys{"kind"};
  if (is_measured(section)) {
    kind = measured(section, list, named.kind);
    keys.emplace_back("curve");
  }
  keys.insert(keys.end(), extra.begin(), extra.end());
  const auto values = read_values(section, kind->parameters(), kind->values(), std::move(keys));
  Element element = kind->with(values);
  if (const auto broken = element.validate()) throw broken_rule(section, *broken, kind->parameters(), values);
  return element;
}

}  // namespace limcycle::case_file
