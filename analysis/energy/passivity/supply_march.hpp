#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/analysis/motion/field/element_slopes.hpp"
#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

class ControlledRodas5p;

/// The signal whose product with an element's output is a power: the velocity of a friction law, the input of another
/// element.
enum class DrivenBy { velocity, input };
DrivenBy port_of(const Element& element);

/// A piece of a signal, linear from one value to the other.
struct SignalPiece {
  double duration = 0.0, from = 0.0, to = 0.0;
};
/// The pieces between the points of a cycle, without jumps, and back.
std::vector<SignalPiece> pieces_of(const VelocityCycle& cycle);
VelocityCycle cycle_of(std::span<const SignalPiece> pieces);

/// State of an element in a prescribed motion.
struct ElementPoint {
  std::vector<double> z;
  Mode mode{};
  double x = 0.0;       ///< displacement; only for DrivenBy::velocity
  double signal = 0.0;  ///< the signal at this point
};

/// Marches one element through a prescribed signal and adds up the energy supplied to it, the integral of signal times
/// output: RODAS5P on the states and the energy together, so that creeping for hours costs no more than a fast step;
/// switches are located by repeating the step, exact to rounding. Errors per step: rtol relative; for the states also
/// rtol of their scales. One object serves one thread.
class SupplyMarch {
 public:
  SupplyMarch(const Element& element, double rtol);
  ~SupplyMarch();

  const Element& element() const { return element_; }
  DrivenBy port() const { return port_; }

  /// The element without history, before that piece.
  ElementPoint virgin(const SignalPiece& first) const;
  /// Input of the element at time t of a piece that began at displacement x.
  Input<double> input(const SignalPiece& piece, double t, double x) const;
  /// True if the mode does not last at that input.
  bool switches(const Input<double>& in, const ElementPoint& at) const { return fired(in, at) >= 0; }
  /// Jumps to the beginning of the piece: the signal changes at once, then follows the piece, and the element is in the
  /// mode that lasts there. False: it switches without end.
  bool settle(const SignalPiece& piece, ElementPoint& at) const;
  /// Carries the element over a piece and adds to supplied() and turnover().
  Status cross(const SignalPiece& piece, ElementPoint& at);

  double supplied() const { return supplied_; }  ///< J, since restart()
  double turnover() const { return turnover_; }  ///< J, sum of the absolute supply of each step
  void restart() { supplied_ = turnover_ = 0.0; }

  /// Called after every step and every switch, with the energy supplied so far.
  std::function<void(const Input<double>&, const ElementPoint&, double supplied)> watch;

 private:
  struct Field;
  int fired(const Input<double>& in, const ElementPoint& at) const;
  bool settle_at(const Input<double>& in, ElementPoint& at) const;
  Status cross_smooth(const SignalPiece& piece, ElementPoint& at);
  double locate(const Field& field, double h, int& which);
  Status step(const Field& field, double& t, double& h, int& fired);
  double first_step(const SignalPiece& piece, const ElementPoint& at) const;

  Element element_;
  DrivenBy port_;
  ElementSlopes slopes_;
  std::unique_ptr<ControlledRodas5p> stepper_;
  std::vector<double> guards_;
  State x_, end_, trial_, error_;
  double supplied_ = 0.0, turnover_ = 0.0;
};

/// Energy of one cycle of a periodic signal.
struct CycleSupply {
  Status status = Status::max_iterations;  ///< converged: the state repeats
  double supplied = 0.0, turnover = 0.0;   ///< J per cycle
  ElementPoint begin;                      ///< at the beginning of a cycle in the periodic state
  std::vector<double> total;               ///< total supplied after each cycle, from the element without history
};

/// Marches cycle by cycle from the element without history until the state repeats itself to `repeats` of its scales.
CycleSupply periodic_supply(SupplyMarch& march, std::span<const SignalPiece> pieces, int most_cycles, double repeats);

}  // namespace limcycle
