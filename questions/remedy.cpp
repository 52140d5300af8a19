#include "limcycle/questions/remedy.hpp"

#include <algorithm>

#include "limcycle/cases/loader/remedy_candidates.hpp"
#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/questions/asking/argument_error.hpp"

namespace limcycle {
std::vector<RemedyCandidate> chosen_remedies(const Case& from, const std::string& argument,
                                             const std::vector<std::string>& names) {
  auto candidates = remedy_candidates(from);
  std::vector<std::string> known;
  known.reserve(candidates.size());
  for (const auto& one : candidates) known.push_back(one.name);
  for (const auto& name : names) position_named(argument, name, known, "is not a remedy");
  if (!names.empty())
    std::erase_if(candidates, [&](const auto& one) { return std::ranges::find(names, one.name) == names.end(); });
  return candidates;
}

std::size_t cost_named(const std::string& argument, const std::string& name) {
  return position_named(argument, name, {std::begin(cost_names), std::end(cost_names)}, "is not a cost");
}

std::vector<std::string> overrides_of_remedy(const RemedyReport& report, const std::string& name) {
  const auto found = std::ranges::find(report.remedies, name, [](const Remedy& one) { return one.candidate.name; });
  if (found == report.remedies.end())
    throw NoAnswer(name + (report.remedies.empty() ? ": the loop does not hunt, or it is not known"
                                                   : ": this remedy was not tried"));
  if (found->ends != true) throw NoAnswer(name + ": it does not end the hunting (" + found->why + ")");
  return remedy_overrides(found->candidate, found->value);
}

RemedyReport ask_remedy(const Case& from, const RemedyWishes& wishes, const Asking& asking) {
  RemedyOptions options;
  options.predict = from.predict;
  options.predict.stop = asking.stop;
  options.predict.progress = asking.progress;
  options.sampled = sampled_parts(from, asking.seed);
  options.samples = wishes.samples;
  options.weights = wishes.weights;
  options.threads = asking.threads;
  auto report = remedies(need_loop(from), chosen_remedies(from, "only", wishes.only), options);
  if (!from.sensitivity) report.notes.emplace_back("no [sensitivity] in the case: robust shares were not computed");
  return report;
}

}  // namespace limcycle
