#pragma once
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "limcycle/analysis/study/adequacy/method_answers.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// True for laws of the same kind with the same parameters. False for a law without a table of parameters.
bool same_law(const Element& a, const Element& b);

/// The loop with that law as every method receives it. A delay is approximated for all of them alike, so that the
/// comparison is of methods and not of treatments of the delay.
Loop scene_loop(const LoopParts& parts, const Element& law);

/// The answers of methods for a case with other laws and other parameters, each computed once: a parameter that a law
/// does not have can be varied without changing its answer. Calls from several threads are safe; those about the same
/// law at the same place wait for each other.
class AskedScenes {
 public:
  /// `patience`: CPU seconds for one answer.
  AskedScenes(PredictOptions options, double patience);

  /// `place`: a number that identifies everything in `parts` except the friction.
  const MethodAnswer& ask(const std::string& method, std::size_t place, const LoopParts& parts, const Element& law);
  /// Stores an answer computed elsewhere.
  void keep(const std::string& method, std::size_t place, const LoopParts& parts, const Element& law,
            MethodAnswer answer);

 private:
  struct Scene {
    Scene(std::size_t place_, Element law_) : place(place_), law(std::move(law_)) {}
    std::size_t place;
    Element law;
    std::optional<MethodQuestions> questions;  ///< empty: the plant does not take this law
    std::string why;                           ///< the reason in that case
    std::map<std::string, MethodAnswer> answers;
    std::mutex mutex;  ///< of the questions and answers
  };
  Scene& scene(std::size_t place, const LoopParts& parts, const Element& law);

  PredictOptions options_;
  double patience_;
  std::deque<Scene> scenes_;
  std::mutex mutex_;  ///< of the list of scenes
};

}  // namespace limcycle
