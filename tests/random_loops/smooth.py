"""Loops with bristles or curved sliding friction: SciPy's LSODA, restarted at every stick and slip.

The absolute tolerance of the velocity is a small part of the Stribeck velocity: with one tolerance for all states a loose
run breaks stiction early and settles on a false cycle.
"""

import numpy as np
from scipy.integrate import LSODA
from scipy.optimize import brentq

from . import laws
from .attractor import Attractor

BRISTLES = ("lugre", "dahl", "elasto-plastic")
STICKING = ("stribeck", "karnopp")


class SmoothLoop:
    """A LoopModel with one friction law and saturations."""

    def __init__(self, model, rtol=1e-8):
        self.model, self.rtol = model, rtol
        self.y = model.y
        friction = next(port for port in model.ports if port.role == "friction")
        self.keys, self.row, self.column = friction.keys, friction.row, friction.column
        self.limits = [(p.row, p.column, p.keys["limit"]) for p in model.ports if p.role == "saturation"]
        self.has_bristle = self.keys["kind"] in BRISTLES
        self.law = laws.bristle(self.keys) if self.has_bristle else laws.stribeck_level(self.keys)
        self.band = self.keys.get("dv", 0.0)
        self.viscous = self.keys.get("sigma2", 0.0)
        self.strength = float(self.row @ self.column)
        if self.strength >= 0.0:
            raise ValueError("friction must act against the rate of its own velocity")
        self.slow = self.keys.get("vs", None)

    def free_rate(self, X):
        """dX/dt without friction."""
        rate = self.model.A @ X
        for row, column, limit in self.limits:
            rate = rate + column * min(limit, max(-limit, row @ X))
        return rate

    def need(self, X):
        """The friction that would keep the velocity as it is."""
        return -(self.row @ self.free_rate(X)) / self.strength

    def rate(self, mode):
        """The right side in a mode: 0 sticking, 1 and -1 sliding, 2 and -2 breaking away within Karnopp's band."""
        if self.has_bristle:

            def bristled(t, S):
                X = S[:-1]
                force, z = self.law(self.row @ X, S[-1])
                return np.append(self.free_rate(X) + self.column * force, z)

            return bristled
        if mode == 0:

            def stuck(t, X):
                free = self.free_rate(self._stopped(X))  # behind a wound-up integral, a rounding of v moves y in time
                return free - self.column * ((self.row @ free) / self.strength)

            return stuck
        side = 1.0 if mode > 0 else -1.0

        def sliding(t, X):
            v = self.row @ X
            level = self.law(v if v * side > 0.0 else 0.0) if abs(mode) == 1 else self.keys["Fs"]
            return self.free_rate(X) + self.column * (side * level + self.viscous * v)

        return sliding

    def guard(self, mode):
        """A function that is positive while the mode lasts."""
        if self.has_bristle:
            return None
        side = 1.0 if mode > 0 else -1.0
        if mode == 0:
            return lambda X: self.keys["Fs"] - abs(self.need(X))
        if abs(mode) == 2:
            return lambda X: min(self.band - side * (self.row @ X), side * (self.row @ X) + 1e-9 * self.band)
        return lambda X: side * (self.row @ X) - self.band

    def after(self, mode, X):
        """(mode, X) after the guard of a mode."""
        v = self.row @ X
        if mode == 0:
            side = 1 if self.need(X) > 0.0 else -1
            return (2 * side if self.band else side), self._nudged(X, side)
        if abs(mode) == 2 and abs(v) > 0.5 * self.band:
            return mode // 2 if mode > 0 else -1, X
        X = self._stopped(X)
        need = self.need(X)
        if abs(need) <= self.keys["Fs"]:
            return 0, X
        side = 1 if need > 0.0 else -1
        return (2 * side if self.band else side), X

    def _stopped(self, X):
        return X - self.column * ((self.row @ X) / self.strength)

    def _nudged(self, X, side):
        """A first velocity: with an infinite slope of the curve at rest, motion starts only so."""
        v = 1e-9 * (self.band or self.keys["vs"])
        return X + self.column * (side * v / self.strength)

    def first(self, X):
        """(mode, state) of a start."""
        if self.has_bristle:
            return 1, np.append(X, 0.0)
        v = self.row @ X
        if abs(v) <= self.band:
            X = self._stopped(X)
            if abs(self.need(X)) <= self.keys["Fs"]:
                return 0, X
            side = 1 if self.need(X) > 0.0 else -1
            return (2 * side if self.band else side), self._nudged(X, side)
        return (1 if v > 0.0 else -1), X

    def tolerances(self, X, size):
        """Absolute tolerances by state: of a velocity that rubs, a part of vs."""
        atol = self.rtol * 1e-3 * np.maximum(np.abs(X), 1e-6 * size)
        atol[len(self.row) - 1] = 1.0
        if self.slow:
            for i in np.flatnonzero(self.row[:-1]):
                atol[i] = min(atol[i], self.rtol * 0.1 * self.slow)
        if self.has_bristle:
            level = self.keys.get("Fs", self.keys["Fc"])
            atol[-1] = self.rtol * 1e-2 * level / self.keys["sigma0"]
        return atol


