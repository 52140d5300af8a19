#include "limcycle/reports/figures/blocks/block_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"

namespace limcycle {
namespace {

constexpr std::size_t block_columns = 36;  // of a line in a block
constexpr std::size_t sum_lines = 3;       // of a polynomial

constexpr std::string_view true_minus = "\xE2\x88\x92", ellipsis = "\xE2\x80\xA6";

/// A value of a parameter table: as displayed, and exactly.
struct ShownValue {
  std::string key, shown, exact, unit;
};

std::string cut_to(const std::string& text, std::size_t width) {
  if (display_width(text) <= width) return text;
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t next = i + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xC0u) == 0x80u) ++next;
    if (display_width(out) + 1 >= width) break;
    out += text.substr(i, next - i);
    i = next;
  }
  return out + std::string(ellipsis);
}

template <class Number>
std::string listed(const std::vector<Number>& values, auto&& word) {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : ", ") + word(value);
  return values.empty() ? "none" : "[" + out + "]";
}

std::string complex_word(const std::complex<double>& value, auto&& word) {
  if (value.imag() == 0.0) return word(value.real());
  std::string minus = word(-1.0);  // each way of writing has its own sign
  minus.pop_back();
  return word(value.real()) + " " + (value.imag() < 0.0 ? minus : "+") + " j " + word(std::abs(value.imag()));
}

std::string matrix_rows(const Eigen::MatrixXd& matrix) {
  std::string out;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    out += i == 0 ? "[" : ", [";
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) out += (k == 0 ? "" : ", ") + shortest(matrix(i, k));
    out += "]";
  }
  return matrix.rows() > 1 ? "[" + out + "]" : out;
}

/// A value of any type in words: to six digits, and exactly.
template <class Value>
std::pair<std::string, std::string> both_ways(const Value& value, std::span<const std::string_view> choices) {
  if constexpr (std::is_same_v<Value, double>) {
    return {diagram_number(value), shortest(value)};
  } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
    return {listed(value, diagram_number), listed(value, shortest)};
  } else if constexpr (std::is_same_v<Value, Choice>) {
    const std::string name(choices[static_cast<std::size_t>(value.index)]);
    return {name, name};
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return {value, value};
  } else if constexpr (std::is_same_v<Value, Eigen::MatrixXd>) {
    return {fmt::format("{} by {}", value.rows(), value.cols()), matrix_rows(value)};
  } else {
    return {listed(value, [](const auto& z) { return complex_word(z, diagram_number); }),
            listed(value, [](const auto& z) { return complex_word(z, shortest); })};
  }
}

/// Eigen compares matrices of one shape only.
bool equal(const ParameterValue& a, const ParameterValue& b) {
  const auto *left = std::get_if<Eigen::MatrixXd>(&a), *right = std::get_if<Eigen::MatrixXd>(&b);
  if (left != nullptr && right != nullptr && (left->rows() != right->rows() || left->cols() != right->cols()))
    return false;
  return a == b;
}

/// True if an optional parameter has its default: its own value, or that of another key.
bool stands_by_default(const std::vector<ParameterRow>& rows, const std::vector<ParameterValue>& values,
                       const std::vector<ParameterValue>& defaults, std::size_t i) {
  if (rows[i].required) return false;
  if (rows[i].default_from.empty()) return equal(values[i], defaults[i]);
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k].key == rows[i].default_from) return equal(values[i], values[k]);
  return false;
}

/// Units of force and length are those of a servo; any other loop has units of time only.
std::string unit_of_value(std::string_view unit, const Units& units) {
  const bool of_time = unit == "s" || unit == "1/s" || unit == "rad/s";
  return unit == "1" || (units.force.empty() && !of_time) ? std::string() : std::string(unit);
}

/// Parts with a block of their own, for any controller.
constexpr std::array<std::string_view, 3> of_actuator{"friction_compensation", "saturation", "lag"};

std::vector<ShownValue> shown_values(const std::vector<ParameterRow>& rows, const std::vector<ParameterValue>& values,
                                     const std::vector<ParameterValue>& defaults, const Units& units) {
  std::vector<ShownValue> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (stands_by_default(rows, values, defaults, i)) continue;
    const auto [shown, exact] =
        std::visit([&](const auto& value) { return both_ways(value, rows[i].choices); }, values[i]);
    const std::string unit = shown == "none" ? "" : unit_of_value(rows[i].unit, units);
    out.push_back({std::string(rows[i].key), shown, exact, unit});
  }
  return out;
}

std::string in_full(std::string_view kind, const std::vector<ShownValue>& values) {
  std::string out(kind);
  for (std::size_t i = 0; i < values.size(); ++i)
    out += (i == 0 ? " (" : ", ") + values[i].key + " = " + Units::attach(values[i].exact, values[i].unit);
  return values.empty() ? out : out + ")";
}

/// Adds a fraction; long polynomials take several lines on either side of the bar.
void add_fraction(std::vector<BlockLine>& lines, const std::vector<double>& over, const std::vector<double>& under) {
  for (auto& line : broken_sum(polynomial_in_s(over), block_columns, sum_lines)) lines.push_back({line, true, false});
  lines.push_back({"", true, true});
  for (auto& line : broken_sum(polynomial_in_s(under), block_columns, sum_lines)) lines.push_back({line, true, false});
}

