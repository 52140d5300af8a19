#include "limcycle/analysis/study/remedy/rest_range.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

/// A straight piece of an element: output = slope input + offset while low <= input <= high. `free`: the output is
/// anything in that range instead, whatever the input, or with `still` for an input of zero.
struct StraightPiece {
  double slope = 0.0, offset = 0.0, low = -infinite, high = infinite;
  bool free = false, still = false;
};

/// On, off and on the other way, each over the inputs at which it does not switch; without hysteresis it may also hold
/// the input at which it would, anywhere between.
std::vector<StraightPiece> relay_pieces(const Element& element) {
  const double level = element.number("level").value(), hysteresis = element.number("hysteresis").value_or(0.0),
               dead_zone = element.number("dead_zone").value_or(0.0), off = dead_zone - hysteresis;
  std::vector<StraightPiece> pieces{{.offset = level, .low = off}, {.offset = -level, .high = -off}};
  if (dead_zone > 0.0) pieces.push_back({.low = -dead_zone - hysteresis, .high = dead_zone + hysteresis});
  if (hysteresis == 0.0 && dead_zone == 0.0)
    pieces.push_back({.low = -level, .high = level, .free = true, .still = true});
  return pieces;
}

/// The pieces of an element that stands in the path of a signal; none for a kind that has none.
std::vector<StraightPiece> straight_pieces(const Element& element) {
  const double slope = element.number("slope").value_or(1.0);
  if (element.kind() == "dead-zone") {
    const double h = element.number("half_width").value();
    return {{.low = -h, .high = h}, {slope, -slope * h, h, infinite}, {slope, slope * h, -infinite, -h}};
  }
  if (element.kind() == "hysteretic-dead-zone") {  // it may hold up to there
    const double h = element.number("half_width").value(), most = h + element.number("hysteresis").value();
    return {{.low = -most, .high = most}, {1.0, 0.0, h, infinite}, {1.0, 0.0, -infinite, -h}};
  }
  if (element.kind() == "saturation") {
    const double limit = element.number("limit").value(), at = limit / slope;
    return {{.slope = slope, .low = -at, .high = at}, {0.0, limit, at, infinite}, {0.0, -limit, -infinite, -at}};
  }
  if (element.kind() == "reset-integrator" || element.kind() == "stop-reset-integrator")
    return {{.free = true, .still = true}};
  if (element.kind() == "clamped-pi") {  // it stands still for an input of zero, or clamped
    const double limit = element.number("limit").value(), sign = element.number("ki").value() < 0.0 ? -1.0 : 1.0;
    return {{.low = -limit, .high = limit, .free = true, .still = true},
            {0.0, sign * limit, 0.0, infinite},
            {0.0, -sign * limit, -infinite, 0.0}};
  }
  if (element.kind() == "window") {
    const double h = element.number("half_width").value();
    return {{.slope = 1.0, .low = -h, .high = h}, {.low = h}, {.high = -h}};
  }
  if (element.kind() == "relay" || element.kind() == "delayed-relay") return relay_pieces(element);
  if (element.kind() == "impulses") {
    const double band = element.number("band").value();
    return {{.low = -band, .high = band}};
  }
  if (element.kind() == "output-rate") return {{}};  // nothing moves
  if (element.kind() == "friction-compensation") {
    const double level = element.number("level").value();
    return {{.low = -level, .high = level, .free = true}};
  }
  return {};
}

/// The rows `row u <= most` and `row u = value` over the unknowns u = (X, w), in the sizes of the loop.
struct RestProgramme {
  std::vector<RowVectorXd> equal, below;
  std::vector<double> value, most;

  void add_equal(RowVectorXd row, double to) { add(equal, value, std::move(row), to); }
  void add_between(const RowVectorXd& row, double low, double high) {
    if (std::isfinite(high)) add(below, most, row, high);
    if (std::isfinite(low)) add(below, most, -row, -low);
  }

 private:
  static void add(std::vector<RowVectorXd>& rows, std::vector<double>& ends, RowVectorXd row, double end) {
    const double size = row.norm();
    if (size > 0.0) {
      row /= size;
      end /= size;
    }
    rows.push_back(std::move(row));
    ends.push_back(end);
  }
};

constexpr double boundless = 1e7, slack = 1e-9, rounding_share = 1e-12;

