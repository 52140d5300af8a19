#include "limcycle/analysis/frequency/describing_function/df_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/analysis/frequency/describing_function/fft_route.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/analysis/frequency/kernels/df_kernel.hpp"
#include "limcycle/analysis/on_threads.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {
namespace {

/// Values of DescribingFunction::method; a row holds the index in this list.
constexpr std::string_view df_methods[] = {"", "closed-form", "kernel", "fft", "quadrature"};

bool finite(const DescribingFunction& df) {
  bool all = std::isfinite(df.gain.real()) && std::isfinite(df.gain.imag()) && std::isfinite(df.mean) &&
             std::isfinite(df.dissipation) && std::isfinite(df.error);
  for (const auto& h : df.harmonics) all = all && std::isfinite(h.real()) && std::isfinite(h.imag());
  return all;
}

/// Numbers are 0 where there is no result; a result that is not finite becomes not_finite.
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

}  // namespace

/// One element, ready for any point.
class DfSolver {
 public:
  explicit DfSolver(const Element& element)
      : element_(element),
        friction_(element.is_friction()),
        odd_(element.odd()),
        rate_independent_(element.facts().rate_independent) {}

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
      const DescribingFunction other = QuadratureRoute(element_, motion, try_symmetric, tighter).refine();
      if (other.status != Status::converged && other.status != Status::incomplete) return clean(other, options);
      const double mean_rate = friction_ ? point.bias : 0.0;
      return clean(FftRoute(element_, motion, try_symmetric, mean_rate, options).refine(other), options);
    }
    DescribingFunction result = QuadratureRoute(element_, motion, try_symmetric, options).refine();
    if (options.method == DfMethod::automatic) take_closed_form(point, result);
    return clean(std::move(result), options);
  }

  /// The exact gain if there is one; the other harmonics stay those of the quadrature.
  void take_closed_form(const DfPoint& point, DescribingFunction& result) const {
    const auto exact = element_.exact_describing_function(point.amplitude, point.frequency, point.bias);
    if (!exact || result.harmonics.empty()) return;
    result.gain = *exact;
    result.harmonics[0] = *exact * point.amplitude;
    if (point.bias == 0.0)
      result.dissipation = std::numbers::pi * point.amplitude * point.amplitude * exact->imag() + 0.0;
    result.error = *exact == 0.0 ? 0.0 : 4e-15;
    result.method = "closed-form";
  }

  const Element& element_;
  bool friction_, odd_, rate_independent_;
  std::mutex guard_;
  std::map<double, DescribingFunction> by_amplitude_;
};

DfTable::DfTable(const Element& element, std::vector<DfPoint> points, const DfOptions& options)
    : points_(std::move(points)), options_(options) {
  validate(options_);
  for (const DfPoint& point : points_) validate(point);
  solver_ = std::make_unique<DfSolver>(element);
  if (options_.method == DfMethod::automatic)
    if (auto kernel = DfKernel::of(element, options_)) kernel_ = std::make_unique<DfKernel>(std::move(*kernel));
  // Large enough to fill the lanes with points of similar meshes, small enough to distribute.
  const std::size_t shares = 8 * thread_count(options_.threads);
  block_ = std::clamp((points_.size() + shares - 1) / shares, std::size_t{kernel_ ? 512U : 1U},
                      std::size_t{kernel_ ? 4096U : 16U});
}

DfTable::~DfTable() = default;

DescribingFunction DfTable::at(const DfPoint& point) const {
  validate(point);
  DescribingFunction result;
  if (kernel_) by_kernel({&point, 1}, {&result, 1});
  return result.method.empty() ? solver_->at(point, options_) : result;
}

std::vector<DescribingFunction> DfTable::some_of(std::span<const DfPoint> points) const {
  for (const DfPoint& point : points) validate(point);
  std::vector<DescribingFunction> results(points.size());
  if (kernel_) by_kernel(points, results);
  return results;
}

std::size_t DfTable::compute(std::span<const std::size_t> which, std::span<DescribingFunction> results,
                             const std::function<bool()>& stop) {
  if (kernel_) {
    which = which.first(begun(which.size(), stop));
    std::vector<DfPoint> some;
    some.reserve(which.size());
    for (const std::size_t k : which) some.push_back(points_[k]);
    by_kernel(some, results.first(which.size()));
  }
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (kernel_ && !results[i].method.empty()) continue;
    if ((!kernel_ || i > 0) && begun(1, stop) == 0) return i;
    results[i] = solver_->at(points_[which[i]], options_);
  }
  return which.size();
}

std::size_t DfTable::begun(std::size_t wanted, const std::function<bool()>& stop) {
  if (!stop) return wanted;
  const std::lock_guard lock(asking_);
  for (std::size_t i = 0; i < wanted; ++i) {
    stopped_ = stopped_ || stop();
    if (stopped_) return i;
  }
  return wanted;
}

void DfTable::by_kernel(std::span<const DfPoint> points, std::span<DescribingFunction> results) const {
  std::ranges::fill(results, DescribingFunction{});
  kernel_->compute(points, results);
  for (DescribingFunction& result : results)
    if (!finite(result)) result = {};
}

std::vector<std::string> df_columns(int harmonics) {
  std::vector<std::string> names{"status",      "method", "gain_re",   "gain_im",    "mean",
                                 "dissipation", "error",  "symmetric", "evaluations"};
  for (int k = 1; k <= harmonics; ++k)
    for (const char* part : {"sine_", "cosine_"}) names.push_back(part + std::to_string(k));
  return names;
}

std::vector<double> df_to_row(const DescribingFunction& df) {
  const auto method = std::ranges::find(df_methods, df.method) - std::begin(df_methods);
  std::vector<double> row{static_cast<double>(df.status),
                          static_cast<double>(method),
                          df.gain.real(),
                          df.gain.imag(),
                          df.mean,
                          df.dissipation,
                          df.error,
                          df.symmetric ? 1.0 : 0.0,
                          static_cast<double>(df.evaluations)};
  for (const auto& h : df.harmonics) row.insert(row.end(), {h.real(), h.imag()});
  return row;
}

DescribingFunction df_of_row(std::span<const double> row) {
  DescribingFunction df;
  df.status = static_cast<Status>(static_cast<int>(row[0]));
  df.method = df_methods[static_cast<std::size_t>(row[1])];
  df.gain = {row[2], row[3]};
  df.mean = row[4];
  df.dissipation = row[5];
  df.error = row[6];
  df.symmetric = row[7] != 0.0;
  df.evaluations = static_cast<long>(row[8]);
  for (std::size_t i = 9; i + 1 < row.size(); i += 2) df.harmonics.emplace_back(row[i], row[i + 1]);
  return df;
}

}  // namespace limcycle