BlockWords words_of(const std::string& role, std::string_view kind, std::string_view equation,
                    const std::vector<ShownValue>& values, std::vector<BlockLine> fraction) {
  const bool drawn = !fraction.empty();
  BlockWords words{role + ": " + std::string(kind), std::move(fraction), in_full(kind, values), std::string(equation)};
  for (const auto& value : values) {
    if (drawn && (value.key == "numerator" || value.key == "denominator")) continue;
    words.lines.push_back(
        {cut_to(value.key + " = " + Units::attach(value.shown, value.unit), block_columns), false, false});
  }
  return words;
}

/// Words of a plant or controller; `whole`: with the actuator, which has blocks of its own in a loop of slots.
template <class Owner>
BlockWords words_of_part(const std::string& role, const Owner& owner, const Units& units, bool whole = false) {
  auto values = shown_values(rows_of<Owner>(), values_of(owner), values_of(Owner{}), units);
  if constexpr (std::is_base_of_v<Actuator, Owner>)
    if (!whole)
      std::erase_if(values,
                    [](const auto& one) { return std::ranges::find(of_actuator, one.key) != of_actuator.end(); });
  std::vector<BlockLine> fraction;
  if constexpr (requires { owner.denominator; }) add_fraction(fraction, owner.numerator, owner.denominator);
  return words_of(role, Owner::kind, Owner::equation, values, std::move(fraction));
}

}  // namespace

std::string diagram_number(double value) {
  const std::string text = fmt::format("{:.6g}", value);
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '-')
      out += true_minus;
    else if (text[i] != '+' && !(text[i] == '0' && i >= 2 && text[i - 2] == 'e'))  // 1e-06
      out += text[i];
  }
  return out;
}

std::string polynomial_in_s(const std::vector<double>& coefficients) {
  constexpr std::array<std::string_view, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const double c = coefficients[i];
    const std::size_t power = coefficients.size() - 1 - i;
    if (c == 0.0) continue;
    if (out.empty())
      out += c < 0.0 ? std::string(true_minus) : "";
    else
      out += c < 0.0 ? " " + std::string(true_minus) + " " : " + ";
    const bool bare = std::abs(c) == 1.0 && power > 0;
    if (!bare) out += diagram_number(std::abs(c)) + (power > 0 ? " " : "");
    if (power > 0) out += "s";
    if (power < 2) continue;
    for (const char digit : std::to_string(power)) out += raised[static_cast<std::size_t>(digit - '0')];
  }
  return out.empty() ? "0" : out;
}

std::vector<std::string> broken_sum(const std::string& sum, std::size_t columns, std::size_t most) {
  std::vector<std::string> lines{""};
  std::size_t begin = 0;
  while (begin < sum.size()) {
    std::size_t next = std::min(sum.find(" + ", begin + 1), sum.find(" " + std::string(true_minus) + " ", begin + 1));
    const std::string term = sum.substr(begin, next == std::string::npos ? next : next - begin);
    if (!lines.back().empty() && display_width(lines.back() + term) > columns) lines.emplace_back();
    lines.back() += lines.back().empty() && lines.size() > 1 ? term.substr(1) : term;
    begin = next == std::string::npos ? sum.size() : next;
  }
  if (lines.size() <= most) return lines;
  lines.resize(most);
  lines.back() += " " + std::string(ellipsis);
  return lines;
}

BlockWords plant_words(const Plant& plant, const Units& units) {
  return std::visit([&](const auto& p) { return words_of_part("plant", p, units); }, plant);
}

std::optional<BlockWords> controller_words(const Controller& controller, const Units& units) {
  if (std::holds_alternative<NoController>(controller)) return std::nullopt;
  return std::visit([&](const auto& c) { return words_of_part("controller", c, units); }, controller);
}

BlockWords element_words(const std::string& role, const Element& element, const Units& units) {
  return words_of(role, element.kind(), element.facts().equation,
                  shown_values(element.parameters(), element.values(), element.defaults(), units), {});
}

BlockWords words_of_block(const Block& block, const Units& units) {
  BlockWords words;
  if (const auto* element = std::get_if<Element>(&block.what))
    words = element_words(block.name, *element, units);
  else if (const auto* plant = std::get_if<Plant>(&block.what))
    words = plant_words(*plant, units);
  else if (const auto* controller = std::get_if<Controller>(&block.what))
    // What a controller reads and commands is up to the diagram: units of force and length are not those of the slots.
    words = std::visit(
        [&](const auto& one) {
          return words_of_part(block.name, one, Units{"", "", ""}, true);
        },
        *controller);
  else
    words = std::visit([&](const auto& one) { return words_of_part(block.name, one, units); },
                       std::get<LinearBlock>(block.what));
  words.title = block.name + words.title.substr(std::min(words.title.find(':'), words.title.size()));
  return words;
}

BlockWords compensation_words(double level, const Units& units) {
  const auto words = [&](const std::string& number) { return Units::attach(number, units.command) + " sgn(v)"; };
  return {"friction compensation",
          {{words(diagram_number(level)), false, false}},
          "friction compensation " + words(shortest(level)),
          "adds friction_compensation sgn(v) to the command"};
}

BlockWords limit_words(double limit, const Units& units) {
  const auto words = [&](const std::string& number) { return "\xC2\xB1" + Units::attach(number, units.command); };
  return {"saturation",
          {{words(diagram_number(limit)), false, false}},
          "saturation " + words(shortest(limit)),
          "limits the command"};
}

BlockWords lag_words(double time_constant) {
  BlockWords words{"lag", {}, "a lag of " + shortest(time_constant) + " s", "first-order actuator"};
  add_fraction(words.lines, {1.0}, {time_constant, 1.0});
  return words;
}

}  // namespace limcycle
