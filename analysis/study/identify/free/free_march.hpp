#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "limcycle/analysis/dense_elimination.hpp"
#include "limcycle/analysis/motion/field/element_slopes.hpp"
#include "limcycle/analysis/study/identify/free/free_motion.hpp"
#include "limcycle/analysis/study/identify/free/number_slopes.hpp"

namespace limcycle {

/// Position and velocity of a simulated motion at the samples of a window, and their derivatives, a column for each
/// sample: a row for each number of the law, then two for the state at the start.
struct FreeRun {
  std::vector<std::ptrdiff_t> samples;
  std::vector<double> y, rate;
  Eigen::MatrixXd y_slopes, rate_slopes;
};

/// A plant with two states under one friction law, simulated with exact derivatives.
///
/// Steps are those of the three-stage Radau IIA method (order 5, L-stable: a bristle of microns does not shorten them),
/// solved by Newton's method, with the step control of Hairer and Wanner (II, 1996, section IV.8). The derivatives of
/// the stages follow from the equations that define them (implicit function theorem), so that they are those of the
/// computed motion for the same steps. Switches of the law, and reversals, at which a law may have a kink, are located
/// by repeating the step; a deviation is carried over by the saltation matrix, its own guard and numbers included. A
/// set-valued law holds its body exactly at rest. Error: below 1e-6 of the range of the motion for `fineness` 1; it
/// falls with the fourth power of `fineness`. Cost: about 2 us a step, and a step a sample.
class FreeMarch {
 public:
  /// Keeps references. `slopes`, with the values of `law`, may be null: the only derivatives are then those by the
  /// start. `stop` is asked every few hundred steps.
  FreeMarch(const FreeMotion& motion, const Element& law, NumberSlopes* slopes, double fineness,
            std::function<bool()> stop = {});

  /// From a state at the start of a window to its end. A contact that slides there has the state of long sliding; one
  /// at rest carries the force that balances the body or, if it cannot, none. False if the steps shrink to nothing, the
  /// law does not stop switching, or it is stopped.
  bool run(const FreeWindow& window, const Eigen::Vector2d& start, FreeRun& result);

 private:
  static constexpr Eigen::Index plant_states = 2;
  static constexpr std::size_t stages = 3;
  static constexpr int most_states = plant_states + 12;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_states, most_states>;

  void rate(double t, const State& x, State& dx);
  void jacobian(double t, const State& x);
  void add_number_rates();
  void guards(double t, const State& x);
  void take_input(std::size_t stop);
  bool begin(const FreeWindow& window, const Eigen::Vector2d& start);
  void begin_contact(bool sliding);
  bool cross(double until);
  void predict(double h);
  bool solve(double h);
  double error_of(double h);
  bool carry(double h);
  bool accept(double h);
  double share_of_break(double h, double share, std::size_t guard, double at_end);
  struct Broken {
    std::ptrdiff_t guard = -1;
    double share = 1.0;
  };
  Broken first_broken(double h);
  void fire(std::size_t guard);
  Eigen::RowVector2d drive_row(const Eigen::Vector2d& x) const;
  double torque_slope(const Eigen::Vector2d& x) const;
  bool has_reversals() const { return !law_.may_stick(); }
  Eigen::Index numbers() const { return slopes_ == nullptr ? 0 : slopes_->count(); }
  Eigen::Index columns() const { return numbers() + plant_states; }

  const FreeMotion& motion_;
  Eigen::Matrix2d A_;  ///< of the plant, as all of the following
  Eigen::Vector2d B_u_, B_F_, B_gravity_ = Eigen::Vector2d::Zero();
  Eigen::RowVector2d C_v_, C_gravity_ = Eigen::RowVector2d::Zero();
  double v0_, torque_ = 0.0;  ///< rubbing velocity at rest; largest torque of gravity
  const Element& law_;
  NumberSlopes* slopes_;
  ElementSlopes own_slopes_;
  std::function<bool()> stop_;
  double fineness_, mobility_;  ///< 1/kg: rate of the rubbing velocity for a unit force
  Eigen::Index n_;
  State scale_;                 ///< of the states
  std::vector<double> z_, dz_;  ///< of the contact
  Mode mode_{};
  double forward_ = 1.0;  ///< direction of the rubbing velocity, for laws with a kink at rest

  double t_ = 0.0, h_ = 0.0, t_input_ = 0.0, u_ = 0.0, u_slope_ = 0.0;
  State x_, rate_, work_, probe_, error_;
  std::array<State, stages> increments_, last_increments_, rates_;
  double last_step_ = 0.0;  ///< 0: none that led here smoothly
  Square J_;
  Eigen::MatrixXd deviations_, forced_;
  std::vector<double> system_, change_, guards_;
  Factors factors_;
  std::array<std::vector<double>, stages> guards_at_;
  Input<double> in_{};  ///< of the law, and its output, where rate() was called last
  double output_ = 0.0;
  long steps_left_ = 0;
  int events_ = 0;
};

}  // namespace limcycle
