#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

/// Experiment that made a record.
enum class RecordKind {
  steady_velocity,  ///< rows are pairs of a constant velocity and the force there, in any order
  lag,              ///< a body slides with a varying velocity, and slid long before the first row
  pre_sliding,      ///< small motions from a relaxed contact
  break_away,       ///< a relaxed contact is loaded until the body slides
  free,             ///< a rig moves under an applied force; the friction force is not measured
  free_decay        ///< a rig that was let go, or pushed, comes to rest by itself
};

/// Names of the kinds, in the order of the enumerators.
inline constexpr std::string_view record_kinds[] = {"steady-velocity", "lag",  "pre-sliding",
                                                    "break-away",      "free", "free-decay"};
constexpr std::string_view to_string(RecordKind kind) { return record_kinds[static_cast<std::size_t>(kind)]; }
/// True where the motion of a whole rig was measured, and not its friction force.
constexpr bool is_free(RecordKind kind) { return kind == RecordKind::free || kind == RecordKind::free_decay; }

/// Measured friction: the motion, which drives a law, and the friction force, which the law has to reproduce. Columns
/// that were not measured are empty; `F` never is, and x or v is there (steady velocity: v, and t may be empty).
///
/// Of a free motion F is the force applied to the plant (free decay: empty), x the plant's y and v its rate; the law
/// has to reproduce them.
struct FrictionRecord {
  RecordKind kind = RecordKind::steady_velocity;
  std::string name;               ///< for messages: the file
  std::vector<double> t;          ///< s, rising
  std::vector<double> x, v;       ///< m, m/s
  std::vector<double> F;          ///< N, opposing the motion
  double skip = 0.0;              ///< s from the first row, during which the force is not compared
  double force_limit = INFINITY;  ///< N; rows with |F| at it or beyond are not compared (a saturated sensor)
  bool holds_force = false;       ///< free: the applied force keeps its value until the next row, else it is linear
  std::vector<double> weight{};   ///< of the rows, each for itself: one over the variance; empty: all are alike
  bool huber = false;             ///< by huber_entry(), else by squares; not for free motions
};

/// Rows of a record that a law is compared with, at most.
inline constexpr std::size_t most_compared = 4000;

/// Piece of a measured motion on which the velocity does not change sign: v(s) = v0 + s (v1 + s v2) for 0 <= s <= 1,
/// s = (time from its start)/duration.
struct MotionPiece {
  double duration = 0.0;                ///< s
  double v0 = 0.0, v1 = 0.0, v2 = 0.0;  ///< m/s
  std::ptrdiff_t sample = -1;           ///< of `compared` at its end; -1: none

  double velocity(double s) const { return v0 + s * (v1 + s * v2); }
  /// From s to the end, m.
  double displacement(double s = 0.0) const {
    return duration * ((1.0 - s) * v0 + (1.0 - s * s) / 2.0 * v1 + (1.0 - s * s * s) / 3.0 * v2);
  }
};

/// What a law is compared with.
enum class MeasuredQuantity { force, position, velocity };
inline constexpr std::string_view measured_names[] = {"force", "position", "velocity"};
inline constexpr std::string_view measured_units[] = {"N", "m", "m/s"};
constexpr std::string_view to_string(MeasuredQuantity one) { return measured_names[static_cast<std::size_t>(one)]; }
constexpr std::string_view unit_of(MeasuredQuantity one) { return measured_units[static_cast<std::size_t>(one)]; }

/// Row that a law is compared with.
struct ComparedRow {
  std::size_t row = 0;    ///< of the record
  double v = 0.0;         ///< m/s
  double measured = 0.0;  ///< the quantity that is compared
  double t = 0.0;         ///< s from the first row
  double x = 0.0;         ///< m from the first row
  double weight = 1.0;    ///< factor on the difference: root of the weight over the mean of the compared rows
};

/// Instant at which a resting body begins to slide: the force there, on the line through the rows before it.
struct BreakAwayEvent {
  double F = 0.0;       ///< N
  bool forward = true;  ///< direction of the slip
  double weight = 1.0;  ///< standard deviation of a row's force over that of F
};

struct FreeMotion;

/// Record as methods use it: one measured quantity. A free motion whose position and velocity were measured is two of
/// them, in this order, with one `motion`.
struct PreparedRecord {
  RecordKind kind = RecordKind::steady_velocity;
  std::string name;
  MeasuredQuantity quantity = MeasuredQuantity::force;
  double size = 0.0;                         ///< largest measured force or speed, or distance from the first position
  std::shared_ptr<const FreeMotion> motion;  ///< null for friction that was measured
  double v_start = 0.0;                      ///< velocity at the first row, m/s
  std::ptrdiff_t first_sample = -1;          ///< of `compared` at the first row; -1: none
  std::vector<MotionPiece> pieces;           ///< empty for steady velocities
  std::vector<ComparedRow> compared;         ///< in the order of the rows
  std::vector<BreakAwayEvent> break_aways;
  bool huber = false;                   ///< rows count by huber_entry(), else by squares
  double largest_force = 0.0;           ///< |F| of the compared rows, N; of a free motion an estimate
  double displacement = 0.0;            ///< largest |x - x(0)|, m; 0 for steady velocities
  double duration = 0.0;                ///< s; 0 for steady velocities
  double slowest = 0.0, fastest = 0.0;  ///< |v| > 0 of the compared rows, m/s
  std::vector<std::string> notes;       ///< what was left out, a sentence each
};

/// Velocity between rows: the parabola through the measured velocities at both ends whose integral is the measured
/// displacement. Without a velocity column the velocities are the slopes of parabolas through three positions; without
/// a position column they are joined by straight lines. `rest_tells_nothing`: leave out rows at v = 0, where a law that
/// is set-valued at rest states no force (for all laws of a list, which are compared on the same rows). Break-aways are
/// those of a break-away record with measured velocities: after four compared rows at v = 0 exactly. Throws
/// std::invalid_argument with a sentence if the record has too few rows, a column of another length, time that does not
/// rise, no motion, or a velocity that contradicts the position. Cost: linear in the rows. Free motions: see
/// prepare_free().
PreparedRecord prepare(const FrictionRecord& record, bool rest_tells_nothing);

/// What all kinds in time need: std::invalid_argument with a sentence for fewer than ten of `rows` rows, columns of
/// another length, time that does not rise, or a velocity that contradicts the position.
void check_in_time(const FrictionRecord& record, std::size_t rows);
/// Gives the compared rows the weights of the record.
void weigh_rows(const FrictionRecord& record, std::vector<ComparedRow>& rows);
/// True for a row whose weight is 0, which is not compared.
inline bool is_weightless(const FrictionRecord& record, std::size_t row) {
  return !record.weight.empty() && record.weight[row] == 0.0;
}
[[noreturn]] void refuse_record(const FrictionRecord& record, const std::string& why);

}  // namespace limcycle
