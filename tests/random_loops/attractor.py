"""What a motion of a piecewise linear loop comes to: rest, steady sliding, a cycle, divergence."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from .motion import MOST_GRIDS

CLOSE = 1e-9  # of the range of each state: a motion has come back
NEAR = 3e-3  # a motion nearly comes back: worth Newton's method
LONGEST = 12  # returns of a section in one period


@dataclass
class Attractor:
    """The end of a motion. `kind`: rest, sliding, cycle, divergence or unknown."""

    kind: str
    period: float = None
    amplitude: float = None
    offset: float = None
    multipliers: list = field(default_factory=list)
    why: str = ""
    point: object = None

    def same(self, other, tolerance=1e-3):
        """Whether two cycles are the same one."""
        return (
            self.kind == other.kind == "cycle"
            and abs(self.period / other.period - 1.0) < tolerance
            and abs(self.amplitude / other.amplitude - 1.0) < tolerance
            and abs(self.offset - other.offset) < tolerance * (self.amplitude + other.amplitude)
        )


def swing(loop, point, period):
    """(lowest, highest) y over a time from a point on, with parabolas between grid points."""
    left, low, high = period, np.inf, -np.inf
    for _ in range(10000):
        following = loop.advance(point, left)
        taken = left if following is None else following.t - point.t
        a, b = _extrema(loop.flow(point.modes, point.applied), point.X, taken, loop.y)
        low, high = min(low, a), max(high, b)
        left -= taken
        if following is None or left <= 1e-12 * period:
            break
        point = following
    return low, high


def _extrema(flow, X, taken, y_row):
    """Extremes of y along a flow."""
    if taken > flow.times[-1]:
        rest = _extrema(flow.later(), flow.Phi[-1] @ X, taken - flow.times[-1], y_row)
        parts = [_extrema(flow, X, flow.times[-1], y_row), rest]
        return min(parts[0][0], parts[1][0]), max(parts[0][1], parts[1][1])
    n = int(np.searchsorted(flow.times, taken, side="right"))
    y, dy, t = flow.y[:n] @ X, flow.dy[:n] @ X, flow.times[:n]
    end = flow.at(X, taken)
    y, dy, t = np.append(y, y_row @ end), np.append(dy, y_row @ flow.A @ end), np.append(t, taken)
    low, high = y.min(), y.max()
    for j in np.flatnonzero(dy[:-1] * dy[1:] < 0.0):
        h = t[j + 1] - t[j]
        s = np.linspace(0.0, 1.0, 33)
        p = (
            (1 + 2 * s) * (1 - s) ** 2 * y[j] + s * (1 - s) ** 2 * h * dy[j]
            + s**2 * (3 - 2 * s) * y[j + 1] + s**2 * (s - 1) * h * dy[j + 1]
        )  # fmt: skip
        low, high = min(low, p.min()), max(high, p.max())
    return low, high


def settle(loop, X, bound, most_events=800, start=None):
    """Follows a motion until it is clear what it comes to. `bound`: |y| beyond which it has diverged, in the range of
    the start."""
    point = loop.start(X) if start is None else start
    history, stuck, tried = {}, 0, 0
    recent, first = deque(maxlen=60), None
    for count in range(most_events):
        before = point
        point = loop.advance(before)
        if point is None:
            return _without_events(loop, before, bound)
        if not np.isfinite(point.X).all() or abs(loop.y @ point.X) > bound:
            return Attractor("divergence")
        stuck = stuck + 1 if point.t - before.t <= 1e-13 * max(1e-300, point.t) else 0
        if stuck > 8:
            small = first is not None and len(recent) > 20 and recent[-1].max() < 1e-5 * first.max()
            why = "events without time between them"
            return Attractor("rest", why="ever faster switching") if small else Attractor("unknown", why=why)
        if stuck:
            continue
        recent.append(np.maximum(np.abs(point.X[:-1]), np.abs(_halfway(loop, before, point.t))))
        first = recent[0] if first is None else first
        scale = np.max(recent, axis=0)
        scale = scale + 1e-12 * scale.max() + 1e-300
        hits = history.setdefault((point.label, point.modes, len(point.queue)), [])
        hits.append(point)
        returned = _returns(hits, scale)
        if returned is not None:
            return _cycle(loop, hits[-1], returned)
        if len(hits) - tried > 15 and count > 40:
            tried = len(hits)
            found = _nearly(loop, hits, scale)
            if found is not None:
                return found
        if _dies_out(loop, hits):
            return Attractor("rest", why="ever smaller")
    return Attractor("unknown", why=f"nothing decided after {most_events} events at t = {point.t:.6g}", point=point)


def _distance(a, b, scale):
    difference = np.abs(a.X[:-1] - b.X[:-1]) / scale
    if len(a.queue) == len(b.queue) and a.queue:
        waits = [abs((p[0] - a.t) - (q[0] - b.t)) / (p[0] - a.t + 1e-300) for p, q in zip(a.queue, b.queue)]
        return max(difference.max(), max(waits))
    return difference.max()


def _halfway(loop, point, t):
    """States about half the way to the next event: those of a section alone do not show their range."""
    flow = loop.flow(point.modes, point.applied)
    j = np.searchsorted(flow.times, 0.5 * (t - point.t), side="right") - 1
    return (flow.Phi[max(j, 0)] @ point.X)[:-1]


def _returns(hits, scale):
    """Number of returns after which a motion repeats itself, or None."""
    for p in range(1, min(LONGEST, (len(hits) - 1) // 2) + 1):
        if _distance(hits[-1], hits[-1 - p], scale) < CLOSE and _distance(hits[-1 - p], hits[-1 - 2 * p], scale) < CLOSE * 10:
            return p
    return None


def _nearly(loop, hits, scale):
    """A slow approach: Newton's method from where the motion nearly repeats itself."""
    for p in range(1, min(LONGEST, len(hits) - 1) + 1):
        if _distance(hits[-1], hits[-1 - p], scale) < NEAR:
            found = shoot(loop, hits[-1], p)
            if found is not None and found.multipliers and abs(found.multipliers[0]) < 1.0:
                low, high = swing(loop, hits[-1 - p], hits[-1].t - hits[-1 - p].t)
                if abs(0.5 * (high - low) / found.amplitude - 1.0) < 0.02:
                    return found
            return None
    return None


