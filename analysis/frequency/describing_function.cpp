#include "limcycle/analysis/frequency/describing_function.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limcycle/analysis/frequency/fft_route.hpp"
#include "limcycle/analysis/frequency/quadrature_route.hpp"

namespace limcycle {

namespace {

[[noreturn]] void refuse(const char* what, double value, const char* rule) {
  std::ostringstream text;
  text.precision(17);
  text << "describing function: " << what << " = " << value << " " << rule;
  throw std::invalid_argument(text.str());
}

template <class E, class List>
inline constexpr bool is_in = false;
template <class E, class... Kinds>
inline constexpr bool is_in<E, std::variant<Kinds...>> = (std::is_same_v<E, Kinds> || ...);

bool finite(const DescribingFunction& df) {
  bool all = std::isfinite(df.gain.real()) && std::isfinite(df.gain.imag()) && std::isfinite(df.mean) &&
             std::isfinite(df.dissipation) && std::isfinite(df.error);
  for (const auto& h : df.harmonics) all = all && std::isfinite(h.real()) && std::isfinite(h.imag());
  return all;
}

/// No number where there is no result, and never one that is not finite.
DescribingFunction clean(DescribingFunction df, const DfOptions& options) {
  if (df.status == Status::converged || df.status == Status::incomplete) {
    if (finite(df)) return df;
    df.status = Status::not_finite;
  }
  DescribingFunction empty;
  empty.status = df.status;
  empty.method = df.method;
  empty.evaluations = df.evaluations;
  empty.harmonics.assign(static_cast<std::size_t>(options.harmonics), 0.0);
  return empty;
}

template <template <class> class Kind>
DescribingFunction compute(const Kind<double>& element, const DfPoint& point, const DfOptions& options) {
  constexpr bool friction = is_in<Kind<double>, FrictionLaws::On<double>>;
  const PrescribedMotion motion(point.amplitude, point.frequency, point.bias, friction);
  const bool try_symmetric = element.odd() && point.bias == 0.0;
  if (options.method == DfMethod::fft) {
    DfOptions tighter = options;
    tighter.accuracy = std::max(0.3 * options.accuracy, 1e-13);
    const DescribingFunction other = QuadratureRoute<Kind>(element, motion, try_symmetric, tighter).refine();
    if (other.status != Status::converged && other.status != Status::incomplete) return clean(other, options);
    return clean(FftRoute<Kind>(element, motion, try_symmetric, friction ? point.bias : 0.0, options).refine(other),
                 options);
  }
  DescribingFunction result = QuadratureRoute<Kind>(element, motion, try_symmetric, options).refine();
  if constexpr (HasExactDescribingFunction<Kind<double>>) {
    const auto exact = element.exact_describing_function(point.amplitude, point.frequency, point.bias);
    if (options.method == DfMethod::automatic && exact && !result.harmonics.empty()) {
      result.gain = *exact;
      result.harmonics[0] = *exact * point.amplitude;
      result.error = *exact == 0.0 ? 0.0 : 4e-15;
      result.method = "closed-form";
    }
  }
  return clean(std::move(result), options);
}

}  // namespace

void validate(const DfOptions& options) {
  if (options.harmonics < 1 || options.harmonics > 1000) refuse("harmonics", options.harmonics, "must lie in 1..1000");
  if (!(options.accuracy >= 1e-13 && options.accuracy <= 0.1))
    refuse("accuracy", options.accuracy, "must lie in 1e-13..0.1");
}

void validate(const DfPoint& point) {
  if (!(point.amplitude > 0.0) || !std::isfinite(point.amplitude))
    refuse("amplitude", point.amplitude, "must be positive and finite");
  if (!(point.frequency > 0.0) || !std::isfinite(point.frequency))
    refuse("frequency", point.frequency, "must be positive and finite");
  if (!std::isfinite(point.bias)) refuse("bias", point.bias, "must be finite");
}

DescribingFunction describing_function(const Element<double>& element, const DfPoint& point, const DfOptions& options) {
  return describing_function_table(element, {point}, options).front();
}

std::vector<DescribingFunction> describing_function_table(const Element<double>& element,
                                                          const std::vector<DfPoint>& points, const DfOptions& options,
                                                          const std::function<bool()>& stop,
                                                          const std::function<void(std::size_t)>& progress) {
  validate(options);
  for (const DfPoint& point : points) validate(point);
  std::vector<DescribingFunction> table;
  table.reserve(points.size());
  std::visit(
      [&](const auto& law) {
        for (const DfPoint& point : points) {
          if (stop && stop()) return;
          table.push_back(compute(law, point, options));
          if (progress) progress(table.size());
        }
      },
      element);
  return table;
}

}  // namespace limcycle
