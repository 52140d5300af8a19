#include "limcycle/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace limcycle {
namespace {

constexpr int bar_width = 30;
constexpr std::size_t line_width = 78;

std::string duration(double seconds) {
  if (!(seconds < 360000.0)) return "?";
  const int s = static_cast<int>(std::ceil(seconds));
  if (s < 60) return fmt::format("{} s", s);
  return s < 3600 ? fmt::format("{} min {:02} s", s / 60, s % 60)
                  : fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

}  // namespace

Progress::Progress(bool quiet) : wanted_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::cerr << '\r' << std::string(line_width, ' ') << '\r' << std::flush;
}

void Progress::show(double fraction, std::string_view what) {
  if (!wanted_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  drawn_ = true;
  const double done = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const double passed = std::chrono::duration<double>(now - begin_).count();
  const int full = static_cast<int>(done * bar_width);
  std::string line = fmt::format("[{}{}] {:3.0f} %", std::string(static_cast<std::size_t>(full), '#'),
                                 std::string(static_cast<std::size_t>(bar_width - full), '.'), 100.0 * done);
  if (done > 0.0) line += ", " + duration(passed * (1.0 - done) / done) + " left";
  if (!what.empty()) line += fmt::format("  {}", what);
  line.resize(line_width, ' ');
  std::cerr << '\r' << line << std::flush;
}

}  // namespace limcycle
