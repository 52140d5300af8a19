#include "limcycle/analysis/study/identify/record/record.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/median.hpp"

namespace limcycle {

void refuse_record(const FrictionRecord& record, const std::string& why) {
  throw std::invalid_argument(record.name + ": " + why);
}

namespace {

std::string row_name(std::size_t i) { return "row " + std::to_string(i + 1); }

void check_count(const FrictionRecord& record, std::size_t rows, std::size_t fewest) {
  if (rows < fewest)
    refuse_record(record, "has " + std::to_string(rows) + " rows; a " + std::string(to_string(record.kind)) +
                              " record needs at least " + std::to_string(fewest));
}

void check_lengths(const FrictionRecord& record, std::size_t rows) {
  for (const auto* column : {&record.t, &record.x, &record.v, &record.F, &record.weight})
    if (!column->empty() && column->size() != rows) refuse_record(record, "has columns of different length");
}

void check_weights(const FrictionRecord& record) {
  for (std::size_t i = 0; i < record.weight.size(); ++i)
    if (!(record.weight[i] >= 0.0 && std::isfinite(record.weight[i])))
      refuse_record(record, "has a weight that is no finite number >= 0 in " + row_name(i));
}

void check_steady(const FrictionRecord& record) {
  check_count(record, record.F.size(), 3);
  if (record.v.empty()) refuse_record(record, "needs a velocity column");
  check_lengths(record, record.F.size());
  check_weights(record);
}

/// Slope at a row of the parabola through it and its neighbours.
double slope_at(const std::vector<double>& t, const std::vector<double>& x, std::size_t i) {
  const std::size_t k = std::clamp<std::size_t>(i, 1, t.size() - 2);
  const double a = t[k] - t[k - 1], b = t[k + 1] - t[k];
  const double left = (x[k] - x[k - 1]) / a, right = (x[k + 1] - x[k]) / b, bend = (right - left) / (a + b);
  return (left * b + right * a) / (a + b) + 2.0 * bend * (t[i] - t[k]);
}

std::vector<double> velocities(const FrictionRecord& record) {
  if (!record.v.empty()) return record.v;
  std::vector<double> v(record.t.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = slope_at(record.t, record.x, i);
  return v;
}

/// A position in mm beside a velocity in m/s, or the like.
void check_units(const FrictionRecord& record) {
  if (record.x.empty() || record.v.empty()) return;
  // The position of a free motion is as noisy as its velocity: from row to row it moves less than its noise.
  const std::size_t n = record.t.size(), stride = is_free(record.kind) ? std::max<std::size_t>(n / 20, 1) : 1;
  double both = 0.0, own = 0.0, other = 0.0, by_v = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    by_v += 0.5 * (record.v[i] + record.v[i - 1]) * (record.t[i] - record.t[i - 1]);
    if (i % stride != 0) continue;
    const double dx = record.x[i] - record.x[i - stride];
    both += dx * by_v;
    own += by_v * by_v;
    other += dx * dx;
    by_v = 0.0;
  }
  if (!(own > 0.0) || !(other > 0.0)) return;
  const double ratio = both / own, alike = both / std::sqrt(own * other);
  if (alike > 0.5 && std::abs(ratio - 1.0) < 0.3) return;
  char text[160];
  std::snprintf(text, sizeof text, "the position moves %.3g times as far as the velocity says", ratio);
  if (alike < 0.5)
    refuse_record(record, "position and velocity do not belong together: their displacements have a correlation of " +
                              std::to_string(alike).substr(0, 5));
  refuse_record(record, std::string(text) + ": is one of them in another unit (mm)? [identify.record] scale converts");
}

/// Friction takes power from the motion.
void check_sign(const FrictionRecord& record, const std::vector<double>& v) {
  constexpr double surely = -0.3;
  double power = 0.0, size = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    power += record.F[i] * v[i];
    size += std::abs(record.F[i] * v[i]);
  }
  if (power < surely * size)
    refuse_record(record,
                  "the force pushes along the motion, which no friction does: is it the force on the body, with the "
                  "other sign? [identify.record] scale = {force = -1.0} turns it");
}

/// Displacement over an interval beyond that of straight-line velocities, as a parabola 6 bump s (1 - s).
MotionPiece interval(const FrictionRecord& record, const std::vector<double>& v, std::size_t i) {
  const double h = record.t[i + 1] - record.t[i];
  double bump = 0.0;
  if (!record.x.empty()) bump = (record.x[i + 1] - record.x[i]) / h - 0.5 * (v[i] + v[i + 1]);
  return {h, v[i], v[i + 1] - v[i] + 6.0 * bump, -6.0 * bump, -1};
}

/// The part of a piece from s = a to b.
MotionPiece part(const MotionPiece& of, double a, double b) {
  const double w = b - a;
  return {of.duration * w, of.velocity(a), w * (of.v1 + 2.0 * a * of.v2), w * w * of.v2, -1};
}

/// Appends a piece, cut where its velocity changes sign.
void append_pieces(const MotionPiece& whole, std::vector<MotionPiece>& to) {
  double cuts[4] = {0.0, 0.0, 0.0, 0.0};
  std::size_t n = 1;
  const auto cut_at = [&](double s) {
    if (s > 1e-9 && s < 1.0 - 1e-9 && s > cuts[n - 1]) cuts[n++] = s;
  };
  if (whole.v2 == 0.0) {
    if (whole.v1 != 0.0) cut_at(-whole.v0 / whole.v1);
  } else if (const double root = whole.v1 * whole.v1 - 4.0 * whole.v0 * whole.v2; root > 0.0) {
    const double q = -0.5 * (whole.v1 + std::copysign(std::sqrt(root), whole.v1));
    const double one = q / whole.v2, two = q != 0.0 ? whole.v0 / q : one;
    cut_at(std::min(one, two));
    cut_at(std::max(one, two));
  }
  cuts[n] = 1.0;
  for (std::size_t i = 0; i < n; ++i) to.push_back(part(whole, cuts[i], cuts[i + 1]));
}

/// Longest run of rows at the largest or smallest force.
std::size_t longest_run_at_extreme(const std::vector<double>& F) {
  const auto [low, high] = std::ranges::minmax(F);
  std::size_t longest = 0, run = 0;
  for (std::size_t i = 0; i < F.size(); ++i) {
    const bool extreme = F[i] == low || F[i] == high;
    run = !extreme ? 0 : i > 0 && F[i] == F[i - 1] ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return low == high ? 0 : longest;
}

bool is_skipped(const FrictionRecord& record, std::size_t i) {
  return !record.t.empty() && record.t[i] - record.t.front() < record.skip;
}
bool is_saturated(const FrictionRecord& record, std::size_t i) { return std::abs(record.F[i]) >= record.force_limit; }

/// The force at the time of row `last`, on the least-squares line through the `count` rows before it. That row itself
/// may be of the body that slides already.
BreakAwayEvent extrapolated(const FrictionRecord& record, std::size_t last, std::size_t count, bool forward) {
  double mt = 0.0, mF = 0.0, tt = 0.0, tF = 0.0;
  const auto n = static_cast<double>(count);
  for (std::size_t i = last - count; i < last; ++i) {
    mt += record.t[i] / n;
    mF += record.F[i] / n;
  }
  for (std::size_t i = last - count; i < last; ++i) {
    tt += (record.t[i] - mt) * (record.t[i] - mt);
    tF += (record.t[i] - mt) * (record.F[i] - mF);
  }
  const double ahead = record.t[last] - mt;
  return {mF + tF / tt * ahead, forward, 1.0 / std::sqrt(1.0 / n + ahead * ahead / tt)};
}

/// Speed that a body at rest is measured to have at most: five standard deviations of the noise of the velocity, which
/// its second differences show (their median: few of them are of a body that speeds up). 0 of an exact measurement, and
/// of one that would always be at rest (the steps of an encoder).
double speed_at_rest(const FrictionRecord& record, const std::vector<double>& v) {
  if (record.kind != RecordKind::break_away || v.size() < 3) return 0.0;
  constexpr double deviations = 5.0, median_of_normal = 0.6745;
  std::vector<double> bends;
  bends.reserve(v.size());
  for (std::size_t i = 1; i + 1 < v.size(); ++i) bends.push_back(std::abs(v[i - 1] - 2.0 * v[i] + v[i + 1]));
  const double rest = deviations * median(std::move(bends)) / (median_of_normal * std::sqrt(6.0));
  return std::ranges::any_of(v, [&](double one) { return std::abs(one) > rest; }) ? rest : 0.0;
}

/// Notes a velocity that is estimated from positions, if their noise makes it uncertain: the noise by its third
/// differences, which a smooth motion hardly has.
void note_estimated_velocity(const FrictionRecord& record, const std::vector<double>& v, PreparedRecord& into) {
  if (!record.v.empty() || record.t.size() < 8) return;
  constexpr double worth_saying = 0.05, median_of_normal = 0.6745;
  const auto& x = record.x;
  std::vector<double> bends, speeds;
  for (std::size_t i = 3; i < x.size(); ++i)
    bends.push_back(std::abs(x[i] - 3.0 * x[i - 1] + 3.0 * x[i - 2] - x[i - 3]));
  for (const double one : v) speeds.push_back(std::abs(one));
  const double noise = median(std::move(bends)) / (median_of_normal * std::sqrt(20.0));
  const double step = (record.t.back() - record.t.front()) / static_cast<double>(record.t.size() - 1);
  const double share = noise / (std::sqrt(2.0) * step) / median(std::move(speeds));
  if (share > worth_saying)
    into.notes.push_back("the velocity is estimated from the position, whose noise makes it uncertain by " +
                         short_number(100.0 * share, 2) +
                         " % of a typical speed: numbers that act on the velocity (sigma1, sigma2) may be biased, and "
                         "their intervals too narrow");
}

/// Slips of a body that was measured at rest for at least four rows of which none is left out. `v`: measured; empty
/// without.
std::vector<BreakAwayEvent> break_aways_of(const FrictionRecord& record, const std::vector<double>& v, double rest) {
  constexpr std::size_t fewest = 4, most = 12, surely = 3;
  std::vector<BreakAwayEvent> events;
  if (record.kind != RecordKind::break_away) return events;
  // Within noise a single row is no slip.
  const auto slips = [&](std::size_t i) {
    const std::size_t end = rest > 0.0 ? std::min(i + surely, v.size()) : i + 1;
    bool all = true;
    for (std::size_t k = i; k < end; ++k) all = all && std::abs(v[k]) > rest && (v[k] > 0.0) == (v[i] > 0.0);
    return all;
  };
  std::size_t resting = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const bool usable = !is_skipped(record, i) && !is_saturated(record, i), moves = slips(i);
    if (usable && moves && resting >= fewest)
      events.push_back(extrapolated(record, i - 1, std::min(resting - 1, most), v[i] > 0.0));
    resting = usable && !moves ? resting + 1 : 0;
  }
  return events;
}

std::string rows_left_out(std::size_t count, const std::string& why) {
  return std::to_string(count) + (count == 1 ? " row was" : " rows were") + " left out: " + why;
}

/// Chooses the rows to be compared. `rest`: see speed_at_rest().
void choose_rows(const FrictionRecord& record, const std::vector<double>& v, bool rest_tells_nothing, double rest,
                 PreparedRecord& into) {
  std::size_t at_limit = 0, at_rest = 0, skipped = 0, weightless = 0;
  std::vector<ComparedRow> rows;
  for (std::size_t i = 0; i < record.F.size(); ++i) {
    if (is_skipped(record, i)) {
      ++skipped;
    } else if (is_weightless(record, i)) {
      ++weightless;
    } else if (is_saturated(record, i)) {
      ++at_limit;
    } else if ((rest_tells_nothing || record.kind == RecordKind::steady_velocity) && std::abs(v[i]) <= rest) {
      ++at_rest;
    } else {
      rows.push_back({i, v[i], record.F[i]});
    }
  }
  if (at_limit > 0) into.notes.push_back(rows_left_out(at_limit, "the force is at force_limit or beyond"));
  if (at_rest > 0) into.notes.push_back(rows_left_out(at_rest, "at rest, where a set-valued law states no force"));
  if (skipped > 0) into.notes.push_back(rows_left_out(skipped, "within skip"));
  if (weightless > 0) into.notes.push_back(rows_left_out(weightless, "their weight is 0"));
  constexpr std::size_t shortest_run = 5;
  if (const auto run = longest_run_at_extreme(record.F); at_limit == 0 && run >= shortest_run)
    into.notes.push_back("the force keeps its extreme value over " + std::to_string(run) +
                         " rows: if the sensor was at its limit, state force_limit");
  const std::size_t every = (rows.size() + most_compared - 1) / most_compared;
  for (std::size_t i = 0; i < rows.size(); i += std::max<std::size_t>(every, 1)) into.compared.push_back(rows[i]);
  if (every > 1)
    into.notes.push_back("of " + std::to_string(rows.size()) + " rows every " + std::to_string(every) +
                         "th is compared; all of them move the law");
}

/// Gives the rows their places, and the record its sizes.
void measure(const FrictionRecord& record, PreparedRecord& into) {
  for (const auto& row : into.compared) {
    into.largest_force = std::max(into.largest_force, std::abs(row.measured));
    const double speed = std::abs(row.v);
    if (speed == 0.0) continue;
    into.slowest = into.slowest == 0.0 ? speed : std::min(into.slowest, speed);
    into.fastest = std::max(into.fastest, speed);
  }
  double x = 0.0;
  for (const auto& piece : into.pieces) {
    x += piece.displacement();
    into.displacement = std::max(into.displacement, std::abs(x));
    into.duration += piece.duration;
    if (piece.sample < 0) continue;
    auto& row = into.compared[static_cast<std::size_t>(piece.sample)];
    row.t = into.duration;
    row.x = x;
  }
  if (into.fastest == 0.0) refuse_record(record, "the body does not move");
  if (into.largest_force == 0.0) refuse_record(record, "the force is 0 throughout");
  into.size = into.largest_force;
}

}  // namespace

