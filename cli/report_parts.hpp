#pragma once
#include <string>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/output/progress.hpp"
#include "limcycle/reports/page/report.hpp"

namespace limcycle {

/// Parts of a report in addition to the prediction.
struct ReportWishes {
  bool quick = false;       ///< without margins, sensitivity and dissipativity
  bool remedies = false;    ///< with all remedies
  bool benchmarks = false;  ///< with accuracy and cost of the methods
  std::string x, y;         ///< of a map, PATH=FROM:TO:N[:log]; both empty: no map
};

/// Throws InputError for wishes that do not apply to this case.
void check_wishes(const Case& from, const ReportWishes& wishes);

/// Computes all parts; one that does not apply, fails or is interrupted states it and does not affect the others.
LoopReport report_parts(const Case& from, const ReportWishes& wishes, const CommonFlags& flags, Progress& progress);

}  // namespace limcycle
