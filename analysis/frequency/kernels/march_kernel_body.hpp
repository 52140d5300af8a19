#pragma once
#include <cstddef>

#include "limcycle/analysis/frequency/kernels/march_laws.hpp"
#include "limcycle/analysis/frequency/kernels/march_nodes.hpp"
#include "limcycle/analysis/lanes/elimination.hpp"
#include "limcycle/analysis/lanes/pack.hpp"

namespace limcycle {

/// Marches the points of a task, each in its own lane; a lane that finishes takes the next point.
template <class P, int S, class Law>
class MarchPass {
 public:
  using Mask = typename P::Mask;

  MarchPass(const MarchNumbers& numbers, const MarchTask& task)
      : law_(numbers), task_(task), mesh_(*task.mesh), collocation_(*task.collocation), polynomial_{collocation_} {}

  void run() {
    for (int lane = 0; lane < P::lanes; ++lane) begin(lane);
    while (active_ > 0) {
      attempt();
      finish();
    }
  }

 private:
  static constexpr int most_orders = 32, most_attempts = 600;

  /// Phases of a panel: their geometry, and the law's quantities there.
  struct Node {
    P sine, cosine, slope, way;  ///< slope: dphi/dq; way: 1 -+ cos(phi), from the nearer end
    MarchPlace<P> at;
  };

  void set(P& pack, int lane, double value) { pack.v[lane] = value; }

  /// The next point, if there is one.
  void begin(int lane) {
    if (next_ < task_.count) {
      point_[lane] = next_;
      const int i = next_++;
      ++active_;
      set(lane_.reach, lane, task_.reach[i]);
      set(lane_.speed, lane, task_.speed[i]);
      set(lane_.tempo, lane, task_.tempo[i]);
      set(lane_.drag, lane, task_.drag[i]);
      set(lane_.lag, lane, task_.lag[i]);
      set(lane_.after, lane, task_.after[i]);
      set(lane_.before, lane, task_.before[i]);
      set(u_, lane, task_.start[i]);
      set(b_, lane, task_.start_level[i]);
    } else {
      point_[lane] = -1;
      if (lane_.after[lane] == 0.0) {  // a lane that never had a point
        set(lane_.after, lane, 1.0);
        set(lane_.before, lane, 1.0);
        set(b_, lane, 1.0);
      }
    }
    set_out(lane);
  }

  /// Sets up the start at phi = 0.
  void set_out(int lane) {
    set(q_, lane, 0.0);
    set(side_, lane, 1.0);
    set(du_, lane, 1.0);
    set(db_, lane, 1.0);
    set(mode_, lane, 0.0);
    set(way_, lane, 0.0);
    set(limit_, lane, beyond);
    set(doubt_, lane, 0.0);
    set(known_, lane, 0.0);
    set(last_h_, lane, 1.0);
    for (P& value : shape_) set(value, lane, 0.0);
    set(fell_low_, lane, 0.0);
    set(fell_high_, lane, 0.0);
    set(tried_, lane, beyond);
    set(running_, lane, point_[lane] >= 0 ? 1.0 : 0.0);
    attempts_[lane] = 0;
    for (int order = 0; order < task_.orders; ++order)
      for (P& sum : sums_[order]) set(sum, lane, 0.0);
    const auto here = point_[lane] >= 0;
    set(end_after_, lane, here ? far_end(lane_.after[lane]) : 1.0);
    set(end_before_, lane, here ? far_end(lane_.before[lane]) : 1.0);
  }

  /// asinh(1/scale): value of q where tan(phi/2) = 1.
  static double far_end(double scale) {
    const double y = 1.0 / scale;
    return log(P(y + __builtin_sqrt(y * y + 1.0)))[0];
  }

  Node node(const P& q, const P& b) const {
    const auto first = side_ > 0.0;
    const P scale = select(first, lane_.after, lane_.before);
    const P e = exp(q), inverse = 1.0 / e, half = 0.5 * scale;
    const P t = half * (e - inverse), square = t * t, d = 1.0 / (1.0 + square);
    Node here;
    here.sine = 2.0 * t * d;
    here.cosine = side_ * (1.0 - square) * d;
    here.way = 2.0 * square * d;
    here.slope = (e + inverse) * scale * d;
    here.at = law_.place(lane_, here.sine, b);
    return here;
  }

