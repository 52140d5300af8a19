#include "limcycle/questions/asking/asking.hpp"

#include <algorithm>
#include <limits>

namespace limcycle {

SweepRunner sweep_in_memory(const Asking& asking) {
  return [&asking](const SweepTask& task, const std::vector<std::string>&, const std::string&) {
    SweptRows swept;
    swept.known.assign(task.points, false);
    swept.rows.assign(task.points * task.columns, std::numeric_limits<double>::quiet_NaN());
    const auto keep = [&](std::span<const std::size_t> points, std::span<const double> rows) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        std::ranges::copy(rows.subspan(i * task.columns, task.columns),
                          swept.rows.begin() + static_cast<std::ptrdiff_t>(points[i] * task.columns));
        swept.known[points[i]] = true;
      }
    };
    swept.status =
        run_sweep(task, {}, keep, part_of_work(asking.threads, asking.stop, asking.progress, 0.0, 1.0, "points"));
    return swept;
  };
}

}  // namespace limcycle
