#include "limcycle/cli/output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "limcycle/cli/time_limit.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr int bar_width = 30;
constexpr std::size_t line_width = 78;

/// "3 s left": the estimate, limited by the time limit.
std::string left_in_words(double seconds) { return as_waiting_time(std::min(seconds, TimeLimit::left())) + " left"; }

}  // namespace

Progress::Progress(bool quiet, bool verbose)
    : wanted_(!quiet && isatty(STDERR_FILENO) == 1), verbose_(verbose && !quiet) {}

Progress::~Progress() {
  if (drawn_) std::cerr << '\r' << std::string(line_width, ' ') << '\r' << std::flush;
  begin_stage({});
  for (const auto& [what, time] : stages_)
    if (!what.empty() && what != "done")
      std::cerr << fmt::format("limcycle: {:8.3f} s  {}\n", std::chrono::duration<double>(time).count(), what);
}

void Progress::begin_stage(std::string_view what) {
  if (!verbose_ || (!stages_.empty() && stages_[stage_].what == what)) return;
  const auto now = Clock::now();
  if (!stages_.empty()) stages_[stage_].time += now - stage_begin_;
  stage_begin_ = now;
  const auto known = std::ranges::find(stages_, what, &Stage::what);
  stage_ = static_cast<std::size_t>(known - stages_.begin());
  if (known == stages_.end()) stages_.push_back({std::string(what), {}});
}

void Progress::show(double fraction, std::string_view what) {
  if (!wanted_ && !verbose_) return;
  const std::lock_guard lock(mutex_);
  begin_stage(what);
  if (!wanted_) return;
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  std::string more;
  if (done > 0.0) more = ", " + left_in_words(passed() * (1.0 - done) / done);
  if (!what.empty()) more += fmt::format("  {}", what);
  draw(done, more);
}

void Progress::count(std::size_t done, std::size_t total) {
  if (!wanted_ && !verbose_) return;
  const std::lock_guard lock(mutex_);
  begin_stage("points of the sweep");
  if (!wanted_) return;
  if (!first_) first_ = done;
  std::string more = fmt::format(", {} of {}", done, total);
  const double rate = static_cast<double>(done - std::min(*first_, done)) / passed();
  if (rate > 0.0)
    more += fmt::format(", {}/s, {}", with_digits(rate, 3),
                        left_in_words(static_cast<double>(total - std::min(done, total)) / rate));
  draw(total > 0 ? static_cast<double>(std::min(done, total)) / static_cast<double>(total) : 1.0, more);
}

double Progress::passed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void Progress::draw(double done, const std::string& more) {
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  drawn_ = true;
  const int full = static_cast<int>(done * bar_width);
  std::string line = fmt::format("[{}{}] {:3.0f} %", std::string(static_cast<std::size_t>(full), '#'),
                                 std::string(static_cast<std::size_t>(bar_width - full), '.'), 100.0 * done) +
                     more;
  line.resize(line_width, ' ');
  std::cerr << '\r' << line << std::flush;
}

}  // namespace limcycle
