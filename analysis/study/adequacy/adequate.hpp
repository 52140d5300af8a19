#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/adequacy/method_answers.hpp"
#include "limcycle/analysis/study/adequacy/simplified_laws.hpp"
#include "limcycle/analysis/study/precision/cycle_reference.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"

namespace limcycle {

/// The scene with other parameters.
struct SceneVariation {
  std::string name;  ///< "Fs -10 %", "friction.Fs = 1.4, controller.kd = 5"
  LoopParts parts;   ///< with friction
};

/// Options of adequate(): tolerance, and the variations tested.
struct AdequateOptions {
  double tolerance = 0.05;                 ///< on period and amplitude, relative
  double spread = 0.1;                     ///< relative change of each parameter of the law, one at a time; 0: none
  std::vector<SceneVariation> variations;  ///< unless empty, used instead of that spread
  std::string spread_rule;                 ///< how they were chosen, as text
  double patience = 2.0;                   ///< CPU seconds for one answer other than the reference
  int threads = 0;                         ///< 0: one per core
  PredictOptions predict;                  ///< search box, starts; stop: called by several threads at once
  std::function<void(double, std::string_view)> progress;
};

/// One law with one method.
struct AdequatePoint {
  std::string law, method;
  MethodAnswer answer;       ///< at the case's own values
  double error = not_known;  ///< there, relative to the best available; infinite: another verdict
  double worst = not_known;  ///< over the spread; NaN: not computed, since it fails before
  std::string worst_at;      ///< where in the spread
  bool within = false;       ///< everywhere within the tolerance
  std::string why;           ///< unless within: the reason, one sentence
};

/// Results of adequate(): the simplest adequate law, the cheapest method, and everything that was tried.
struct AdequateReport {
  MethodAnswer best;     ///< of the case's own law by shooting
  std::string verified;  ///< how it is confirmed, as text; empty: it is not
  std::vector<SimplifiedLaw> laws;
  std::vector<AdequatePoint> points;
  std::vector<std::string> spread;      ///< what was varied
  std::string spread_rule;              ///< by which rule, as text; empty: nothing was
  std::optional<std::size_t> least;     ///< index of the simplest adequate law
  std::optional<std::size_t> cheapest;  ///< index of its cheapest point
  double tolerance = 0.05;
  std::vector<std::string> notes;
  Status status = Status::converged;
  std::string why;  ///< unless converged: one sentence
};

/// The simplest law and the cheapest method that give the same answer for this loop as its own law, solved by shooting:
/// verdict, period, amplitude and stability of its (largest) stable cycle, at the case's own values and over a spread:
/// the given variations, or else each parameter of the law increased and decreased. Laws are made by simplified_laws;
/// only the friction is exchanged. A law is adequate if shooting with it stays within the tolerance; then all methods
/// are tested with that law.
///
/// Throws std::invalid_argument if the loop has no friction. Status no_cycle never; undefined: the case's own law gives
/// no confirmed answer to compare with; interrupted: what was computed until then is kept. Cost: some seconds per law
/// for the methods, and a simulation for each law, number and direction.
AdequateReport adequate(const LoopParts& parts, const AdequateOptions& options);

}  // namespace limcycle
