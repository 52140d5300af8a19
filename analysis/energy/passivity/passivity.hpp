#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

enum class Passive { yes, no, undecided };
std::string_view to_string(Passive passive);

/// A periodic velocity (m/s): piecewise linear through (time, velocity), the first time being 0 and the last one the
/// period. Two equal times make a jump. After the last point the first one follows, by a jump if they differ.
struct VelocityCycle {
  std::vector<double> time, velocity;
  double period() const { return time.back(); }
  double at(double t) const;  ///< right-hand value; t is taken modulo the period
};

/// A motion that takes energy out of a law, cycle after cycle.
struct Counterexample {
  VelocityCycle input;
  std::vector<double> z0;  ///< state at the beginning of the periodic motion
  Mode mode0{};
  double energy = 0.0;          ///< taken out per cycle in the periodic state, J, > 0
  double error = 0.0;           ///< estimated, of `energy`, J
  std::vector<double> taken{};  ///< from the law without history: total after each cycle, J; grows without bound
  double lead_velocity = 0.0;  ///< at which the law without history is first brought to z0, m/s; its cost is in `taken`
  double lead_time = 0.0;      ///< s; 0: the cycles begin at once
  double confirmed = 0.0;      ///< taken out per cycle in the independent simulation, J
  std::string words;           ///< the motion described in a sentence
};

/// Options of passivity().
struct PassivityOptions {
  double top_speed = infinite;  ///< largest |v| of the inputs, m/s
  double accuracy = 1e-6;       ///< relative, of numbers found by search
  std::uint64_t seed = 0;       ///< of searches
  int effort = 1;               ///< factor on the usual number of tries of a search
  std::function<bool()> stop;
  std::function<void(double, std::string_view)> progress;
};

/// Condition on the storage of a law with one state (for figures and for checks): its slope dS/dz lies between `least`
/// and `most` at every z if the law is passive; `available` is the energy that can be taken out from there, J.
struct StorageCurve {
  std::vector<double> z, least, most, available;
};

/// Verdict on unlimited extraction of energy from a law (Willems 1972: passive if and only if the available storage sup
/// -int F v dt is finite).
struct Passivity {
  Passive passive = Passive::undecided;
  std::string method;     ///< "storage over the state", "storage function of the law", "search", ...
  std::string why;        ///< one sentence
  double deficit = 0.0;   ///< J taken out per cycle by the counter-example; 0 if passive, NaN if undecided
  double searched = 0.0;  ///< least energy supplied per cycle, J, by all inputs that a search tried; NaN without one
  std::optional<Counterexample> counterexample{};
  std::optional<StorageCurve> storage{};
  Status status = Status::converged;
};

/// Passivity of a friction law from v to F, or of another element from its input to its output.
Passivity passivity(const Element& law, const PassivityOptions& options = {});

}  // namespace limcycle