/// Least and largest of `of` z over g z <= h, |z_i| <= boundless, by its corners; empty if there is no such z.
std::optional<Extent> over_corners(MatrixXd g, VectorXd h, const VectorXd& of) {
  const Index d = of.size();
  if (d == 0) return (h.array() >= -slack).all() ? std::optional(Extent{}) : std::nullopt;
  const Index own = g.rows();
  g.conservativeResize(own + 2 * d, d);
  h.conservativeResize(own + 2 * d);
  g.middleRows(own, d).setIdentity();
  g.bottomRows(d) = -MatrixXd::Identity(d, d);
  h.tail(2 * d).setConstant(boundless);
  Extent found{infinite, -infinite};
  std::vector<bool> chosen(static_cast<std::size_t>(g.rows()), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(d), true);
  do {
    MatrixXd corner(d, d);
    VectorXd at(d);
    Index k = 0;
    for (Index i = 0; i < g.rows(); ++i) {
      if (!chosen[static_cast<std::size_t>(i)]) continue;
      corner.row(k) = g.row(i);
      at(k++) = h(i);
    }
    if (rank(corner) < d) continue;
    const VectorXd z = solve(corner, at);
    if (!((g * z - h).array() <= slack + rounding_share * z.norm()).all()) continue;
    const double value = of.dot(z);
    found.low = std::min(found.low, value);
    found.high = std::max(found.high, value);
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return found.low <= found.high ? std::optional(found) : std::nullopt;
}

class RestRange {
 public:
  explicit RestRange(const Loop& loop)
      : loop_(loop),
        n_(loop.states()),
        ne_(std::ssize(loop.elements)),
        in_path_(ne_ > 0 && loop.ports.back().opposes ? ne_ - 1 : ne_) {
    const State typical = typical_sizes(loop);
    scale_.resize(n_ + ne_);
    scale_.head(n_) = Eigen::Map<const VectorXd>(typical.data(), n_);
    for (Index i = 0; i < ne_; ++i) {
      const double size = output_level(loop, static_cast<std::size_t>(i));
      scale_(n_ + i) = size > 0.0 && std::isfinite(size) ? size : 1.0;
    }
  }

  std::optional<Extent> run() {
    if (ne_ == 0) return std::nullopt;
    for (Index i = 0; i < in_path_; ++i) {
      pieces_.push_back(shares_selection(i) ? shared_pieces(i) : straight_pieces(element(i)));
      if (pieces_.back().empty()) return std::nullopt;
    }
    Extent all{infinite, -infinite};
    std::vector<std::size_t> choice(pieces_.size(), 0);
    while (true) {
      if (const auto one = over(choice)) {
        all.low = std::min(all.low, one->low);
        all.high = std::max(all.high, one->high);
      }
      std::size_t i = 0;
      while (i < choice.size() && ++choice[i] == pieces_[i].size()) choice[i++] = 0;
      if (i == choice.size()) break;
    }
    return all.low <= all.high && !too_free_ ? std::optional(all) : std::nullopt;
  }

 private:
  const Element& element(Index i) const { return loop_.elements[static_cast<std::size_t>(i)]; }
  const Port& port(Index i) const { return loop_.ports[static_cast<std::size_t>(i)]; }

  RowVectorXd scaled(const RowVectorXd& of_states, const RowVectorXd& of_outputs) const {
    RowVectorXd row(n_ + ne_);
    row << of_states, of_outputs;
    return row.cwiseProduct(scale_.transpose());
  }

  /// The input of element i: a row over u, and what the external signals add.
  std::pair<RowVectorXd, double> input(Index i) const {
    RowVectorXd c = port(i).C;
    if (loop_.delay > 0.0 && port(i).C_delayed.size() == c.size()) c += port(i).C_delayed;
    return {scaled(c, port(i).D), port(i).c.dot(loop_.external.transpose())};
  }

  /// True for what follows the friction force that holds the body: see Port::selection_of.
  bool shares_selection(Index i) const {
    const auto leader = port(i).selection_of;
    return leader && loop_.elements[*leader].facts().stuck && element(i).kind() == "friction-compensation";
  }

  /// Over the force of the friction law: a share of the level, which may differ for both signs.
  std::vector<StraightPiece> shared_pieces(Index i) const {
    const Element& law = loop_.elements[*port(i).selection_of];
    const double level = (port(i).reversed ? -1.0 : 1.0) * element(i).number("level").value();
    const auto slope = [&](double sign) { return sign * level * law.selection(*law.facts().stuck, sign); };
    return {{.slope = slope(1.0), .low = 0.0}, {.slope = slope(-1.0), .high = 0.0}};
  }

  RowVectorXd unit(Index i) const {
    RowVectorXd of_outputs = RowVectorXd::Zero(ne_);
    of_outputs(i) = 1.0;
    return scaled(RowVectorXd::Zero(n_), of_outputs);
  }

  RestProgramme programme(const std::vector<std::size_t>& choice) const {
    RestProgramme all;
    MatrixXd A = loop_.A;
    if (loop_.delay > 0.0) A += loop_.A_delayed;
    const VectorXd pull = loop_.E * loop_.external;
    for (Index i = 0; i < n_; ++i) all.add_equal(scaled(A.row(i), loop_.B.row(i)), -pull(i));
    if (in_path_ < ne_) {  // friction is the last one
      const Port& rubbing = port(in_path_);
      all.add_equal(scaled(rubbing.C_v, rubbing.D_v), -rubbing.c_v.dot(loop_.external.transpose()));
      const Extent holds = holding_forces(element(in_path_));
      all.add_between(unit(in_path_), holds.low, holds.high);
    }
    for (Index i = 0; i < in_path_; ++i) {
      const StraightPiece& piece = pieces_[static_cast<std::size_t>(i)][choice[static_cast<std::size_t>(i)]];
      const auto [row, shift] =
          shares_selection(i) ? std::pair{unit(static_cast<Index>(*port(i).selection_of)), 0.0} : input(i);
      if (piece.still) all.add_equal(row, -shift);
      if (piece.free) {
        all.add_between(unit(i), piece.low, piece.high);
        continue;
      }
      all.add_equal(unit(i) - piece.slope * row, piece.offset + piece.slope * shift);
      all.add_between(row, piece.low - shift, piece.high - shift);
    }
    return all;
  }

  /// Range of y with each element on one of its pieces.
  std::optional<Extent> over(const std::vector<std::size_t>& choice) {
    constexpr Index most_free = 4;
    const RestProgramme all = programme(choice);
    MatrixXd M(std::ssize(all.equal), n_ + ne_);
    for (Index i = 0; i < M.rows(); ++i) M.row(i) = all.equal[static_cast<std::size_t>(i)];
    const VectorXd to = Eigen::Map<const VectorXd>(all.value.data(), std::ssize(all.value));
    const VectorXd u = least_squares(M, to, slack);
    if ((M * u - to).norm() > 1e-8 * (to.norm() + u.norm())) return std::nullopt;
    // The directions of rest are those left over by the rows.
    const MatrixXd left = MatrixXd::Identity(n_ + ne_, n_ + ne_) - pseudo_inverse(M) * M;
    const PivotedQr qr = pivoted_qr(left, 1e-6);  // relative to the largest
    const Index rank = left.cwiseAbs().maxCoeff() > 1e-6 ? qr.rank : 0;
    if (rank > most_free) {
      too_free_ = true;
      return std::nullopt;
    }
    const MatrixXd N = qr.Q.leftCols(rank);
    MatrixXd g(std::ssize(all.below), N.cols());
    VectorXd h(std::ssize(all.below));
    for (Index i = 0; i < g.rows(); ++i) {
      g.row(i) = all.below[static_cast<std::size_t>(i)] * N;
      h(i) = all.most[static_cast<std::size_t>(i)] - all.below[static_cast<std::size_t>(i)].dot(u.transpose());
    }
    const RowVectorXd y = scaled(loop_.C_y, RowVectorXd::Zero(ne_));
    const double middle = loop_.output_origin + y.dot(u.transpose());
    auto range = over_corners(g, h, (y * N).transpose());
    if (!range) return std::nullopt;
    const double far = 1e-3 * boundless * y.norm();
    const auto end = [&](double by) {
      const double value = middle + by;
      return std::abs(value) < 1e-12 * (std::abs(loop_.output_origin) + y.norm()) ? 0.0 : value;  // rounding
    };
    return Extent{range->low < -far ? -infinite : end(range->low), range->high > far ? infinite : end(range->high)};
  }

  const Loop& loop_;
  Index n_, ne_, in_path_;  ///< states, elements, and those of them that stand in the path of a signal
  VectorXd scale_;
  std::vector<std::vector<StraightPiece>> pieces_;
  bool too_free_ = false;  ///< a piece has more directions of rest than corners can be tried for: no answer
};

}  // namespace

std::optional<Extent> rest_range(const Loop& loop) {
  if (loop.origin_rate.size() > 0 && !loop.origin_rate.isZero(0.0)) return std::nullopt;
  return RestRange(loop).run();
}

}  // namespace limcycle
