"""The loop of a case as one linear system with elements in feedback.

X = (states, 1) follows X' = A X + sum_i column_i w_i, where element i has the input row_i X and the output w_i. The last
entry of X is the constant 1, so references, loads and biases are columns of A.
"""

from dataclasses import dataclass, field

import numpy as np

from . import linear


@dataclass
class Port:
    """Where an element sits: its kind and keys, the row of its input and the column of its output."""

    role: str  # "friction", "element" or "saturation"
    keys: dict
    row: np.ndarray
    column: np.ndarray
    delay: float = 0.0


@dataclass
class LoopModel:
    """Matrices of a loop; `friction_row` is that of the rubbing velocity (belt included), or None."""

    A: np.ndarray
    y: np.ndarray
    ports: list
    names: dict  # states by meaning: "positions", "velocities", "integral": lists of indices
    plant_order: int
    push: np.ndarray  # column of a force on the plant
    reference: float = 0.0

    @property
    def order(self):
        """Number of states, without the constant."""
        return len(self.A) - 1

    def start(self, displacement=0.0, kick=0.0, windup=0.0):
        """At rest at the origin but for: y displaced, a velocity, an integral of the error."""
        X = np.zeros(len(self.A))
        X[-1] = 1.0
        if displacement and self.names["positions"]:
            X[self.names["positions"]] = displacement
        elif displacement:
            direction = self._slow_direction()
            X[:-1] += displacement * direction
        for key, size in (("velocities", kick), ("integral", windup)):
            X[self.names[key]] = size
        return X

    def _slow_direction(self):
        """The states that a constant force on the plant leads to, scaled so that y is one."""
        n = self.plant_order
        row, A = self.y[:n], self.A[:n, :n]
        slow = 1e-6 * (np.abs(np.linalg.eigvals(A)).max() or 1.0)
        direction = np.linalg.solve(slow * np.eye(n) - A, self.push[:n])
        if row @ direction == 0.0:
            direction = row
        full = np.zeros(self.order)
        full[:n] = direction / (row @ direction)
        return full


@dataclass
class _Chain:
    """What is being built: rows grow as controllers and lags add states."""

    A: np.ndarray
    names: dict = field(default_factory=lambda: {"positions": [], "velocities": [], "integral": []})

    def add(self, rate_row, own=None):
        """A state before the constant with rate rate_row X + own x; returns its index."""
        n = len(self.A)
        at = n - 1
        A = np.zeros((n + 1, n + 1))
        keep = [i for i in range(n + 1) if i != at]
        A[np.ix_(keep, keep)] = self.A
        A[at, keep] = rate_row
        A[at, at] = own or 0.0
        self.A = A
        return at

    def widen(self, row, at):
        """The row for the system with the state `at` put in."""
        return np.insert(row, at, 0.0)


def build(case):
    """The model of a case (a dictionary as read by tomllib)."""
    loop = case["loop"]
    plant = linear.plant(loop["plant"])
    n = len(plant.A)
    chain = _Chain(np.zeros((n + 1, n + 1)))
    chain.A[:n, :n] = plant.A
    chain.A[:n, n] = plant.B * loop.get("load", 0.0)
    chain.names["positions"] = list(plant.positions)
    chain.names["velocities"] = [i + 1 for i in plant.positions]
    reference = loop.get("reference", 0.0)
    if isinstance(reference, dict):
        raise ValueError("no moving set-points for the checker")
    rows = {"y": np.append(plant.C, 0.0), "B": np.append(plant.B, 0.0), "Bf": np.append(plant.B_friction, 0.0)}
    rows["v"] = np.append(plant.velocity, -plant.belt)
    rows["r"] = np.append(np.zeros(n), reference)
    ports = []
    _control(chain, rows, ports, loop, plant.delay)
    if "friction" in loop:
        ports.append(Port("friction", loop["friction"], rows["v"], -rows["Bf"]))
    for port in ports:
        port.row, port.column = (_padded(a, len(chain.A)) for a in (port.row, port.column))
    return LoopModel(chain.A, rows["y"], ports, chain.names, n, plant.B, reference)


def _padded(row, size):
    if len(row) != size:
        raise ValueError("a row was left behind")
    return row


def _control(chain, rows, ports, loop, delay):
    """Controller, saturation, lag and forward element, from e to the plant."""
    keys = loop.get("controller", {"kind": "none"})
    element = loop.get("element")
    if keys["kind"] == "none" and element is None:
        return
    u = _command(chain, rows, keys)

    def grow(rate_row, own):
        nonlocal u
        at = chain.add(rate_row, own)
        for key in rows:
            rows[key] = chain.widen(rows[key], at)
        for port in ports:
            port.row, port.column = chain.widen(port.row, at), chain.widen(port.column, at)
        u = chain.widen(u, at)
        return at

    lag = keys.get("lag", 0.0)
    limited = None
    if "saturation" in keys:
        limited = Port("saturation", {"kind": "saturation", "limit": keys["saturation"]}, u, None)
    if lag > 0.0:
        at = grow(np.zeros(len(u)) if limited else u / lag, -1.0 / lag)
        unit = np.eye(len(chain.A))[at]
        if limited:
            ports.append(Port("saturation", limited.keys, u, unit / lag))
        u, limited = unit, None
    if element is not None:
        if limited:
            raise ValueError("saturation straight before an element: not for the checker")
        ports.append(Port("element", element, u, rows["B"], delay))
    elif limited:
        ports.append(Port("saturation", limited.keys, u, rows["B"]))
    else:
        chain.A = chain.A + np.outer(rows["B"], u)


def _command(chain, rows, keys):
    """Row of the command u of the controller; adds its states to the chain."""
    kind = keys["kind"]

    def error():
        return rows["r"] - rows["y"]

    def grow(rate_row, own=0.0):
        at = chain.add(rate_row, own)
        for key in rows:
            rows[key] = chain.widen(rows[key], at)
        return at

    if kind == "none":
        return error()
    if kind == "pid":
        integral = grow(error()) if keys.get("ki", 0.0) else None
        if integral is not None:
            chain.names["integral"].append(integral)
        kd, tf = keys.get("kd", 0.0), keys.get("tf", 0.0)
        filtered = grow(error() / tf, -1.0 / tf) if kd and tf else None
        u = keys["kp"] * error()
        if integral is not None:
            u = u + keys["ki"] * np.eye(len(chain.A))[integral]
        if filtered is not None:
            u = u + kd / tf * (error() - np.eye(len(chain.A))[filtered])
        elif kd:
            u = u + kd * error() @ chain.A
        return u
    if kind == "transfer-function":
        A, B, C, D = linear.canonical(keys["numerator"], keys["denominator"])
    elif kind == "state-space":
        A, B, C = (np.atleast_2d(np.asarray(keys[key], float)) for key in "ABC")
        B, C = B.ravel(), C.ravel()
        D = float(np.asarray(keys.get("D", [[0.0]]), float).ravel()[0])
    else:
        raise ValueError(f"no controller for the checker: {kind}")
    states = [grow(b * error()) for b in B]
    chain.A[np.ix_(states, states)] += A
    u = D * error()
    u[states] += C
    return u
