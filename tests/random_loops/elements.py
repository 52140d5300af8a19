"""Piecewise linear elements: in each mode the output is a row of X, and rows that must stay positive guard the mode.

A mode is a small integer. `output(mode, A)` is the row of the output, where A is the system without this element;
`guards(mode, output, A)` are pairs of a row that must stay positive and a name; `after(mode, name, X, hold)` is the mode
after that guard has been crossed.
"""

import numpy as np


class Switch:
    """Set-valued at zero: ideal relay, and Coulomb friction with stiction and viscous friction.

    Modes: 1 and -1 by the sign of the input, 0: the input is held at zero (sticking, sliding mode of a relay).
    """

    def __init__(self, port, level, hold=None, viscous=0.0):
        self.row, self.column = port.row, port.column
        self.level, self.viscous = level, viscous
        self.hold = dict(level) if hold is None else hold
        strength = float(self.row @ self.column)
        size = np.linalg.norm(self.row[:-1]) * np.linalg.norm(self.column)
        self.holds = strength < -1e-12 * size
        self.unit = np.eye(len(self.row))[-1]

    def first(self, X):
        """The mode of a start: by the sign of the input, held where it is zero."""
        z = self.row @ X
        if z != 0.0:
            return 1 if z > 0.0 else -1
        return 0 if self.holds else 1

    def held(self, A):
        """Row of the output that keeps the rate of the input at zero."""
        return -(self.row @ A) / (self.row @ self.column)

    def output(self, mode, A):
        """Row of the output."""
        if mode == 0:
            return self.held(A)
        return mode * self.level[mode] * self.unit + self.viscous * self.row

    def guards(self, mode, output, A):
        """The sign of the input, or the limits of what can be held."""
        if mode == 0:
            return [(self.hold[1] * self.unit - output, "up"), (output + self.hold[-1] * self.unit, "down")]
        return [(mode * self.row, "zero")]

    def after(self, mode, name, X, A):
        """From a side over zero, or out of holding."""
        if name != "zero":
            return 1 if name == "up" else -1
        if not self.holds:
            return -mode
        need = self.held(A) @ X
        if -self.hold[-1] <= need <= self.hold[1]:
            return 0
        return 1 if need > 0.0 else -1

    def still_holds(self, X, A, slack=1e-9):
        """Whether what has to be held can be held."""
        need = self.held(A) @ X
        return -self.hold[-1] * (1.0 + slack) <= need <= self.hold[1] * (1.0 + slack), (1 if need > 0.0 else -1)


class Hysteresis:
    """Relay with hysteresis, with or without a dead zone: modes -1, 0, 1 are the output over the level."""

    def __init__(self, port):
        keys = port.keys
        self.row, self.column, self.level = port.row, port.column, keys["level"]
        h, d = keys.get("hysteresis", 0.0), keys.get("dead_zone", 0.0)
        self.on, self.off = d + h, d - h
        self.three = d > 0.0
        self.unit = np.eye(len(self.row))[-1]

    def first(self, X):
        """As if reached from far away on the side of the input."""
        z = self.row @ X
        if not self.three:
            return 1 if z >= 0.0 else -1
        return 0 if abs(z) < self.on else (1 if z > 0.0 else -1)

    def output(self, mode, A):
        """Row of the output."""
        return mode * self.level * self.unit

    def guards(self, mode, output, A):
        """Thresholds that leave this mode."""
        if mode == 0:
            return [(self.on * self.unit - self.row, "up"), (self.on * self.unit + self.row, "down")]
        return [(mode * self.row - self.off * self.unit, "off")]

    def after(self, mode, name, X, A):
        """The neighbouring mode."""
        if mode == 0:
            return 1 if name == "up" else -1
        return 0 if self.three else -mode


class Segments:
    """Saturation and dead zone: straight lines; modes -1, 0, 1 are the left, middle and right one."""

    def __init__(self, port):
        keys = port.keys
        self.row, self.column = port.row, port.column
        self.unit = np.eye(len(self.row))[-1]
        slope = keys.get("slope", 1.0)
        if keys["kind"] == "saturation":
            self.edge, self.inner, self.outer = keys["limit"] / slope, slope, 0.0
        else:
            self.edge, self.inner, self.outer = keys["half_width"], 0.0, slope

    def first(self, X):
        """By the input."""
        z = self.row @ X
        return 0 if abs(z) <= self.edge else (1 if z > 0.0 else -1)

    def output(self, mode, A):
        """Row of the output."""
        if mode == 0:
            return self.inner * self.row
        return self.outer * self.row + mode * (self.inner - self.outer) * self.edge * self.unit

    def guards(self, mode, output, A):
        """The corners."""
        if mode == 0:
            return [(self.edge * self.unit - self.row, "up"), (self.edge * self.unit + self.row, "down")]
        return [(mode * self.row - self.edge * self.unit, "in")]

    def after(self, mode, name, X, A):
        """The neighbouring line."""
        return {"up": 1, "down": -1, "in": 0}[name]


class Backlash:
    """Play: the output is a state of its own, moved along with the input while driven; modes -1, 0, 1: driven down,
    standing, driven up. Needs an input whose rate does not depend on the output."""

    def __init__(self, port, memory):
        keys = port.keys
        self.row, self.column, self.memory = port.row, port.column, memory
        self.gap, self.slope = keys["half_gap"], keys.get("slope", 1.0)
        self.unit = np.eye(len(self.row))[-1]
        self.kept = np.eye(len(self.row))[memory]

    def first(self, X):
        """Standing, at the middle of the gap or at its edge; sets the memory."""
        z = self.row @ X
        if abs(z) > self.gap:
            X[self.memory] = self.slope * (z - np.sign(z) * self.gap)
        return 0

    def output(self, mode, A):
        """Row of the output: the memory."""
        return self.kept

    def memory_rate(self, mode, A):
        """Row of the rate of the memory."""
        return self.slope * (self.row @ A) if mode else 0.0 * self.row

    def guards(self, mode, output, A):
        """The edges of the gap while standing, the sign of the rate while driven."""
        if mode:
            return [(mode * (self.row @ A), "turn")]
        up = self.kept - self.slope * (self.row - self.gap * self.unit)
        down = self.slope * (self.row + self.gap * self.unit) - self.kept
        return [(up, "up"), (down, "down")]

    def after(self, mode, name, X, A):
        """Driven or standing."""
        return {"up": 1, "down": -1, "turn": 0}[name]


def element(port, extra_state):
    """The element of a port; `extra_state` is the index of a free state, for those with a memory."""
    keys = port.keys
    kind = keys["kind"]
    if kind == "relay":
        if keys.get("hysteresis", 0.0) == 0.0 and keys.get("dead_zone", 0.0) == 0.0:
            return Switch(port, {1: keys["level"], -1: keys["level"]})
        return Hysteresis(port)
    if kind == "coulomb":
        slide = {1: keys["Fc"], -1: keys.get("Fc_minus", keys["Fc"])}
        stick = {1: keys.get("Fs", keys["Fc"])}
        stick[-1] = keys.get("Fs_minus", stick[1] if "Fc_minus" not in keys else keys["Fc_minus"])
        return Switch(port, slide, stick, keys.get("sigma2", 0.0))
    if kind in ("saturation", "dead-zone"):
        return Segments(port)
    if kind == "backlash":
        return Backlash(port, extra_state)
    raise ValueError(f"not piecewise linear: {kind}")
