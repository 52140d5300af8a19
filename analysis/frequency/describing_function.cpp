#include "limcycle/analysis/frequency/describing_function.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "limcycle/analysis/erased_element.hpp"
#include "limcycle/analysis/frequency/drive_dependence.hpp"
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

bool is_friction(const Element<double>& element) {
  return std::visit([]<class E>(const E&) { return FrictionLaws::contains<E>; }, element);
}

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

/// One element, ready for any point.
class Table {
 public:
  explicit Table(const Element<double>& element)
      : element_(element), erased_(element), friction_(is_friction(element)), odd_(erased_.odd()) {}

  DescribingFunction at(const DfPoint& point, const DfOptions& options) const {
    const PrescribedMotion motion(point.amplitude, point.frequency, point.bias, friction_);
    const bool try_symmetric = odd_ && point.bias == 0.0;
    if (undefined_under(element_, motion.least_speed(), motion.mean_rate())) {
      DescribingFunction none;
      none.status = Status::undefined;
      return clean(std::move(none), options);
    }
    if (options.method == DfMethod::fft) {
      DfOptions tighter = options;
      tighter.accuracy = std::max(0.3 * options.accuracy, 1e-13);
      const DescribingFunction other = QuadratureRoute<ErasedElement>(erased_, motion, try_symmetric, tighter).refine();
      if (other.status != Status::converged && other.status != Status::incomplete) return clean(other, options);
      const double mean_rate = friction_ ? point.bias : 0.0;
      return clean(FftRoute<ErasedElement>(erased_, motion, try_symmetric, mean_rate, options).refine(other), options);
    }
    DescribingFunction result = QuadratureRoute<ErasedElement>(erased_, motion, try_symmetric, options).refine();
    if (options.method == DfMethod::automatic) take_closed_form(point, result);
    return clean(std::move(result), options);
  }

 private:
  /// The exact gain where there is one; the other harmonics stay those of the quadrature.
  void take_closed_form(const DfPoint& point, DescribingFunction& result) const {
    const auto exact = std::visit(
        [&]<class E>(const E& element) -> std::optional<std::complex<double>> {
          if constexpr (HasExactDescribingFunction<E>)
            return element.exact_describing_function(point.amplitude, point.frequency, point.bias);
          return std::nullopt;
        },
        element_);
    if (!exact || result.harmonics.empty()) return;
    result.gain = *exact;
    result.harmonics[0] = *exact * point.amplitude;
    if (point.bias == 0.0)
      result.dissipation = std::numbers::pi * point.amplitude * point.amplitude * exact->imag() + 0.0;
    result.error = *exact == 0.0 ? 0.0 : 4e-15;
    result.method = "closed-form";
  }

  const Element<double>& element_;
  ErasedElement<double> erased_;
  bool friction_, odd_;
};

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
  const Table law(element);
  for (const DfPoint& point : points) {
    if (stop && stop()) break;
    table.push_back(law.at(point, options));
    if (progress) progress(table.size());
  }
  return table;
}

}  // namespace limcycle
