#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// What a method says of a loop: does it hunt, and how.
struct SceneAnswer {
  bool answered = false;
  std::string verdict;                   ///< "cycle", "rest", ...; joined by "/" where starts end differently
  double period = 0.0, amplitude = 0.0;  ///< of the stable cycle, if there is one
  double first_harmonic = 0.0;           ///< of y on it
  std::optional<Cycle> cycle;            ///< itself, if it was simulated
  double error = 0.0;                    ///< own estimate, relative
  double seconds = 0.0;                  ///< CPU
  std::string why;                       ///< unless answered: one sentence
  bool hunts() const { return ("/" + verdict + "/").find("/cycle/") != std::string::npos; }
};

/// The ladder of methods, least first. A first-harmonic method says "no cycle" where it sees no stable oscillation,
/// and answers with the first harmonic. Harmonic balance begins from the roots of either, and takes over their
/// stability. "simulation" is a plain one that runs until its swings repeat; "shooting" simulates until the motion is
/// near a cycle and solves for it.
const std::vector<std::string>& scene_methods();

/// Asks one of them. `options`: search box, starts, stop.
SceneAnswer ask_scene(const std::string& method, const Loop& loop, const PredictOptions& options);

/// What harmonic balance says where neither describing function predicts a cycle: nothing.
SceneAnswer balance_without_start();

/// Largest relative difference of period and amplitude (for first-harmonic methods: of the first harmonic), infinite
/// where the verdicts differ, NaN where there is no answer.
double scene_error(const std::string& method, const SceneAnswer& answer, const SceneAnswer& best);

}  // namespace limcycle
