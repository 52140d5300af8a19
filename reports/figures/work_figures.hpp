#pragma once
#include <string>
#include <vector>

#include "limcycle/reports/figures/figures.hpp"

namespace limcycle {

/// One mark of a figure whose axes are logarithmic.
struct WorkMark {
  double x = 0.0, y = 0.0;  ///< y not finite: not measured, drawn as a cross at the upper edge
  bool good = true;         ///< else a cross
  std::string label;        ///< shown at the pointer
};

/// Marks of one method, joined by a line if `joined`.
struct WorkSeries {
  std::string name;
  std::vector<WorkMark> marks;
  bool joined = true;
  int dash = 0;     ///< 0: solid, 1: dashed, 2: dotted
  int colour = -1;  ///< -1: its own; else that of series number `colour`, and no entry in the legend
};

/// A figure with both axes logarithmic. `id` is "work-..." (see reports/page/script.cpp).
Figure work_figure(const std::string& id, const std::string& heading, const std::string& finding,
                   const std::string& x_title, const std::string& y_title, const std::vector<WorkSeries>& series);

}  // namespace limcycle
