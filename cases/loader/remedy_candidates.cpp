#include "limcycle/cases/loader/remedy_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/remedy/dither.hpp"
#include "limcycle/analysis/study/remedy/gain_line.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/models/diagram/assemble.hpp"

namespace limcycle {
namespace {

using Way = RemedyCandidate::Way;

Case case_with_overrides(const Case& from, const std::vector<std::string>& more) {
  auto overrides = from.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_again(from, overrides);
}

Case case_with_remedy(const Case& from, const RemedyCandidate& candidate, double value) {
  return case_with_overrides(from, remedy_overrides(candidate, value));
}

/// The loop over the remedy's number; a reason why not if the case does not take the remedy at all.
void find_parts(const Case& from, RemedyCandidate& candidate) try {
  const Case with = case_with_remedy(from, candidate, candidate.is_absent() ? 1.0 : candidate.own);
  candidate.parts = [variation = LoopVariation(with, "remedy", candidate.parameter)](double value) {
    return variation.parts({&value, 1});
  };
} catch (const InputError& error) {
  candidate.why_not = error.fault().key + " " + error.fault().rule;
}

/// Impulses in the place of integral action: of a hundredth of a turn at the crossover of the loop, half a turn apart;
/// an error of a tenth of the hunting may stay, and a hundredth of its speed counts as none.
RemedyCandidate sized_impulses(const Case& from, RemedyCandidate candidate, double turn, const HuntingSizes& sizes) {
  const auto set = [&](const std::string& key, double value) {
    candidate.with.push_back(override_of("loop.controller." + key, rounded_to(value, 2)));
  };
  candidate.sized = {};
  candidate.band = rounded_to(0.1 * sizes.displacement, 2);
  set("ki", 0.0);
  set("impulse_width", 0.01 * turn);
  set("impulse_pause", 0.5 * turn);
  set("impulse_band", candidate.band);
  set("impulse_speed", 0.01 * sizes.displacement * sizes.frequency);
  find_parts(from, candidate);
  return candidate;
}

class Candidates {
 public:
  explicit Candidates(const Case& from) : from_(from), parts_(need_loop(from)), numbers_(numbers_of(from)) {}

  std::vector<RemedyCandidate> all() {
    dead_zone();
    hold_back("integrator-dead-zone", "integral_dead_zone", Measure::displacement, Way::up);
    hysteresis();
    leak();
    hold_back("integrator-clamp", "integral_limit", Measure::force, Way::down);
    hold_back("integrator-reset", "integral_reset", Measure::own, Way::up);
    reset_at_stop();
    gain("gain-kp", {"kp", "position_kp"}, "proportional gain", Measure::stiffness);
    integral_gain();
    gain("gain-kd", {"kd", "velocity_kp"}, "derivative gain", Measure::damping);
    gain_line("gain-line-bandwidth", GainLine::Keeps::bandwidth);
    gain_line("gain-line-margin", GainLine::Keeps::phase_margin);
    compensation();
    impulses();
    dither();
    hold_back("integral-band", "integral_band", Measure::displacement, Way::down);
    feedforward();
    of_plant("damping", {"loop.plant.damping", "loop.friction.sigma2"}, Measure::damping);
    of_plant("stiffness", {"loop.plant.stiffness"}, Measure::stiffness);
    return std::move(list_);
  }

 private:
  void add(RemedyCandidate candidate) {
    if (candidate.why_not.empty()) find_parts(from_, candidate);
    list_.push_back(std::move(candidate));
  }
  void not_there(const std::string& name, const std::string& why) { add({name, {}, {}, why}); }
  void vary(const std::string& name, const CaseNumber& number, Measure measure, Way way) {
    const double own = std::isfinite(number.value) ? number.value : 0.0;
    add({name, number.path, number.unit, {}, own, measure, own == 0.0 ? Way::up : way});
  }

