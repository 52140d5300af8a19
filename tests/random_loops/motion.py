"""A piecewise linear loop from event to event."""

from dataclasses import dataclass

import numpy as np

from .elements import Switch, element
from .grid import Flow


MOST_GRIDS = 60  # without an event: a motion that goes on unchanged


@dataclass
class Point:
    """State of a motion right after an event."""

    t: float
    X: np.ndarray
    modes: tuple
    queue: tuple = ()  # of a delayed relay: (time, output mode) still to come
    applied: int = 0  # the delayed output mode
    label: tuple = ()  # what happened


class PiecewiseLoop:
    """Marches a LoopModel whose elements are piecewise linear; one of them may be a delayed relay."""

    def __init__(self, model):
        self.y = model.y
        self.A = model.A
        self.model = model
        memory = None
        if any(port.keys["kind"] == "backlash" for port in model.ports):
            memory = self._add_memory()
        self.elements = [element(port, memory) for port in model.ports]
        self.delays = [port.delay for port in model.ports]
        self.delayed = next((i for i, delay in enumerate(self.delays) if delay > 0.0), None)
        if self.delayed is not None and isinstance(self.elements[self.delayed], Switch):
            self.elements[self.delayed].holds = False  # what answers late cannot hold
        self.memory = memory
        self.flows = {}

    def _add_memory(self):
        """A state before the constant; every row and column grows by it."""
        at = len(self.A) - 1
        self.A = np.insert(np.insert(self.A, at, 0.0, axis=0), at, 0.0, axis=1)
        self.y = np.insert(self.y, at, 0.0)
        for port in self.model.ports:
            port.row, port.column = np.insert(port.row, at, 0.0), np.insert(port.column, at, 0.0)
        return at

    def start(self, X):
        """The first point from the states of the model."""
        X = np.array(X, float)
        if len(X) < len(self.A):
            X = np.insert(X, len(X) - 1, 0.0)
        modes = tuple(e.first(X) for e in self.elements)
        point = Point(0.0, X, modes, (), modes[self.delayed] if self.delayed is not None else 0)
        return self._settled_modes(point)

    def system(self, modes, applied, without=None):
        """Matrix of the system in these modes, without the output of one element. Held outputs come last, because they
        depend on all the others."""
        A = self.A.copy()
        order = sorted(range(len(modes)), key=lambda i: isinstance(self.elements[i], Switch) and modes[i] == 0)
        for i in order:
            if i == without:
                continue
            mode = applied if i == self.delayed else modes[i]
            e = self.elements[i]
            A = A + np.outer(e.column, e.output(mode, A))
            if isinstance(e, Switch) and mode == 0:
                A = A - np.outer(e.column, e.row @ A) / (e.row @ e.column)  # of roundings
                A[(e.row != 0.0) & (np.count_nonzero(e.row[:-1]) == 1)] = 0.0
        if self.memory is not None:
            e = next(e for e in self.elements if hasattr(e, "memory_rate"))
            A[self.memory] = e.memory_rate(modes[self.elements.index(e)], A)
        return A

    def flow(self, modes, applied):
        """The flow in these modes; its guards are named (element, name)."""
        key = (modes, applied)
        if key not in self.flows:
            A = self.system(modes, applied)
            guards = []
            for i, (e, mode) in enumerate(zip(self.elements, modes)):
                rest = self.system(modes, applied, i) if isinstance(e, Switch) else A
                for row, name in e.guards(mode, e.output(mode, rest), rest):
                    guards.append((row, (i, name)))
            self.flows[key] = Flow(A, guards, self.y)
        return self.flows[key]

    def advance(self, point, horizon=np.inf):
        """The point after the next event, or None if none comes (within the horizon)."""
        flow = self.flow(point.modes, point.applied)
        due = point.queue[0][0] - point.t if point.queue else np.inf
        X, waited = point.X, 0.0
        for _ in range(MOST_GRIDS):
            left = min(due, horizon) - waited
            event = flow.first_event(X, left)
            if event is not None:
                t, k = event
                return self._cross(point, flow.at(X, t), waited + t, flow.guards[k][1])
            if flow.times[-1] >= left:
                return self._apply(point, flow.at(X, due - waited), due) if due <= horizon else None
            X, waited = flow.Phi[-1] @ X, waited + flow.times[-1]
            if (flow.complete and not point.queue) or not np.isfinite(X).all():
                return None
            flow = flow.later()
        return None

    def _apply(self, point, X, waited):
        """A delayed output arrives."""
        mode = point.queue[0][1]
        t = point.queue[0][0]
        return Point(t, X, point.modes, point.queue[1:], mode, ("arrives", point.applied, mode))

    def _cross(self, point, X, waited, guard):
        """An element leaves its mode."""
        i, name = guard
        e = self.elements[i]
        A = self.system(point.modes, point.applied, i)
        X = self._projected(e, X)
        mode = e.after(point.modes[i], name, X, A)
        modes = tuple(mode if j == i else old for j, old in enumerate(point.modes))
        queue, applied, t = point.queue, point.applied, point.t + waited
        if i == self.delayed:
            queue = queue + ((t + self.delays[i], mode),)
        return self._settled_modes(Point(t, X, modes, queue, applied, (i, point.modes[i], mode)))

    def _projected(self, e, X):
        """Exactly on the surface of a held input, so that roundings do not add up."""
        if isinstance(e, Switch) and e.holds:
            weight = e.column / (e.row @ e.column)
            X = X - weight * (e.row @ X)
        return X

    def _settled_modes(self, point):
        """Held inputs that can no longer be held after another element has switched are let go."""
        modes = list(point.modes)
        for i, e in enumerate(self.elements):
            if isinstance(e, Switch) and modes[i] == 0:
                holds, side = e.still_holds(point.X, self.system(tuple(modes), point.applied, i))
                if not holds:
                    modes[i] = side
        point.modes = tuple(modes)
        return point
