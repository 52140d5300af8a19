#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/identify/identify.hpp"

namespace limcycle {
namespace {

/// A number as TOML: with a point or an exponent.
std::string toml_number(double value) {
  const std::string text = shortest(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string toml_value(const ParameterValue& value, const ParameterRow& row) {
  if (const auto* number = std::get_if<double>(&value)) return toml_number(*number);
  if (const auto* choice = std::get_if<Choice>(&value))
    return fmt::format("\"{}\"", row.choices[static_cast<std::size_t>(choice->index)]);
  std::string list;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value))
    for (const double one : *numbers) list += (list.empty() ? "" : ", ") + toml_number(one);
  return "[" + list + "]";
}

/// What stands behind a value in the fitted case.
std::string comment_on(const IdentifiedLaw& law, std::string_view key) {
  std::string comment;
  for (const auto& one : law.numbers) {
    const bool entry = one.name.starts_with(std::string(key) + "[");
    if (one.name != key && !entry) continue;
    if (!one.identifiable) return "  # not determined by the records";
    if (entry) continue;
    const auto end = [](const std::optional<double>& at) { return at ? with_digits(*at, 5) : std::string("?"); };
    comment = fmt::format("  # {} to {} (95 %){}", end(one.low), end(one.high), one.unit == "1" ? "" : ", " + one.unit);
  }
  return comment;
}

/// True for a value that a case has without writing it.
bool goes_without_saying(const Element& law, std::size_t row, const std::vector<ParameterValue>& values) {
  const auto& rows = law.parameters();
  if (rows[row].required) return false;
  const auto from = std::ranges::find(rows, rows[row].default_from, &ParameterRow::key);
  if (!rows[row].default_from.empty() && from != rows.end())
    return values[row] == values[static_cast<std::size_t>(from - rows.begin())];
  return values[row] == law.defaults()[row];
}

/// The table [loop.friction] of the fitted law, with the interval of each number behind it.
std::string friction_table(const IdentifiedLaw& law) {
  std::string text = fmt::format("[loop.friction]\nkind = \"{}\"\n", law.law.kind());
  const auto values = law.law.values();
  const auto& rows = law.law.parameters();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string comment = comment_on(law, rows[i].key);
    const auto* list = std::get_if<std::vector<double>>(&values[i]);
    if ((comment.empty() && goes_without_saying(law.law, i, values)) || (list != nullptr && list->empty())) continue;
    text += fmt::format("{} = {}{}\n", rows[i].key, toml_value(values[i], rows[i]), comment);
  }
  return text;
}

/// The correlations of the numbers that are spread, as the derivatives at the fit have them: the coordinates of the fit
/// rise with the numbers.
std::string correlation_list(const IdentifiedLaw& law, const std::vector<std::string>& spread) {
  std::string list;
  for (std::size_t i = 0; i < law.correlated.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double value = law.correlations(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      const auto is_spread = [&](const std::string& name) { return std::ranges::find(spread, name) != spread.end(); };
      if (!std::isfinite(value) || !is_spread(law.correlated[i]) || !is_spread(law.correlated[k])) continue;
      list += fmt::format("  {{between = [\"loop.friction.{}\", \"loop.friction.{}\"], value = {:.6f}}},\n",
                          law.correlated[k], law.correlated[i], std::clamp(value, -0.999999, 0.999999));
    }
  return list.empty() ? list : "[sensitivity]\ncorrelation = [\n" + list + "]\n";
}

const IdentifiedNumber* number_called(const IdentifiedLaw& law, std::string_view name) {
  const auto found = std::ranges::find(law.numbers, name, &IdentifiedNumber::name);
  return found == law.numbers.end() ? nullptr : &*found;
}

/// The level that is never above (Fs_minus: Fc_minus) or below this one, if both are fitted.
const IdentifiedNumber* other_level(const IdentifiedLaw& law, const std::string& name) {
  if (name.starts_with("Fs")) return number_called(law, "Fc" + name.substr(2));
  return name.starts_with("Fc") ? number_called(law, "Fs" + name.substr(2)) : nullptr;
}

/// How the value of a number varies: a table of [[sensitivity.parameters]] less its path; empty if it does not.
/// - Determined: normal, with the deviation of its interval; on its bound uniform over the interval.
/// - Not determined: over what its interval leaves of the range in which it was looked for.
/// Levels that came out equal stay in their order, so that every draw is a law.
std::string spread_of(const IdentifiedLaw& law, const IdentifiedNumber& one) {
  constexpr double half_in_deviations = 1.959964, deviations = 4.0;
  const IdentifiedNumber* other = other_level(law, one.name);
  const bool above = other != nullptr && one.name.starts_with("Fs"), below = other != nullptr && !above;
  const auto within = [&](double low, double high, const char* distribution) {
    if (above) low = std::max(low, other->high.value_or(other->value));
    if (below && !one.identifiable) high = std::min(high, other->low.value_or(other->value));
    if (!(low < high)) return std::string();
    return fmt::format("distribution = \"{}\"\nfrom = {}\nto = {}\n", low > 0.0 ? distribution : "uniform",
                       toml_number(low), toml_number(high));
  };
  if (!one.identifiable || !one.high)
    return within(one.low.value_or(std::min(one.searched_low, one.value > 0.0 ? one.value : infinite)),
                  one.high.value_or(std::max(one.searched_high, one.value)), "log-uniform");
  const double low = one.low.value_or(0.0), deviation = 0.5 * (*one.high - low) / half_in_deviations;
  if (!(deviation > 0.0)) return {};
  const bool level = other != nullptr && std::abs(one.value - other->value) <= 1e-9 * one.value;
  if (one.value <= 0.0 || (above && level)) return within(low, *one.high, "uniform");
  const double highest = below && level ? one.value : one.value + deviations * deviation;
  return fmt::format("distribution = \"normal\"\nmean = {}\ndeviation = {}\nfrom = {}\nto = {}\n",
                     toml_number(one.value), toml_number(deviation),
                     toml_number(std::max(0.0, one.value - deviations * deviation)), toml_number(highest));
}

std::string sensitivity_section(const IdentifiedLaw& law) {
  std::string text, not_spread;
  std::vector<std::string> spread;
  for (const auto& one : law.numbers) {
    const bool entry = one.name.find('[') != std::string::npos;
    const std::string how = entry ? std::string() : spread_of(law, one);
    if (entry) not_spread += (not_spread.empty() ? "" : ", ") + one.name;
    if (how.empty()) continue;
    if (one.identifiable) spread.push_back(one.name);
    text += fmt::format("[[sensitivity.parameters]]\npath = \"loop.friction.{}\"\n{}", one.name, how);
  }
  if (!not_spread.empty()) text += "# Not spread, since they are entries of lists: " + not_spread + "\n";
  return correlation_list(law, spread) + text;
}

/// Follows the brackets of arrays and inline tables from line to line: within them a line is no header.
class OpenBrackets {
 public:
  bool any() const { return depth_ > 0; }
  void follow(const std::string& line) {
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (quote != 0) {
        if (c == '\\' && quote == '"') ++i;
        if (c == quote) quote = 0;
      } else if (c == '#') {
        return;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '[' || c == '{') {
        ++depth_;
      } else if (c == ']' || c == '}') {
        --depth_;
      }
    }
  }

 private:
  int depth_ = 0;
};

/// The name of a table from its header line, "[[identify.record]]" -> "identify.record"; empty for other lines.
std::string header_of(const std::string& line) {
  const auto begin = line.find_first_not_of(" \t");
  if (begin == std::string::npos || line[begin] != '[') return {};
  const auto first = line.find_first_not_of("[ \t", begin), last = line.find_first_of("] \t", first);
  return first == std::string::npos || last == std::string::npos ? std::string() : line.substr(first, last - first);
}

bool is_in(const std::string& table, const std::string& of) { return table == of || table.starts_with(of + "."); }

}  // namespace

