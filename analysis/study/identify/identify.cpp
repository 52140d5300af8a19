#include "limcycle/analysis/study/identify/identify.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "limcycle/analysis/study/identify/fitted_law.hpp"

namespace limcycle {
namespace {

bool has_key(const Element& law, std::string_view key) {
  return std::ranges::find(law.parameters(), key, &ParameterRow::key) != law.parameters().end();
}

void check_choice(const IdentifyRequest& request) {
  std::vector<std::string> keys = request.choice.free;
  for (const auto& [key, value] : request.choice.fixed) keys.push_back(key);
  for (const auto& key : keys)
    if (std::ranges::none_of(request.laws, [&](const Element& law) { return has_key(law, key); }))
      throw std::invalid_argument("none of the laws has a number called " + key);
}

/// See identify().
std::optional<std::size_t> simplest(const std::vector<IdentifiedLaw>& laws) {
  const auto converged = [](const IdentifiedLaw& law) { return law.status == Status::converged; };
  double least = infinite;
  for (const auto& law : laws)
    if (converged(law) && law.held_out < least) least = law.held_out;
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (!converged(laws[i]) || !(laws[i].held_out <= 1.01 * least)) continue;
    const auto rank = [](const IdentifiedLaw& one) { return std::pair(one.fitted, one.bic); };
    if (!chosen || rank(laws[i]) < rank(laws[*chosen])) chosen = i;
  }
  return chosen;
}

/// Several runs for all laws, unless one of them follows the motions in one run nearly as well.
Shooting shooting_for(const std::vector<std::unique_ptr<LawFit>>& fits) {
  constexpr double nearly = 1.3, exact = 1e-5;
  double single = infinite, multiple = infinite;
  for (const auto& one : fits) {
    single = std::min(single, one->error_of_motion(Shooting::single));
    multiple = std::min(multiple, one->error_of_motion(Shooting::multiple));
  }
  return single <= std::max(nearly * multiple, exact) ? Shooting::single : Shooting::multiple;
}

}  // namespace

IdentifyReport identify(const IdentifyRequest& request, const IdentifyOptions& options) {
  check_choice(request);
  IdentifyReport report;
  const bool rest_tells_nothing = std::ranges::any_of(request.laws, [](const Element& law) { return law.may_stick(); });
  for (const auto& record : request.records) {
    if (!is_free(record.kind)) {
      report.records.push_back(prepare(record, rest_tells_nothing));
      continue;
    }
    if (record.huber)
      throw std::invalid_argument(record.name + ": Huber's loss is for a friction force that was measured");
    if (!request.rig) throw std::invalid_argument(record.name + ": a free motion needs the plant that moves");
    for (auto& series : prepare_free(record, *request.rig)) report.records.push_back(std::move(series));
    report.shooting = Shooting::single;
  }
  const auto stop = [&] { return options.stop && options.stop(); };
  const auto show = [&](std::size_t done, std::string_view what) {
    if (options.progress)
      options.progress(static_cast<double>(done) / (2.0 * static_cast<double>(request.laws.size())), std::string(what));
  };
  std::vector<std::unique_ptr<LawFit>> fits;
  double least = infinite;
  for (const auto& law : request.laws) {
    if (stop()) break;
    show(fits.size(), law.kind());
    fits.push_back(std::make_unique<LawFit>(law, report.records, request.choice, options.stop));
  }
  if (report.shooting) report.shooting = shooting_for(fits);
  for (const auto& one : fits) {
    one->settle(report.shooting.value_or(Shooting::single));
    if (one->held_out() < least) least = one->held_out();
  }
  // Intervals of a law that misses the records mean little, and its flat directions cost most of the time.
  constexpr double far_worse = 1.1;
  for (const auto& one : fits) {
    show(fits.size() + report.laws.size(), "intervals");
    report.laws.push_back(one->with_intervals(fits.size() == 1 || one->held_out() <= far_worse * least));
  }
  if (!stop()) report.chosen = simplest(report.laws);
  if (request.plan && report.chosen) report.laws[*report.chosen].plan = fits[*report.chosen]->plan();
  report.status = stop() ? Status::interrupted : report.chosen ? Status::converged : Status::stalled;
  return report;
}

}  // namespace limcycle
