#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"

namespace limcycle {

class DfKernel;
class DfSolver;

/// Describing functions of one element at the points of a list, several at a time, in any order and from several
/// threads, as a sweep needs them (analysis/sweep.hpp). The result at a point does not depend on the other points of
/// the call.
class DfTable {
 public:
  /// Keeps a reference to the element. Throws std::invalid_argument quoting the option or coordinate that is out of
  /// range.
  DfTable(const Element& element, std::vector<DfPoint> points, const DfOptions& options);
  ~DfTable();
  DfTable(const DfTable&) = delete;
  DfTable& operator=(const DfTable&) = delete;

  std::size_t size() const { return points_.size(); }
  std::size_t block() const { return block_; }  ///< recommended number of points per call

  /// Result at any point, on the list or not; the same as compute() would give. Throws as the constructor does.
  DescribingFunction at(const DfPoint& point) const;

  /// The same at several points at once, in a fraction of the time; `method` is empty where only at() has a result.
  std::vector<DescribingFunction> some_of(std::span<const DfPoint> points) const;

  /// Results at these points; returns how many were computed, counted from the first. `stop` is called for every point,
  /// one call at a time, and once it has returned true no further point is begun.
  std::size_t compute(std::span<const std::size_t> which, std::span<DescribingFunction> results,
                      const std::function<bool()>& stop);

 private:
  std::size_t begun(std::size_t wanted, const std::function<bool()>& stop);
  void by_kernel(std::span<const DfPoint> points, std::span<DescribingFunction> results) const;

  std::vector<DfPoint> points_;
  DfOptions options_;
  std::unique_ptr<DfSolver> solver_;
  std::unique_ptr<DfKernel> kernel_;  ///< null: the solver does everything
  std::size_t block_ = 1;
  std::mutex asking_;  ///< of calls of stop
  bool stopped_ = false;
};

/// A result as the row of a sweep: status, method, gain, mean, dissipation, error, symmetric, evaluations, and sine and
/// cosine of each harmonic.
std::vector<std::string> df_columns(int harmonics);
std::vector<double> df_to_row(const DescribingFunction& df);
DescribingFunction df_of_row(std::span<const double> row);

}  // namespace limcycle
