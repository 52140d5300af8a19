#include "limcycle/questions/remedy.hpp"

#include <algorithm>

#include "limcycle/cases/loader/remedy_candidates.hpp"
#include "limcycle/questions/answer_of.hpp"

namespace limcycle {
namespace {

InputError unknown(const std::string& argument, const std::string& name, const std::string& rule,
                   const std::vector<std::string>& known) {
  return InputError({.file = {},
                     .line = 0,
                     .override = {},
                     .key = argument,
                     .value = name,
                     .rule = rule,
                     .suggestion = suggest(name, known)});
}

}  // namespace

std::vector<RemedyCandidate> chosen_remedies(const Case& from, const std::string& argument,
                                             const std::vector<std::string>& names) {
  auto candidates = remedy_candidates(from);
  std::vector<std::string> known;
  known.reserve(candidates.size());
  for (const auto& one : candidates) known.push_back(one.name);
  for (const auto& name : names)
    if (std::ranges::find(known, name) == known.end()) throw unknown(argument, name, "is not a remedy", known);
  if (!names.empty())
    std::erase_if(candidates, [&](const auto& one) { return std::ranges::find(names, one.name) == names.end(); });
  return candidates;
}

std::size_t cost_named(const std::string& argument, const std::string& name) {
  const auto found = std::ranges::find(cost_names, name);
  if (found == std::end(cost_names))
    throw unknown(argument, name, "is not a cost", {std::begin(cost_names), std::end(cost_names)});
  return static_cast<std::size_t>(found - std::begin(cost_names));
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
