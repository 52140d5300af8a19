#include "limcycle/cli/ranks/rank_sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <utility>

#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/ranks/crew.hpp"
#include "limcycle/cli/ranks/rank_job.hpp"
#include "limcycle/cli/ranks/rank_words.hpp"
#include "limcycle/cli/ranks/ranks.hpp"

namespace limcycle {
namespace {

using RankClock = std::chrono::steady_clock;
using std::chrono::microseconds;

constexpr double piece_seconds = 0.05;   // least computing time between two messages of a thread
constexpr double writer_seconds = 1e-4;  // added for each thread of the job, for the writer's time per message
constexpr double patience = 1.5;         // multiple of the planned time after which the rest of a piece is returned
constexpr auto last_rows = microseconds(400'000);  // time that the writer waits for them after a stop
constexpr auto longest_pause = microseconds(1000);

std::string packed(const FinishedPoints& finished) {
  std::string content;
  const std::uint64_t head[] = {finished.points.size(), finished.rest.size(), finished.stopped ? 1U : 0U};
  pack(content, head, 3);
  pack(content, &finished.seconds, 1);
  pack(content, finished.points.data(), finished.points.size());
  pack(content, finished.rest.data(), finished.rest.size());
  pack(content, finished.rows.data(), finished.rows.size());
  return content;
}

FinishedPoints unpacked(const std::string& content, std::size_t columns) {
  Unpacking from(content);
  FinishedPoints finished;
  const auto count = static_cast<std::size_t>(from.number<std::uint64_t>());
  const auto rest = static_cast<std::size_t>(from.number<std::uint64_t>());
  finished.stopped = from.number<std::uint64_t>() != 0;
  finished.seconds = from.number<double>();
  finished.points = from.numbers<std::size_t>(count);
  finished.rest = from.numbers<std::size_t>(rest);
  finished.rows = from.numbers<double>(count * columns);
  return finished;
}

/// Short at first, longer while idle: low latency under load, low processor use without.
class Pause {
 public:
  microseconds next() { return std::exchange(length_, std::min(2 * length_, longest_pause)); }
  void reset() { length_ = shortest; }

 private:
  static constexpr auto shortest = microseconds(30);
  microseconds length_ = shortest;
};

/// Rank 0 during the sweep.
class SweepWriter {
 public:
  SweepWriter(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink, const SweepOptions& options,
              const std::string& identity)
      : task_(task),
        sink_(sink),
        options_(options),
        identity_(identity),
        blocks_(task.points, task.block, known),
        left_(blocks_.blocks()),
        ranks_(static_cast<std::size_t>(rank_count())),
        total_threads_(static_cast<std::size_t>(std::max(1, options.threads))),
        crew_(task, total_threads_) {
    ranks_[0].threads = total_threads_;
  }

  Status run() {
    done_ = task_.points - blocks_.missing();
    if (options_.progress) options_.progress(done_, task_.points);
    try {
      while (done_ < task_.points && !stopped_) {
        listen();
        stopped_ = stopped_ || (options_.stop && options_.stop());
      }
    } catch (...) {
      interrupt();  // the results of the others are not needed
      say_end();
      throw;
    }
    say_end();
    if (stopped_) gather();
    return done_ == task_.points ? Status::converged : Status::interrupted;
  }

 private:
  struct OneRank {
    std::size_t threads = 0;  // 0: not ready yet
    std::size_t pieces = 0;   // pieces that it holds
  };

  /// Receives messages and results, and hands out work; waits a little if nothing happened.
  void listen() {
    bool heard = false;
    for (int count = 0; count < 100; ++count) {  // a limit, so that this process's own threads are served too
      const auto message = message_from_ranks();
      if (!message) break;
      heard = true;
      hear(*message);
    }
    for (auto& finished : crew_.take()) {
      heard = true;
      take(0, finished);
    }
    crew_.check();
    hand_out(0);
    if (heard)
      pause_.reset();
    else
      crew_.wait(pause_.next());
  }

  void hear(const RankMessage& message) {
    auto& from = ranks_[static_cast<std::size_t>(message.other)];
    if (message.kind == word_ready) {
      Unpacking said(message.content);
      from.threads = said.number<std::size_t>();
      total_threads_ += from.threads;
      if (said.rest() != identity_)
        throw RankFailure("rank " + std::to_string(message.other) +
                              " would compute another sweep: its case file, command or program is another one",
                          2);
    }
    if (message.kind == word_rows) {
      FinishedPoints finished = unpacked(message.content, task_.columns);
      take(static_cast<std::size_t>(message.other), finished);
    }
    if (message.kind == word_last) {
      const Ending ending = hear_last(message);
      if (!ending.message.empty()) throw RankFailure(ending.message, ending.code);
      stopped_ = true;  // it left early: it was asked to stop
    }
    hand_out(static_cast<std::size_t>(message.other));
  }

  void take(std::size_t rank, FinishedPoints& finished) {
    --ranks_[rank].pieces;
    if (const std::size_t blocks = blocks_of(finished.points.size()); blocks > 0)
      pace_ += (finished.seconds / static_cast<double>(blocks) - pace_) * (pace_ > 0.0 ? 0.1 : 1.0);
    stopped_ = stopped_ || finished.stopped;
    if (!finished.points.empty()) {
      sink_(finished.points, finished.rows);
      done_ += finished.points.size();
      if (options_.progress) options_.progress(done_, task_.points);
    }
    if (finished.rest.empty()) return;
    left_ += blocks_of(finished.rest.size());
    returned_.push_back(std::move(finished.rest));
    for (std::size_t other = 0; other < ranks_.size(); ++other) hand_out(other);  // some may be idle
  }

  /// Gives a rank as many pieces as it has room for.
  void hand_out(std::size_t rank) {
    auto& to = ranks_[rank];
    while (!stopped_ && left_ > 0 && to.pieces < to.threads * (left_ > total_threads_ ? 2 : 1)) {
      const double seconds = piece_seconds + writer_seconds * static_cast<double>(total_threads_);
      std::vector<std::size_t> points = next_piece(seconds);
      left_ -= blocks_of(points.size());
      ++to.pieces;
      if (rank == 0) {
        crew_.give(std::move(points), patience * seconds);
        continue;
      }
      std::string content;
      const double most = patience * seconds;
      pack(content, &most, 1);
      pack(content, points.data(), points.size());
      send_to_rank({static_cast<int>(rank), word_points, std::move(content)});
    }
  }

  /// Returned points go out again in single blocks, as they take longer than most. Otherwise as many blocks as take
  /// this time, but no more than half an even share of the rest, so that all ranks end together.
  std::vector<std::size_t> next_piece(double seconds) {
    if (!returned_.empty()) {
      auto& from = returned_.front();
      const auto end = from.begin() + static_cast<std::ptrdiff_t>(std::min(task_.block, from.size()));
      std::vector<std::size_t> piece(from.begin(), end);
      from.erase(from.begin(), end);
      if (from.empty()) returned_.pop_front();
      return piece;
    }
    const std::size_t most = std::max<std::size_t>(1, left_ / (2 * total_threads_));
    const double wanted = pace_ > 0.0 ? std::clamp(seconds / pace_, 1.0, static_cast<double>(most)) : 1.0;
    const auto piece = blocks_.next(static_cast<std::size_t>(wanted));
    return {piece.begin(), piece.end()};
  }

  std::size_t blocks_of(std::size_t points) const { return (points + task_.block - 1) / task_.block; }

  /// Collects the results finished until all ranks have stopped.
  void gather() {
    interrupt();
    const auto until = RankClock::now() + last_rows;
    while (!all_others_left() && RankClock::now() < until) listen();
    crew_.stop();
    for (auto& finished : crew_.take()) take(0, finished);
    crew_.check();
  }

  const SweepTask& task_;
  const SweepSink& sink_;
  const SweepOptions& options_;
  const std::string& identity_;
  SweepBlocks blocks_;
  std::deque<std::vector<std::size_t>> returned_;
  std::size_t left_;  // blocks not handed out
  std::vector<OneRank> ranks_;
  std::size_t total_threads_;
  Pause pause_;
  double pace_ = 0.0;  // recent s a block; 0: unknown
  std::size_t done_ = 0;
  bool stopped_ = false;
  Crew crew_;
};

}  // namespace

Status run_on_ranks(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink,
                    const SweepOptions& options, const std::string& identity) {
  static bool shared = false;
  if (std::exchange(shared, true)) return run_sweep(task, known, sink, options);
  return SweepWriter(task, known, sink, options, identity).run();
}

void serve_ranks(const SweepTask& task, int threads, const std::string& identity) {
  const auto count = static_cast<std::size_t>(std::max(1, threads));
  std::string ready;
  pack(ready, &count, 1);
  send_to_rank({0, word_ready, ready + identity});
  Crew crew(task, count);
  const auto hand_in = [&crew] {
    const auto all = crew.take();
    for (const auto& finished : all) send_to_rank({0, word_rows, packed(finished)});
    return !all.empty();
  };
  Pause pause;
  while (!rank_job().end_said && !interrupted()) {
    bool heard = false;
    while (const auto message = message_from_ranks()) {
      heard = true;
      if (message->kind == word_end) rank_job().end_said = true;
      if (message->kind != word_points) continue;
      Unpacking from(message->content);
      const auto seconds = from.number<double>();
      crew.give(from.numbers<std::size_t>((message->content.size() - sizeof seconds) / sizeof(std::size_t)), seconds);
    }
    heard = hand_in() || heard;
    crew.check();
    if (heard)
      pause.reset();
    else
      crew.wait(pause.next());
  }
  interrupt();
  crew.stop();
  hand_in();
  crew.check();
  throw ShareDone{};
}

}  // namespace limcycle
