#include "limcycle/python/core/work.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace limcycle::python {
namespace {

namespace py = pybind11;
using Clock = std::chrono::steady_clock;

constexpr double glance = 0.05;  // s between two looks at signals, time and progress

/// What the two threads share.
class Watch {
 public:
  Watch(const Work& work, std::shared_ptr<const Case> from) : work_(work) {
    question.from = std::move(from);
    question.asking = {.seed = work.seed,
                       .threads = work.threads,
                       .isa = work.isa,
                       .stop = [this] { return stop_.load(std::memory_order_relaxed); },
                       .progress = {}};
    if (!work.progress.is_none())
      question.asking.progress = [this](double fraction, std::string_view what) { note(fraction, what); };
    question.time_limit = work.time_limit;
    question.time_is_over = [this] { return time_over_.load(); };
  }

  Question question;

  void ended() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

  /// Until the work has ended. Called without the interpreter's lock.
  void watch() {
    while (!wait()) {
      if (work_.time_limit > 0.0 && passed() >= work_.time_limit) {
        time_over_ = true;
        stop_ = true;
      }
      look_at_python();
    }
  }

  /// Throws what the interpreter raised while the work went on. Called with its lock.
  void rethrow() {
    if (raised_) throw *std::exchange(raised_, std::nullopt);
  }

 private:
  double passed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  /// Until the work has ended, or it is time for a look; true if it has ended.
  bool wait() {
    const double left = work_.time_limit - passed();
    const std::chrono::duration<double> patience(work_.time_limit > 0.0 && left > 0.0 ? std::min(left, glance)
                                                                                      : glance);
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [this] { return ended_; });
  }

  void note(double fraction, std::string_view what) {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction;
    what_ = what;
    noted_ = true;
  }

  void look_at_python() {
    const py::gil_scoped_acquire lock;
    if (raised_) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      tell();
    } catch (py::error_already_set& error) {
      raised_.emplace(std::move(error));
      stop_ = true;
    }
  }

  void tell() {
    double fraction = 0.0;
    std::string what;
    {
      const std::lock_guard lock(mutex_);
      if (!std::exchange(noted_, false)) return;
      fraction = fraction_;
      what = what_;
    }
    work_.progress(fraction, what);
  }

  const Work& work_;
  const Clock::time_point begin_ = Clock::now();
  std::atomic<bool> stop_{false}, time_over_{false};
  std::optional<py::error_already_set> raised_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false, noted_ = false;  // with the mutex held, as the next two
  double fraction_ = 0.0;
  std::string what_;
};

}  // namespace

Answer answer_to(const std::shared_ptr<const Case>& from, const Work& work,
                 const std::function<Answer(const Question&)>& ask) {
  Watch watch(work, from);
  std::optional<Answer> answer;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release unlocked;
    std::thread worker([&] {
      const py::gil_scoped_acquire
          state;  // of this thread in the interpreter: a law of Python would make one each call
      const py::gil_scoped_release also_unlocked;
      try {
        answer = ask(watch.question);
      } catch (...) {
        failure = std::current_exception();
      }
      watch.ended();
    });
    watch.watch();
    worker.join();
  }
  watch.rethrow();
  if (failure) std::rethrow_exception(failure);
  if (!work.progress.is_none()) work.progress(1.0, "done");
  return *std::move(answer);
}

}  // namespace limcycle::python
