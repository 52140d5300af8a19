#pragma once
#include <complex>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/frequency/composite/composite_describing_function.hpp"
#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A cycle that the balance 1 - K N = 0 predicts.
struct CompositeRoot {
  double amplitude = 0.0;          ///< of y's first harmonic
  double frequency = 0.0;          ///< rad/s
  double force = 0.0;              ///< U: first harmonic of the force on mass and friction, N
  double bias = 0.0;               ///< U0: its mean, N
  double input_amplitude = 0.0;    ///< of the rubbing displacement's first harmonic, m
  double sticking_fraction = 0.0;  ///< share of the period
  double residual = 0.0;           ///< |1 - K N|
  int index = 0;                   ///< +1: stable by Loeb's rule, -1: unstable
  std::optional<bool> stable;      ///< Loeb's rule with the other closed-loop roots; empty if it does not decide
  /// N jumps here from pre-sliding to full slip, and the balance holds somewhere in the jump: first harmonics are
  /// hardly a prediction then (see `note`). Amplitude and frequency only mark the place.
  bool on_break_away_front = false;
  std::string note;  ///< one sentence, or empty
};

/// Settings of the search of the composite balance.
struct CompositeSearchOptions {
  double frequency_min = 0.01, frequency_max = 1000.0;  ///< rad/s
  double force_min = 0.0, force_max = 0.0;              ///< N; 0: 0.2 and 100 times the level of the friction
  double coarse_accuracy = 1e-3;                        ///< of N in the search, 1e-8..1e-2
  double accuracy = 1e-8;                               ///< of N at a root, 1e-10..1e-4
  /// Of the integrator, for the whole search of a law with one state, some seconds; in inverse proportion to the number
  /// of unknowns of laws with more.
  long max_steps = 2'000'000;
  std::function<bool()> stop;  ///< called often; true ends the search
};

/// All roots found by a search of the composite balance.
struct CompositeSearch {
  std::vector<CompositeRoot> roots;  ///< sorted by frequency
  std::vector<std::string> notes;    ///< limitations of the search, for the user
  long evaluations = 0;              ///< of N
  long steps = 0;                    ///< of the integrator
  Status status = Status::no_cycle;  ///< converged, no_cycle; incomplete: roots may be missing; interrupted
};

/// First-harmonic balance with mass and friction as one element (Olsson 1995, 1996): u = K x describes the rest of the
/// loop, x = N(U, w) u the pair, so 1 - K(jw) N = 0. With the closed-loop response H from the friction force to the
/// rubbing displacement, K = 1/H + m s^2, with m the mass at the friction: -1/(C_v B_f). A delay is exact.
///
/// Accuracy, measured against the exact cycles (m = 1 kg; frequency in rad/s, first harmonic of y in m; "jump":
/// on_break_away_front). Coulomb's law with its Fs/Fc unless stated otherwise:
///
///   loop                               exact cycle        composite DF
///   PID 3,4,6  1.5/1                   0.2689  0.0846     0.605  0.354  jump
///   PID 3,4,6  1.5/1  sigma2 = 0.4     0.2617  0.0826     0.563  0.314  jump
///   PID 3,4,6  LuGre 1.5/1 (default)   0.2571  0.0804     0.565  0.313  jump
///   PID 3,4,6  Stribeck vs = 1e-3      0.2722  0.0862     0.607  0.357  jump
///   PID 3,4,6  1.1/1  sigma2 = 0.4     0.0740  0.0167     0.366  0.121
///   PID 3,4,6  1/1                     none (it rests)    0.314  0.094  invented
///   PID 3,4,2  1.5/1                   0.4999  0.1550     0.848  0.358
///   PID 3,1,6  1.5/1                   0.0802  0.0895     0.229  0.354  jump
///   PD 3,6     1.5/1                   none (it rests)    none
///   belt k = 2, 0.1 m/s  1.5/1         0.8255  0.2173     0.624  0.250  jump, bias -1 N
///   belt, LuGre 1.5/1 sigma2 = 0.4     0.9875  0.1693     undecided (Status::incomplete)
///
/// So it finds hunting, which the friction-only balance misses, but 1.7 to 5 times too fast and 2 to 7 times too large,
/// and it does not distinguish hunting from coming to rest: the force on a mass that sticks under integral action is a
/// ramp, not a sine. On the belt it is 15 to 25 % off. Use it as a warning and a starting point.
class CompositeBalance {
 public:
  /// Reason why the method does not apply to this loop, or nothing.
  static std::optional<std::string> not_applicable(const Loop& loop);