  void attempt() {
    const auto first = side_ > 0.0;
    const P rest = select(first, end_after_ - q_, q_);
    P h = min(P(mesh_.width), min(limit_, tried_));
    h = select(tried_ < beyond, min(h, rest), select(rest < h * 1.00001, rest, select(rest < 2.0 * h, 0.5 * rest, h)));
    nodes_[0] = node(q_, b_);
    P b_end = b_, db_end = db_;
    if constexpr (Law::lags) {
      for (int i = 1; i <= S; ++i) nodes_[i] = node(q_ + side_ * (h * collocation_.nodes[i]), b_);
      solve_level(h, b_end, db_end);
    } else {
      for (int i = 1; i <= S; ++i) nodes_[i] = node(q_ + side_ * (h * collocation_.nodes[i]), b_);
    }
    const Mask solved = solve(h);
    guard(h, solved, b_end, db_end);
  }

  /// The lagged level at the nodes, linear in itself.
  void solve_level(const P& h, P& b_end, P& db_end) {
    P m[S][S], x[S], y[S];
    MarchLevel<P> level = law_.level;
    for (int i = 0; i < S; ++i) {
      const P scale = h * nodes_[i + 1].slope * lane_.lag;
      x[i] = scale * level.at(lane_.speed * nodes_[i + 1].sine) + b_ * collocation_.row_sum[i];
      y[i] = db_ * collocation_.row_sum[i];
      for (int j = 0; j < S; ++j) m[i][j] = P(collocation_.inverse[i * S + j]);
      m[i][i] += scale;
    }
    eliminate(m, x, y);
    for (int i = 0; i < S; ++i) nodes_[i + 1].at = law_.place(lane_, nodes_[i + 1].sine, x[i]);
    b_end = x[S - 1];
    db_end = y[S - 1];
  }

  /// u and du at the nodes; true where Newton converged.
  Mask solve(const P& h) {
    const Mask holds = Law::sticks ? abs(mode_) < 0.5 : mode_ < -beyond;
    z_[0] = u_;
    const MarchRate<P> now = law_.rate(nodes_[0].at, mode_, u_, lane_);
    const P stretch = h / last_h_, way = h * nodes_[0].slope;
    // Initial guess: the polynomial of the previous panel where the mode continues, a relaxation where it is new.
    const Mask goes_on = (known_ > 0.5) & (stretch < 1.3);
    for (int i = 1; i <= S; ++i) {
      const double c = collocation_.nodes[i];
      const P before = min(P(2.0), max(P(-2.0), polynomial_.at(offset_ + c * stretch, shape_)));
      const P relaxes = u_ + c * way * now.rate / (1.0 + c * way * abs(now.slope));
      z_[i] = select(holds, u_ + lane_.reach * side_ * (nodes_[i].way - way_), select(goes_on, before, relaxes));
    }
    Mask done = holds;
    P step;
    for (int pass = 0; pass < 7; ++pass) {
      P m[S][S], x[S], y[S];
#pragma GCC unroll 8
      for (int i = 0; i < S; ++i) {
        const MarchRate<P> rate = law_.rate(nodes_[i + 1].at, mode_, z_[i + 1], lane_);
        const P scale = h * nodes_[i + 1].slope;
        x[i] = scale * rate.rate;
        y[i] = du_ * collocation_.row_sum[i];
#pragma GCC unroll 8
        for (int j = 0; j < S; ++j) {
          m[i][j] = P(collocation_.inverse[i * S + j]);
          x[i] = x[i] - (z_[j + 1] - u_) * collocation_.inverse[i * S + j];
        }
        m[i][i] = m[i][i] - scale * rate.slope;
      }
      eliminate(m, x, y);
      step = P(0.0);
#pragma GCC unroll 8
      for (int i = 0; i < S; ++i) {
        step = max(step, abs(x[i]));
        z_[i + 1] = select(done, z_[i + 1], z_[i + 1] + x[i]);
        dz_[i + 1] = select(done, dz_[i + 1], y[i]);
      }
      done = done | (step < mesh_.newton);
      if (done.all()) break;
    }
    for (int i = 1; i <= S; ++i) dz_[i] = select(holds, du_, dz_[i]);
    return done;
  }

