#include "limcycle/cli/ranks/crew.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace limcycle {

Crew::Crew(const SweepTask& task, std::size_t threads) : task_(task) {
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Crew::~Crew() { stop(); }

void Crew::give(std::vector<std::size_t> points, double seconds) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back({std::move(points), seconds});
  given_.notify_one();
}

std::vector<FinishedPoints> Crew::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, {});
}

void Crew::wait(std::chrono::microseconds patience) {
  std::unique_lock lock(mutex_);
  finished_.wait_for(lock, patience, [this] { return !done_.empty() || failure_ != nullptr; });
}

void Crew::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    waiting_.clear();
  }
  given_.notify_all();
  threads_.clear();
}

void Crew::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void Crew::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    given_.wait(lock, [this] { return stopped_ || !waiting_.empty(); });
    if (stopped_) return;
    const Piece piece = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    std::exception_ptr failure;
    try {
      compute(piece);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (!failure) continue;
    if (!failure_) failure_ = failure;
    stopped_ = true;
    finished_.notify_one();
  }
}

void Crew::compute(const Piece& piece) {
  const auto begin = std::chrono::steady_clock::now();
  FinishedPoints finished;
  std::span<const std::size_t> left = piece.points;
  std::vector<double> rows;
  while (!left.empty() && !finished.stopped && finished.seconds <= piece.seconds && !stopped()) {
    const auto some = left.first(std::min(task_.block, left.size()));
    // A number that compute does not set is missing.
    rows.assign(some.size() * task_.columns, std::numeric_limits<double>::quiet_NaN());
    std::size_t count = 0;
    try {
      count = std::min(task_.compute(some, rows), some.size());
    } catch (...) {
      deliver(std::move(finished));  // earlier results are valid
      throw;
    }
    finished.points.insert(finished.points.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    finished.rows.insert(finished.rows.end(), rows.begin(),
                         rows.begin() + static_cast<std::ptrdiff_t>(count * task_.columns));
    finished.stopped = count < some.size();
    finished.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    left = left.subspan(count);
  }
  finished.rest.assign(left.begin(), left.end());
  deliver(std::move(finished));
}

void Crew::deliver(FinishedPoints&& finished) {
  const std::lock_guard lock(mutex_);
  done_.push_back(std::move(finished));
  finished_.notify_one();
}

bool Crew::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

}  // namespace limcycle
