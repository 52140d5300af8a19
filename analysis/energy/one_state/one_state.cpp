#include "limcycle/analysis/energy/one_state/one_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/energy/one_state/one_state_cycle.hpp"
#include "limcycle/analysis/energy/passivity/storage_slopes.hpp"
#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Integral of a slope over a panel by Simpson's rule; `none` if the slope is infinite (z cannot pass that way).
double over_panel(double h, double left, double middle, double right, double none) {
  const double sum = h / 6.0 * (left + 4.0 * middle + right);
  return std::isfinite(sum) ? sum : none;
}

/// The slopes and the available storage. From z, energy can be extracted on the way down, the integral of `least`, or
/// on the way up, minus that of `most`; as least <= most no detour yields more.
StorageCurve storage_curve(const OneStateLaw& law, const SlopeSurvey& survey) {
  StorageCurve curve;
  const auto& gaps = survey.gaps;
  std::vector<double> middle_least, middle_most;
  for (const SlopeGap& gap : gaps) {
    curve.z.push_back(gap.z);
    curve.least.push_back(gap.down.endless ? infinite : gap.least());
    curve.most.push_back(gap.up.endless ? -infinite : gap.most());
  }
  curve.available.assign(gaps.size(), infinite);
  if (survey.passive != Passive::yes) return curve;
  for (std::size_t i = 0; i + 1 < gaps.size(); ++i) {
    const SlopeGap middle = slope_gap(law, 0.5 * (gaps[i].z + gaps[i + 1].z));
    middle_least.push_back(middle.least());
    middle_most.push_back(middle.most());
  }
  std::ranges::fill(curve.available, 0.0);
  double down = 0.0, up = 0.0;
  for (std::size_t i = 1; i < gaps.size(); ++i) {
    const double h = gaps[i].z - gaps[i - 1].z;
    down += over_panel(h, curve.least[i - 1], middle_least[i - 1], curve.least[i], -infinite);
    down = std::max(down, 0.0);
    curve.available[i] = down;
  }
  for (std::size_t i = gaps.size() - 1; i-- > 0;) {
    const double h = gaps[i + 1].z - gaps[i].z;
    up -= over_panel(h, curve.most[i], middle_most[i], curve.most[i + 1], infinite);
    up = std::max(up, 0.0);
    curve.available[i] = std::max(curve.available[i], up);
  }
  return curve;
}

std::string speed_words(double top_speed) {
  return std::isfinite(top_speed) ? " at speeds up to " + short_number(top_speed) + " m/s" : " at any speed";
}

std::string violation(const SlopeGap& worst) {
  const std::string where = "at z = " + short_number(worst.z);
  if (worst.leak != 0.0)
    return where + " sliding at " + short_number(worst.leak) + " m/s gives energy for as long as it lasts";
  if (worst.down.endless || worst.up.endless)
    return "near z = " + short_number(worst.z) + " the energy that a passage gives grows with the speed without bound";
  return where + " a storage would need a slope of at least " + short_number(worst.least()) + " and at most " +
         short_number(worst.most());
}

std::string undecided_words(const SlopeSurvey& survey) {
  if (survey.status == Status::interrupted) return "interrupted";
  if (survey.status == Status::not_finite) return "the law gave NaN or infinity";
  if (survey.worst.verdict() == Passive::yes)
    return "undecided: a storage slope exists at every state, but whether the storage stays bounded was not determined";
  return "at z = " + short_number(survey.worst.z) +
         " the least and the largest slope of a storage cross by less than 1e-9: too close to tell";
}

void refute(const OneStateLaw& law, const SlopeSurvey& survey, const PassivityOptions& options, Passivity& result) {
  result.counterexample = one_state_counterexample(law, survey, options);
  result.deficit = result.counterexample ? result.counterexample->energy : std::numeric_limits<double>::quiet_NaN();
  result.passive = result.counterexample ? Passive::no : Passive::undecided;
  result.why = violation(survey.worst);
  result.why += result.counterexample ? ": " + result.counterexample->words
                                      : ", but no cycle was found that a simulation confirms";
  if (!result.counterexample) result.status = options.stop && options.stop() ? Status::interrupted : Status::incomplete;
}

}  // namespace

Passivity one_state_passivity(const Element& law, const PassivityOptions& options) {
  const OneStateLaw one(law, options.top_speed);
  Passivity result;
  result.method = "storage over the state";
  result.searched = std::numeric_limits<double>::quiet_NaN();
  const SlopeSurvey survey = survey_slopes(one, true, options.stop);
  result.passive = survey.passive;
  result.status = survey.status;
  result.storage = storage_curve(one, survey);
  if (survey.passive == Passive::no) {
    refute(one, survey, options, result);
  } else if (survey.passive == Passive::yes) {
    result.why = "at each of " + std::to_string(survey.gaps.size()) + " states from " + short_number(one.low()) +
                 " to " + short_number(one.high()) + " a storage has a slope that no motion" +
                 speed_words(options.top_speed) + " contradicts";
  } else {
    result.deficit = std::numeric_limits<double>::quiet_NaN();
    result.why = undecided_words(survey);
  }
  return result;
}

}  // namespace limcycle
