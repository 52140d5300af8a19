#include "limcycle/analysis/energy/passivity/adversary.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double noise = 1e-5;  ///< of the energy turnover: less is an error of the coarse march
constexpr double coarse = 1e-7, rough = 1e-9, fine = 1e-11;
constexpr int coarse_cycles = 12, fine_cycles = 60;

struct Trial {
  Strokes input;
  double share = 1.0, supplied = 0.0;
  double score = 0.0;  ///< the energy, weighted less the longer it takes and the faster the motion must be
};

/// Tries inputs and keeps the best.
class Search {
 public:
  Search(const Element& element, const MotionScales& scales, const PassivityOptions& options)
      : scales_(scales), options_(options), march_(element, coarse) {}

  bool stopped() {
    if (options_.stop && options_.stop()) result_.status = Status::interrupted;
    return result_.status != Status::converged;
  }

  Trial tried(Strokes input) {
    Trial trial{std::move(input)};
    const auto pieces = pieces_of(trial.input, march_.port());
    const CycleSupply cycle = periodic_supply(march_, pieces, coarse_cycles, 1e-7);
    if (cycle.status != Status::converged || !(cycle.turnover > 0.0) || !std::isfinite(cycle.supplied)) return trial;
    ++result_.inputs;
    const bool counts = std::abs(cycle.supplied) > noise * cycle.turnover;
    trial.supplied = counts ? cycle.supplied : 0.0;
    trial.share = counts ? cycle.supplied / cycle.turnover : 0.0;
    double period = 0.0, fastest = scales_.most;
    for (const SignalPiece& piece : pieces) {
      period += piece.duration;
      fastest = std::max(fastest, std::abs(piece.to));
    }
    trial.score = trial.supplied * std::pow(period, -0.1) * std::pow(scales_.most / fastest, 1.5);
    if (trial.share < result_.share) result_.share = trial.share;
    result_.least = std::min(result_.least, trial.supplied);
    if (trial.score < best_score_) {
      best_score_ = trial.score;
      result_.input = trial.input;
    }
    return trial;
  }

  /// Coordinate search in the logarithms, with ever finer steps, of share or of energy.
  Trial refined(Trial best, bool by_energy, int most) {
    const auto better = [by_energy](const Trial& a, const Trial& b) {
      return by_energy ? a.score < b.score : a.share < b.share;
    };
    int spent = 0;
    for (double step = 0.7; step > 0.02 && spent < most; step *= 0.5) {
      for (bool moved = true; moved && spent < most && !stopped();) {
        moved = false;
        for (std::size_t k = 0; k < best.input.size(); ++k)
          for (const bool of_length : {false, true})
            for (const double change : {step, -step}) {
              Strokes next = best.input;
              double& value = of_length ? next[k].length : next[k].size;
              const double bounded =
                  std::clamp(value + change, low(next[k], of_length), high(next[k], of_length, by_energy));
              if (bounded == value) continue;
              value = bounded;
              ++spent;
              if (const Trial trial = tried(std::move(next)); better(trial, best)) {
                best = trial;
                moved = true;
              }
            }
      }
    }
    return best;
  }

  Attack run() {
    std::vector<Trial> trials;
    std::mt19937_64 random(options_.seed + 1);
    const auto known = known_strokes(scales_, march_.port());
    const std::size_t count = known.size() + static_cast<std::size_t>(150 * options_.effort);
    result_.least = infinite, result_.share = 1.0;
    for (std::size_t k = 0; k < count && !stopped(); ++k) {
      trials.push_back(tried(k < known.size() ? known[k] : random_strokes(scales_, march_.port(), random)));
      if (options_.progress) options_.progress(0.5 * static_cast<double>(k) / static_cast<double>(count), "searching");
      if (k + 1 >= known.size() && result_.share < -1e-2) break;
    }
    // Elastic ranges and the trivial input supply nothing and are dropped.
    std::erase_if(trials, [](const Trial& trial) { return trial.share == 0.0; });
    std::ranges::stable_sort(trials, {}, &Trial::share);
    const std::size_t starts = std::min<std::size_t>(trials.size(), static_cast<std::size_t>(6 * options_.effort));
    for (std::size_t k = 0; k < starts && !stopped(); ++k) {
      Trial best = trials[k];
      if (!(best.share < 0.0)) best = refined(best, false, 80);
      if (best.share < 0.0) {
        refined(best, true, 150);
        if (k >= 1) break;
      }
      if (options_.progress)
        options_.progress(0.5 + 0.5 * static_cast<double>(k) / static_cast<double>(starts), "refining");
    }
    if (!(result_.least < 0.0) && !trials.empty()) result_.input = trials.front().input;
    return result_;
  }

 private:
  double low(const Stroke& stroke, bool of_length) const {
    if (!of_length) return std::log10(scales_.least);
    return std::log10(stroke.by_time ? 1e-3 * scales_.shortest : 1e-4 * scales_.way);
  }
  /// Upper limit: any speed serves to find some energy, but only plausible speeds to find much.
  double high(const Stroke& stroke, bool of_length, bool by_energy) const {
    if (!of_length) return by_energy ? std::max(std::log10(scales_.most), stroke.size) : std::log10(scales_.reach);
    return std::log10(stroke.by_time ? 300.0 * scales_.longest : 1e3 * scales_.way);
  }

  const MotionScales& scales_;
  const PassivityOptions& options_;
  SupplyMarch march_;
  Attack result_;
  double best_score_ = 0.0;
};

}  // namespace

Attack attack(const Element& element, const MotionScales& scales, const PassivityOptions& options) {
  return Search(element, scales, options).run();
}

std::optional<Counterexample> counterexample_of(const Element& element, const Strokes& input) {
  const DrivenBy port = port_of(element);
  const auto pieces = pieces_of(input, port);
  SupplyMarch first(element, rough), second(element, fine);
  const CycleSupply loose = periodic_supply(first, pieces, fine_cycles, 1e-8);
  const CycleSupply cycle = periodic_supply(second, pieces, fine_cycles, 1e-9);
  if (loose.status != Status::converged || cycle.status != Status::converged) return std::nullopt;
  Counterexample found;
  found.input = cycle_of(pieces);
  found.z0 = cycle.begin.z;
  found.mode0 = cycle.begin.mode;
  found.energy = -cycle.supplied;
  found.error = std::abs(cycle.supplied - loose.supplied) + 1e-9 * cycle.turnover;
  if (!(found.energy > 100.0 * found.error)) return std::nullopt;
  // The state repeats: all further cycles are the same.
  double taken = 0.0;
  for (const double total : cycle.total) found.taken.push_back(taken = -total);
  for (std::size_t k = cycle.total.size(); k < 12; ++k) found.taken.push_back(taken += found.energy);
  found.words = words_of(pieces, port);
  return found;
}

std::string words_of(std::span<const SignalPiece> pieces, DrivenBy port) {
  const std::string unit = port == DrivenBy::velocity ? " m/s" : "";
  std::string words;
  for (const SignalPiece& piece : pieces) {
    if (!words.empty()) words += ", then ";
    words += short_number(piece.from);
    if (piece.to != piece.from) words += " to " + short_number(piece.to);
    words += unit + " for " + short_number(piece.duration) + " s";
  }
  return words + ", over and over";
}

}  // namespace limcycle
