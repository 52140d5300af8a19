#include "limcycle/analysis/study/dissipativity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/energy/one_state/one_state_law.hpp"

namespace limcycle {
namespace {

std::vector<std::string> names_of_states(const Element& element) {
  const int n = element.states();
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) names.push_back(n == 1 ? "z" : "z" + std::to_string(i + 1));
  return names;
}

/// The verdict for one of many laws, without moving the progress bar.
Passive verdict(const Element& law, const DissipativityOptions& options) {
  PassivityOptions quiet = options.passivity;
  quiet.progress = {};
  return passivity(law, quiet).passive;
}

ThresholdOptions threshold_options(const Element& element, const DissipativityOptions& options) {
  ThresholdOptions threshold;
  threshold.top_speed = options.passivity.top_speed;
  threshold.stop = options.passivity.stop;
  if (!OneStateLaw::fits(element)) threshold.verdict = [&options](const Element& law) { return verdict(law, options); };
  return threshold;
}

/// The least sigma2: computed for a law with one state; 0 for another law that is passive without it.
std::optional<SigmaThreshold> least_damping(const Element& element, const DissipativityOptions& options,
                                            Passive as_it_is) {
  const auto own = element.number("sigma2");
  if (!own) return std::nullopt;
  if (OneStateLaw::fits(element)) {
    const LeastDamping least = least_sigma2(element, threshold_options(element, options));
    if (std::isnan(least.value)) return std::nullopt;
    return SigmaThreshold{least.value, least.error};
  }
  if (as_it_is != Passive::yes) return std::nullopt;
  if (*own == 0.0) return SigmaThreshold{};
  const auto without = family_of(element, "sigma2")(0.0);
  if (without && verdict(*without, options) == Passive::yes) return SigmaThreshold{};
  return std::nullopt;
}

/// The speed of the other surface: its place in the parts, and the loop at another speed.
struct SlidingSpeed {
  std::string path;
  double value = 0.0;
  std::function<Loop(double)> family;
};

std::optional<SlidingSpeed> sliding_speed(const LoopParts& parts) {
  const auto of_surface = [&parts]<class P>(P plant) -> std::optional<SlidingSpeed> {
    if constexpr (requires { plant.surface_speed(); }) {
      if (plant.surface_speed() == 0.0) return std::nullopt;
      return SlidingSpeed{"loop.plant." + std::string(P::surface_speed_key), plant.surface_speed(), [parts](double v) {
                            LoopParts other = parts;
                            std::get<P>(other.plant).surface_speed() = v;
                            return build_loop(other);
                          }};
    } else {
      return std::nullopt;
    }
  };
  if (auto speed = std::visit(of_surface, parts.plant)) return speed;
  if (parts.reference_rate != 0.0)
    return SlidingSpeed{"loop.reference.rate", parts.reference_rate, [parts](double v) {
                          LoopParts other = parts;
                          other.reference_rate = v;
                          return build_loop(other);
                        }};
  return std::nullopt;
}

void look_at_sliding(const LoopParts& parts, const DissipativityOptions& options, DissipativityReport& report) {
  const auto speed = sliding_speed(parts);
  if (!speed || !parts.friction) return;
  report.speed_of_sliding = speed->path;
  HopfOptions hopf;
  hopf.stop = options.passivity.stop;
  const double size = std::abs(speed->value), sign = speed->value < 0.0 ? -1.0 : 1.0;
  report.sliding_changes =
      sliding_stability_changes([&](double v) { return speed->family(sign * v); }, 1e-3 * size, 1e3 * size, hopf);
  for (auto& point : report.sliding_changes) point.speed *= sign;
}

}  // namespace

DissipativityReport dissipativity(const Element& element, const std::string& path,
                                  const DissipativityOptions& options) {
  DissipativityReport report;
  report.kind = element.kind();
  report.path = path;
  report.friction = element.is_friction();
  report.states = names_of_states(element);
  report.top_speed = options.passivity.top_speed;
  PassivityOptions first = options.passivity;
  first.progress = [&](double fraction, std::string_view what) {
    if (options.passivity.progress) options.passivity.progress(0.6 * fraction, what);
  };
  report.passivity = passivity(element, first);
  const auto stopped = [&] { return options.passivity.stop && options.passivity.stop(); };
  if (report.friction && !stopped()) {
    BoundsOptions bounding;
    bounding.seed = options.passivity.seed;
    bounding.stop = options.passivity.stop;
    bounding.top_speed = options.passivity.top_speed;
    report.over_all = bounds(element, bounding);
    bounding.top_speed = options.speed;
    report.up_to_speed = bounds(element, bounding);
    if (options.passivity.progress) options.passivity.progress(0.75, "thresholds");
    report.threshold = least_damping(element, options, report.passivity.passive);
    if (OneStateLaw::fits(element)) {
      const PassiveSpeed speed = passive_speed(element, threshold_options(element, options));
      if (!std::isnan(speed.value)) report.passive_speed = speed;
    }
  }
  if (options.range && !stopped()) {
    ThresholdOptions scan = threshold_options(element, options);
    if (!OneStateLaw::fits(element)) {  // every verdict may be a search
      scan.scan = 9;
      scan.accuracy = 1e-3;
    }
    scan.logarithmic = options.range->from > 0.0 && options.range->to > 10.0 * options.range->from;
    report.asked = options.range;
    const PassivityRange& asked = *options.range;
    report.range =
        passivity_threshold(asked.family ? asked.family : family_of(element, asked.key), asked.from, asked.to, scan);
  }
  if (stopped() || report.passivity.status == Status::interrupted) report.status = Status::interrupted;
  return report;
}

DissipativityReport dissipativity(const LoopParts& parts, const DissipativityOptions& options) {
  const Subject subject = subject_of(parts);
  if (subject.element == nullptr || subject.path == "loop.error")
    throw std::invalid_argument("dissipativity needs one friction law or forward element");
  DissipativityReport report = dissipativity(*subject.element, subject.path, options);
  if (report.status == Status::interrupted) return report;
  const Loop loop = build_loop(parts);
  LoopDissipationOptions energy;
  energy.stop = options.passivity.stop;
  if (subject.opposes && report.threshold) {
    energy.deficit = report.threshold->value - subject.element->number("sigma2").value_or(0.0);
  } else if (subject.opposes && report.passivity.passive == Passive::yes) {
    energy.deficit = 0.0;
  }
  report.loop = loop_dissipation(loop, energy);
  look_at_sliding(parts, options, report);
  if (report.loop->no_cycle.decision == Decision::yes) {
    PredictOptions check = options.predict;
    check.stop = options.passivity.stop;
    const PredictReport found = predict(loop, check);
    if (found.status != Status::interrupted) report.agrees = found.cycles.empty();
  }
  if (options.passivity.stop && options.passivity.stop()) report.status = Status::interrupted;
  return report;
}

}  // namespace limcycle
