#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/field/element_slopes.hpp"
#include "limcycle/analysis/motion/field/plain_field.hpp"
#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// External signals and their rates at time t; the default of a field is the loop's own constants.
using ExternalSignals = std::function<void(double t, External& value, External& rate)>;

/// Effect of a switch on small deviations: n the gradient of the guard, f- and f+ the rates before and after, dh the
/// derivative of the reset, including the removal of a velocity.
struct SwitchSlopes {
  Eigen::MatrixXd reset;      ///< dh
  Eigen::RowVectorXd guard;   ///< n
  Eigen::VectorXd before;     ///< f-
  Eigen::VectorXd after;      ///< f+
  double crossing = 0.0;      ///< n f-, the rate of the guard
  Eigen::MatrixXd saltation;  ///< dh + (f+ - dh f-) n/(n f-)
};

/// The vector field of a loop in its present modes, smooth as long as every guard is >= 0.
/// State: linear states, then the states of the elements in order. One object serves one thread.
///
/// An element that holds a signal (a stuck friction law, a sliding relay) outputs the drive: the outputs of all holding
/// elements are solved for together, so that the held signals have zero rate. An element that shares the selection
/// of a stuck law (Port::selection_of: a friction compensation, a second law at the same body) outputs its level times
/// the same element of Sgn(0), so it is part of that solution.
///
/// A law that needs the drive while it holds nothing (NeedsDrive: it comes last) gets it at its turn, when the rates
/// contain all other contributions. If another element holds, both are solved for together: the loop is affine in
/// holding outputs and drive.
class LoopField {
 public:
  /// Throws std::invalid_argument if an element needs the drive and is not the last.
  explicit LoopField(const Loop& loop);

  const Loop& loop() const { return *loop_; }
  std::size_t size() const { return size_; }
  std::vector<Mode>& modes() { return modes_; }
  const std::vector<Mode>& modes() const { return modes_; }
  void set_external(ExternalSignals signals) {
    signals_ = std::move(signals);
    evaluated_.known = false;
  }
  bool driven() const { return static_cast<bool>(signals_); }

  /// dx/dt. Cost O(n^2).
  void rate(const State& x, State& dx, double t);
  /// d(dx/dt)/dx and d(dx/dt)/dt, exact (dual numbers through the elements).
  void jacobian(const State& x, Eigen::MatrixXd& J, double t, State& dfdt);

  /// Number of guards in the present modes, and their values.
  std::size_t guard_count() const;
  void guards(const State& x, double t, std::vector<double>& g);
  /// Performs the switch of the guard that fired: new mode, reset states, a held signal put to exactly zero. A law that
  /// arrests the body (see arrests) first has its velocity removed along the direction of the force.
  void fire(State& x, double t, std::size_t guard);
  /// The same, and the saltation matrix S = dh + (f+ - dh f-) n/(n f-) that carries a small deviation of the state over
  /// the switch: n the gradient of the guard, f- and f+ the rates before and after, dh the derivative of the reset (di
  /// Bernardo, Budd, Champneys and Kowalczyk, Piecewise-smooth Dynamical Systems, 2008, section 2.5). On entering stick
  /// n S = 0: the rank drops by one. Autonomous loops only. Returns false (S undefined) if the switch is not crossed
  /// transversally.
  bool fire(State& x, double t, std::size_t guard, Eigen::MatrixXd& saltation);
  /// The same, with the terms of the saltation matrix.
  bool fire(State& x, double t, std::size_t guard, SwitchSlopes& slopes);
  /// Gives the velocities of bodies that are held the values that they had at the start of a step, to the last bit: on
  /// a velocity of rounding size a body that breaks away would stop again at once.
  void keep_held(const State& start, State& end) const;
  /// The element whose guard this is.
  std::size_t owner(std::size_t guard) const;
  /// Time until the next switch by an element's own clock, s; infinite without one.
  double due(const State& x) const;
  bool has_clocks() const { return !clocks_.empty(); }
  /// True if nothing changes at these rates but the states of elements with a clock.
  bool only_clocks_run(const State& dx) const;
  /// Of guards with these values, the one of the clock that runs down first.
  std::size_t clock_guard(const std::vector<double>& g) const;
  /// True if element i holds its body now, as one that sticks does.
  bool holds(std::size_t i) const { return held(i) != Held::nothing; }
  /// Modes of elements without history at this state, whose own states are set too.
  void start(State& x, double t);
  /// Changes the linear states by an impulse; a body that was held moves on with its velocity.
  void kick(State& x, double t, const Eigen::VectorXd& change);

  /// Inputs and output of element i at the last evaluated point.
  const Input<double>& input(std::size_t i) const { return inputs_[i]; }
  double output(std::size_t i) const { return w_[i]; }
  /// External signals at the last evaluated point.
  const External& external() const { return ext_; }
  double y(const State& x) const;
  double y_rate(const State& dx) const;
  /// Position of the first state of element i.
  std::size_t first_state(std::size_t i) const { return first_state_[i]; }