  /// The number of that key of the controller: in a diagram of the only block that has it.
  const CaseNumber* of_controller(std::string_view key) const {
    const std::string tail = "." + std::string(key);
    const CaseNumber* found = nullptr;
    for (const CaseNumber& one : numbers_) {
      if (!one.path.starts_with(parts_.diagram ? "diagram." : "loop.controller.") || !one.path.ends_with(tail))
        continue;
      if (found != nullptr) return nullptr;
      found = &one;
    }
    return found;
  }
  const CaseNumber* at(std::string_view path) const {
    const auto found = std::ranges::find(numbers_, path, &CaseNumber::path);
    return found == numbers_.end() ? nullptr : &*found;
  }
  bool has_controller() const {
    return parts_.diagram.has_value() || !std::holds_alternative<NoController>(parts_.controller);
  }
  std::string no_number(const std::string& what) const {
    if (!has_controller()) return "there is no controller";
    return parts_.diagram ? "no block, or more than one, has a " + what
                          : "a controller of this kind has no " + what + " of its own";
  }

  void gain(const std::string& name, std::initializer_list<std::string_view> keys, const std::string& what,
            Measure measure) {
    for (const std::string_view key : keys)
      if (const auto* number = has_controller() ? of_controller(key) : nullptr)
        return vary(name, *number, measure, Way::both);
    not_there(name, no_number(what));
  }

  /// Why the controller has no integral that could be held back; empty: it has.
  std::string why_no_integral() const {
    const auto* pid = std::get_if<Pid>(&parts_.controller);
    if (parts_.diagram) return "in a diagram the integral is a block of its own";
    if (pid == nullptr) return "the controller has no integral of that kind: kind \"pid\" has";
    return pid->ki == 0.0 ? "there is no integral action" : "";
  }
  /// Or whose integral is held back already.
  std::string why_no_free_integral() const {
    const auto why = why_no_integral();
    const bool held = why.empty() && std::get<Pid>(parts_.controller).holds_integral_back();
    return held ? "the integral is held back already" : why;
  }
  /// The loop with other numbers of its PID; empty if `set` returns false or they are not valid.
  std::function<std::optional<LoopParts>(double)> with_pid(std::function<bool(Pid&, double)> set) const {
    return [parts = parts_, set = std::move(set)](double value) -> std::optional<LoopParts> {
      LoopParts changed = parts;
      if (!set(std::get<Pid>(changed.controller), value) || validate(changed)) return std::nullopt;
      return changed;
    };
  }

  /// kp along the line on which kd keeps something of the loop.
  void gain_line(const std::string& name, GainLine::Keeps keeps) {
    const auto* pid = std::get_if<Pid>(&parts_.controller);
    if (parts_.diagram || pid == nullptr) return not_there(name, "the controller has no kp and kd: kind \"pid\" has");
    const auto line = GainLine::of(parts_, keeps);
    if (!line)
      return not_there(name, "it needs kp and kd above 0 and a frequency at which the open loop has a gain of 1");
    const CaseNumber* number = at("loop.controller.kp");
    RemedyCandidate candidate{name, number->path, number->unit, {}, pid->kp, Measure::stiffness, Way::both};
    candidate.parts = with_pid([line](Pid& changed, double kp) {
      const auto kd = line->kd(kp);
      changed.kp = kp;
      changed.kd = kd.value_or(0.0);
      return kd.has_value();
    });
    candidate.follows = [line](double kp) {
      return std::vector<std::string>{override_of("loop.controller.kd", line->kd(kp).value_or(0.0))};
    };
    list_.push_back(std::move(candidate));
  }

  void integral_gain() {
    for (const std::string_view key : {"ki", "velocity_ki", "position_ki"}) {
      const auto* number = has_controller() ? of_controller(key) : nullptr;
      if (number != nullptr && number->value != 0.0) return vary("gain-ki", *number, Measure::own, Way::both);
    }
    not_there("gain-ki", has_controller() ? "there is no integral gain that is not 0" : "there is no controller");
  }

  void leak() {
    const auto *ki = of_controller("ki"), *leak = of_controller("leak");
    if (leak != nullptr && (parts_.diagram || (ki != nullptr && ki->value != 0.0)))
      return vary("integrator-leak", *leak, Measure::rate, Way::both);
    not_there("integrator-leak", ki != nullptr && ki->value == 0.0
                                     ? "there is no integral action"
                                     : "the controller has no integral that can leak: kind \"pid\" has");
  }

