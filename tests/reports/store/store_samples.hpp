#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "limcycle/reports/store/store.hpp"

namespace limcycle::test {

inline SweepIdentity sweep_identity(std::size_t points = 100) {
  return {.command = "map",
          .title = "a servo, a \"quoted\" title and \xC3\xA4",
          .case_file = "cases/servo.toml",
          .case_sha256 = std::string(64, 'a'),
          .overrides = {"loop.controller.kd=6.5", "title=\"two\nlines\""},
          .design = "x loop.controller.kp 1 .. 10, 10 points; y loop.controller.ki 0.1 .. 10, log",
          .seed = 18446744073709551615U,
          .columns = {"verdict", "amplitude", "period"},
          .points = points,
          .version = "0.1.0",
          .commit = "0123456789ab",
          .isa = "avx2"};
}

/// A row with numbers of every kind, among them a NaN whose payload is its point.
inline std::vector<double> store_row(std::size_t point) {
  switch (point % 4) {
    case 0:
      return {-0.0, std::numeric_limits<double>::denorm_min(), std::bit_cast<double>(0x7ff8000000000000U + point)};
    case 1:
      return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0.1};
    case 2:
      return {1.0 / 3.0, std::numeric_limits<double>::max(), std::bit_cast<double>(0xfff0000000000001U)};
    default:
      return {static_cast<double>(point), -1.0 - static_cast<double>(point), 0.0};
  }
}

inline std::vector<double> store_rows(std::span<const std::size_t> points) {
  std::vector<double> rows;
  for (const std::size_t point : points)
    for (const double value : store_row(point)) rows.push_back(value);
  return rows;
}

inline std::vector<std::size_t> points_from(std::size_t first, std::size_t end) {
  std::vector<std::size_t> points(end - first);
  std::iota(points.begin(), points.end(), first);
  return points;
}

/// Hands those points over to the store.
inline void fill(SweepStore& store, std::size_t first, std::size_t end) {
  const auto points = points_from(first, end);
  store.write(points, store_rows(points));
}

inline std::vector<std::uint64_t> bits_of(std::span<const double> numbers) {
  std::vector<std::uint64_t> bits;
  for (const double value : numbers) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

/// Error on opening that store; empty if there is none.
inline std::string store_refusal(const std::string& path, const SweepIdentity& identity, bool resume,
                                 StoreError::Kind kind = StoreError::Kind::refused) {
  try {
    const SweepStore store(path, identity, resume);
  } catch (const StoreError& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  return {};
}

/// Runs `work` in a child process, whose exit code is its result, without destructors.
template <class Work>
pid_t in_child(const Work& work) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  int code = 99;
  try {
    code = work();
  } catch (...) {
    code = 98;
  }
  _exit(code);
}

/// Exit code of a child process, or 1000 + the signal.
inline int end_of(pid_t pid) {
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace limcycle::test
