#include "limcycle/analysis/study/identify/parameter_space.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace limcycle {
namespace {

/// Sizes in the records, from which ranges follow by the unit of a number.
struct RecordSizes {
  double force = 0.0, displacement = 0.0, duration = 0.0, slowest = infinite, fastest = 0.0;
};

RecordSizes sizes_of(const std::vector<PreparedRecord>& records) {
  RecordSizes sizes;
  double least = infinite;
  for (const auto& record : records) {
    sizes.force = std::max(sizes.force, record.largest_force);
    // A rig slides far beyond what stretches its contact.
    const double stretch = is_free(record.kind) ? 0.01 * record.displacement : record.displacement;
    if (stretch > 0.0) least = std::min(least, stretch);
    sizes.duration = std::max(sizes.duration, record.duration);
    if (record.kind == RecordKind::pre_sliding) continue;
    sizes.slowest = std::min(sizes.slowest, record.slowest);
    sizes.fastest = std::max(sizes.fastest, record.fastest);
  }
  for (const auto& record : records) {
    if (std::isfinite(sizes.slowest)) break;
    sizes.slowest = std::min(sizes.slowest, record.slowest);
    sizes.fastest = std::max(sizes.fastest, record.fastest);
  }
  sizes.displacement = std::isfinite(least) ? least : sizes.fastest;
  if (sizes.duration == 0.0) sizes.duration = sizes.displacement / sizes.fastest;
  return sizes;
}

void set_range(FreeNumber& number, const RecordSizes& sizes) {
  const double F = sizes.force, x = sizes.displacement, v = sizes.fastest;
  const auto between = [&](double low, double high) {
    number.low = low;
    number.high = high;
  };
  if (number.unit == "N")
    between(0.2 * F, 1.2 * F);
  else if (number.unit == "m/s")
    between(std::max(sizes.slowest, 1e-4 * v), v);
  else if (number.unit == "N/m")
    between(F / x, 300.0 * F / x);
  else if (number.unit == "N s/m")
    between(0.01 * F / v, F / v);
  else if (number.unit == "N/s")
    between(3.0 * F / sizes.duration, 3000.0 * F / sizes.duration);
  else if (number.unit == "m")
    between(0.003 * x, x);
  else
    between(0.1, 0.9);
  if (number.name == "delta") between(0.5, 2.0);
}

/// Shapes with a usual value, and numbers that are 0 unless a case says more.
bool has_usual_value(const ParameterRow& row) {
  return row.key == "delta" || row.key == "exponent" || row.key == "vd" ||
         (!row.default_from.empty() && row.key != "Fs") || (row.key == "sigma1" && row.unit == "1");
}

bool contains(const std::vector<std::string>& list, std::string_view key) {
  return std::ranges::find(list, key) != list.end();
}

/// Lists get their length: `elements`, where the law does not default to none.
Element with_elements(const Element& kind, int elements) {
  auto values = kind.values();
  const auto& rows = kind.parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (auto* list = std::get_if<std::vector<double>>(&values[i]); list && rows[i].required)
      list->assign(static_cast<std::size_t>(elements), 1.0 / elements);
  return kind.with(values);
}

/// How far beyond its typical range a number > 0 may be fitted; on the way there methods may go further.
constexpr double farthest_factor = 1e3, never_beyond = 1e4;
/// The same of a share, as a logit: from 0.002 to 0.998.
constexpr double farthest_logit = 6.0;

Coordinate coordinate_for(const Range& range) {
  if (range.high < infinite) return Coordinate::logit;
  return range.low == 0.0 && range.low_open ? Coordinate::log : Coordinate::linear;
}

double logit(double p) { return std::log(p / (1.0 - p)); }

}  // namespace

ParameterSpace::ParameterSpace(const Element& kind, const std::vector<PreparedRecord>& records,
                               const FreeChoice& choice)
    : kind_(with_elements(kind, choice.elements)) {
  const auto& rows = kind_.parameters();
  const RecordSizes sizes = sizes_of(records);
  auto values = kind_.values();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto held = std::ranges::find(choice.fixed, rows[i].key, &std::pair<std::string, double>::first);
    if (held != choice.fixed.end() && std::holds_alternative<double>(values[i])) {
      if (!rows[i].range.contains(held->second))
        throw std::invalid_argument(held->first + " is held at a value outside its range");
      values[i] = held->second;
      own_rows_.push_back(i);
    } else if (!has_usual_value(rows[i]) || contains(choice.free, rows[i].key)) {
      FreeNumber number{std::string(rows[i].key), std::string(rows[i].unit), {i, 0}, rows[i].range, {}, 0.0, 0.0, 1.0};
      number.coordinate = coordinate_for(rows[i].range);
      set_range(number, sizes);
      add_numbers(i, values[i], std::move(number));
    }
  }
  kind_ = kind_.with(values);
  std::optional<std::size_t> dependent;
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    if (is_share_of_sum(k)) dependent = k;
  number_coordinates(dependent);
}

