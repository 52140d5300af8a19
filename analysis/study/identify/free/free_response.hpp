#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "limcycle/analysis/study/identify/free/free_motion.hpp"
#include "limcycle/analysis/study/identify/free/number_slopes.hpp"

namespace limcycle {

/// How free motions are simulated: each in one run from its first row, or in several, each with a start of its own.
enum class Shooting { single, multiple };
inline constexpr std::string_view shooting_names[] = {"single", "multiple"};
constexpr std::string_view to_string(Shooting shooting) { return shooting_names[static_cast<std::size_t>(shooting)]; }

/// The difference between free motions under a law and the measured ones, with the states at the starts eliminated.
///
/// The states at the start of each run are not known exactly. For any numbers of the law they are fitted to the rows of
/// that run by Gauss and Newton's method, so that they are no numbers of the outer fit; its slopes are the total
/// derivatives, with the starts following (variable projection, Golub and Pereyra 1973, in the form of Kaufman 1975:
/// exact for the gradient of the sum of squares). Intervals and profiles are then those with the starts fitted.
class FreeResponse {
 public:
  /// For a law of that kind and derivatives by these numbers. `stop` is asked within each simulation.
  FreeResponse(const Element& law, std::vector<LawNumber> numbers, std::vector<std::size_t> own_rows, Shooting shooting,
               std::function<bool()> stop = {});

  /// One measured quantity of a motion.
  struct Series {
    const PreparedRecord* record;
    double noise;        ///< standard deviation
    Eigen::Index first;  ///< place of its first row in the entries
  };
  /// Fills the entries of all `series` of one motion, differences over the noise, and the rows of `slopes` if that is
  /// not null, a column for each number. `known`: 1 for the entries to which the starts are fitted, 0 for others; null:
  /// all. A run with fewer than four known entries is fitted to all of its own; its entries are then enlarged to the
  /// size that those of n rows have before two states are fitted to them. False if the motion cannot be computed, or it
  /// is stopped. Cost: two to four simulations with derivatives.
  bool run(const Element& law, const std::vector<Series>& series, const Eigen::VectorXd* known,
           Eigen::VectorXd& entries, Eigen::MatrixXd* slopes, double fineness);

  /// Later fits of starts begin at those of the last run.
  void keep_starts() { kept_ = last_; }
  /// States that are fitted for a motion.
  Eigen::Index start_states(const FreeMotion& motion) const { return 2 * std::ssize(windows(motion)); }
  Shooting shooting() const { return shooting_; }

 private:
  struct WindowFit;
  const std::vector<FreeWindow>& windows(const FreeMotion& motion) const {
    return shooting_ == Shooting::single ? motion.whole : motion.pieces;
  }

  std::unique_ptr<NumberSlopes> slopes_;
  Shooting shooting_;
  std::function<bool()> stop_;
  std::map<std::pair<const FreeMotion*, std::size_t>, Eigen::Vector2d> kept_, last_;
};

}  // namespace limcycle
