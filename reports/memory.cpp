#include "limcycle/reports/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace limcycle {
namespace {

constexpr double gigabyte = 1e9;

/// Limit of the control group, if this process has one of its own (a container, a job of a scheduler).
void take_group_limit(const char* file, double& bytes) {
  std::ifstream in(file);
  double limit = 0.0;
  if (in >> limit && limit > 0.0) bytes = std::min(bytes, limit);  // "max" is no number
}

}  // namespace

double memory_there_is() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  take_group_limit("/sys/fs/cgroup/memory.max", bytes);
  take_group_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes", bytes);
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(space.rlim_cur));
  return bytes;
}

std::string lack_of_memory(double bytes) {
  const double there = memory_there_is();
  if (bytes <= there) return {};
  return fmt::format("needs {:.3g} GB of memory; {:.3g} GB are there", bytes / gigabyte, there / gigabyte);
}

}  // namespace limcycle
