#pragma once
#include <string>

#include "limcycle/cases/case.hpp"
#include "limcycle/cli/command.hpp"
#include "limcycle/cli/progress.hpp"
#include "limcycle/reports/report.hpp"

namespace limcycle {

/// What a report is to hold beside the prediction.
struct ReportWishes {
  bool quick = false;  ///< neither sensitivity nor dissipativity nor work-precision
  std::string x, y;    ///< of a map, PATH=FROM:TO:N[:log]; both empty: no map
};

/// Throws InputError for wishes that this case cannot fulfil.
void check_wishes(const Case& from, const ReportWishes& wishes);

/// Computes all parts; one that does not apply, fails or is interrupted says so and costs no other.
LoopReport report_parts(const Case& from, const ReportWishes& wishes, const CommonFlags& flags, Progress& progress);

}  // namespace limcycle