std::string fitted_case(const std::string& text, const std::string& title, const IdentifiedLaw& law) {
  std::string out, table;
  bool placed = false, loop = false;
  OpenBrackets open;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (const auto name = open.any() ? std::string() : header_of(line); !name.empty()) table = name;
    open.follow(line);
    loop = loop || is_in(table, "loop") || is_in(table, "diagram");
    if (is_in(table, "identify") || is_in(table, "sensitivity")) continue;
    if (is_in(table, "loop.friction")) {
      if (!placed) out += friction_table(law) + "\n";
      placed = true;
      continue;
    }
    out += line + "\n";
  }
  if (!placed && loop)
    throw std::invalid_argument(
        "the fitted law cannot be written into this case: its friction does not stand in a table [loop.friction]");
  if (!placed) {
    std::string quoted;
    for (const char c : title) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    out = fmt::format("title = \"{}\"\n\n", quoted) + friction_table(law);
  }
  while (out.ends_with("\n\n")) out.pop_back();
  const std::string spread = sensitivity_section(law);
  return out + (spread.empty() ? "" : "\n" + spread);
}

std::string record_csv(const FrictionRecord& record) {
  std::string out;
  const std::pair<const char*, const std::vector<double>*> columns[] = {
      {"time", &record.t}, {"position", &record.x}, {"velocity", &record.v}, {"force", &record.F}};
  for (const auto& [name, values] : columns)
    if (!values->empty()) out += (out.empty() ? "" : ",") + std::string(name);
  out += "\n";
  for (std::size_t i = 0; i < std::max(record.t.size(), record.F.size()); ++i) {
    bool first = true;
    for (const auto& [name, values] : columns) {
      if (values->empty()) continue;
      if (!first) out += ",";
      append_shortest(out, (*values)[i]);
      first = false;
    }
    out += "\n";
  }
  return out;
}

std::string identify_section(const std::string& law, const std::vector<FrictionRecord>& records,
                             const std::vector<std::string>& files) {
  std::string out = fmt::format("[identify]\nlaw = \"{}\"\n", law);
  for (std::size_t i = 0; i < records.size(); ++i)
    out += fmt::format("\n[[identify.record]]\nkind = \"{}\"\nfile = \"{}\"\n", to_string(records[i].kind), files[i]);
  return out;
}

}  // namespace limcycle
