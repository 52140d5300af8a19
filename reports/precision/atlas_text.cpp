#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/precision/atlas.hpp"

namespace limcycle {
namespace {

std::string power(double value) { return fmt::format("{:.0e}", value); }

std::string column_name(double stiffness) { return std::isfinite(stiffness) ? power(stiffness) : "no bristles"; }

template <class T, class Get>
std::vector<T> distinct(const StepperAtlas& atlas, const std::string& law, const Get& get) {
  std::vector<T> found;
  for (const auto& point : atlas.points)
    if (point.law == law && std::ranges::find(found, get(point)) == found.end()) found.push_back(get(point));
  return found;
}

/// The runs of one stepper in one loop, the loosest first.
std::vector<const AtlasPoint*> runs_of(const StepperAtlas& atlas, const std::string& law, const std::string& stepper,
                                       const std::string& column) {
  std::vector<const AtlasPoint*> runs;
  for (const auto& point : atlas.points)
    if (point.law == law && point.stepper == stepper && column_name(point.stiffness) == column) runs.push_back(&point);
  std::ranges::sort(runs, [](const auto* a, const auto* b) { return a->setting > b->setting; });
  return runs;
}

/// "1e-05": the loosest setting at and below which it is right; "1e-05*" if tighter ones were too slow; else the class
/// of the tightest run with an answer.
std::string cell(const std::vector<const AtlasPoint*>& runs) {
  const AtlasPoint* loosest = nullptr;
  const AtlasPoint* tightest = nullptr;
  bool slow = false;
  for (const auto* run : runs) {
    if (run->kind == RunClass::too_slow) {
      slow = true;
      continue;
    }
    tightest = run;
    if (run->kind != RunClass::right)
      loosest = nullptr;
    else if (loosest == nullptr)
      loosest = run;
  }
  if (loosest != nullptr) return power(loosest->setting) + (slow ? "*" : "");
  return std::string(to_string(tightest != nullptr ? tightest->kind : RunClass::too_slow));
}

std::vector<std::string> laws_of(const StepperAtlas& atlas) {
  std::vector<std::string> laws;
  for (const auto& one : atlas.references)
    if (std::ranges::find(laws, one.law) == laws.end()) laws.push_back(one.law);
  return laws;
}

std::string counts(const StepperAtlas& atlas, const std::string& law) {
  std::map<RunClass, int> count;
  for (const auto& point : atlas.points)
    if (point.law == law) ++count[point.kind];
  std::string out;
  for (const auto& [kind, n] : count) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", n, to_string(kind));
  return out;
}

}  // namespace

std::string atlas_answer(const StepperAtlas& atlas) {
  if (atlas.points.empty()) return "No loop has a verified reference, so no stepper can be assessed.";
  std::string right, never;
  std::vector<std::string> steppers;
  for (const auto& point : atlas.points)
    if (!point.fixed_step && std::ranges::find(steppers, point.stepper) == steppers.end())
      steppers.push_back(point.stepper);
  for (const auto& stepper : steppers) {
    const double loosest = loosest_right(atlas, stepper, infinite);
    const bool slow = std::ranges::any_of(
        atlas.points, [&](const auto& point) { return point.stepper == stepper && point.kind == RunClass::too_slow; });
    if (std::isfinite(loosest))
      right += fmt::format("{}{} at {} or tighter{}", right.empty() ? "" : ", ", stepper, power(loosest),
                           slow ? " where it is not too slow" : "");
    else
      never += (never.empty() ? "" : ", ") + stepper;
  }
  std::string out = right.empty() ? std::string("No stepper is right everywhere.") : "Right everywhere: " + right + ".";
  if (!never.empty()) out += " At no tolerance right everywhere: " + never + ".";
  return out;
}

Table atlas_table(const StepperAtlas& atlas, const std::string& law) {
  Table table{{{"stepper", "", Align::left}}, {}};
  const auto columns =
      distinct<std::string>(atlas, law, [](const AtlasPoint& point) { return column_name(point.stiffness); });
  for (const auto& column : columns) table.columns.push_back({column, ""});
  for (const auto& stepper : distinct<std::string>(atlas, law, [](const AtlasPoint& point) { return point.stepper; })) {
    std::vector<std::string> row{stepper};
    for (const auto& column : columns) row.push_back(cell(runs_of(atlas, law, stepper, column)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Document atlas_document(const std::string& title, const StepperAtlas& atlas) {
  Document out(wrapped(title) + "\n" + wrapped(atlas_answer(atlas)));
  out += wrapped(fmt::format(
      "Right: the period within {} (a motion that comes to rest: y within {} of its range); each run begins on the "
      "verified motion. Tables: the largest tolerance, or step in s, from which on all that were answered are right "
      "(*: tighter ones were too slow), else what became of the tightest.",
      power(atlas_right), power(atlas_right)));
  for (const auto& law : laws_of(atlas)) {
    const Table table = atlas_table(atlas, law);
    if (!table.rows.empty()) {
      out.add(fmt::format("{}, by stiffness before sliding", law), table, 100);
      out += wrapped(counts(atlas, law) + ".", 80, 2);
    }
    for (const auto& one : atlas.references)
      if (one.law == law)
        out += wrapped(fmt::format("{} {}: {}.", law, column_name(one.stiffness),
                                   (one.verified ? "" : "left out, no verified reference: ") + one.words),
                       80, 2);
  }
  if (atlas.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(atlas.status));
  return out;
}

std::string atlas_text(const std::string& title, const StepperAtlas& atlas) {
  return atlas_document(title, atlas).text();
}

}  // namespace limcycle
