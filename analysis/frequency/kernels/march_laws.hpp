#pragma once
#include "limcycle/analysis/frequency/kernels/march_kernel.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Quantities that differ from lane to lane, see march_kernel.hpp.
template <class P>
struct MarchLane {
  P reach{}, speed{}, tempo{}, drag{}, lag{}, after{}, before{};
};

/// Quantities in the equations at a phase that do not depend on the state.
template <class P>
struct MarchPlace {
  P drive{};             ///< reach sin(phi), or the tempo
  P level{};             ///< g or b
  P extra{};             ///< further quantity of the law
  P per{}, per_range{};  ///< and quotients of these, which are expensive
};

/// du/dphi and its derivative by u.
template <class P>
struct MarchRate {
  P rate{}, slope{};
};

/// Bounds of u between which a mode lasts.
template <class P>
struct MarchBand {
  P low{}, high{};
};

/// g over its value at rest.
template <class P>
struct MarchLevel {
  StribeckCurve<P> curve;

  explicit MarchLevel(const MarchNumbers& numbers) {
    curve.Fs = curve.Fs_minus = 1.0;
    curve.Fc = curve.Fc_minus = numbers.ratio;
    curve.vs = 1.0;
    curve.delta = numbers.delta;
    curve.curve.index = numbers.curve;
  }
  P at(const P& speed) const { return curve.level(speed, true); }
};

/// Laws with a common interface: `sticks`, u follows the motion in mode 0; `lags`, there is a b; `gentle`, du/dphi does
/// not jump where the mode changes, so that a small error of the edge has a second-order effect only.
inline constexpr double beyond = 1e300;  ///< a bound that is never met

/// Modes: 0 elastic, 1 between, 2 plastic.
template <class P>
struct ElastoPlasticMarch {
  static constexpr bool sticks = true, lags = false, gentle = true;
  MarchLevel<P> level;
  double share, fixed;

  explicit ElastoPlasticMarch(const MarchNumbers& n) : level(n), share(n.share), fixed(n.fixed) {}

  MarchPlace<P> place(const MarchLane<P>& lane, const P& sine, const P&) const {
    const P g = level.at(lane.speed * sine);
    const P elastic = fixed > 0.0 ? P(fixed) : share * g;
    return {lane.reach * sine, g, elastic, 1.0 / g, 1.0 / (g - elastic)};
  }
  /// a = (1 + sin(pi r))/2 with r = (u - middle)/(g - elastic), and da/du, by the half angle.
  MarchRate<P> rate(const MarchPlace<P>& at, const P& mode, const P& u, const MarchLane<P>&) const {
    const P &width = at.per_range, &per = at.per;
    const P r = min(P(0.65), max(P(-0.65), (u - at.extra) * width - 0.5));
    const P h = (0.5 * 3.14159265358979323846) * r, s = h * h;
    const P sine =
        h *
        (((((((P(-1.0 / 1307674368000.0) * s + 1.0 / 6227020800.0) * s - 1.0 / 39916800.0) * s + 1.0 / 362880.0) * s -
            1.0 / 5040.0) *
               s +
           1.0 / 120.0) *
              s -
          1.0 / 6.0) *
             s +
         1.0);
    const P cosine =
        ((((((((P(1.0 / 20922789888000.0) * s - 1.0 / 87178291200.0) * s + 1.0 / 479001600.0) * s - 1.0 / 3628800.0) *
                 s +
             1.0 / 40320.0) *
                s -
            1.0 / 720.0) *
               s +
           1.0 / 24.0) *
              s -
          0.5) *
             s +
         1.0);
    const auto plastic = mode > 1.5, elastic = mode < 0.5;
    const P a = select(plastic, P(1.0), select(elastic, P(0.0), 0.5 + sine * cosine));
    const P slope =
        select(plastic | elastic, P(0.0), (0.5 * 3.14159265358979323846) * (1.0 - 2.0 * sine * sine) * width);
    return {at.drive * (1.0 - a * u * per), -at.drive * (a + slope * u) * per};
  }
  MarchBand<P> band(const MarchPlace<P>& at, const P& mode) const {
    const P low = select(mode > 1.5, at.level, select(mode > 0.5, at.extra, P(-beyond)));
    return {low, select(mode > 1.5, P(beyond), select(mode > 0.5, at.level, at.extra))};
  }
  /// Largest rate of relaxation in that mode.
  P stiffness(const MarchPlace<P>& at, const P& mode, const MarchLane<P>&) const {
    return at.drive * select(mode > 1.5, at.per, select(mode > 0.5, 1.6 * at.per_range, P(0.0)));
  }
  P next(const P& mode, const typename P::Mask& up) const { return mode + select(up, P(1.0), P(-1.0)); }
};

