#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/energy/loop/loop_dissipation.hpp"
#include "limcycle/analysis/energy/passivity/bounds.hpp"
#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/analysis/energy/passivity/threshold.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// A parameter of the element over whose range passivity is tested.
struct PassivityRange {
  std::string key;  ///< "vd"
  double from = 0.0, to = 0.0;
  LawFamily family = {};  ///< the element with that number; empty: family_of()
};

/// Options of dissipativity().
struct DissipativityOptions {
  double speed = 1.0;                   ///< |v| up to which the force is bounded, m/s
  PassivityOptions passivity;           ///< top speed of the motions that may take out energy, seed, stop, progress
  std::optional<PassivityRange> range;  ///< search for the values at which passivity changes
  PredictOptions predict;               ///< check of a proof that there is no cycle
};

/// The least sigma2 with which the law is passive.
struct SigmaThreshold {
  double value = 0.0, error = 0.0;  ///< N s/m; infinite: none is enough
};

/// Results of energy methods for a law and its loop.
struct DissipativityReport {
  std::string kind, path;             ///< of the element: "lugre", "loop.friction"
  bool friction = true;               ///< false: the supply is formed from its input and output
  std::vector<std::string> states;    ///< names
  std::optional<Bounds> over_all;     ///< over all motions up to the top speed; friction only
  std::optional<Bounds> up_to_speed;  ///< over those up to `speed`, for the force
  Passivity passivity;
  double top_speed = infinite;
  std::optional<SigmaThreshold> threshold;  ///< if the law has a sigma2 and the answer was determined
  std::optional<PassiveSpeed> passive_speed;
  std::optional<Threshold> range;  ///< over options.range
  std::optional<PassivityRange> asked;

  std::optional<LoopDissipation> loop;  ///< of a loop with this element
  std::string speed_of_sliding;         ///< path of the speed to which `sliding_changes` refer; empty: there is none
  std::vector<HopfPoint> sliding_changes;
  std::optional<bool> agrees;  ///< with predict(), if the loop is proved to have no cycle
  std::vector<std::string> notes;
  Status status = Status::converged;
};

/// Results of energy methods for an element alone.
DissipativityReport dissipativity(const Element& element, const std::string& path, const DissipativityOptions& options);

/// The same for the friction law of a loop, or its forward element if there is none, and the consequences for the loop.
/// A proof that there is no cycle is checked against predict(). Throws std::invalid_argument for a loop without either.
DissipativityReport dissipativity(const LoopParts& parts, const DissipativityOptions& options);

}  // namespace limcycle