/// A number for a value, or one for each entry of a list.
void ParameterSpace::add_numbers(std::size_t row, const ParameterValue& value, FreeNumber number) {
  if (std::holds_alternative<double>(value)) {
    number.scale = number.high;
    numbers_.push_back(std::move(number));
    own_rows_.push_back(row);
  }
  const auto* list = std::get_if<std::vector<double>>(&value);
  if (list == nullptr) return;
  if (number.unit == "N/m") {
    number.low *= 0.1;  // a part of the force at the full displacement, or much sooner
    number.high *= 0.1;
  }
  number.scale = number.high;
  const std::string key = number.name;
  for (std::size_t k = 0; k < list->size(); ++k) {
    number.name = key + "[" + std::to_string(k) + "]";
    number.at.entry = k;
    numbers_.push_back(number);
  }
}

void ParameterSpace::number_coordinates(std::optional<std::size_t> dependent) {
  dependent_ = dependent;
  of_.clear();
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    if (k != dependent_) of_.push_back(k);
}

bool ParameterSpace::is_share_of_sum(std::size_t number) const {
  return kind_.parameters()[numbers_[number].at.row].key == "alpha" && kind_.kind().starts_with("gms");
}

bool ParameterSpace::is_own(std::size_t row) const { return std::ranges::find(own_rows_, row) != own_rows_.end(); }

/// The key that it follows by default, or itself.
std::string_view ParameterSpace::key_behind(std::string_view key) const {
  const auto& rows = kind_.parameters();
  const auto row = std::ranges::find(rows, key, &ParameterRow::key);
  if (row == rows.end() || row->default_from.empty() || is_own(static_cast<std::size_t>(row - rows.begin())))
    return key;
  return key_behind(row->default_from);
}

std::optional<std::size_t> ParameterSpace::source_of(std::string_view key) const {
  const auto found = std::ranges::find(numbers_, key_behind(key), &FreeNumber::name);
  if (found == numbers_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - numbers_.begin());
}

std::vector<Bound> ParameterSpace::bounds() const {
  std::vector<Bound> list;
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const auto& number = numbers_[k];
    const auto c = coordinate_of(k);
    if (number.coordinate == Coordinate::linear && number.range.low == 0.0)
      list.push_back({c, -1, 0.0, number.name + " comes out at its bound, 0"});
    if (number.coordinate == Coordinate::linear || is_share_of_sum(k)) continue;
    const std::string note = number.name + " comes out at the end of the range in which it was looked for";
    const bool share = number.coordinate == Coordinate::logit;
    list.push_back({c, -1, share ? -farthest_logit : std::log(number.low / farthest_factor), note, false});
    list.push_back({-1, c, share ? farthest_logit : std::log(number.high * farthest_factor), note, false});
  }
  for (const auto& [above, below] : {std::pair("Fs", "Fc"), std::pair("Fs_minus", "Fc_minus")}) {
    const auto high = source_of(above), low = source_of(below);
    const auto at_above = kind_.number(key_behind(above)), at_below = kind_.number(key_behind(below));
    if ((!high && !low) || !at_above || !at_below) continue;  // held, or a law without these levels
    Bound bound{high ? coordinate_of(*high) : -1, low ? coordinate_of(*low) : -1, 0.0,
                std::string(above) + " comes out at its bound, " + below};
    constexpr double beyond_rounding = 1e-14;  // exp(log(Fc)) may be less than Fc
    if (!high) bound.at = std::log(*at_above) - beyond_rounding;
    if (!low) bound.at = std::log(*at_below) + beyond_rounding;
    const auto same = [&](const Bound& one) {
      return one.above == bound.above && one.below == bound.below && one.at == bound.at;
    };
    if (std::ranges::none_of(list, same)) list.push_back(std::move(bound));
  }
  return list;
}

ParameterSpace ParameterSpace::with_dependent(std::size_t number) const {
  ParameterSpace other = *this;
  if (is_share_of_sum(number)) other.number_coordinates(number);
  return other;
}