def _dies_out(loop, hits):
    """Ever smaller swings: the last ones are 1e-10 of the first."""
    if len(hits) < 6:
        return False
    still = hits[-1].X[:-1] - hits[-2].X[:-1]
    largest = max(np.abs(hits[i].X[:-1] - hits[i - 1].X[:-1]).max() for i in range(1, min(6, len(hits))))
    return np.abs(still).max() < 1e-10 * largest and abs(hits[-1].t - hits[-2].t) < 1e-6 * abs(hits[1].t - hits[0].t)


def _cycle(loop, point, returns):
    """Period, amplitude and offset of a motion that repeats itself from `point` on."""
    again, label, seen = point, (point.label, point.modes, len(point.queue)), 0
    for _ in range(5000):
        again = loop.advance(again)
        if again is None:
            return Attractor("unknown", why="a cycle was lost")
        if (again.label, again.modes, len(again.queue)) == label:
            seen += 1
            if seen == returns:
                break
    period = again.t - point.t
    low, high = swing(loop, point, period)
    if high - low < 1e-9 * (abs(high) + abs(low)):
        return Attractor("rest", why="a cycle without a swing")
    return Attractor("cycle", period, 0.5 * (high - low), 0.5 * (high + low), point=point)


def _without_events(loop, point, bound):
    """A motion that stays in one mode for ever."""
    flow = loop.flow(point.modes, point.applied)
    X = point.X
    for _ in range(MOST_GRIDS):
        X = flow.Phi[-1] @ X
        if not np.isfinite(X).all() or abs(loop.y @ X) > bound:
            return Attractor("divergence")
        if flow.complete:
            break
        flow = flow.later()
    friction = [i for i, port in enumerate(loop.model.ports) if port.role == "friction"]
    rate = flow.A @ X
    scale = np.abs(X[:-1]).max() + 1e-300
    if np.abs(rate[:-1]).max() * flow.times[-1] > 1e-3 * scale:
        return Attractor("unknown", why="a slow motion without events")
    slides = any(point.modes[i] != 0 for i in friction)
    return Attractor("sliding" if slides else "rest", offset=float(loop.y @ X))


def _return_map(loop, point, returns, most_events=4000):
    """The point after `returns` visits to the section of `point`, or None."""
    label, seen = (point.label, point.modes, len(point.queue)), 0
    start_t, stuck = point.t, 0
    for _ in range(most_events):
        before, point = point, loop.advance(point)
        if point is None or not np.isfinite(point.X).all():
            return None
        stuck = stuck + 1 if point.t == before.t else 0
        if stuck > 8:
            return None
        if (point.label, point.modes, len(point.queue)) == label:
            seen += 1
            if seen == returns:
                point.elapsed = point.t - start_t
                return point
    return None


def shoot(loop, point, returns, iterations=12):
    """Newton's method on the return map, by differences; None where it fails or the loop has a queue."""
    if point.queue:
        return None
    n = len(point.X) - 1
    X = point.X.copy()
    scale = np.abs(X[:-1]) + 1e-9 * np.abs(X[:-1]).max() + 1e-300
    for _ in range(iterations):
        image = _return_map(loop, _moved(point, X), returns)
        if image is None:
            return None
        J = np.zeros((n, n))
        for i in range(n):
            step = 1e-6 * scale[i]
            sides = []
            for sign in (1.0, -1.0):
                Y = X.copy()
                Y[i] += sign * step
                side = _return_map(loop, _moved(point, Y), returns)
                if side is None:
                    return None
                sides.append(side.X[:-1])
            J[:, i] = (sides[0] - sides[1]) / (2.0 * step)
        residual = image.X[:-1] - X[:-1]
        change = np.linalg.lstsq((np.eye(n) - J) / scale[:, None] * scale, residual / scale, rcond=1e-10)[0] * scale
        X[:-1] += change
        if np.abs(change / scale).max() < 1e-9:
            found = _cycle(loop, _moved(point, X), returns)
            values = np.linalg.eigvals(J / scale[:, None] * scale)
            found.multipliers = sorted(values.tolist(), key=abs, reverse=True)
            return found if found.kind == "cycle" else None
    return None


def _moved(point, X):
    """The same section with other states."""
    return type(point)(point.t, X.copy(), point.modes, point.queue, point.applied, point.label)
