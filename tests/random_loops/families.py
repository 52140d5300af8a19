"""Random loops by family, plausible designs in units of their own.

Each family draws a loop in natural units (mass, bandwidth and sliding force of order one); random factors of length, force
and time, over decades, then make it anybody's loop.
"""

import math

import numpy as np

from . import units


class Dice:
    """Draws from one seed, the same everywhere."""

    def __init__(self, seed, index):
        self.random = np.random.default_rng([seed, index])

    def log(self, low, high):
        """Log-uniform."""
        return float(math.exp(self.random.uniform(math.log(low), math.log(high))))

    def between(self, low, high):
        """Uniform."""
        return float(self.random.uniform(low, high))

    def chance(self, share):
        """True in this share of the draws."""
        return bool(self.random.random() < share)

    def among(self, choices):
        """One of them."""
        return choices[int(self.random.integers(len(choices)))]


def _pid(dice, mass=1.0, stiff=0.0):
    """A servo of bandwidth 1: (s^2 + 2 zeta s + 1)(s + share) by design."""
    zeta, share = dice.between(0.4, 1.4), dice.log(0.05, 0.7)
    keys = {"kind": "pid", "kp": mass * (1.0 + 2.0 * zeta * share) - stiff, "ki": mass * share, "kd": mass * (2.0 * zeta + share)}
    if dice.chance(0.15):
        keys["ki"] = 0.0
    if dice.chance(0.3):
        keys["tf"] = dice.log(0.01, 0.1)
    if dice.chance(0.2):
        keys["lag"] = dice.log(0.01, 0.15)
    if dice.chance(0.3):
        keys["saturation"] = dice.log(2.0, 20.0)
    return keys


def _levels(dice, most=2.5):
    return {"Fc": 1.0, "Fs": dice.between(1.05, most)}


def friction(dice, kind):
    """A law with sliding force 1; speeds of slip are of order one."""
    keys = {"kind": kind}
    if kind == "dahl":
        return keys | {"Fc": 1.0, "sigma0": dice.log(10.0, 1e4), "exponent": dice.among([1.0, 1.0, 2.0])}
    keys |= _levels(dice) if dice.chance(0.85) else {"Fc": 1.0, "Fs": 1.0}
    if dice.chance(0.5):
        keys["sigma2"] = dice.log(0.01, 0.5)
    if kind == "coulomb":
        return keys
    keys["vs"] = dice.log(2e-3, 0.3)
    if kind == "stribeck":
        keys["delta"] = dice.among([0.5, 0.7, 1.0, 1.0, 2.0, 2.0])
    elif kind == "karnopp":
        keys["dv"] = keys["vs"] * dice.log(0.01, 0.2)
    else:
        keys["sigma0"] = dice.log(50.0, 1e5)
        keys["sigma1"] = dice.among([0.0, 1.0, 1.0]) * dice.log(0.1, 1.0) * math.sqrt(keys["sigma0"])
    return keys


def servo(kind):
    """Mass under PID control with a friction law."""

    def draw(dice):
        loop = {}
        if dice.chance(0.2):
            loop["reference"] = dice.between(-2.0, 2.0)
        if dice.chance(0.2):
            loop["load"] = dice.between(-0.6, 0.6)
        plant = {"kind": "mass", "mass": 1.0}
        if dice.chance(0.3):
            plant["damping"] = dice.log(0.01, 0.3)
        return {"loop": loop | {"plant": plant, "controller": _pid(dice), "friction": friction(dice, kind)}}

    return draw


def two_mass(dice):
    """Two masses of sum 1 with a shaft well above the bandwidth."""
    share, shaft = dice.between(0.2, 0.8), dice.log(8.0, 60.0)
    reduced = share * (1.0 - share)
    plant = {"kind": "two-mass", "motor_mass": share, "load_mass": 1.0 - share, "stiffness": reduced * shaft**2}
    plant["damping"] = 2.0 * dice.log(0.02, 0.3) * reduced * shaft
    plant["friction_on"] = dice.among(["motor", "load"])
    plant["measured"] = dice.among(["motor", "motor", "load"])
    controller = _pid(dice)
    controller.pop("lag", None)
    return {"loop": {"plant": plant, "controller": controller, "friction": friction(dice, "coulomb")}}


def belt(kind):
    """Mass on a running belt."""

    def draw(dice):
        plant = {"kind": "belt", "mass": 1.0, "stiffness": 1.0, "damping": dice.among([0.0, 1.0]) * dice.log(0.005, 0.2)}
        plant["speed"] = dice.log(0.02, 1.5)
        return {"loop": {"plant": plant, "friction": friction(dice, kind)}}

    return draw


