#include "limcycle/analysis/study/remedy/cause.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/energy/passivity/steady_slide.hpp"
#include "limcycle/analysis/golden_maximum.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/remedy/without.hpp"
#include "limcycle/models/diagram/quanta.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

/// Where the steady friction curve falls: up to the speed `end`, or for ever; then `most` of the fall lies below it.
struct FallingRange {
  double end = 0.0;
  bool for_ever = false;
};
constexpr double most = 0.99;

/// By a scan with six speeds a decade, then golden section; empty if the curve does not fall, or steeply to the end of
/// the scan.
std::optional<FallingRange> falling_range_of(const Element& law) {
  const double unit = law.scales().velocity;
  if (!std::isfinite(unit)) return std::nullopt;
  const auto force = [&](double v) {
    const auto slide = steady_slide(law, v);
    return slide ? slide->force : NAN;
  };
  constexpr int points = 31;
  constexpr double from = 1e-2, a_decade = 6.0, level = 1e-6;
  std::vector<double> speeds, forces;
  for (int i = 0; i < points; ++i) {
    speeds.push_back(unit * from * std::pow(10.0, i / a_decade));
    forces.push_back(force(speeds.back()));
    if (!std::isfinite(forces.back())) return std::nullopt;
  }
  const auto least = static_cast<std::size_t>(std::ranges::min_element(forces) - forces.begin());
  if (least == 0) return std::nullopt;
  const double fall = forces.front() - forces[least];
  if (forces.back() - forces[least] < level * fall) {  // no rise: it comes to a level, where rounding makes the minimum
    const auto below = std::ranges::find_if(forces, [&](double F) { return F <= forces.front() - most * fall; });
    const bool comes_to_level = forces[forces.size() - 2] - forces.back() < 1e-2 * fall;
    if (!comes_to_level || below == forces.begin()) return std::nullopt;
    return FallingRange{speeds[static_cast<std::size_t>(below - forces.begin())], true};
  }
  return FallingRange{
      golden_maximum([&](double v) { return -force(v); }, speeds[least - 1], speeds[least], speeds[least + 1], 40)};
}

/// True if the steps of a sampled controller are all that is not linear.
bool only_quanta_bend(const LoopParts& parts) {
  if (!has_only_quanta(parts)) return false;
  const Loop loop = build_loop(parts);
  return loop.sampled && std::ranges::all_of(loop.elements, [](const Element& element) {
           return element.as<Quantizer<double>>() != nullptr;
         });
}

/// What a loop does that is linear as far as its limits are never reached, by its poles; empty for any other. (A
/// simulation would take a swing for rest that is small beside the limits.)
std::optional<Hunts> linear_answer(const Loop& loop) {
  constexpr double rounding = 1e-9;
  const auto limits = [](const Element& element) { return element.as<Saturation<double>>() != nullptr; };
  if (loop.delay > 0.0 || loop.sampled || !std::ranges::all_of(loop.elements, limits)) return std::nullopt;
  double largest = -infinite, size = 0.0;
  for (const auto& pole : eigenvalues(working_loop(loop))) {
    largest = std::max(largest, pole.real());
    size = std::max(size, std::abs(pole));
  }
  if (std::abs(largest) <= rounding * size) return Hunts::neutral;
  return largest > 0.0 ? Hunts::diverges : Hunts::no;
}

class CauseStudy {
 public:
  /// A loop without its cause comes to rest soon, or is no answer: a sampled one is not followed for long.
  CauseStudy(LoopParts parts, Judging judging, const std::vector<Cycle>& cycles)
      : parts_(std::move(parts)), judging_(std::move(judging)), cycles_(cycles) {
    constexpr long enough_readings = 1'000'000;
    judging_.predict.max_readings = std::min(judging_.predict.max_readings, enough_readings);
    judging_.predict.enough = [](const OutcomeOfStart& one) {
      return one.outcome == Outcome::cycle || one.outcome == Outcome::irregular || one.outcome == Outcome::undecided;
    };
  }

  Cause run() {
    if (ends("without friction compensation", without_compensation(parts_)))
      return decided(CauseKind::over_compensation,
                     "The friction compensation is too strong: without it " + calm() + ".");
    if (only_quanta_bend(parts_))
      return decided(CauseKind::quantization,
                     "The controller reads, or commands, in steps, and everything else in the loop is linear: with "
                     "exact numbers " +
                         calm() + ".");
    if (ends(no_samples, without_delay(parts_))) {
      if (ends("without quanta", without_quanta(parts_)))  // which end with the sampling
        return decided(CauseKind::quantization,
                       "The controller reads, or commands, in steps: with exact numbers " + calm() + ".");
      return decided(CauseKind::delay, "The loop reacts too late: without dead time and sampling " + calm() + ".");
    }
    leave_samples();
    const bool integral = ends(no_integral, without_integral_action(parts_));
    const std::string level = friction_is_measured(parts_) ? "with a friction curve that is level at its least force"
                                                           : "with Fs lowered to Fc";
    const bool falling = ends(level, without_falling_friction(parts_));
    if (integral && falling)
      return decided(CauseKind::integral_action_and_stiction,
                     "The integral action pushes until the body breaks away from stiction, and it then slides too "
                     "far: without integral action, or " +
                         level + ", " + calm() + ".");
    // Falling friction alone would be the cause only if the loop hunted without integral action too.
    if (falling && came_out(no_integral, Hunts::undecided)) return decided(CauseKind::undecided, no_single_cause());
    if (falling)
      return decided(CauseKind::negative_slope, "Friction falls as the speed rises" + falling_range() +
                                                    ", which feeds the oscillation: " + level + " " + calm() + ".");
    if (ends("with a valve that does not stick", without_sticking_valve(parts_)) && integral)
      return decided(CauseKind::integral_action_and_stiction,
                     "The integral action drives the command through the band in which the valve sticks, and the valve "
                     "then jumps too far: without integral action, or with a valve that does not stick, " +
                         calm() + ".");
    if (ends("with a saturation in place of the relay", without_relay(parts_, relay_swing())))
      return decided(CauseKind::relay,
                     "The relay switches at full level however small the error: with a saturation that reaches this "
                     "level at twice the amplitude of the cycle " +
                         calm() + ".");
    if (ends("without limits of the command", without_limits(parts_), true))
      return decided(CauseKind::saturation, "The command is limited: without the limit " + calm() + ".");
    return decided(CauseKind::undecided, no_single_cause());
  }

