#pragma once
#include <Eigen/Core>
#include <complex>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace limcycle {

/// A value picked from a short list of names; `index` counts from 0 in the order of the list.
struct Choice {
  int index = 0;
  bool operator==(const Choice&) const = default;
};

/// Interval of valid values. Infinity at an end means unlimited; the value itself must always be finite.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;   ///< low itself is not allowed
  bool high_open = false;  ///< high itself is not allowed

  bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr Range any_number{};
inline constexpr Range positive{0.0, infinite, true, false};
inline constexpr Range not_negative{0.0, infinite, false, false};

/// Value of a parameter of any type.
using ParameterValue =
    std::variant<double, std::vector<double>, Choice, Eigen::MatrixXd, std::vector<std::complex<double>>, std::string>;

/// One row of a parameter table, for any owner: all data that loader, listing, report and sensitivity need about it.
struct ParameterRow {
  std::string_view key;
  std::string_view unit;     ///< "1" if dimensionless
  std::string_view meaning;  ///< in a few words
  Range range = any_number;
  bool required = true;                            ///< else the default is that of a default-constructed owner
  std::string_view default_from = {};              ///< if not empty: the default is the value of that key
  std::span<const std::string_view> choices = {};  ///< names for a Choice
};

/// The same with the member of `Owner` (a law, element, plant or controller) that holds the value.
template <class Owner, class S>
struct Parameter : ParameterRow {
  using Member = std::variant<S Owner::*,                                  // number
                              std::vector<S> Owner::*,                     // list of numbers
                              Choice Owner::*,                             // one of `choices`
                              Eigen::MatrixXd Owner::*,                    // rows as lists
                              std::vector<std::complex<double>> Owner::*,  // numbers or [re, im] pairs
                              std::string Owner::*>;                       // a text, such as the name of a file
  Member member;

  Parameter(std::string_view key_, std::string_view unit_, std::string_view meaning_, Member member_,
            Range range_ = any_number, bool required_ = true, std::string_view default_from_ = {},
            std::span<const std::string_view> choices_ = {})
      // NOLINTNEXTLINE(clang-analyzer-optin.cplusplus.UninitializedObject): it does not see a base set in braces
      : ParameterRow{key_, unit_, meaning_, range_, required_, default_from_, choices_}, member(member_) {}
};

/// Rows of the table of an owner, and its values, in the order of the table.
template <class Owner>
const std::vector<ParameterRow>& rows_of() {
  static const std::vector<ParameterRow> rows = [] {
    std::vector<ParameterRow> list;
    for (const auto& parameter : Owner::parameters()) list.push_back(parameter);
    return list;
  }();
  return rows;
}
template <class Owner>
std::vector<ParameterValue> values_of(const Owner& owner) {
  std::vector<ParameterValue> list;
  for (const auto& parameter : Owner::parameters())
    list.push_back(std::visit([&](auto member) { return ParameterValue(owner.*member); }, parameter.member));
  return list;
}

/// Writes values, in the order of the table. Throws std::invalid_argument where one is of another type.
template <class Owner>
void set_values(Owner& owner, const std::vector<ParameterValue>& values) {
  const auto table = Owner::parameters();
  for (std::size_t i = 0; i < table.size(); ++i)
    std::visit(
        [&](auto member) {
          using Type = std::decay_t<decltype(owner.*member)>;
          const auto* value = std::get_if<Type>(&values.at(i));
          if (!value) throw std::invalid_argument(std::string(table[i].key) + ": a value of another type");
          owner.*member = *value;
        },
        table[i].member);
}

/// Value of the scalar parameter of that key; empty if there is none.
inline std::optional<double> number_of(const std::vector<ParameterRow>& rows, const std::vector<ParameterValue>& values,
                                       std::string_view key) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (const auto* number = std::get_if<double>(&values[i]); number && rows[i].key == key) return *number;
  return std::nullopt;
}

/// Applies defaults that refer to another key: parameters that are not `written` get the value of that key, in the
/// order of the table, as a default may come from another default.
template <class Written>
void follow_defaults(const std::vector<ParameterRow>& rows, std::vector<ParameterValue>& values,
                     const Written& written) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows.size() && !rows[i].default_from.empty(); ++k)
      if (rows[k].key == rows[i].default_from && values[k].index() == values[i].index() && !written(rows[i].key))
        values[i] = values[k];
}

/// A rule between parameters that is broken, found by `validate()` of a law, plant or controller.
struct BrokenRule {
  std::string key;   ///< parameter to which the error refers
  std::string rule;  ///< required condition, in words, with the values that break it
};

/// A class without a table of parameters (a user's own law) that converts itself to another scalar.
template <class Owner, class To>
concept OffersScalar = requires(const Owner owner) {
  owner.template on<To>();
};

/// Same object with another scalar: `recast<Dual>(LuGre<double>)`. Numbers and lists are converted, the rest copied.
template <template <class> class Owner, class To, class From>
Owner<To> recast(const Owner<From>& from) {
  if constexpr (OffersScalar<Owner<From>, To>) {
    return from.template on<To>();
  } else {
    Owner<To> to;
    const auto source = Owner<From>::parameters();
    const auto target = Owner<To>::parameters();
    for (std::size_t i = 0; i < source.size(); ++i) {
      std::visit(
          [&](auto out) {
            using Out = std::decay_t<decltype(to.*out)>;
            if constexpr (std::is_same_v<Out, To>) {
              to.*out = To(from.*std::get<From Owner<From>::*>(source[i].member));
            } else if constexpr (std::is_same_v<Out, std::vector<To>>) {
              const auto& values = from.*std::get<std::vector<From> Owner<From>::*>(source[i].member);
              (to.*out).assign(values.begin(), values.end());
            } else if constexpr (std::is_same_v<Out, Choice>) {
              to.*out = from.*std::get<Choice Owner<From>::*>(source[i].member);
            }
          },
          target[i].member);
    }
    return to;
  }
}

}  // namespace limcycle
