#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/root_search.hpp"
#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/trust.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Initial displacements of y from which a loop is tried: the largest amplitude of interest and smaller ones, one and
/// then two decades apart, as far as they are of interest. `unit`: amplitude of y per input of the element (see
/// output_per_input).
std::vector<double> start_displacements(double unit, const SearchBox& box, int starts);

/// Box chosen from the loop's own scales: the response to the element's output level over the band of the loop's poles.
SearchBox default_search_box(const Loop& loop);

/// Methods that predict; all of them are checked against the cycles that are really there.
struct Methods {
  bool describing_function = true;
  bool composite = true;         ///< mass + friction as one element
  bool harmonic_balance = true;  ///< from each root of the others, and from cycles that they missed
};

/// What predict() is asked beside the loop.
struct PredictOptions {
  Methods methods;
  std::optional<SearchBox> search;  ///< default: default_search_box
  int starts = 4;                   ///< simulations from different initial states
  double accuracy = 1e-8;           ///< wanted relative error of period and amplitude of a cycle
  bool nyquist = true;              ///< the curves for the picture too
  std::function<bool()> stop;       ///< asked often, by several threads; true ends the work and keeps what is there
  std::function<void(double, std::string_view)> progress;  ///< fraction done (0..1), what is being done
};

/// What a prediction turned out to be worth.
enum class Verdict { confirmed, biased, wrong, undecided };  // "wrong" is printed "false"

/// A cycle that a method predicts.
struct Prediction {
  std::string method = "describing-function";
  double amplitude = 0.0;        ///< of y's first harmonic
  double frequency = 0.0;        ///< rad/s
  double input_amplitude = 0.0;  ///< of the element's input
  double residual = 0.0;         ///< of the method's own equation at the root
  std::optional<bool> stable;    ///< Loeb's rule; empty if it does not decide, or for harmonic balance
  Verdict verdict = Verdict::undecided;
  std::optional<std::size_t> cycle;  ///< index of the matching cycle
  std::string why;                   ///< one sentence
  int harmonics = 1;                 ///< that the method balances
  std::optional<Trust> trust{};      ///< what the assumptions of the method are worth here, before any check in time
};

/// What a simulation from one start reached.
struct OutcomeOfStart {
  std::string start;  ///< the initial state in words
  Outcome outcome = Outcome::undecided;
  std::string why;  ///< one sentence
  std::optional<std::size_t> cycle;
  Trace trace;                                 ///< the run, for pictures
  double time = 0.0;                           ///< simulated, s
  long steps = 0;                              ///< of the integrator
  std::string by{};                            ///< as in Settled
  double half_range = 0.0, mean_period = 0.0;  ///< of an irregular motion, as in Settled
};

/// What a method had to do, in the unit in which its work is counted. Times are not told here: results do not depend on
/// how fast they come.
struct Effort {
  std::string method;
  long count = 0;
  std::string unit;  ///< plural: "return maps"; empty: the work is not counted
};

/// A cycle that a method overlooked.
struct Missed {
  std::string method;
  std::size_t cycle;
};

/// Nyquist curve of the linear part and the -1/N family, for the picture.
struct NyquistPicture {
  std::vector<double> frequency;
  std::vector<std::complex<double>> G;
  std::vector<double> family_amplitude;  ///< amplitudes along each member
  std::vector<double> family_frequency;  ///< one member per frequency
  std::vector<std::vector<std::complex<double>>> minus_inverse_N;
};

/// Both curves over the search box, finer where G turns fast; where an amplitude or frequency belongs to a root, the
/// curves have a point there. G is that of small motions: other elements of the loop, and gravity, change it with the
/// amplitude. Points where N or G does not exist are NaN or left out. `stop` is asked between points: when it returns
/// true the curves end there.
NyquistPicture nyquist_picture(const Loop& loop, const SearchBox& box, const std::vector<SearchPoint>& roots = {},
                               const std::function<bool()>& stop = {});

/// What predict() answers: cycles, predictions with verdicts, outcomes of simulations.
struct PredictReport {
  SearchBox search;
  std::vector<Cycle> cycles;
  std::vector<Prediction> predictions;
  std::vector<Missed> missed;
  std::vector<OutcomeOfStart> outcomes;
  std::vector<std::string> unfinished{};  ///< methods whose search was interrupted: they may predict more
  std::vector<std::string> incomplete{};  ///< methods whose search left something undecided (see the notes): likewise
  NyquistPicture nyquist;
  std::optional<Absence> absence{};  ///< loops with a slope-bounded element without any root: is that proved?
  std::vector<std::string> notes;    ///< what a user must know: methods that do not apply, searches that are incomplete
  Status status = Status::converged;
  std::vector<Effort> efforts{};  ///< of the methods that ran, beside those of the outcomes
};

/// Every limit cycle that the methods predict in the search box, what really happens from several starts and near every
/// prediction, and a verdict for each.
PredictReport predict(const Loop& loop, const PredictOptions& options = {});

std::string_view to_string(Verdict verdict);

}  // namespace limcycle