def _poles(dice, most=4):
    """Stable poles of order one; sometimes an integrator or a pair."""
    count = 1 + int(dice.random.integers(most))
    poles = []
    if dice.chance(0.3):
        poles.append(0.0)
    while len(poles) < count:
        size = dice.log(0.2, 5.0)
        if len(poles) + 2 <= count and dice.chance(0.4):
            zeta = dice.between(0.2, 0.95)
            root = [-zeta * size, size * math.sqrt(1.0 - zeta * zeta)]
            poles += [root, [root[0], -root[1]]]
        else:
            poles.append(-size)
    return poles


def _gain(poles):
    """Size that makes the response to a constant (or its rate) 1."""
    sizes = [abs(complex(*p)) if isinstance(p, list) else abs(p) for p in poles]
    return math.prod(size for size in sizes if size > 0.0)


def relay(delayed):
    """Relay before lags; with a reference or a bias where that keeps it switching."""

    def draw(dice):
        poles = _poles(dice, 3 if delayed else 4)
        plant = {"kind": "zpk", "zeros": [], "poles": poles, "gain": _gain(poles)}
        if delayed:
            plant["delay"] = dice.log(0.05, 2.0)
        element = {"kind": "relay", "level": 1.0}
        if not delayed and (len(poles) < 3 or dice.chance(0.5)):
            element["hysteresis"] = dice.log(0.01, 0.3)
            if dice.chance(0.3):
                element["dead_zone"] = element["hysteresis"] * dice.between(1.2, 3.0)
        elif delayed and dice.chance(0.5):
            element["hysteresis"] = dice.log(0.01, 0.3)
        loop = {}
        if dice.chance(0.4) and 0.0 not in poles:
            loop["reference"] = dice.between(-0.7, 0.7)
        return {"loop": loop | {"plant": plant, "element": element}}

    return draw


def conditional(dice):
    """Dead zone, saturation or backlash before lags with too much or nearly too much gain."""
    poles = _poles(dice, 4)
    while len(poles) < 3:
        poles.append(-dice.log(0.3, 3.0))
    w = np.logspace(-3, 3, 6000)
    G = np.prod([1.0 / (1j * w - (complex(*p) if isinstance(p, list) else p)) for p in poles], axis=0)
    turn = np.flatnonzero((G.imag[:-1] < 0.0) != (G.imag[1:] < 0.0))
    turn = [i for i in turn if G.real[i] < 0.0]
    critical = 1.0 / abs(G[turn[0]]) if turn else 1.0
    kind = dice.among(["saturation", "dead-zone", "backlash"])
    gain = critical * (dice.between(0.4, 0.9) if kind == "backlash" else dice.between(1.1, 4.0))
    size = {"saturation": "limit", "dead-zone": "half_width", "backlash": "half_gap"}[kind]
    plant = {"kind": "zpk", "zeros": [], "poles": poles, "gain": gain}
    return {"loop": {"plant": plant, "element": {"kind": kind, size: 1.0}}}


def sensor_lag(dice):
    """A mass whose position is seen through a lag: a state space with its rubbing velocity named."""
    lag = dice.log(0.01, 0.1)
    damping = dice.between(0.0, 0.2)
    plant = {
        "kind": "state-space",
        "A": [[0.0, 1.0, 0.0], [0.0, -damping, 0.0], [1.0 / lag, 0.0, -1.0 / lag]],
        "B": [[0.0], [1.0], [0.0]],
        "C": [[0.0, 0.0, 1.0]],
        "B_friction": [[0.0], [1.0], [0.0]],
        "C_velocity": [[0.0, 1.0, 0.0]],
    }
    controller = _pid(dice)
    controller.pop("saturation", None)
    return {"loop": {"plant": plant, "controller": controller, "friction": friction(dice, "coulomb")}}


FAMILIES = {
    "coulomb": servo("coulomb"), "stribeck": servo("stribeck"), "karnopp": servo("karnopp"), "lugre": servo("lugre"),
    "dahl": servo("dahl"), "elasto-plastic": servo("elasto-plastic"), "two-mass": two_mass,
    "belt-coulomb": belt("coulomb"), "belt-stribeck": belt("stribeck"), "belt-lugre": belt("lugre"),
    "relay": relay(False), "relay-delay": relay(True), "conditional": conditional, "sensor-lag": sensor_lag,
}  # fmt: skip


def loop(seed, index, family=None):
    """(family, case in random units, case in natural units, factors) of one random loop."""
    dice = Dice(seed, index)
    name = family or list(FAMILIES)[index % len(FAMILIES)]
    natural = FAMILIES[name](dice)
    factors = dice.log(1e-4, 1e2), dice.log(1e-2, 1e4), dice.log(1e-3, 1e1)
    case = {"title": f"{name}, loop {index} of seed {seed}"} | units.scaled(natural, *factors)
    return name, rounded(case), factors


def rounded(entry):
    """Six digits, as a person would write them; the case is then what it says."""
    if isinstance(entry, dict):
        return {key: rounded(value) for key, value in entry.items()}
    if isinstance(entry, list):
        return [rounded(value) for value in entry]
    return float(f"{entry:.6g}") if isinstance(entry, float) else entry