  /// In the place of integral action. Their times are those of the loop without friction, the band a tenth of the
  /// hunting.
  void impulses() {
    const std::string name = "impulse-compensation";
    const auto* pid = std::get_if<Pid>(&parts_.controller);
    if (parts_.diagram) return not_there(name, "in a diagram it is a block of kind \"impulses\"");
    if (pid == nullptr) return not_there(name, "the controller sends no impulses: kind \"pid\" does");
    if (!parts_.friction) return not_there(name, "there is no friction");
    if (pid->is_on()) return not_there(name, "a sampled controller sends none yet");
    if (pid->impulse > 0.0) return vary(name, *at("loop.controller.impulse"), Measure::force, Way::both);
    if (parts_.reference_rate != 0.0) return not_there(name, "along a ramp the body is not to stop");
    const auto crossover = highest_crossover(parts_);
    if (!crossover) return not_there(name, "the loop without friction has no crossover to take their times from");
    RemedyCandidate candidate{name, "loop.controller.impulse", "N", {}, 0.0, Measure::force, Way::up};
    candidate.sized = [from = from_, candidate, turn = 2.0 * std::numbers::pi / *crossover](const HuntingSizes& sizes) {
      return sized_impulses(from, candidate, turn, sizes);
    };
    list_.push_back(std::move(candidate));
  }

  /// A limit, a band or a reset of the integral of a PID: infinite or 0 where it is absent.
  void hold_back(const std::string& name, const std::string& key, Measure measure, Way way) {
    if (const auto why = why_no_integral(); !why.empty()) return not_there(name, why);
    const CaseNumber* number = at("loop.controller." + key);
    add({name, number->path, number->unit, {}, number->value, measure, way});
  }

  /// A dead zone before the integral that lets it go on at twice the error at which it holds.
  void hysteresis() {
    const std::string name = "integrator-hysteresis";
    if (parts_.diagram)
      return not_there(name, "in a diagram it is a block \"hysteretic-dead-zone\" before the integral");
    if (const auto why = why_no_free_integral(); !why.empty()) return not_there(name, why);
    RemedyCandidate candidate{name, "loop.controller.integral_dead_zone", "m", {}, 0.0, Measure::displacement, Way::up};
    candidate.parts = with_pid([](Pid& changed, double value) {
      changed.integral_dead_zone = changed.integral_hysteresis = value;
      return true;
    });
    candidate.follows = [](double value) {
      return std::vector<std::string>{override_of("loop.controller.integral_hysteresis", value)};
    };
    list_.push_back(std::move(candidate));
  }

  /// The same where the body stops: at a hundredth of the speed of the hunting.
  void reset_at_stop() {
    const std::string name = "integrator-stop-reset";
    if (const auto why = why_no_free_integral(); !why.empty()) return not_there(name, why);
    RemedyCandidate candidate{name, "loop.controller.integral_reset", "1", {}, 0.0, Measure::own, Way::up};
    candidate.sized = [from = from_, candidate](const HuntingSizes& sizes) {
      RemedyCandidate with_speed = candidate;
      with_speed.sized = {};
      const double speed = rounded_to(0.01 * sizes.displacement * sizes.frequency, 2);
      with_speed.with.push_back(override_of("loop.controller.reset_speed", speed));
      find_parts(from, with_speed);
      return with_speed;
    };
    list_.push_back(std::move(candidate));
  }

  void dead_zone() {
    const std::string name = "error-dead-zone";
    if (parts_.diagram) return not_there(name, "in a diagram it is a block \"dead-zone\" behind the error");
    if (!uses_error(parts_)) return not_there(name, "there is no error: the loop has no controller");
    if (parts_.error && parts_.error->kind() != "dead-zone")
      return not_there(name, "the error passes another element already");
    const double own = parts_.error ? parts_.error->number("half_width").value() : 0.0;
    RemedyCandidate candidate{name, "loop.error.half_width", "1", {}, own, Measure::displacement, Way::up};
    if (own == 0.0) candidate.with.emplace_back("loop.error.kind=\"dead-zone\"");
    add(std::move(candidate));
  }