  /// Accepts the panel if the mode lasts to its end; else finds how long it may be.
  void guard(const P& h, const Mask& solved, const P& b_end, const P& db_end) {
    // Largest distance of u beyond its bounds that is accepted.
    P room = P(Law::gentle ? 0.3 * __builtin_sqrt(mesh_.located) : mesh_.located < 1e-10 ? mesh_.located : 1e-10);
    // A fast relaxation amplifies deviations at a cap.
    if constexpr (Law::lags) room = max(room / (1.0 + lane_.tempo), P(1e-14));
    P low[S + 1], high[S + 1], before = P(0.0), behind = P(0.0);
    Mask lower, out = leaves(room, low, high, lower, before, behind) & solved;
    P share = P(1.0), root_slope = P(-1.0);
    if (out.any()) {
      P met[S + 1];
      for (int i = 0; i <= S; ++i) met[i] = select(lower, low[i], high[i]);
      share = polynomial_.root(met, before, behind, root_slope);
    }
    const Mask runs = running_ > 0.5, at_once = out & (share * h < 1e-12);
    tried_ = select((out & !at_once) | !solved, select(solved, share * h, 0.5 * h), P(beyond));
    const Mask taken = (!out) & solved & runs, jumps = at_once & runs;
    const P low_slope = polynomial_.slope_at_end(low), high_slope = polynomial_.slope_at_end(high);
    // The end of a panel may be an edge.
    const Mask up = taken & (high[S] < room) & (high_slope < 0.0);
    const Mask ends = up | (taken & (low[S] < room) & (low_slope < 0.0));
    take(h, taken, b_end, db_end);
    if constexpr (Law::lags) {
      const Mask sticking = taken & (abs(mode_) < 0.5);
      const Mask near = nearly_met(low, low_slope, fell_low_) | nearly_met(high, high_slope, fell_high_);
      doubt_ = select(sticking & near, P(1.0), doubt_);
      fell_low_ = select(taken, low_slope, fell_low_);
      fell_high_ = select(taken, high_slope, fell_high_);
    }
    for (int i = 0; i <= S; ++i) shape_[i] = z_[i];
    polynomial_.divide(shape_);
    last_h_ = h;
    offset_ = select(taken, P(1.0), P(0.0));
    known_ = select(solved & !over_ & (h > 0.0), P(1.0), P(0.0));
    if (ends.any()) switch_mode(ends, up, select(up, high_slope, low_slope), h, nodes_[S]);
    if (jumps.any()) switch_mode(jumps, !lower, root_slope, h, nodes_[0]);
  }

  /// Distances of u from its bounds at the nodes; true where u leaves them, with the bound (`lower`) and the nodes
  /// between.
  Mask leaves(const P& room, P (&low)[S + 1], P (&high)[S + 1], Mask& lower, P& before, P& behind) const {
    Mask out = mode_ < -beyond;
    lower = out;
    for (int i = 0; i <= S; ++i) {
      const MarchBand<P> band = law_.band(nodes_[i].at, mode_);
      low[i] = z_[i] - band.low;
      high[i] = band.high - z_[i];
      // The edge may be missed by more at the start of a mode than at its end, to avoid toggling between modes.
      const P least = i > 0 ? -room : (Law::gentle ? -30.0 : -1e3) * room;
      const Mask below = low[i] < least, now = (below | (high[i] < least)) & !out;
      lower = lower | (now & below);
      before = select(now, P(i > 0 ? collocation_.nodes[i - 1] : 0.0), before);
      behind = select(now, P(collocation_.nodes[i]), behind);
      out = out | now;
    }
    return out;
  }

  /// True if a bound came so near within the panel that it may have been met between the nodes; `fell`: slope at the
  /// end of the previous panel.
  Mask nearly_met(const P (&values)[S + 1], const P& end_slope, const P& fell) const {
    P least = values[0];
    for (int i = 1; i <= S; ++i) least = min(least, values[i]);
    const P start = polynomial_.slope_at_start(values);
    const P depth = max(values[0], values[S]) - least;
    return ((fell < 0.0) | (start < 0.0)) & (end_slope > 0.0) & (least < 0.1 * depth + 1e-9);
  }

  /// Adds the panel to the sums.
  void add(const P& h, const Mask& taken) {
    for (int i = 1; i <= S; ++i) {
      const Node& here = nodes_[i];
      const P weight = select(taken, h * here.slope * collocation_.weights[i], P(0.0));
      const P u = select(taken, z_[i], P(0.0)) * weight, du = select(taken, dz_[i], P(0.0)) * weight;
      const P twice = 4.0 * here.cosine * here.cosine - 2.0;
      P sine = here.sine, cosine = here.cosine, sine_before = -sine, cosine_before = cosine;
      for (int order = 0; order < task_.orders; ++order) {
        sums_[order][0] += u * sine;
        sums_[order][1] += u * cosine;
        sums_[order][2] += du * sine;
        sums_[order][3] += du * cosine;
        const P s = twice * sine - sine_before, c = twice * cosine - cosine_before;
        sine_before = sine;
        cosine_before = cosine;
        sine = s;
        cosine = c;
      }
    }
  }

