"""A friction law by itself under velocities that are constant for a while: its deflection, its force, its energy."""

import numpy as np
from scipy.integrate import solve_ivp

from . import laws


class LawMotion:
    """The motion of one law of one bristle, or of one without a state."""

    def __init__(self, keys):
        self.keys = keys
        self.has_state = "sigma0" in keys
        self.level = laws.stribeck_level(keys) if "vs" in keys else (lambda v: keys["Fc"])
        self.stick = max(keys.get("Fs", keys["Fc"]), keys["Fc"])
        self.widest = self.stick / keys["sigma0"] if self.has_state else 1.0
        self.law = laws.bristle(keys) if self.has_state else self._sliding

    def _sliding(self, v, z):
        return np.sign(v) * self.level(v) + self.keys.get("sigma2", 0.0) * v, 0.0

    def speed(self):
        """A velocity that matters: that of the curve, or one that takes a second for the pre-sliding."""
        return self.keys.get("vs", self.widest)

    def run(self, pieces, z=0.0):
        """(z, energy put in, energy to and fro, largest |F|, largest |z|) after pieces of (duration, velocity)."""
        total, turned, force, reach = 0.0, 0.0, 0.0, abs(z)
        for duration, v in pieces:
            size = self.stick * abs(v) * duration

            def rate(t, S, v=v):
                F, dz = self.law(v, S[0])
                return [dz, F * v, abs(F * v)]

            atol = [1e-11 * self.widest, 1e-11 * size + 1e-300, 1e-9 * size + 1e-300]
            done = solve_ivp(rate, (0.0, duration), [z, 0.0, 0.0], "LSODA", rtol=1e-10, atol=atol)
            if done.status != 0:
                raise ArithmeticError(done.message)
            force = max(force, max(abs(self.law(v, one)[0]) for one in done.y[0]))
            reach = max(reach, np.abs(done.y[0]).max())
            z, total, turned = done.y[0][-1], total + done.y[1][-1], turned + done.y[2][-1]
        return z, total, turned, force, reach

    def taken(self, pieces, z=0.0, most=30):
        """(energy taken out in a cycle, energy to and fro) once the deflection repeats itself, or None."""
        for _ in range(most):
            end, energy, turned, _, _ = self.run(pieces, z)
            if abs(end - z) < 1e-9 * self.widest:
                return -energy, turned
            z = end
        return None


def crossing(motion, top=np.inf):
    """How far the two bounds on the slope of a storage cross: (relative size, z, rising speed, falling speed).

    Up over dz at a velocity costs F v/f dz, down at another one returns as much: if some way down returns more than some
    way up costs, at the same place, going to and fro takes energy out without end.
    """
    scale = motion.speed()
    speeds = scale * np.logspace(-8, 9, 171)
    speeds = np.append(speeds[speeds < top], top) if np.isfinite(top) else speeds
    near = 1.0 - np.logspace(-1, -5, 17)
    places = motion.widest * np.concatenate([np.linspace(0.0, 0.9, 61), near])
    worst = (-np.inf, 0.0, 0.0, 0.0)
    for z in places:
        least, most, up, down = np.inf, -np.inf, 0.0, 0.0
        for v in np.concatenate([speeds, -speeds]):
            F, f = motion.law(v, z)
            # A rate that is a rounding has no slope; what v f = 0 costs at rest does not depend on the slope.
            if abs(f) < 1e-9 * abs(v):
                continue
            slope = F * v / f
            if f > 0.0 and slope < least:
                least, up = slope, v
            elif f < 0.0 and slope > most:
                most, down = slope, v
        cross = (most - least) / (abs(most) + abs(least) + 1e-300)
        if cross > worst[0]:
            worst = (cross, z, up, down)
    return worst
