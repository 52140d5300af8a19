#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/energy/bounds.hpp"
#include "limcycle/analysis/energy/loop_dissipation.hpp"
#include "limcycle/analysis/energy/passivity.hpp"
#include "limcycle/analysis/energy/threshold.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// One number of the element over which passivity is asked.
struct PassivityRange {
  std::string key;  ///< "vd"
  double from = 0.0, to = 0.0;
};

/// What dissipativity() is asked beside the loop.
struct DissipativityOptions {
  double speed = 1.0;                   ///< |v| up to which the force is bounded, m/s
  PassivityOptions passivity;           ///< top speed of the motions that energy may be taken by, seed, stop, progress
  std::optional<PassivityRange> range;  ///< look for the values at which passivity changes
  PredictOptions predict;               ///< what a proof that there is no cycle is held against
};

/// The least sigma2 with which the law is passive.
struct SigmaThreshold {
  double value = 0.0, error = 0.0;  ///< N s/m; infinite: none is enough
};

/// Everything that energy says of a law and its loop.
struct DissipativityReport {
  std::string kind, path;             ///< of the element: "lugre", "loop.friction"
  bool friction = true;               ///< else its input and output are what supply is made of
  std::vector<std::string> states;    ///< names
  std::optional<Bounds> over_all;     ///< over all motions up to the top speed; friction only
  std::optional<Bounds> up_to_speed;  ///< over those up to `speed`, for the force
  Passivity passivity;
  double top_speed = infinite;
  std::optional<SigmaThreshold> threshold;  ///< if the law has a sigma2 and the answer is known
  std::optional<PassiveSpeed> passive_speed;
  std::optional<Threshold> range;  ///< over options.range
  std::optional<PassivityRange> asked;

  std::optional<LoopDissipation> loop;  ///< of a loop with this element
  std::string speed_of_sliding;         ///< path of the speed that `sliding_changes` are about; empty: there is none
  std::vector<HopfPoint> sliding_changes;
  std::optional<bool> agrees;  ///< with predict(), where the loop is proved to have no cycle
  std::vector<std::string> notes;
  Status status = Status::converged;
};

/// What energy has to say of an element alone.
DissipativityReport dissipativity(const Element<double>& element, const std::string& path,
                                  const DissipativityOptions& options);

/// The same of the friction law of a loop, or of its forward element where there is none, and what follows for the
/// loop. A proof that there is no cycle is held against predict(). Throws std::invalid_argument for a loop without
/// either.
DissipativityReport dissipativity(const LoopParts& parts, const DissipativityOptions& options);

}  // namespace limcycle