class Run:
    """A motion kept step by step."""

    def __init__(self, loop, X, size):
        self.loop, self.size = loop, size
        self.mode, self.S = loop.first(np.array(X, float))
        self.t, self.pieces = 0.0, []  # (t0, t1, interpolant, end state)
        self.solver = None
        self.switches = 0

    def _solver(self):
        atol = self.loop.tolerances(self.S, self.size)
        return LSODA(self.loop.rate(self.mode), self.t, self.S, np.inf, rtol=self.loop.rtol, atol=atol)

    def step(self):
        """One step, cut at an event; False where the solver fails."""
        if self.solver is None:
            self.solver = self._solver()
        solver = self.solver
        if solver.status != "running":
            return False
        solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            return False
        dense, t0, t1, end = solver.dense_output(), solver.t_old, solver.t, solver.y
        guard = self.loop.guard(self.mode)
        if guard is not None and guard(end) < 0.0:
            t1 = brentq(lambda t: guard(dense(t)), t0, t1, xtol=1e-15 * max(t1, 1e-300)) if guard(dense(t0)) > 0.0 else t0
            end = dense(t1)
            self.mode, self.S = self.loop.after(self.mode, end)
            self.solver = None
            self.switches += 1
            end = self.S
        self.t, self.S = t1, end
        self.pieces.append((t0, t1, dense, end))
        return True


def settle(loop, X, bound, most_steps=36000, window=900):
    """Follows a motion until it is clear what it comes to."""
    size = np.abs(X[:-1]).max()
    run = Run(loop, X, size)
    horizon = np.inf
    for count in range(most_steps // window):
        if run.t > horizon:
            return Attractor("unknown", why=f"a slow motion, not decided at t = {run.t:.6g}")
        for _ in range(window):
            if not run.step():
                return Attractor("unknown", why="the solver gave up")
            if abs(loop.y @ run.S[: len(loop.y)]) > bound:
                return Attractor("divergence")
        found = judged(run)
        if found is not None:
            return found
        horizon = 1e6 * run.t if count == 0 else horizon
    return Attractor("unknown", why=f"nothing decided after {most_steps} steps at t = {run.t:.6g}")


def judged(run):
    """Rest, sliding or a cycle, or None if that is not yet clear."""
    n = len(run.loop.y)
    states = np.array([piece[3] for piece in run.pieces])
    times = np.array([piece[1] for piece in run.pieces])
    late = times > 0.4 * times[-1]
    reach = np.ptp(states, axis=0) + 1e-300
    if late.sum() > 3 and (np.ptp(states[late], axis=0)[: n - 1] < 1e-7 * reach[: n - 1]).all():
        slides = abs(run.loop.row @ run.S[:n]) > 1e-6 * (run.loop.slow or np.abs(states @ _padded(run, n)).max())
        return Attractor("sliding" if slides else "rest", offset=float(run.loop.y @ run.S[:n]))
    # Upward crossings of the middle of the last swings.
    tail = states[len(states) // 2 :, :n] @ run.loop.y
    if np.ptp(tail) < 1e-9 * np.ptp(states[:, :n] @ run.loop.y):
        return None
    level = 0.5 * (tail.max() + tail.min())
    crossings = _crossings(run, level, 13)
    if len(crossings) < 4:
        return None
    return _repeats(run, crossings, np.ptp(states[len(states) // 2 :], axis=0) + 1e-300)


def _padded(run, n):
    row = np.zeros(len(run.S))
    row[:n] = run.loop.row
    return row


def _crossings(run, level, most):
    """The last times and states at which y rises through a level, latest first."""
    y_row, found = run.loop.y, []
    n = len(y_row)
    for t0, t1, dense, end in reversed(run.pieces):
        if y_row @ end[:n] >= level and t1 > t0 and y_row @ dense(t0)[:n] < level:
            t = brentq(lambda t: y_row @ dense(t)[:n] - level, t0, t1, xtol=1e-14 * t1) if y_row @ end[:n] > level else t1
            found.append((t, dense(t)))
            if len(found) == most:
                break
    return found


def _repeats(run, crossings, reach, close=2e-6):
    for p in range(1, (len(crossings) - 1) // 3 + 1):
        first, second, third = crossings[0], crossings[p], crossings[2 * p]
        same = (np.abs(first[1] - second[1]) < close * reach).all() and (np.abs(second[1] - third[1]) < close * reach).all()
        periods = first[0] - second[0], second[0] - third[0]
        if same and abs(periods[0] / periods[1] - 1.0) < 10 * close:
            low, high = _swing(run, second[0], first[0])
            return Attractor("cycle", periods[0], 0.5 * (high - low), 0.5 * (high + low))
    return None


def _swing(run, begin, end):
    """Lowest and highest y between two times."""
    y_row, low, high = run.loop.y, np.inf, -np.inf
    for t0, t1, dense, _ in reversed(run.pieces):
        if t0 > end or t1 == t0:
            continue
        if t1 < begin:
            break
        y = y_row @ dense(np.linspace(max(t0, begin), min(t1, end), 5))[: len(y_row)]
        low, high = min(low, y.min()), max(high, y.max())
    return low, high
