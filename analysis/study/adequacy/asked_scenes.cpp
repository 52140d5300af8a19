#include "limcycle/analysis/study/adequacy/asked_scenes.hpp"

#include <algorithm>
#include <stdexcept>

#include "limcycle/models/delay.hpp"

namespace limcycle {

bool same_law(const Element& a, const Element& b) {
  return a.is_of_kind_of(b) && !a.parameters().empty() && a.values() == b.values();
}

Loop scene_loop(const LoopParts& parts, const Element& law) {
  LoopParts changed = parts;
  changed.friction = law;
  const Loop loop = build_loop(changed);
  return loop.delay == 0.0 ? loop : in_time_domain(loop, 6).loop;
}

AskedScenes::AskedScenes(PredictOptions options, double patience) : options_(std::move(options)), patience_(patience) {}

AskedScenes::Scene& AskedScenes::scene(std::size_t place, const LoopParts& parts, const Element& law) {
  const std::lock_guard lock(mutex_);
  const auto known =
      std::ranges::find_if(scenes_, [&](const Scene& one) { return one.place == place && same_law(one.law, law); });
  if (known != scenes_.end()) return *known;
  Scene& made = scenes_.emplace_back(place, law);
  try {
    made.questions.emplace(scene_loop(parts, law), options_);
  } catch (const std::invalid_argument& error) {
    made.why = error.what();
  }
  return made;
}

const MethodAnswer& AskedScenes::ask(const std::string& method, std::size_t place, const LoopParts& parts,
                                     const Element& law) {
  Scene& asked = scene(place, parts, law);
  const std::lock_guard lock(asked.mutex);
  if (const auto known = asked.answers.find(method); known != asked.answers.end()) return known->second;
  return asked.answers[method] = asked.questions ? asked.questions->ask(method, patience_) : unanswered(asked.why);
}

void AskedScenes::keep(const std::string& method, std::size_t place, const LoopParts& parts, const Element& law,
                       MethodAnswer answer) {
  Scene& asked = scene(place, parts, law);
  const std::lock_guard lock(asked.mutex);
  asked.answers[method] = std::move(answer);
}

}  // namespace limcycle