 private:
  static constexpr const char *no_integral = "without integral action", *no_samples = "without dead time and sampling";

  Cause decided(CauseKind kind, std::string why) {
    cause_.kind = kind;
    cause_.why = std::move(why);
    if (left_samples_)
      cause_.why += " (Without dead time and sampling the loop hunts as well; the other changes were tried there.)";
    return std::move(cause_);
  }

  /// A loop that hunts without its samples too does so for a reason that shows there, where it is judged a hundred
  /// times as fast.
  void leave_samples() {
    if (!came_out(no_samples, Hunts::yes) || !build_loop(parts_).sampled) return;
    parts_ = *without_delay(parts_);
    left_samples_ = true;
  }

  bool ends(const std::string& without, const std::optional<LoopParts>& parts, bool limits_are_far = false) {
    if (!parts || (judging_.predict.stop && judging_.predict.stop())) return false;
    const Hunts answer = answer_of(*parts, limits_are_far);
    cause_.tests.push_back({without, answer});
    neutral_ = neutral_ || answer == Hunts::neutral;
    return answer == Hunts::no || answer == Hunts::neutral;  // nothing feeds a centre
  }

  /// Undecided for a change that cannot be made: measured data without their dead time may have no fit.
  Hunts answer_of(const LoopParts& parts, bool limits_are_far) const try {
    const Loop loop = build_loop(parts);
    const auto linear = limits_are_far ? linear_answer(loop) : std::nullopt;
    return linear ? *linear : hunts(loop, judging_).hunts;
  } catch (const std::invalid_argument&) {
    return Hunts::undecided;
  }

  /// What the loop does without its cause.
  std::string calm() const {
    return neutral_ ? "the loop has no limit cycle, though its swings go on for ever as those of a frictionless one"
                    : "the loop does not hunt";
  }

  bool came_out(const std::string& without, Hunts as) const {
    return std::ranges::any_of(cause_.tests,
                               [&](const Counterfactual& test) { return test.without == without && test.hunts == as; });
  }

  /// From the tests, as they came out.
  std::string no_single_cause() const {
    if (cause_.tests.empty()) return "None of the known causes applies to this loop.";
    std::string ending, going_on, open;
    for (const Counterfactual& test : cause_.tests) {
      const bool ends = test.hunts == Hunts::no || test.hunts == Hunts::neutral;
      std::string& list = ends ? ending : test.hunts == Hunts::undecided ? open : going_on;
      list += (list.empty() ? "" : ", ") + test.without +
              (test.hunts == Hunts::diverges ? " (where it diverges)" : std::string());
    }
    std::string why = "No single known cause:";
    if (!ending.empty()) why += " the loop does not hunt " + ending + (going_on.empty() && open.empty() ? "" : ";");
    if (!going_on.empty()) why += " it does not come to rest " + going_on + (open.empty() ? "" : ";");
    if (!open.empty()) why += " not decided: " + open;
    return why + ".";
  }

  /// Amplitude of the input of the relay on the cycle; 0 if there is no relay or no cycle.
  double relay_swing() const {
    if (!parts_.diagram && !(parts_.element && parts_.element->kind() == "relay")) return 0.0;
    const auto cycle = std::ranges::find(cycles_, std::optional<bool>(true), &Cycle::stable);
    if (cycle == cycles_.end() || cycle->trace.input.empty()) return 0.0;
    const auto [low, high] = std::ranges::minmax(cycle->trace.input);
    return 0.5 * (high - low);
  }

  std::string falling_range() const {
    const Subject subject = subject_of(parts_);
    if (subject.element == nullptr || !subject.opposes) return {};
    const auto range = falling_range_of(*subject.element);
    if (!range) return {};
    const std::string speed = short_number(range->end, 3) + " m/s";
    return range->for_ever ? ", 99 % of the fall below " + speed : " up to " + speed;
  }

  LoopParts parts_;
  Judging judging_;  ///< that ends with the first start that does not come to rest
  const std::vector<Cycle>& cycles_;
  Cause cause_;
  bool left_samples_ = false;
  bool neutral_ = false;  ///< in one of the tests nothing fed or damped the swings
};

}  // namespace

std::string_view to_string(CauseKind kind) {
  switch (kind) {
    case CauseKind::integral_action_and_stiction:
      return "integral-action-and-stiction";
    case CauseKind::negative_slope:
      return "negative-slope";
    case CauseKind::delay:
      return "delay";
    case CauseKind::relay:
      return "relay";
    case CauseKind::over_compensation:
      return "over-compensation";
    case CauseKind::quantization:
      return "quantization";
    case CauseKind::saturation:
      return "saturation";
    case CauseKind::undecided:
      break;
  }
  return "undecided";
}

Cause cause_of(const LoopParts& parts, const Judging& judging, const std::vector<Cycle>& cycles) {
  return CauseStudy(parts, judging, cycles).run();
}

}  // namespace limcycle
