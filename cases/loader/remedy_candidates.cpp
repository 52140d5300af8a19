#include "limcycle/cases/loader/remedy_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/remedy/dither.hpp"
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

class Candidates {
 public:
  explicit Candidates(const Case& from) : from_(from), parts_(need_loop(from)), numbers_(numbers_of(from)) {}

  std::vector<RemedyCandidate> all() {
    dead_zone();
    leak();
    hold_back("integrator-clamp", "integral_limit", Measure::force, Way::down);
    hold_back("integrator-reset", "integral_reset", Measure::own, Way::up);
    gain("gain-kp", {"kp", "position_kp"}, "proportional gain", Measure::stiffness);
    integral_gain();
    gain("gain-kd", {"kd", "velocity_kp"}, "derivative gain", Measure::damping);
    compensation();
    not_written(
        "impulse-compensation",
        "no controller here sends pulses to a body that is stuck with an error; `simulate` takes a table of the "
        "force");
    dither();
    hold_back("integral-band", "integral_band", Measure::displacement, Way::down);
    feedforward();
    of_plant("damping", {"loop.plant.damping", "loop.friction.sigma2"}, Measure::damping);
    of_plant("stiffness", {"loop.plant.stiffness"}, Measure::stiffness);
    return std::move(list_);
  }

 private:
  void add(RemedyCandidate candidate) {
    if (candidate.why_not.empty()) try {
        const Case with = case_with_remedy(from_, candidate, candidate.is_absent() ? 1.0 : candidate.own);
        candidate.parts = [variation = LoopVariation(with, "remedy", candidate.parameter)](double value) {
          return variation.parts({&value, 1});
        };
      } catch (const InputError& error) {  // the case does not take the remedy at all
        candidate.why_not = error.fault().key + " " + error.fault().rule;
      }
    list_.push_back(std::move(candidate));
  }
  void not_there(const std::string& name, const std::string& why) { add({name, {}, {}, why}); }
  void not_written(const std::string& name, const std::string& why) { not_there(name, "not implemented: " + why); }
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

  /// A limit, a band or a reset of the integral of a PID: infinite or 0 where it is absent.
  void hold_back(const std::string& name, const std::string& key, Measure measure, Way way) {
    const auto* pid = std::get_if<Pid>(&parts_.controller);
    if (parts_.diagram) return not_there(name, "in a diagram the integral is a block of its own");
    if (pid == nullptr) return not_there(name, "the controller has no integral of that kind: kind \"pid\" has");
    if (pid->ki == 0.0) return not_there(name, "there is no integral action");
    const CaseNumber* number = at("loop.controller." + key);
    add({name, number->path, number->unit, {}, number->value, measure, way});
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
