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

/// One row of a parameter table: everything that loader, listing, report, recast and sensitivity need to know about one
/// parameter of `Owner` (a law, element, plant or controller), written down once.
template <class Owner, class S>
struct Parameter {
  using Member = std::variant<S Owner::*,                                   // number
                              std::vector<S> Owner::*,                      // list of numbers
                              Choice Owner::*,                              // one of `choices`
                              Eigen::MatrixXd Owner::*,                     // rows as lists
                              std::vector<std::complex<double>> Owner::*>;  // numbers or [re, im] pairs
  std::string_view key;
  std::string_view unit;     ///< "1" if dimensionless
  std::string_view meaning;  ///< a few words
  Member member;
  Range range = any_number;
  bool required = true;                            ///< else the default is what a default-constructed Owner holds
  std::string_view default_from = {};              ///< if not empty: the default is the value of that key
  std::span<const std::string_view> choices = {};  ///< names for a Choice
};

/// A rule between parameters that is broken, found by `validate()` of a law, plant or controller.
struct BrokenRule {
  std::string key;   ///< the parameter to blame
  std::string rule;  ///< what must hold, in words, with the values that break it
};

/// What is no table of parameters (a user's own law) and makes itself anew on another scalar.
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