/// Modes: 0 below the cap, 1 and -1 at the upper and the lower one.
template <class P>
struct CappedMarch {
  static constexpr bool sticks = true, lags = true, gentle = true;
  MarchLevel<P> level;

  explicit CappedMarch(const MarchNumbers& n) : level(n) {}

  /// `extra`: force added by the damper below the cap.
  MarchPlace<P> place(const MarchLane<P>& lane, const P& sine, const P& b) const {
    return {lane.reach * sine, b, lane.drag * sine, 0.0, 0.0};
  }
  MarchRate<P> rate(const MarchPlace<P>& at, const P& mode, const P& u, const MarchLane<P>& lane) const {
    const auto below = abs(mode) < 0.5;
    return {select(below, at.drive, lane.tempo * (mode * at.level - u)), select(below, P(0.0), -lane.tempo)};
  }
  MarchBand<P> band(const MarchPlace<P>& at, const P& mode) const {
    const P upper = at.level - at.extra, lower = -at.level - at.extra;
    return {select(mode > 0.5, upper, select(mode < -0.5, P(-beyond), lower)),
            select(mode > 0.5, P(beyond), select(mode < -0.5, lower, upper))};
  }
  P stiffness(const MarchPlace<P>&, const P& mode, const MarchLane<P>& lane) const {
    return select(abs(mode) > 0.5, lane.tempo, P(0.0));
  }
  P next(const P& mode, const typename P::Mask& up) const { return mode + select(up, P(1.0), P(-1.0)); }
};

/// One mode.
template <class P>
struct DahlMarch {
  static constexpr bool sticks = false, lags = false, gentle = false;
  double exponent;

  explicit DahlMarch(const MarchNumbers& n) : exponent(n.exponent) {}

  MarchPlace<P> place(const MarchLane<P>& lane, const P& sine, const P&) const {
    return {lane.reach * sine, 1.0, 0.0, 0.0, 0.0};
  }
  MarchRate<P> rate(const MarchPlace<P>& at, const P&, const P& u, const MarchLane<P>&) const {
    const P left = max(1.0 - u, P(1e-200)), f = power(left, P(exponent));
    return {at.drive * f, -exponent * at.drive * f / left};
  }
  MarchBand<P> band(const MarchPlace<P>&, const P&) const { return {-beyond, beyond}; }
  P stiffness(const MarchPlace<P>&, const P&, const MarchLane<P>&) const { return 0.0; }
  P next(const P& mode, const typename P::Mask&) const { return mode; }
};

/// Modes: 0 for u < 0, 1 for u > 0.
template <class P>
struct BoucWenMarch {
  static constexpr bool sticks = false, lags = false, gentle = false;
  double exponent, curvature;

  explicit BoucWenMarch(const MarchNumbers& n) : exponent(n.exponent), curvature(n.curvature) {}

  MarchPlace<P> place(const MarchLane<P>& lane, const P& sine, const P&) const {
    return {lane.reach * sine, 1.0, 0.0, 0.0, 0.0};
  }
  MarchRate<P> rate(const MarchPlace<P>& at, const P& mode, const P& u, const MarchLane<P>&) const {
    const auto up = mode > 0.5;
    // A mode is continued beyond its end as an odd power, so that panels that overshoot stay smooth.
    const P size = max(select(up, u, -u), P(0.0)), f = power(size, P(exponent));
    const P bend = select(up, P(1.0), P(curvature)), turn = select(up, P(-exponent), P(exponent));
    return {at.drive * (1.0 - bend * f), at.drive * turn * bend * f / max(size, P(1e-200))};
  }
  MarchBand<P> band(const MarchPlace<P>&, const P& mode) const {
    const auto up = mode > 0.5;
    return {P(-beyond), select(up, P(beyond), P(0.0))};
  }
  P stiffness(const MarchPlace<P>& at, const P&, const MarchLane<P>&) const { return at.drive; }
  P next(const P&, const typename P::Mask&) const { return 1.0; }
};

}  // namespace limcycle
