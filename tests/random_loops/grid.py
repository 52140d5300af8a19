"""Motion of X' = A X between events: exact, on a grid of times dense enough to see every crossing.

The grid is fine after an event and grows with time; a complex pole limits the step for as long as its mode is alive, so
that a fast, dead mode costs nothing. Each X(t_j) is Phi_j X(0) with a product of matrix exponentials.
"""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

ALIVE = 45.0  # exp(-45) = 3e-20: a mode is dead after that many time constants
MOST_POINTS = 700


def exponential(A):
    """exp(A); SciPy's short cut for 2 x 2 overflows for large, stable A."""
    if len(A) != 2:
        return expm(A)
    wide = np.zeros((3, 3))
    wide[:2, :2] = A
    return expm(wide)[:2, :2]


class Flow:
    """exp(A t) on a grid, the guards there and their rates. A grid has an end; later() goes on from there."""

    def __init__(self, A, guards, y_row, age=0.0):
        self.A = A
        self.guards = guards  # pairs (row, name)
        self.y_row, self.age, self.following = y_row, age, None
        self.times, self.Phi, self.complete = _grid(A, age)
        rows = np.array([row for row, _ in guards]) if guards else np.zeros((0, len(A)))
        self.rows = rows
        self.values = np.einsum("gi,tij->gtj", rows, self.Phi)
        self.rates = np.einsum("gi,tij->gtj", rows @ A, self.Phi)
        self.roundoff = np.einsum("gi,tij->gtj", np.abs(rows), np.abs(self.Phi))
        self.y = np.einsum("i,tij->tj", y_row, self.Phi)
        self.dy = np.einsum("i,tij->tj", y_row @ A, self.Phi)

    def later(self):
        """The grid that goes on where this one ends."""
        if self.following is None:
            self.following = Flow(self.A, self.guards, self.y_row, self.age + self.times[-1])
        return self.following

    def at(self, X, t):
        """X(t), by the grid point before t and one exponential."""
        j = max(0, np.searchsorted(self.times, t, side="right") - 1)
        return exponential(self.A * (t - self.times[j])) @ (self.Phi[j] @ X)

    def first_event(self, X, until=np.inf):
        """(time, guard index) of the first guard that goes below zero, or None up to the end of the grid."""
        if not len(self.rows):
            return None
        g = self.values @ X
        noise = 5e-14 * (self.roundoff @ np.abs(X)) + 1e-300
        below = g[:, 1:] < -noise[:, 1:]
        dips = self._dips(X, g, noise)
        best = None
        for k in range(len(g)):
            hits = np.flatnonzero(below[k])
            last = hits[0] if len(hits) else len(self.times)
            early = [j for j in dips if j[0] == k and j[1] < last]
            for _, j in early:
                low = self._minimum(k, X, j, noise[k, j + 1])
                if low is not None:
                    hits, last = None, j
                    candidate = self._root(k, X, j, low)
                    break
            else:
                if not len(hits):
                    continue
                candidate = self._root(k, X, last, self.times[last + 1])
            if best is None or candidate < best[0]:
                best = (candidate, k)
        return best if best is not None and best[0] <= until else None

    def _dips(self, X, g, noise):
        """Intervals where a guard is positive at both ends but turns in between, near to zero."""
        r = self.rates @ X
        h = np.diff(self.times)
        turns = (r[:, :-1] < 0) & (r[:, 1:] > 0) & (g[:, :-1] >= -noise[:, :-1]) & (g[:, 1:] > 0)
        depth = g[:, :-1] - 0.6 * np.abs(r[:, :-1]) * h
        return [tuple(pair) for pair in np.argwhere(turns & (depth < 0))]

    def _minimum(self, k, X, j, noise):
        """Time in the interval j at which guard k is below zero, or None."""
        start = self.Phi[j] @ X
        rate = self.rows[k] @ self.A
        h = self.times[j + 1] - self.times[j]
        if not (rate @ start < 0 < rate @ exponential(self.A * h) @ start):
            return None
        s = brentq(lambda s: rate @ exponential(self.A * s) @ start, 0.0, h, xtol=1e-14 * h)
        value = self.rows[k] @ exponential(self.A * s) @ start
        return self.times[j] + s if value < -noise else None

    def _root(self, k, X, j, end):
        """Time of the zero of guard k between grid point j and `end`."""
        start = self.Phi[j] @ X
        row, h = self.rows[k], end - self.times[j]
        if row @ start <= 0.0:
            return self.times[j]
        function = _guard_function(row, self.A, start, h)
        if not function(h) < 0.0:
            return end
        return self.times[j] + brentq(function, 0.0, h, xtol=1e-15 * max(h, self.times[j]), rtol=8.9e-16)


def _guard_function(row, A, start, h):
    """row exp(A s) start as a function of s up to h: a Taylor polynomial where it converges fast."""
    if np.abs(A).sum(axis=1).max() * h < 1.0:
        terms, vector = [], start
        for k in range(22):
            terms.append(row @ vector)
            vector = A @ vector / (k + 1)
        coefficients = terms[::-1]
        return lambda s: np.polyval(coefficients, s)
    return lambda s: row @ exponential(A * s) @ start


def _grid(A, age):
    """Times, exponentials there, and whether the grid ends because nothing is alive (True) or by its length."""
    values = np.linalg.eigvals(A)
    fastest = np.abs(values).max() or np.abs(A).max() or 1.0
    live = values[np.abs(values) > 1e-9 * fastest]
    slowest = np.abs(live).min() if len(live) else fastest
    smallest = 0.01 / fastest
    ladder = {}
    times, Phi = [0.0], [np.eye(len(A))]
    growth = max(0.0, values.real.max())
    if growth < 1e-7 * fastest:
        growth = 0.0  # rounding of a multiple eigenvalue at zero
    t = age
    while len(times) < MOST_POINTS:
        alive = live[(live.real >= 0) | (-live.real * t < ALIVE)]
        h = min(smallest + 0.15 * t, 2.0 / growth if growth else np.inf)
        oscillating = alive[np.abs(alive.imag) > 1e-3 * np.abs(alive.real)]
        if len(oscillating):
            h = min(h, 0.35 / np.abs(oscillating).max())
        level = int(np.floor(np.log2(h / smallest)))
        if level not in ladder:
            ladder[level] = exponential(A * (smallest * 2.0**level))
        t += smallest * 2.0**level
        times.append(t - age)
        Phi.append(ladder[level] @ Phi[-1])
        if (t - age) * growth > 40.0 or t * slowest > 1e9:
            break
    complete = t * slowest > 1e9
    return np.array(times), np.array(Phi), complete
