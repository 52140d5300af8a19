#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/identify/free/free_response.hpp"
#include "limcycle/analysis/study/identify/parameter_space.hpp"

namespace limcycle {

/// Weighted differences between what a law gives and the records, as a function of the coordinates of a ParameterSpace:
/// compared rows over the noise of their record (or the entries of Huber's loss of these), then, for laws that stick,
/// break-aways, |F| = Fs. The states at which free motions begin are fitted to them for any coordinates, and are none:
/// see FreeResponse.
class Misfit {
 public:
  /// Keeps references to the space and the records. `noise`: standard deviation of the measured quantity in each
  /// record. `stop` is asked while a free motion is simulated; a law that is cut short there has no answer.
  Misfit(const ParameterSpace& space, const std::vector<PreparedRecord>& records, std::vector<double> noise,
         Shooting shooting = Shooting::single, std::function<bool()> stop = {});

  Eigen::Index size() const { return size_; }
  const ParameterSpace& space() const { return space_; }
  const std::vector<PreparedRecord>& records() const { return records_; }
  const std::vector<double>& noise() const { return noise_; }
  /// First entry of a record, and of the break-aways behind all records.
  Eigen::Index first_of(std::size_t record) const { return first_[record]; }
  /// The weighted differences of a record, over its noise, of which these are the entries: the same but for Huber's
  /// loss.
  Eigen::VectorXd differences(std::size_t record, const Eigen::VectorXd& entries) const;
  /// What the sum of squares is for least squares, where intervals are taken from it: for Huber's loss the sum of the
  /// squared pulls over the share of rows that still pull the harder, the farther off they are (Huber 1964).
  double spread(const Eigen::VectorXd& entries) const;

  /// Only these records, or (empty) all; the entries of the others are 0.
  void use(std::vector<bool> records) {
    used_ = std::move(records);
    last_ = {};
  }
  Shooting shooting() const { return free_.shooting(); }
  /// States at starts that are fitted to the records, besides the coordinates.
  Eigen::Index start_states() const;
  /// Fits of starts begin at those for these coordinates from now on.
  void start_from(const Eigen::VectorXd& u);

  /// Entries at u, and their derivatives by u if `slopes` is not null. `known`: see FreeResponse::run(). False where
  /// the law has no answer.
  bool at(const Eigen::VectorXd& u, Eigen::VectorXd& entries, Eigen::MatrixXd* slopes, double fineness = 1.0,
          const Eigen::VectorXd* known = nullptr) const;
  /// Evaluations of the law over all records so far, with and without derivatives.
  long evaluations() const { return evaluations_; }

 private:
  struct Evaluation {
    Eigen::VectorXd u = {}, entries = {};
    Eigen::MatrixXd slopes = {};
    bool known = false;  ///< the law has an answer
  };
  bool evaluate(const Eigen::VectorXd& u, Eigen::VectorXd& entries, Eigen::MatrixXd* slopes, double fineness,
                const Eigen::VectorXd* known) const;
  bool has_break_aways() const { return size_ > first_.back(); }
  bool uses(std::size_t record) const { return used_.empty() || used_[record]; }
  void add_break_aways(const Element& law, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values) const;
  bool add_forces(const Element& law, std::size_t record, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values,
                  double fineness) const;
  bool add_motion(const Element& law, std::size_t first, Eigen::VectorXd& entries, Eigen::MatrixXd* by_values,
                  double fineness, const Eigen::VectorXd* known) const;

  const ParameterSpace& space_;
  const std::vector<PreparedRecord>& records_;
  std::vector<double> noise_;
  std::unique_ptr<FrictionResponse> response_;
  mutable FreeResponse free_;
  std::vector<Eigen::Index> first_;
  std::vector<bool> used_;
  Eigen::Index size_ = 0;
  mutable Evaluation last_;  ///< with free motions, whose slopes cost little more: a fit asks for them afterwards
  mutable long evaluations_ = 0;
  mutable std::vector<double> forces_;
  mutable Eigen::MatrixXd by_numbers_;
};

/// Coordinates at a minimum of the sum of squares.
struct Fit {
  Eigen::VectorXd u = {};
  std::vector<std::size_t> held = {};  ///< bounds of the space that it lies on, see fit_within()
  double sum_of_squares = infinite;
  Status status = Status::max_iterations;
  int iterations = 0;
  double possible_decrease = infinite;  ///< of the sum, by a Gauss-Newton step from here
};

/// Coordinates that are varied, each by itself, or several that have one value.
using Groups = std::vector<std::vector<Eigen::Index>>;
Groups each_by_itself(const std::vector<Eigen::Index>& coordinates);

/// Least squares by Levenberg and Marquardt's method within a trust region (GSL's multifit_nlinear, with the exact
/// derivatives of Misfit), from `start`, over the coordinates in `groups`; the others keep their values.
/// `stop` is asked between iterations. Status: converged, where a Gauss-Newton step could lower the sum by 1e-4 at most
/// (by 0.04 if no step lowers it: a tenth of the way to the end of a 95 % interval, where it has risen by about 4);
/// max_iterations; stalled; not_finite if the law has no answer at the start; interrupted.
Fit fit(const Misfit& misfit, const Eigen::VectorXd& start, const Groups& groups, int most_iterations,
        const std::function<bool()>& stop = {});

}  // namespace limcycle
