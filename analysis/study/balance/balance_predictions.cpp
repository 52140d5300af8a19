#include "limcycle/analysis/study/balance/balance_predictions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/study/balance/orbit_guess.hpp"
#include "limcycle/analysis/study/predict/failure_note.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

constexpr double settled = 0.05;          ///< relative change of an answer by the last harmonics that were added to it
constexpr long one_balance = 200'000;     ///< evaluations permitted for one start
constexpr double sticks_too_much = 0.02;  ///< share of the period

class BalanceStudy {
 public:
  BalanceStudy(const BalanceQuestion& question, CycleHunt& hunt) : ask_(question), hunt_(hunt) {
    result_.effort = {std::string(balance_name), 0, "evaluations of its equations"};
  }

  BalancePredictions run() {
    HarmonicBalanceOptions options;
    options.half_wave_symmetric = symmetry(ask_.loop).has_value();
    options.stop = ask_.stop;
    for (const HarmonicGuess& guess : guesses()) {
      if (stopped()) {
        result_.interrupted = true;
        break;
      }
      const long left = ask_.max_evaluations - result_.effort.count;
      if (left <= 0) {
        result_.cut_short = true;
        break;
      }
      options.max_evaluations = std::min(one_balance, left);
      begin_from(guess, options);
    }
    return std::move(result_);
  }

 private:
  void begin_from(const HarmonicGuess& guess, const HarmonicBalanceOptions& options) {
    try {
      const HarmonicBalance found = harmonic_balance(ask_.loop, guess, options);
      result_.effort.count += found.evaluations;
      add(found);
    } catch (const std::invalid_argument& refused) {  // numbers of the loop beyond the range of the method
      result_.notes.push_back(failure_note(refused.what()));
    }
  }

  bool stopped() const { return ask_.stop && ask_.stop(); }

  std::vector<HarmonicGuess> guesses() {
    const auto ne = std::ssize(ask_.loop.elements);
    std::vector<HarmonicGuess> list;
    for (const Prediction& p : ask_.predicted) {
      if (p.method != df_name) continue;
      HarmonicGuess guess{p.frequency, Eigen::VectorXcd::Zero(ne), {}, {}};
      guess.first(ne - 1) = p.input_amplitude;
      // If the means cannot be determined, as for a swing clipped entirely by saturation, the search begins without
      // them.
      if (ne > 1) guess.mean = ask_.first_harmonic->mean_inputs(p.input_amplitude, p.frequency, 1e-9);
      if (!guess.mean.allFinite()) guess.mean = {};
      list.push_back(std::move(guess));
    }
    for (std::size_t i = 0; i < hunt_.cycles().size(); ++i) {
      const Cycle& cycle = hunt_.cycles()[i];
      if (!missed_by_df(i)) continue;
      if (ne == 1 && cycle.sticking_fraction < sticks_too_much) {
        // The harmonics of a known cycle, to test if the balance has a solution there.
        list.push_back({cycle.frequency(), {}, {}, {}});
        list.back().inputs.push_back(input_harmonics(cycle, 9));
      } else {
        result_.notes.push_back("harmonic balance was not tried on cycle " + std::to_string(i) +
                                (ne > 1 ? ": it has no describing-function root to start from"
                                        : ", which sticks: the Fourier ripple exceeds the pre-sliding displacement"));
      }
    }
    return list;
  }

  bool missed_by_df(std::size_t cycle) const {
    return std::ranges::none_of(ask_.predicted,
                                [&](const Prediction& p) { return p.method == df_name && p.cycle == cycle; });
  }

  void add(const HarmonicBalance& found) {
    if (found.harmonics == 0 || !(found.residual < 1e-6) || !(found.first_harmonic > 0.0)) {
      result_.notes.push_back("harmonic balance found no solution from one of its starts: " + found.why);
      return;
    }
    // Harmonics that still change the answer by more than a verdict allows have not converged.
    if (found.status != Status::converged && !(found.change < settled)) {
      result_.notes.push_back("harmonic balance gives no prediction from one of its starts: with " +
                              std::to_string(found.harmonics) +
                              " harmonics, amplitude and frequency have not converged; " + found.why);
      return;
    }
    Prediction p;
    p.method = balance_name;
    p.amplitude = found.first_harmonic;
    p.frequency = found.frequency;
    p.input_amplitude = std::abs(found.inputs.back()(1));
    p.residual = found.residual;
    p.harmonics = found.harmonics;
    const auto same = [&](const Prediction& q) {
      return std::abs(q.frequency / p.frequency - 1.0) < 1e-6 && std::abs(q.amplitude / p.amplitude - 1.0) < 1e-6;
    };
    if (std::ranges::any_of(result_.predictions, same)) return;
    conclude(p, found);
    result_.predictions.push_back(std::move(p));
  }

  void conclude(Prediction& p, const HarmonicBalance& found) {
    if (!nearest(hunt_.cycles(), p)) {
      const double late = ask_.in_time.states() == ask_.loop.states() ? ask_.loop.delay : 0.0;
      const auto states = [&](double phase) { return linear_states(ask_.in_time, found, phase, late); };
      hunt_.shoot_from(guess_orbit(ask_.in_time, states, p.frequency, symmetry(ask_.in_time).has_value()));
    }
    if (const auto cycle = nearest(hunt_.cycles(), p))
      compare(p, hunt_.cycles(), *cycle);
    else
      p.why = "no cycle was found near it";
    if (!found.why.empty()) p.why += "; " + found.why;
  }

  const BalanceQuestion& ask_;
  CycleHunt& hunt_;
  BalancePredictions result_;
};

}  // namespace

BalancePredictions balance_predictions(const BalanceQuestion& question, CycleHunt& hunt) {
  return BalanceStudy(question, hunt).run();
}

}  // namespace limcycle
