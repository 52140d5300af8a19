#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/balance/trust.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Initial displacements of y from which a loop is tried: the largest amplitude of interest and smaller ones, one and
/// then two decades apart, if they are of interest. `unit`: amplitude of y per input of the element (see
/// output_per_input).
std::vector<double> start_displacements(double unit, const SearchBox& box, int starts);

/// Box chosen from the loop's own scales: the response to the element's output level over the band of the loop's poles.
SearchBox default_search_box(const Loop& loop);

/// Methods that predict; all of them are compared with the true cycles.
struct Methods {
  bool describing_function = true;
  bool composite = true;         ///< mass + friction as one element
  bool harmonic_balance = true;  ///< from each root of the others, and from cycles that they miss
};

struct OutcomeOfStart;

/// Options of predict().
struct PredictOptions {
  Methods methods;
  std::optional<SearchBox> search;                      ///< default: default_search_box
  int starts = 4;                                       ///< simulations from different displacements of y
  bool load_step = true;                                ///< and one from the release of a load: see load_step()
  double accuracy = 1e-8;                               ///< wanted relative error of period and amplitude of a cycle
  long max_readings = 5'000'000;                        ///< from one start of a sampled loop, see SettleOptions
  std::function<bool(const OutcomeOfStart&)> enough{};  ///< true of an outcome: nothing more is simulated or predicted
  std::function<bool()> stop;  ///< called often, by several threads; true ends the work and keeps the results
  std::function<void(double, std::string_view)> progress;  ///< fraction done (0..1), current activity
};

/// Verdict on a prediction.
enum class Verdict { confirmed, biased, wrong, undecided };  // "wrong" is printed "false"

/// Standard deviations, or half-widths, relative, of a root.
struct RootSpread {
  double amplitude = 0.0, frequency = 0.0;
};

/// A cycle that a method predicts.
struct Prediction {
  std::string method = "describing-function";
  double amplitude = 0.0;        ///< of y's first harmonic
  double frequency = 0.0;        ///< rad/s
  double input_amplitude = 0.0;  ///< of the element's input
  double residual = 0.0;         ///< of the method's own equation at the root
  std::optional<bool> stable;    ///< Loeb's rule; empty if it does not decide, or for harmonic balance
  Verdict verdict = Verdict::undecided;
  std::optional<std::size_t> cycle;         ///< index of the matching cycle
  std::string why;                          ///< one sentence
  int harmonics = 1;                        ///< number of harmonics that the method balances
  std::optional<Trust> trust{};             ///< assessment of the method's assumptions here, before any check in time
  std::optional<RootSpread> spread{};       ///< of measured plants; empty if their data state no uncertainty
  std::optional<IrregularMotion> motion{};  ///< of a sampled loop: what it refers to, if that is locked to no sample
  std::optional<RootSpread> sampling{};     ///< half-widths by the instants of the samples, see sampling_band()
};

/// Outcome of a simulation from one start.
struct OutcomeOfStart {
  std::string start;  ///< the initial state as text
  Outcome outcome = Outcome::undecided;
  std::string why;  ///< one sentence
  std::optional<std::size_t> cycle;
  Trace trace;                  ///< the run, for figures
  double time = 0.0;            ///< simulated, s
  long steps = 0;               ///< of the integrator
  std::string by{};             ///< as in Settled
  IrregularMotion irregular{};  ///< likewise
  bool probe = false;           ///< from a state that no user would choose (see CycleHunt::probe_from)
};

/// Work of a method, in the unit in which it is counted. Times are not given here: results do not depend on the time
/// taken.
struct Effort {
  std::string method;
  long count = 0;
  std::string unit;  ///< plural: "return maps"; empty: the work is not counted
};

/// A cycle that a method missed.
struct Missed {
  std::string method;
  std::size_t cycle;
};

/// Nyquist curve of the linear part and the -1/N family, for the figure.
struct NyquistPicture {
  std::vector<double> frequency;
  std::vector<std::complex<double>> G;
  std::vector<double> family_amplitude;  ///< amplitudes along each member
  std::vector<double> family_frequency;  ///< one member per frequency
  std::vector<std::vector<std::complex<double>>> minus_inverse_N;
};

/// Why a loop hunts: see cause_of().
struct HuntingCause {
  std::string kind;  ///< "integral-action-and-stiction"
  std::string why;   ///< one sentence
};

/// Results of predict(): cycles, predictions with verdicts, outcomes of simulations.
struct PredictReport {
  SearchBox search;
  std::vector<Cycle> cycles;
  std::vector<Prediction> predictions;
  std::vector<Missed> missed;
  std::vector<OutcomeOfStart> outcomes;
  std::vector<std::string> unfinished{};  ///< methods whose search was interrupted: they may predict more
  std::vector<std::string> incomplete{};  ///< methods whose search left something undecided (see the notes): likewise
  bool describing_function = false;       ///< that of the main element exists in the box, and its roots were looked for
  NyquistPicture nyquist;                 ///< filled by those who draw it, with nyquist_picture(); predict() does not
  std::optional<Absence> absence{};  ///< loops with a slope-bounded element without any root: proof of absence, if any
  std::vector<std::string> notes;    ///< notes for the user: methods that do not apply, incomplete searches
  Status status = Status::converged;
  double sample_time = 0.0;             ///< of a sampled controller, s; 0: it is continuous
  std::optional<HuntingCause> cause{};  ///< filled by those who ask for it; predict() leaves it empty
  std::vector<Effort> efforts{};        ///< of the methods that ran, without those of the outcomes
};

/// Every limit cycle that the methods predict in the search box, the true behaviour from several starts and near every
/// prediction, and a verdict for each.
PredictReport predict(const Loop& loop, const PredictOptions& options = {});

std::string_view to_string(Verdict verdict);

}  // namespace limcycle
