#include "limcycle/analysis/study/continuation/follow.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/derivative_notes.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"

namespace limcycle {
namespace {

class Following {
 public:
  Following(const LoopFamily& family, const FollowOptions& options)
      : family_(family), options_(options), scale_(options.continuation.from, options.continuation.to) {
    report_.from = options.continuation.from;
    report_.to = options.continuation.to;
    report_.start = report_.from;
    if (!options.own) return;
    const double s = scale_.s(*options.own);
    if (s >= 0.0 && s <= ParameterScale::length) report_.start = *options.own;
  }

  FollowReport run() {
    if (const auto loop = family_(report_.start)) report_.notes = derivative_notes(*loop);
    auto cycles = cycles_at(report_.start);
    if (cycles.empty() && !stopped()) cycles = look_elsewhere();
    std::size_t done = 0;
    for (const Cycle& cycle : cycles) {
      if (stopped()) break;
      const auto on_it = [&](const Branch& branch) { return passes(branch, report_.start, cycle); };
      if (!std::ranges::any_of(report_.branches, on_it)) follow_one(cycle, done, cycles.size());
      ++done;
    }
    if (cycles.empty() && report_.status == Status::converged) report_.status = Status::no_cycle;
    if (stopped()) report_.status = Status::interrupted;
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }

  std::vector<Cycle> cycles_at(double p) {
    const auto loop = family_(p);
    if (!loop) {
      report_.notes.push_back("the case is not valid at " + short_number(p, 6));
      return {};
    }
    if (!in_exact_time(*loop)) {
      report_.refused = why_not_followed(*loop);
      report_.status = Status::incomplete;
      return {};
    }
    PredictOptions predicting = options_.predict;
    if (p != options_.own) predicting.search.reset();  // the box of the case is for its own value
    predicting.progress = [&](double fraction, std::string_view what) { tell(0.2 * fraction, what); };
    auto found = predict(*loop, predicting);
    // Stable ones first: a branch through one often contains the unstable ones too.
    std::ranges::stable_sort(found.cycles, {}, [](const Cycle& cycle) { return cycle.stable == true ? 0 : 1; });
    return std::move(found.cycles);
  }

  std::vector<Cycle> look_elsewhere() {
    if (report_.status != Status::converged) return {};
    for (int i = 0; i <= options_.scan && !stopped(); ++i) {
      const double p = scale_.p(ParameterScale::length * i / options_.scan);
      if (p == report_.start || !family_(p)) continue;
      tell(0.2 * i / options_.scan, "looking for a cycle");
      auto cycles = cycles_at(p);
      if (cycles.empty()) continue;
      report_.notes.push_back("no limit cycle was found at " + short_number(report_.start, 6) +
                              "; the one followed was found at " + short_number(p, 6));
      report_.start = p;
      return cycles;
    }
    report_.notes.push_back("no limit cycle was found at " + short_number(report_.start, 6) + " nor at " +
                            std::to_string(options_.scan + 1) + " values over the range");
    return {};
  }

  void tell(double fraction, std::string_view what) const {
    if (options_.predict.progress) options_.predict.progress(fraction, what);
  }

  void follow_one(const Cycle& cycle, std::size_t index, std::size_t count) {
    ContinuationOptions continuing = options_.continuation;
    continuing.stop = options_.predict.stop;
    continuing.accuracy = options_.predict.accuracy;
    const double part = 0.8 / static_cast<double>(count), begin = 0.2 + part * static_cast<double>(index);
    double least = 1.0, most = 0.0;
    continuing.progress = [&](double share) {
      least = std::min(least, share);
      most = std::max(most, share);
      tell(begin + part * std::min(1.0, most - least), "following a cycle");
    };
    Branch branch = continue_cycle(in_exact_time(family_), cycle, report_.start, continuing);
    if (branch.points.empty()) {
      report_.notes.push_back("the cycle of period " + short_number(cycle.period, 6) +
                              " s could not be followed: " + branch.why);
      report_.status = branch.status == Status::interrupted ? branch.status : Status::incomplete;
      return;
    }
    if (branch.status != Status::converged) report_.status = branch.status;
    report_.branches.push_back(std::move(branch));
  }

  const LoopFamily& family_;
  const FollowOptions& options_;
  ParameterScale scale_;
  FollowReport report_;
};

}  // namespace

FollowReport follow(const LoopFamily& family, const FollowOptions& options) { return Following(family, options).run(); }

bool passes(const Branch& branch, double parameter, const Cycle& cycle) {
  // Logarithms are interpolated linearly between two points; the error is a share of their difference.
  const auto near = [](double a, double b, double at, double wanted) {
    const double run = std::log(b / a);
    return std::abs(std::log(a) + at * run - std::log(wanted)) < 1e-3 + 0.2 * std::abs(run);
  };
  for (std::size_t i = 0; i + 1 < branch.points.size(); ++i) {
    const auto &a = branch.points[i], &b = branch.points[i + 1];
    if ((a.parameter - parameter) * (b.parameter - parameter) > 0.0 || a.parameter == b.parameter) continue;
    const double at = (parameter - a.parameter) / (b.parameter - a.parameter);
    if (near(a.cycle.period, b.cycle.period, at, cycle.period) &&
        near(a.cycle.amplitude, b.cycle.amplitude, at, cycle.amplitude))
      return true;
  }
  return false;
}

}  // namespace limcycle