void weigh_rows(const FrictionRecord& record, std::vector<ComparedRow>& rows) {
  if (record.weight.empty()) return;
  double sum = 0.0;
  for (const auto& row : rows) sum += record.weight[row.row];
  const double mean = sum / static_cast<double>(rows.size());
  for (auto& row : rows) row.weight = std::sqrt(record.weight[row.row] / mean);
}

void check_in_time(const FrictionRecord& record, std::size_t rows) {
  check_count(record, rows, 10);
  if (record.t.empty()) refuse_record(record, "needs a time column");
  if (record.v.empty() && record.x.empty()) refuse_record(record, "needs a position or velocity column");
  check_lengths(record, rows);
  check_weights(record);
  for (std::size_t i = 1; i < rows; ++i)
    if (!(record.t[i] > record.t[i - 1])) refuse_record(record, "time does not rise at " + row_name(i));
  check_units(record);
}

PreparedRecord prepare(const FrictionRecord& record, bool rest_tells_nothing) {
  const bool steady = record.kind == RecordKind::steady_velocity;
  if (steady)
    check_steady(record);
  else
    check_in_time(record, record.F.size());
  const std::vector<double> v = velocities(record);
  check_sign(record, v);
  PreparedRecord result;
  note_estimated_velocity(record, v, result);
  result.kind = record.kind;
  result.name = record.name;
  result.v_start = v.front();
  if (record.kind == RecordKind::lag && v.front() == 0.0)
    refuse_record(record, "begins at rest; a lag record begins in sliding");
  const double rest = speed_at_rest(record, v);
  if (rest > 0.0 && rest_tells_nothing)
    result.notes.push_back("a body of a speed below " + short_number(rest, 2) +
                           " m/s counts as at rest: five deviations of the noise of the velocity");
  choose_rows(record, v, rest_tells_nothing, rest, result);
  if (result.compared.empty()) refuse_record(record, "no row can be compared with a law");
  weigh_rows(record, result.compared);
  result.huber = record.huber;
  std::vector<std::ptrdiff_t> compared_at(record.F.size(), -1);
  for (std::size_t k = 0; k < result.compared.size(); ++k)
    compared_at[result.compared[k].row] = static_cast<std::ptrdiff_t>(k);
  if (!steady) {
    result.first_sample = compared_at.front();
    for (std::size_t i = 0; i + 1 < v.size(); ++i) {
      append_pieces(interval(record, v, i), result.pieces);
      result.pieces.back().sample = compared_at[i + 1];
    }
    result.break_aways = break_aways_of(record, record.v, rest);
  }
  measure(record, result);
  return result;
}

}  // namespace limcycle