  /// Keeps a reference to the loop. Throws std::invalid_argument if the method is not applicable.
  explicit CompositeBalance(const Loop& loop);

  /// 1 - K(jw) N(U, w); NaN if there is no periodic response.
  std::complex<double> operator()(double force, double frequency, double accuracy);
  /// K(jw): from the rubbing displacement to the force on mass and friction, N/m.
  std::complex<double> rest_of_loop(double frequency) const;
  /// The periodic response itself.
  CompositeResponse response(double force, double frequency, const CompositeOptions& options);

  const Loop& loop() const { return *loop_; }
  double mass() const { return mass_; }
  double mean_velocity() const { return mean_velocity_; }

  /// All roots in the range. The jump of N at break-away (Fs > Fc) is a line in the plane of U and w: both sides are
  /// searched separately, and the jump itself, closed by the straight line between the two values of N, along the line.
  /// If the law is symmetric and not biased, N is passive: frequencies at which 1/K would require an active N by more
  /// than 3 degrees are omitted. Cost: about 500 evaluations, 0.03 s for Coulomb's law, 0.2 to 0.4 s for bristles;
  /// several seconds with a mean velocity.
  /// Of measured plants only the frequencies of their data are searched.
  CompositeSearch find(const CompositeSearchOptions& options = {});

  /// State of the loop on the predicted oscillation (first harmonics; velocity and law as in the periodic response), to
  /// start a simulation from.
  LoopState state(const CompositeRoot& root);

 private:
  CompositeSearch find_between(const CompositeSearchOptions& options);

  struct Front {
    double force;                       ///< where N jumps
    std::complex<double> below, above;  ///< 1 - K N on either side
    double sticking_below, sticking_above;
  };
  /// The force of the jump around a frequency: a parabola over the logarithm of the frequency.
  struct SmoothFront {
    double frequency, force, slope, bend;
  };
  struct Window {
    double low, high;
  };

  /// A response in stick-slip on a belt, closed over the jump of the mean velocity at break-away.
  struct StickSlip {
    std::complex<double> gain{};
    double bias = 0.0, sticking = 0.0;
    double share = 1.0;  ///< of the time in full stick-slip; below 1: stuck for the rest, a state inside the jump
    CompositeResponse full;
  };
  std::optional<StickSlip> stick_slip(double force, double frequency, double accuracy);
  CompositeResponse solve(double force, double frequency, double accuracy, bool estimate);
  double guess_front(double frequency) const;
  Front front(double frequency, double accuracy);
  double smooth_front(double frequency);
  std::complex<double> residue(std::complex<double> gain, double frequency) const;
  std::vector<Window> windows(const CompositeSearchOptions& options) const;
  void bound(const CompositeSearchOptions& options);
  bool ended_early(const CompositeSearchOptions& options, CompositeSearch& found) const;
  bool may_balance_below(const Window& window, const CompositeSearchOptions& options, CompositeSearch& found);
  void search_side(const Window& window, bool above, const CompositeSearchOptions& options, CompositeSearch& found);
  void search_biased(const CompositeSearchOptions& options, CompositeSearch& found);
  void search_front(const Window& window, const CompositeSearchOptions& options, CompositeSearch& found);
  double side_force(double coordinate, double frequency, bool above, double accuracy);
  void add(double force, double frequency, int index, const CompositeSearchOptions& options, CompositeSearch& found);
  CompositeRoot describe(double force, double frequency, std::complex<double> gain, int index) const;
  std::optional<bool> stable(double frequency, std::complex<double> gain, int index) const;

  const Loop* loop_;
  Eigen::Index f_ = 0;
  double mass_ = 1.0, mean_velocity_ = 0.0, level_ = 1.0;
  bool biased_ = false;
  CompositeDescribingFunction element_;
  std::optional<CompositeResponse> near_;
  std::map<std::pair<double, double>, double> fronts_;  ///< (frequency, accuracy) -> break-away force
  std::vector<SmoothFront> smooth_fronts_;
  long evaluations_ = 0;
  long last_step_ = 0;  ///< of the element, for a search that continues
};

}  // namespace limcycle
