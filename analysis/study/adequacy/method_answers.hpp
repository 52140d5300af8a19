#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Answer of a method for a loop: hunting or not, with its period and amplitude.
struct MethodAnswer {
  bool answered = false;
  std::string verdict;                   ///< "cycle", "rest", ...; joined by "/" if starts end differently
  double period = 0.0, amplitude = 0.0;  ///< of the stable cycle, if there is one
  double first_harmonic = 0.0;           ///< of y on it
  std::optional<Cycle> cycle;            ///< the cycle itself, if it was simulated
  double error = 0.0;                    ///< own estimate, relative
  double seconds = 0.0;                  ///< CPU
  std::string why;                       ///< unless answered: one sentence
  bool hunts() const { return ("/" + verdict + "/").find("/cycle/") != std::string::npos; }
};

/// The ladder of methods, simplest first. A first-harmonic method answers "no cycle" if it finds no stable oscillation,
/// and otherwise gives the first harmonic. Harmonic balance starts from the roots of either, and adopts their
/// stability. "simulation" is a plain one that runs until its swings repeat; "shooting" simulates until the motion is
/// near a cycle and solves for it.
const std::vector<std::string>& answering_methods();

/// Verdict of methods that do not distinguish rest from steady sliding.
inline constexpr std::string_view no_cycle_verdict = "no cycle";

/// "cycle/rest" of ends in any order, possibly repeated.
std::string joined_verdict(std::vector<std::string> ends);

/// No answer, with the reason.
MethodAnswer unanswered(std::string why);
/// The same for a method that was not run: it has no CPU time.
MethodAnswer not_asked(std::string why);

/// Several methods applied to one loop. Roots that harmonic balance starts from are searched once for it and for the
/// method that predicts them; the CPU time of either answer includes their search.
class MethodQuestions {
 public:
  /// `options`: search box, starts, stop.
  MethodQuestions(Loop loop, PredictOptions options);

  /// `patience`: CPU seconds after which the method is stopped without an answer.
  MethodAnswer ask(const std::string& method, double patience = infinite);

  /// An oscillation that a first-harmonic method predicts.
  struct Oscillation {
    double amplitude = 0.0, frequency = 0.0, input_amplitude = 0.0;
    std::optional<bool> stable;
  };
  /// All oscillations found by one method.
  struct Roots {
    std::vector<Oscillation> list;
    bool answered = false;     ///< the method applies and its search was complete
    bool interrupted = false;  ///< its search was interrupted
    std::string why;           ///< unless answered
    double seconds = 0.0;      ///< CPU
  };

 private:
  MethodAnswer answer_by(const std::string& method, const PredictOptions& options);
  const Roots& roots(std::optional<Roots>& known,
                     const std::function<Roots(const Loop&, const PredictOptions&)>& search,
                     const PredictOptions& options);

  Loop loop_;
  PredictOptions options_;
  std::optional<Roots> describing_function_, composite_;
  double borrowed_ = 0.0;  ///< CPU seconds of roots found earlier
  double patience_ = infinite;
};

/// Applies one of the methods, once. `options`: search box, starts, stop.
MethodAnswer ask_scene(const std::string& method, const Loop& loop, const PredictOptions& options);

/// Largest relative difference of period and amplitude (for first-harmonic methods: of the first harmonic), infinite if
/// the verdicts differ, NaN if there is no answer.
double scene_error(const std::string& method, const MethodAnswer& answer, const MethodAnswer& best);

}  // namespace limcycle