std::vector<LawNumber> ParameterSpace::places() const {
  std::vector<LawNumber> list;
  for (const auto& number : numbers_) list.push_back(number.at);
  return list;
}

Eigen::Index ParameterSpace::coordinate_of(std::size_t number) const {
  const auto found = std::ranges::find(of_, number);
  return found == of_.end() ? -1 : found - of_.begin();
}

Eigen::VectorXd ParameterSpace::values(const Eigen::VectorXd& u) const {
  Eigen::VectorXd result(std::ssize(numbers_));
  double rest = 1.0;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const auto& number = numbers_[of_[i]];
    const double at = u(static_cast<Eigen::Index>(i));
    double value = 0.0;
    switch (number.coordinate) {
      case Coordinate::log:
        value = std::exp(std::clamp(at, -300.0, 300.0));
        break;
      case Coordinate::linear:
        value = number.scale * at;
        break;
      case Coordinate::logit:
        value = 1.0 / (1.0 + std::exp(-at));
        break;
    }
    result(static_cast<Eigen::Index>(of_[i])) = value;
    if (dependent_ && is_share_of_sum(of_[i])) rest -= value;
  }
  if (dependent_) result(static_cast<Eigen::Index>(*dependent_)) = rest;
  return result;
}

bool ParameterSpace::inside(const Eigen::VectorXd& values) const {
  if (!values.allFinite() || (dependent_ && !(values(static_cast<Eigen::Index>(*dependent_)) > 1e-6))) return false;
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const double value = values(static_cast<Eigen::Index>(k));
    if (numbers_[k].coordinate == Coordinate::log && k != dependent_ &&
        !(value > numbers_[k].low / never_beyond && value < numbers_[k].high * never_beyond))
      return false;
  }
  return true;
}

Eigen::VectorXd ParameterSpace::coordinates(const Eigen::VectorXd& values) const {
  Eigen::VectorXd u(size());
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const auto& number = numbers_[of_[i]];
    const double value = values(static_cast<Eigen::Index>(of_[i]));
    u(static_cast<Eigen::Index>(i)) = number.coordinate == Coordinate::log      ? std::log(value)
                                      : number.coordinate == Coordinate::linear ? value / number.scale
                                                                                : logit(value);
  }
  return u;
}

Eigen::MatrixXd ParameterSpace::chain(const Eigen::VectorXd& values) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(std::ssize(numbers_), size());
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const auto& number = numbers_[of_[i]];
    const auto row = static_cast<Eigen::Index>(of_[i]), column = static_cast<Eigen::Index>(i);
    const double value = values(row);
    result(row, column) = number.coordinate == Coordinate::log      ? value
                          : number.coordinate == Coordinate::linear ? number.scale
                                                                    : value * (1.0 - value);
    if (dependent_ && is_share_of_sum(of_[i]))
      result(static_cast<Eigen::Index>(*dependent_), column) = -result(row, column);
  }
  return result;
}

Element ParameterSpace::law(const Eigen::VectorXd& values) const {
  auto all = kind_.values();
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const double value = values(static_cast<Eigen::Index>(k));
    if (auto* list = std::get_if<std::vector<double>>(&all[numbers_[k].at.row]))
      list->at(numbers_[k].at.entry) = value;
    else
      all[numbers_[k].at.row] = value;
  }
  const auto& rows = kind_.parameters();
  follow_defaults(rows, all, [&](std::string_view key) {
    return is_own(static_cast<std::size_t>(std::ranges::find(rows, key, &ParameterRow::key) - rows.begin()));
  });
  return kind_.with(all);
}

Eigen::VectorXd ParameterSpace::start(const std::vector<double>& shares) const {
  Eigen::VectorXd values(std::ssize(numbers_));
  double sum = 0.0;
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    const auto& number = numbers_[k];
    const double share = shares.at(k);
    const bool by_ratio = number.coordinate != Coordinate::logit;
    double& value = values(static_cast<Eigen::Index>(k));
    value =
        by_ratio ? number.low * std::pow(number.high / number.low, share) : std::lerp(number.low, number.high, share);
    if (is_share_of_sum(k)) sum += value;
  }
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    if (is_share_of_sum(k)) values(static_cast<Eigen::Index>(k)) /= sum;
  Eigen::VectorXd u = coordinates(values);
  for (const auto& bound : bounds())
    if (bound.room(u) < 0.0 && bound.above >= 0 && bound.below >= 0) std::swap(u(bound.above), u(bound.below));
  return u;
}

}  // namespace limcycle
