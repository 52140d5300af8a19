#include "limcycle/analysis/sweep.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "limcycle/analysis/on_threads.hpp"

namespace limcycle {
namespace {

void require_for_sweep(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("sweep: " + what);
}

/// The threads of one sweep.
class SweepRun {
 public:
  SweepRun(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink, const SweepOptions& options)
      : task_(task), sink_(sink), options_(options), blocks_(task.points, task.block, known) {}

  Status run() {
    done_ = task_.points - blocks_.missing();
    if (options_.progress) options_.progress(done_, task_.points);
    if (blocks_.missing() > 0)
      on_threads(
          std::min(thread_count(options_.threads), blocks_.blocks()), [this] { work(); }, [this] { ended_ = true; });
    return done_ == task_.points ? Status::converged : Status::interrupted;
  }

 private:
  void work() {
    std::vector<double> rows(std::min(task_.block, blocks_.missing()) * task_.columns);
    while (!stopped()) {
      const auto points = blocks_.next();
      if (points.empty()) return;
      const std::span<double> some(rows.data(), points.size() * task_.columns);
      // An entry that compute does not write is NaN, not that of another point computed before on this thread.
      std::ranges::fill(some, std::numeric_limits<double>::quiet_NaN());
      const std::size_t finished = task_.compute(points, some);
      if (finished > points.size()) throw std::logic_error("sweep: more points finished than asked for");
      if (finished < points.size()) ended_ = true;
      take(points.first(finished), some.first(finished * task_.columns));
    }
  }

  bool stopped() {
    if (!ended_ && options_.stop) {
      const std::lock_guard lock(asking_);
      if (!ended_ && options_.stop()) ended_ = true;
    }
    return ended_;
  }

  void take(std::span<const std::size_t> points, std::span<const double> rows) {
    if (points.empty()) return;
    const std::lock_guard lock(giving_);
    // A sink that failed is not called again: it may have taken part of the rows.
    if (sink_failed_) return;
    try {
      sink_(points, rows);
    } catch (...) {
      sink_failed_ = true;
      throw;
    }
    done_ += points.size();
    if (options_.progress) options_.progress(done_, task_.points);
  }

  const SweepTask& task_;
  const SweepSink& sink_;
  const SweepOptions& options_;
  SweepBlocks blocks_;
  std::atomic<bool> ended_{false};
  std::mutex asking_;  ///< of calls of stop
  std::mutex giving_;  ///< of calls of sink and progress, and of the members below
  std::size_t done_ = 0;
  bool sink_failed_ = false;
};

}  // namespace

SweepBlocks::SweepBlocks(std::size_t points, std::size_t block, const std::vector<bool>& known) : block_(block) {
  require_for_sweep(block > 0, "a block has at least one point");
  require_for_sweep(known.empty() || known.size() == points,
                    std::to_string(known.size()) + " flags for " + std::to_string(points) + " points");
  for (std::size_t i = 0; i < points; ++i)
    if (known.empty() || !known[i]) missing_.push_back(i);
}

std::span<const std::size_t> SweepBlocks::next(std::size_t blocks) {
  const std::size_t index = next_.fetch_add(blocks, std::memory_order_relaxed);
  if (index >= this->blocks()) return {};
  const std::size_t first = index * block_;
  return {missing_.data() + first, std::min(blocks * block_, missing_.size() - first)};
}

SweepOptions part_of_work(int threads, std::function<bool()> stop, std::function<void(double, std::string_view)> report,
                          double from, double to, std::string what) {
  SweepOptions options{threads, std::move(stop), {}};
  if (report)
    options.progress = [=, report = std::move(report), what = std::move(what)](std::size_t done, std::size_t total) {
      const double share = total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
      report(from + (to - from) * share, what);
    };
  return options;
}

Status run_sweep(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink,
                 const SweepOptions& options) {
  require_for_sweep(static_cast<bool>(task.compute), "there is nothing to compute");
  require_for_sweep(static_cast<bool>(sink), "nothing takes the rows");
  require_for_sweep(task.columns > 0, "a row has at least one number");
  require_for_sweep(options.threads >= 0 && options.threads <= 1024, "threads must lie in 0..1024");
  return SweepRun(task, known, sink, options).run();
}

Status run_each(std::size_t count, const std::function<void(std::size_t)>& work, const SweepOptions& options) {
  SweepTask task{count, 1, 1, {}};
  task.compute = [&](std::span<const std::size_t> points, std::span<double>) {
    for (const std::size_t i : points) work(i);
    return points.size();
  };
  return run_sweep(
      task, {}, [](std::span<const std::size_t>, std::span<const double>) {}, options);
}

}  // namespace limcycle
