"""What a loop really does: the attractors that motions from several starts come to."""

import time

import numpy as np

from . import attractor, loop_model, smooth
from .motion import PiecewiseLoop


class Truth:
    """Independent simulations of one case."""

    def __init__(self, case, rtol=1e-8, seconds=10.0):
        kind = case["loop"].get("friction", {}).get("kind")
        self.case, self.rtol = case, rtol
        self.smooth = kind in smooth.BRISTLES + smooth.STICKING
        if self.smooth:
            self.loop = smooth.SmoothLoop(loop_model.build(case), rtol)
        else:
            self.loop = PiecewiseLoop(loop_model.build(case))
        self.model = self.loop.model
        self.found = {}
        self.deadline = time.process_time() + seconds  # of CPU time, for all starts together

    def scale(self):
        """A length that matters in the loop: friction over stiffness, the width of an element, the swing of a relay."""
        loop = self.case["loop"]
        plant = loop["plant"]
        if "friction" in loop:
            force = loop["friction"].get("Fs", loop["friction"]["Fc"])
            stiff = loop.get("controller", {}).get("kp", 0.0) + plant.get("stiffness", 0.0)
            return force / stiff if stiff > 0.0 else force
        keys = loop["element"]
        gain = self._gain()
        if "level" in keys:
            return keys["level"] * gain
        width = keys.get("half_width", keys.get("half_gap", keys.get("limit", 0.0) / keys.get("slope", 1.0)))
        return width

    def _gain(self):
        """|G| at the corner of the slowest moving pole."""
        A = self.model.A[:-1, :-1]
        n = self.model.plant_order
        sizes = np.abs(np.linalg.eigvals(A[:n, :n]))
        w = np.median(sizes[sizes > 1e-9 * sizes.max()]) if sizes.max() > 0.0 else 1.0
        return abs(self.model.y[:n] @ np.linalg.solve(1j * w * np.eye(n) - A[:n, :n], self.model.push))

    def out_of_time(self):
        """Whether starts may have been left out."""
        return time.process_time() > self.deadline

    def decided(self):
        """Whether no start was left out, and each came to something that is known."""
        return not self.out_of_time() and all(one.kind != "unknown" for one in self.found.values())

    def settle(self, displacement=0.0, kick=0.0, windup=0.0):
        """The attractor from a start; kept."""
        return self._from((displacement, kick, windup), self.model.start)

    def settle_in_mode(self, frequency, swing, phase):
        """The attractor from a swing of y in the mode of the loop without its elements whose frequency is nearest."""
        return self._from((frequency, swing, phase, "mode"), lambda w, size, turn, _: in_mode(self.model, w, size, turn))

    def _from(self, key, start):
        if key not in self.found and self.out_of_time():
            return attractor.Attractor("unknown", why="no time left")
        if key not in self.found:
            X = start(*key)
            far = abs(self.model.y @ X) + abs(self.model.reference)
            bound = 1e6 * max(far, self.scale())
            method = smooth.settle if self.smooth else attractor.settle
            one = method(self.loop, X, bound)
            if self.smooth and one.kind == "divergence":
                # LSODA takes ever longer steps at rest until one of them leaves it.
                tighter = smooth.SmoothLoop(self.model, 0.01 * self.rtol)
                one = smooth.settle(tighter, X, bound)
            if one.kind == "cycle" and one.amplitude < 1e-7 * self.scale():
                one = attractor.Attractor("unknown", why="a swing of the size of roundings")
            self.found[key] = one
        return self.found[key]

    def attractors(self, sizes):
        """Distinct attractors from y displaced by each of these about the reference."""
        distinct = []
        for size in sizes:
            one = self.settle(size)
            if one.kind == "unknown":
                continue
            if any(one.kind == other.kind == "cycle" and _slow(one, other) for other in distinct):
                distinct = [other for other in distinct if other.kind != "cycle" or not _slow(one, other)]
            elif one.kind != "cycle":
                if all(other.kind != one.kind for other in distinct):
                    distinct.append(one)
            elif not any(one.same(other) for other in distinct):
                distinct.append(one)
        return distinct


def in_mode(model, frequency, swing, phase):
    """The state in which y is swing cos(phase), in the mode of the loop without its elements nearest this frequency."""
    X = model.start(0.0)
    values, vectors = np.linalg.eig(model.A[:-1, :-1])
    mode = vectors[:, np.argmin(np.abs(values - 1j * frequency))]
    y = model.y[: len(mode)] @ mode
    if abs(y) > 1e-9 * np.linalg.norm(mode):
        X[: len(mode)] += swing * np.real(mode / y * np.exp(1j * phase))
    return X


def _slow(one, other):
    """The same period with another amplitude: slow decay or a continuum, not two cycles."""
    return abs(one.period / other.period - 1.0) < 1e-4 and not one.same(other)