 private:
  void evaluate(const State& x, double t);
  void evaluate_anew(const State& x, double t);
  void sweep(const State& x);
  void solve_held(const State& x);
  void solve_with_drive(const State& x);
  Eigen::VectorXd held_and_drive(const State& x, const Eigen::VectorXd& unknowns);
  double drive_at_turn(std::size_t i) const;
  void arrest(State& x, std::size_t i);
  bool arrests_at(std::size_t i, std::size_t guard) const;
  void hold_residual(Eigen::VectorXd& residual) const;
  const Eigen::VectorXd& outputs_by_superposition(const State& x);
  double follow(std::size_t i) const;
  double follow_slope(std::size_t i) const;
  bool follows_held(std::size_t i) const;
  bool is_second_law(std::size_t i) const;
  void follow_modes();
  double full_output(std::size_t i, double sign) const;
  void look_outside(double t);
  void find_inputs(const State& x);
  double hold_row(std::size_t i, Eigen::RowVectorXd& row) const;
  std::optional<std::size_t> held_state(std::size_t i) const;
  std::vector<std::size_t> held_states() const;
  double drive_of(std::size_t i) const;
  double drive_with_follower(std::size_t i, const State& x);
  Held held(std::size_t i) const;
  bool has_own_guards(std::size_t i) const { return !loop_->ports[i].selection_of; }
  void input_gradients(std::size_t i);
  void element_gradient(std::size_t i, const State& x);
  void drive_gradient();
  void held_gradient(const State& x);
  void held_and_drive_gradient(const State& x);
  void output_gradients(const State& x);
  Eigen::RowVectorXd guard_gradient(const State& x, std::size_t i, std::size_t guard);
  Eigen::MatrixXd reset_gradient(const State& x, std::size_t i, std::size_t guard);
  std::size_t first_guard_of(std::size_t i, std::size_t guard) const;

  const Loop* loop_;
  std::optional<PlainField> plain_;  ///< implements evaluate() and jacobian() if applicable
  State plain_dx_;
  std::size_t size_ = 0;
  std::size_t n_ = 0, ne_ = 0;
  /// The states of element i within those of the loop.
  std::span<const double> own_states(const State& x, std::size_t i) const;
  std::span<double> own_states(State& x, std::size_t i) const;

  std::vector<std::size_t> first_state_;
  std::vector<ElementSlopes> slopes_;
  std::vector<bool> has_follower_;
  std::vector<std::size_t> clocks_;  ///< elements with a clock
  std::vector<Mode> modes_;
  ExternalSignals signals_;

  /// A row with few entries, without its zeros: such loops are small and evaluated millions of times.
  struct Sparse {
    std::vector<std::pair<std::size_t, double>> entries;
    explicit Sparse(const Eigen::RowVectorXd& row);
    double dot(const double* x) const {
      double sum = 0.0;
      for (const auto& [i, c] : entries) sum += c * x[i];
      return sum;
    }
  };
  struct SparsePort {
    Sparse C, D, C_v, D_v, c, c_v;
    std::vector<std::pair<std::size_t, double>> B;
    double reach = 0.0;                     ///< of the output on the rate of the signal that the element can hold
    bool reaches = false;                   ///< its output can hold that signal
    bool uses_drive = false;                ///< the element looks at it
    std::optional<std::size_t> velocity{};  ///< the state that the rate row is, to a factor, if it is one state
  };
  SparsePort sparse_port(std::size_t i) const;
  double free_rate_of_held(std::size_t i) const;
  void add_output(std::size_t i, double w);

  std::vector<Sparse> A_, E_;
  std::vector<SparsePort> ports_;
  External ext_, ext_rate_;
  std::vector<double> w_, dX_, E_ext_;
  std::vector<std::size_t> holding_;
  /// Of a loop with clocks, several of which may run down at one time: the point that is evaluated, not to do it again.
  struct Point {
    bool kept = false, known = false;
    double t = 0.0;
    State x{};
    std::vector<Mode> modes{};
  };
  Point evaluated_;
  bool followed_ = false;                  ///< one of the holding elements has a follower
  std::optional<std::size_t> asks_drive_;  ///< the element that needs the drive
  double drive_reach_ = 0.0;               ///< of its output on the rate of its velocity; < 0, or 0 if there is none
  bool coupled_ = false;                   ///< its drive is solved for together with the holding outputs
  Eigen::RowVectorXd drive_gradient_;
  Eigen::RowVectorXd input_gradient_, rate_gradient_;
  std::vector<Input<double>> inputs_;
  Eigen::MatrixXd reach_;  ///< rates of the held signals per unit of the holding outputs; of held_and_drive()
  /// Memory of what is done at every evaluation, kept for the next one.
  struct Superposition {
    Eigen::VectorXd base, side, outputs, residual;
  } superposition_;
  struct Kept {
    std::vector<double> w{}, dX{};
    std::vector<std::size_t> holding{};
    std::vector<Input<double>> inputs{};
  } kept_;
  /// Gradients over the state, and over time in the last column: of the outputs, and of the element states' rates.
  Eigen::MatrixXd w_gradient_, z_gradient_;
};

/// The loop at these linear states, its elements without history.
LoopState without_history(const Loop& loop, const Eigen::VectorXd& X);

}  // namespace limcycle