  /// The same, and advances.
  void take(const P& h, const Mask& taken, const P& b_end, const P& db_end) {
    add(h, taken);
    u_ = select(taken, z_[S], u_);
    du_ = select(taken, dz_[S], du_);
    b_ = select(taken, b_end, b_);
    db_ = select(taken, db_end, db_);
    way_ = select(taken, nodes_[S].way, way_);
    const auto first = side_ > 0.0;
    const P q = q_ + side_ * h;
    q_ = select(taken, q, q_);
    limit_ = select(taken, limit_ * (1.0 + 2.0 * mesh_.width), limit_);
    limit_ = min(limit_, P(beyond));
    // Change over from the first end to the second.
    over_ = taken & first & (end_after_ - q_ <= 1e-12 * end_after_);
    q_ = select(over_, end_before_, q_);
    side_ = select(over_, P(-1.0), side_);
    way_ = select(over_, P(1.0), way_);
  }

  /// Switches the mode at an edge, the distance from which falls at the rate `slope` < 0 over the panel.
  void switch_mode(const Mask& switched, const Mask& up, const P& slope, const P& h, const Node& here) {
    const P before = law_.rate(here.at, mode_, u_, lane_).rate;
    mode_ = select(switched, law_.next(mode_, up), mode_);
    const P jump = (law_.rate(here.at, mode_, u_, lane_).rate - before) * h * here.slope;
    const P apart = select(up, -slope, slope);
    du_ = select(switched & (slope < 0.0), du_ * (apart + jump) / apart, du_);
    known_ = select(switched, P(0.0), known_);
    relax(switched, here, u_);
  }

  /// A relaxation after a switch is cut into panels of growing length.
  void relax(const Mask& switched, const Node& here, const P& u) {
    const P rate = abs(law_.rate(here.at, mode_, u, lane_).rate), stiffness = law_.stiffness(here.at, mode_, lane_);
    const P shortest = mesh_.width / (stiffness * here.slope + 1e-300);
    limit_ = select(switched, select(rate > mesh_.layer * stiffness, shortest, P(beyond)), limit_);
  }

  /// Stores the results of lanes that have finished and starts their next points.
  void finish() {
    const Mask ended = (running_ > 0.5) & (side_ < 0.0) & (q_ <= 1e-14);
    const bool any = ended.any();
    for (int lane = 0; lane < P::lanes; ++lane) {
      if (point_[lane] < 0) continue;
      const bool fails = ++attempts_[lane] > most_attempts;
      if (!(any && ended.bits[lane] != 0) && !fails) continue;
      hand_in(lane, fails);
      --active_;
      begin(lane);
    }
  }

  void hand_in(int lane, bool fails) {
    const int i = point_[lane];
    task_.end[i] = u_[lane];
    task_.slope[i] = du_[lane];
    task_.end_level[i] = b_[lane];
    task_.level_slope[i] = db_[lane];
    task_.panels[i] = fails ? 0 : doubt_[lane] > 0.0 ? -attempts_[lane] : attempts_[lane];
    double* sums = task_.sums + std::ptrdiff_t{4} * task_.orders * i;
    for (int order = 0; order < task_.orders; ++order)
      for (int k = 0; k < 4; ++k) sums[4 * order + k] = sums_[order][k][lane];
  }

  Law law_;
  const MarchTask& task_;
  const MarchMesh& mesh_;
  const MarchCollocation& collocation_;
  MarchPolynomial<P, S> polynomial_;
  int next_ = 0, active_ = 0;
  int point_[P::lanes] = {}, attempts_[P::lanes] = {};

  MarchLane<P> lane_;
  P q_, side_, end_after_, end_before_;  ///< distance from the nearer end, sign of that end (1 or -1), extent of both
  P u_, du_, b_, db_, mode_, way_, limit_, tried_, running_, doubt_, fell_low_, fell_high_;
  Node nodes_[S + 1];
  P z_[S + 1], dz_[S + 1];
  P shape_[S + 1], last_h_, offset_, known_;  ///< for the initial guess
  Mask over_;
  P sums_[most_orders][4];
};

template <class P, int S, template <class> class Law>
void march(const MarchNumbers& numbers, const MarchTask& task) {
  MarchPass<P, S, Law<P>>(numbers, task).run();
}

template <class P>
constexpr MarchKernels march_kernels() {
  MarchKernels k;
  k.of[0][5] = march<P, 5, ElastoPlasticMarch>;
  k.of[1][5] = march<P, 5, CappedMarch>;
  k.of[2][5] = march<P, 5, DahlMarch>;
  k.of[3][5] = march<P, 5, BoucWenMarch>;
  k.of[0][8] = march<P, 8, ElastoPlasticMarch>;
  k.of[1][8] = march<P, 8, CappedMarch>;
  k.of[2][8] = march<P, 8, DahlMarch>;
  k.of[3][8] = march<P, 8, BoucWenMarch>;
  return k;
}

}  // namespace limcycle