  /// A sine in [simulate]: no part of the loop.
  void dither() {
    const std::string name = "dither";
    if (const auto why = why_no_dither(parts_); !why.empty()) return not_there(name, why);
    if (from_.simulate && from_.simulate->force) return not_there(name, "[simulate] has a force already");
    const auto frequency = frequency_of_dither(parts_);
    if (!frequency) return not_there(name, "the loop without friction has no crossover above which a dither could lie");
    RemedyCandidate candidate{name, "simulate.force.amplitude", "N", {}, 0.0, Measure::force, Way::up};
    candidate.parts = [parts = parts_](double) { return parts; };
    candidate.frequency = *frequency;
    if (!from_.simulate)
      candidate.with.push_back(fmt::format("simulate.duration={:.2g}", 2000.0 * std::numbers::pi / *frequency));
    candidate.with.emplace_back("simulate.force.kind=\"sine\"");
    candidate.with.push_back(override_of("simulate.force.frequency", *frequency));
    list_.push_back(std::move(candidate));
  }

  void compensation() {
    const std::string name = "friction-compensation";
    if (parts_.diagram) return not_there(name, "in a diagram it is a block of that kind, `on` the plant");
    if (!parts_.friction) return not_there(name, "there is no friction");
    if (!has_controller()) return not_there(name, "there is no controller");
    vary(name, *at("loop.controller.friction_compensation"), Measure::force, Way::both);
    if (parts_.friction->facts().holds == Held::nothing && list_.back().is_absent())
      list_.back().in_vain =
          "this friction is smooth at v = 0, where the compensation is not: in a small swing it gives more energy than "
          "any damping takes, so that the body never rests";
  }

  void feedforward() {
    const std::string name = "velocity-feedforward";
    if (parts_.reference_rate == 0.0)
      return not_there(name, "the reference stands still: the feedforward of its velocity is zero");
    if (const auto* number = at("loop.controller.velocity_feedforward"))
      return vary(name, *number, Measure::own, Way::both);
    not_there(name, "at the constant velocity of a ramp it is a constant force, which loop.load can be");
  }

  void of_plant(const std::string& name, std::initializer_list<std::string_view> paths, Measure measure) {
    if (parts_.diagram) {
      const auto* number = of_controller(name);
      if (number != nullptr) return vary(name, *number, measure, Way::up);
      return not_there(name, "no block, or more than one, has a " + name);
    }
    for (const std::string_view path : paths)
      if (const auto* number = at(path)) return vary(name, *number, measure, Way::up);
    not_there(name, "a plant of this kind has no " + name + " of its own");
  }

  const Case& from_;
  const LoopParts& parts_;
  const std::vector<CaseNumber> numbers_;
  std::vector<RemedyCandidate> list_;
};

}  // namespace

std::vector<RemedyCandidate> remedy_candidates(const Case& from) { return Candidates(from).all(); }

std::vector<std::string> remedy_overrides(const RemedyCandidate& candidate, double value) {
  std::vector<std::string> overrides = candidate.with;
  overrides.push_back(override_of(candidate.parameter, value));
  if (candidate.follows)
    for (std::string& one : candidate.follows(value)) overrides.push_back(std::move(one));
  return overrides;
}

SampledParts sampled_parts(const Case& from, std::uint64_t seed) {
  if (!from.sensitivity) return {};
  return [from, seed, joint = JointSpread(*from.sensitivity)](const RemedyCandidate& candidate, double value,
                                                              std::size_t sample) -> std::optional<LoopParts> {
    RandomStream random(seed, "remedy", sample);
    std::vector<std::string> overrides;
    const auto& parameters = from.sensitivity->parameters;
    std::vector<double> shares(parameters.size());
    for (double& share : shares) share = random.uniform();
    const auto drawn = joint.values(std::move(shares));
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (parameters[i].path != candidate.parameter) overrides.push_back(override_of(parameters[i].path, drawn[i]));
    const auto remedy = remedy_overrides(candidate, value);
    overrides.insert(overrides.end(), remedy.begin(), remedy.end());
    try {
      return case_with_overrides(from, overrides).loop;
    } catch (const InputError&) {
      return std::nullopt;
    }
  };
}

}  // namespace limcycle
