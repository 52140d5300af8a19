#pragma once
#include <string>

#include "limcycle/analysis/study/continuation/follow.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Branches of limit cycles over a parameter, as reports need them.
struct ContinueReport {
  std::string path;  ///< "loop.controller.kd"
  std::string unit;  ///< of the parameter; empty or "1": none
  FollowReport found;
};

/// The answer in words: the ranges in which cycles exist, and their ends.
std::string continue_answer(const ContinueReport& report, const Units& units);

/// For a terminal: the answer, the events with their sentences, up to `longest_branch_table` points of each branch.
std::string continue_text(const std::string& title, const ContinueReport& report, const Units& units);
Document continue_document(const std::string& title, const ContinueReport& report,
                           const Units& units);  ///< the same, with its tables
inline constexpr std::size_t longest_branch_table = 25;

/// JSON document of `continue`; with several branches `branch` has the points of all, distinguished by the key `part`.
std::string continue_json(const Provenance& provenance, const ContinueReport& report);

/// One row a point and event, distinguished by the first column `kind`.
std::string continue_csv(const ContinueReport& report);

/// Self-contained page with the bifurcation diagram; `case_text`: the case file as read; empty: left out.
std::string continue_page(const ContinueReport& report, const Provenance& provenance, const std::string& case_text,
                          const Units& units);

/// The diagram as one SVG: amplitude and period over the parameter, stable parts solid, unstable ones dashed, events
/// marked.
std::string continue_picture(const ContinueReport& report, const Units& units);

Table event_table(const ContinueReport& report, const Units& units);

}  // namespace limcycle
