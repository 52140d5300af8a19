#include "limcycle/analysis/frequency/describing_function.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "limcycle/analysis/erased_element.hpp"
#include "limcycle/analysis/frequency/df_kernel.hpp"
#include "limcycle/analysis/frequency/drive_dependence.hpp"
#include "limcycle/analysis/frequency/fft_route.hpp"
#include "limcycle/analysis/frequency/quadrature_route.hpp"
#include "limcycle/analysis/frequency/refuse.hpp"
#include "limcycle/analysis/on_threads.hpp"

namespace limcycle {

namespace {

bool is_rate_independent(const Element<double>& element) {
  return std::visit([]<class E>(const E&) { return RateIndependent<E>; }, element);
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
      : element_(element),
        erased_(element),
        friction_(is_friction(element)),
        odd_(erased_.odd()),
        rate_independent_(is_rate_independent(element)) {}

  DescribingFunction at(const DfPoint& point, const DfOptions& options) {
    if (!rate_independent_ || point.bias != 0.0 || options.method != DfMethod::automatic) return found(point, options);
    // The path is the same at all frequencies, and so is the work of a period.
    {
      const std::lock_guard lock(guard_);
      if (const auto known = by_amplitude_.find(point.amplitude); known != by_amplitude_.end()) return known->second;
    }
    DescribingFunction result = found({point.amplitude, 1.0, 0.0}, options);
    const std::lock_guard lock(guard_);
    return by_amplitude_.try_emplace(point.amplitude, std::move(result)).first->second;
  }

 private:
  DescribingFunction found(const DfPoint& point, const DfOptions& options) const {
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
  bool friction_, odd_, rate_independent_;
  std::mutex guard_;
  std::map<double, DescribingFunction> by_amplitude_;
};

/// The points of a list, unit by unit, by several threads.
class TableRun {
 public:
  TableRun(const Element<double>& element, const std::vector<DfPoint>& points, const DfOptions& options,
           const std::function<bool()>& stop, const std::function<void(std::size_t)>& progress)
      : points_(points), options_(options), law_(element), stop_(stop), progress_(progress), results_(points.size()) {
    if (options.method == DfMethod::automatic) kernel_ = DfKernel::of(element, options);
    threads_ = thread_count(options.threads);
    // Large enough to fill the lanes with points of like meshes, small enough to share out.
    const std::size_t shares = 8 * threads_;
    unit_ = std::clamp((points.size() + shares - 1) / shares, std::size_t{kernel_ ? 512U : 1U},
                       std::size_t{kernel_ ? 4096U : 16U});
    computed_.assign((points.size() + unit_ - 1) / unit_, 0);
  }

  std::vector<DescribingFunction> run() {
    on_threads(
        std::min(threads_, computed_.size()), [this] { work(); },
        [this] {
          const std::lock_guard lock(guard_);
          stopped_ = true;
        });
    std::size_t whole = 0;
    for (const std::size_t count : computed_) {
      whole += count;
      if (count < unit_) break;
    }
    results_.resize(whole);
    return std::move(results_);
  }

 private:
  void work() {
    for (std::size_t unit = next(); unit < computed_.size(); unit = next()) compute(unit);
  }

  std::size_t next() {
    const std::lock_guard lock(guard_);
    return stopped_ ? computed_.size() : next_++;
  }

  bool stopped() {
    const std::lock_guard lock(guard_);
    stopped_ = stopped_ || (stop_ && stop_());
    return stopped_;
  }

  /// End of the points of a unit that may be begun.
  std::size_t begun(std::size_t first, std::size_t end) {
    const std::lock_guard lock(guard_);
    while (first < end && !stopped_) {
      stopped_ = stop_ && stop_();
      if (!stopped_) ++first;
    }
    return first;
  }

  void compute(std::size_t unit) {
    const std::size_t first = unit * unit_, end = std::min(points_.size(), first + unit_);
    std::size_t at = first;
    if (kernel_) {
      at = begun(first, end);
      by_kernel(first, at);
    }
    for (std::size_t i = first; i < (kernel_ ? at : end); ++i) {
      if (!results_[i].method.empty()) continue;
      if (kernel_ ? i > first && stopped() : stopped()) {
        at = i;
        break;
      }
      results_[i] = law_.at(points_[i], options_);
      if (!kernel_) at = i + 1;
    }
    const std::lock_guard lock(guard_);
    computed_[unit] = at - first;
    done_ += at - first;
    if (progress_ && at > first) progress_(done_);
  }

  /// Those that the kernel can do; the others keep an empty method.
  void by_kernel(std::size_t first, std::size_t end) {
    const std::span results(results_.data() + first, end - first);
    kernel_->compute({points_.data() + first, end - first}, results);
    for (DescribingFunction& result : results)
      if (!finite(result)) result = {};
  }

  const std::vector<DfPoint>& points_;
  const DfOptions& options_;
  Table law_;
  std::optional<DfKernel> kernel_;
  const std::function<bool()>& stop_;
  const std::function<void(std::size_t)>& progress_;
  std::size_t threads_ = 1;
  std::size_t unit_ = 1;
  std::vector<DescribingFunction> results_;

  std::mutex guard_;                   ///< of what follows, and of calls of stop and progress
  std::vector<std::size_t> computed_;  ///< of each unit
  std::size_t next_ = 0, done_ = 0;
  bool stopped_ = false;
};

}  // namespace

void validate(const DfOptions& options) {
  if (options.harmonics < 1 || options.harmonics > 1000)
    refuse("describing function", "harmonics", options.harmonics, "must lie in 1..1000");
  if (options.threads < 0 || options.threads > 1024)
    refuse("describing function", "threads", options.threads, "must lie in 0..1024");
  if (!is_available(options.isa))
    throw std::invalid_argument("describing function: instruction set " + std::string(to_string(options.isa)) +
                                " is not available here");
  if (!(options.accuracy >= 1e-13 && options.accuracy <= 0.1))
    refuse("describing function", "accuracy", options.accuracy, "must lie in 1e-13..0.1");
}

void validate(const DfPoint& point) {
  if (!(point.amplitude > 0.0) || !std::isfinite(point.amplitude))
    refuse("describing function", "amplitude", point.amplitude, "must be positive and finite");
  if (!(point.frequency > 0.0) || !std::isfinite(point.frequency))
    refuse("describing function", "frequency", point.frequency, "must be positive and finite");
  if (!std::isfinite(point.bias)) refuse("describing function", "bias", point.bias, "must be finite");
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
  return TableRun(element, points, options, stop, progress).run();
}

}  // namespace limcycle
